// Reads Wavefront OBJ files as models, by the rules of LumiBench's application.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/obj_loader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <tiny_obj_loader.h>
#include <utility>

#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "scenes/import/obj_chunks.h"
#include "scenes/import/obj_faces.h"
#include "scenes/import/obj_vertices.h"
#include "scenes/import/texture_loader.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

namespace fs = std::filesystem;

// Finds material libraries beside the file that names them, and notes their paths.
class LibraryReader final : public tinyobj::MaterialReader {
 public:
  LibraryReader(const fs::path& folder, LookupLog* log)
      : folder_(folder.empty() ? "" : folder.string() + '/'), log_(log) {}
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* numbers, std::string* warning, std::string* error) override {
    if (log_) log_->add(folder_ + name);
    const std::optional<std::string> text = read_regular_file(folder_ + name);
    if (!text) {
      *warning += fmt::format("{}{} was not found", folder_, name);
      return false;
    }
    std::istringstream stream(*text);
    tinyobj::LoadMtl(numbers, materials, &stream, warning, error);
    return true;
  }

 private:
  const std::string folder_;
  LookupLog* const log_;
};

// Reads the materials of a text whose lines about materials are given. Returns the library's materials and,
// in `material_of`, the number of the material that holds before the first line and after each one. The
// material library of a file in parts has the file's name; another file names its own, relative to its
// folder.
std::vector<tinyobj::material_t> read_materials(std::span<const ObjChunk> chunks, const std::string& path,
                                                const std::vector<std::string>& parts, LookupLog* log,
                                                std::vector<int32_t>& material_of) {
  // The library reads these lines with one face after each, which then has the material.
  std::string text = "v 0 0 0\nf 1 1 1\n";
  size_t faces = 1;
  for (const ObjChunk& chunk : chunks) {
    for (const ObjMaterialLine& line : chunk.material_lines) text.append(line.text).append("\nf 1 1 1\n");
    faces += chunk.material_lines.size();
  }
  std::istringstream stream(text);
  std::istringstream own(
      parts.empty() ? "" : read_regular_file(fs::path(path).replace_extension(".mtl").string()).value_or(""));
  tinyobj::MaterialStreamReader of_parts(own);
  LibraryReader of_file(fs::path(path).parent_path(), log);
  tinyobj::MaterialReader& library =
      parts.empty() ? static_cast<tinyobj::MaterialReader&>(of_file) : of_parts;
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, &library, false, false))
    throw UserError({path}, "this OBJ file cannot be read: " + error, "expected a Wavefront OBJ file");
  // Without this error, a named material library that is absent would silently turn every colour grey.
  if (warning.find("not found") != std::string::npos && materials.empty())
    throw UserError({path}, "its material library cannot be read: " + warning,
                    "put the .mtl file beside the .obj file");
  for (const tinyobj::shape_t& shape : shapes)
    for (const int material : shape.mesh.material_ids) material_of.push_back(std::max(0, material));
  // A later version of the library may join lines that end with a backslash.
  if (material_of.size() != faces)
    throw UserError({path}, "a line \"usemtl\" or \"mtllib\" of this OBJ file cannot be read",
                    "expected the name of a material or of its library alone in such a line");
  return materials;
}

// Holds the text of a file, or of the parts that it was cut into.
class Text {
 public:
  Text(const std::string& path, const std::vector<std::string>& parts, uint32_t threads) {
    const std::vector<std::string> files = parts.empty() ? std::vector{path} : parts;
    std::vector<uint64_t> sizes;
    for (const std::string& file : files) size_ += sizes.emplace_back(size_of_regular_file(file));
    bytes_ = std::make_unique_for_overwrite<char[]>(size_);
    char* at = bytes_.get();
    for (size_t i = 0; i < files.size(); at += sizes[i++])
      if (!read_regular_file(files[i], {at, sizes[i]}, threads))
        throw UserError({files[i]}, "this file cannot be read", "expected a Wavefront OBJ file");
  }
  std::string_view view() const { return {bytes_.get(), size_}; }

 private:
  size_t size_ = 0;
  std::unique_ptr<char[]> bytes_;  // not filled at first, because one thread would then touch all pages
};

Material material_of(const tinyobj::material_t& m) {
  return lambertian(float(m.diffuse[0]), float(m.diffuse[1]), float(m.diffuse[2]));
}

// Gives each of `materials` its texture. `read` are the library's materials, and `folder` is the folder of
// the material library, to which texture names are relative.
void add_textures(std::span<Material> materials, const std::vector<tinyobj::material_t>& read,
                  const fs::path& folder, const ObjReading& reading) {
  std::vector<std::string> paths;
  for (size_t i = 0; i < read.size(); ++i) {
    std::string name = read[i].diffuse_texname;
    while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back()))) name.pop_back();
    if (name.empty()) continue;
    std::replace(name.begin(), name.end(), '\\', '/');
    materials[i].texture = int32_t(reading.textures->size() + paths.size());
    if (materials[i].diffuse == Vec4{0, 0, 0, 1}) materials[i].diffuse = {1, 1, 1, 1};
    paths.push_back((folder / name).string());
  }
  if (reading.log)
    for (const std::string& texture : paths) reading.log->add(texture);
  std::vector<Texture> textures = load_textures(paths, reading.threads);
  std::move(textures.begin(), textures.end(), std::back_inserter(*reading.textures));
}

}  // namespace

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::error_code error;
  if (fs::exists(path, error)) return parts;
  for (char first = 'a'; first <= 'z'; ++first)
    for (char second = 'a'; second <= 'z'; ++second) {
      std::string part = path + '.' + first + second;
      if (!fs::is_regular_file(part, error)) return parts;
      parts.push_back(std::move(part));
    }
  return parts;
}

std::vector<Material> load_materials(const std::string& path) {
  std::ifstream file(path);
  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> read;
  std::string warning, error;
  if (file) tinyobj::LoadMtl(&names, &read, &file, &warning, &error);
  if (!file.is_open() || !error.empty())
    throw UserError({path}, "this material library cannot be read: " + error, "expected an MTL file");
  std::vector<Material> materials;
  for (const tinyobj::material_t& m : read) materials.push_back(material_of(m));
  return materials;
}

Model load_obj(const std::string& path, std::vector<Material>& materials, const ObjReading& reading) {
  const std::vector<std::string> parts = parts_of(path);
  std::optional<Text> text(std::in_place, path, parts, reading.threads);
  const std::vector<ObjChunk> chunks =
      checked_chunks(text->view(), path, reading.threads, reading.chunk_bytes);

  std::vector<int32_t> material_of_line;
  const std::vector<tinyobj::material_t> read =
      read_materials(chunks, path, parts, reading.log, material_of_line);
  for (int32_t& material : material_of_line) material += int32_t(materials.size());
  const size_t first = materials.size();
  for (const tinyobj::material_t& m : read) {
    materials.push_back(material_of(m));
    if (reading.names) reading.names->push_back(m.name);
  }
  if (reading.textures)
    add_textures(std::span(materials).subspan(first), read, fs::path(path).parent_path(), reading);
  if (read.empty()) materials.push_back(lambertian(0.7f, 0.7f, 0.7f));

  ObjMesh mesh = read_obj(chunks, material_of_line, path, reading.threads);
  text.reset();
  const bool has_normals = !mesh.normals.empty();
  Model model = model_of(std::move(mesh), reading.threads);
  model.name = fs::path(path).stem().string();
  if (!has_normals) compute_smooth_normals(model, reading.threads);
  return model;
}

}  // namespace glint::scenes
