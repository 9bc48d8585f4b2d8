// Reads Wavefront OBJ files as models, by the rules of LumiBench's application.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/obj_loader.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <optional>
#include <tiny_obj_loader.h>
#include <utility>

#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "scenes/import/obj_check.h"
#include "scenes/import/texture_loader.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

// Hashes what makes two corners the same vertex: the values, not the file's indices.
struct VertexHash {
  size_t operator()(const Vertex& v) const {
    uint64_t state = uint64_t(uint32_t(v.material)) + 0x9e3779b97f4a7c15;
    const auto mix = [&state](float value) {
      // The sum turns -0 into +0, because the two zeros are equal and must hash alike.
      state = (state ^ std::bit_cast<uint32_t>(value + 0.0f)) * 0xff51afd7ed558ccd;
      state ^= state >> 32;
    };
    for (size_t i = 0; i < 3; ++i) mix(v.position[i]);
    for (size_t i = 0; i < 3; ++i) mix(v.normal[i]);
    for (size_t i = 0; i < 2; ++i) mix(v.texture_coordinate[i]);
    return size_t(state);
  }
};
struct VertexEqual {
  bool operator()(const Vertex& a, const Vertex& b) const {
    return a.position == b.position && a.normal == b.normal && a.texture_coordinate == b.texture_coordinate &&
           a.material == b.material;
  }
};

// Finds vertices by value, and appends those that are new. It holds only their numbers, in a table that is at
// most half full, so that a lookup touches little memory.
class VertexTable {
 public:
  explicit VertexTable(std::vector<Vertex>& vertices) : vertices_(vertices) {}

  uint32_t index_of(const Vertex& vertex) {
    if (2 * (vertices_.size() + 1) > places_.size()) grow();
    uint32_t& place = place_of(vertex);
    if (place == kNone) {
      place = uint32_t(vertices_.size());
      vertices_.push_back(vertex);
    }
    return place;
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;
  static constexpr size_t kLeast = 1024;

  // Returns where the vertex is, or the free place where it belongs.
  uint32_t& place_of(const Vertex& vertex) {
    const size_t mask = places_.size() - 1;
    size_t at = VertexHash{}(vertex)&mask;
    while (places_[at] != kNone && !VertexEqual{}(vertices_[places_[at]], vertex)) at = (at + 1) & mask;
    return places_[at];
  }
  void grow() {
    places_.assign(std::max(kLeast, 2 * places_.size()), kNone);
    for (uint32_t i = 0; i < vertices_.size(); ++i) place_of(vertices_[i]) = i;
  }

  std::vector<Vertex>& vertices_;
  std::vector<uint32_t> places_;  // numbers of vertices; the count of places is a power of two
};

Vertex corner_of(const tinyobj::attrib_t& attributes, const tinyobj::index_t& index, int32_t material) {
  const auto at = [](const std::vector<float>& values, int i) { return values[size_t(i)]; };
  Vertex vertex;
  const auto triple = [&at](const std::vector<float>& values, int i) -> Vec3 {
    return {at(values, 3 * i), at(values, 3 * i + 1), at(values, 3 * i + 2)};
  };
  vertex.position = triple(attributes.vertices, index.vertex_index);
  if (index.normal_index >= 0) vertex.normal = triple(attributes.normals, index.normal_index);
  if (index.texcoord_index >= 0)
    vertex.texture_coordinate = {at(attributes.texcoords, 2 * index.texcoord_index),
                                 1 - at(attributes.texcoords, 2 * index.texcoord_index + 1)};
  vertex.material = material;
  return vertex;
}

std::string contents(const std::string& path) {
  std::optional<std::string> text = read_regular_file(path);
  if (!text) throw UserError({path}, "this file cannot be read", "expected a Wavefront OBJ file");
  return std::move(*text);
}

bool parse(tinyobj::ObjReader& reader, const std::string& path) {
  tinyobj::ObjReaderConfig config;
  config.triangulate = false;  // The loader's own triangulation is not a fan.
  config.vertex_color = false;
  const std::vector<std::string> parts = parts_of(path);
  if (parts.empty()) {
    check_obj(contents(path), path);
    return reader.ParseFromFile(path, config);
  }
  std::string text;
  for (const std::string& part : parts) text += contents(part);
  check_obj(text, path);
  const std::string library = std::filesystem::path(path).replace_extension(".mtl").string();
  return reader.ParseFromString(text, read_regular_file(library).value_or(""), config);
}

tinyobj::ObjReader read(const std::string& path) {
  tinyobj::ObjReader reader;
  if (!parse(reader, path))
    throw UserError({path}, "this OBJ file cannot be read: " + reader.Error(),
                    "expected a Wavefront OBJ file");
  // Without this error, a named material library that is absent would silently turn every colour grey.
  if (reader.Warning().find("not found") != std::string::npos && reader.GetMaterials().empty())
    throw UserError({path}, "its material library cannot be read: " + reader.Warning(),
                    "put the .mtl file beside the .obj file");
  return reader;
}

Material material_of(const tinyobj::material_t& m) {
  return lambertian(float(m.diffuse[0]), float(m.diffuse[1]), float(m.diffuse[2]));
}

// Gives a material the texture `name`. `folder` is the folder of the library, to which texture names are
// relative.
void add_texture(Material& material, std::string name, const std::filesystem::path& folder,
                 std::vector<Texture>& textures) {
  if (name.empty()) return;
  while (std::isspace(static_cast<unsigned char>(name.back()))) name.pop_back();
  std::replace(name.begin(), name.end(), '\\', '/');
  textures.push_back(load_texture((folder / name).string()));
  material.texture = int32_t(textures.size() - 1);
  if (material.diffuse == Vec4{0, 0, 0, 1}) material.diffuse = {1, 1, 1, 1};
}

}  // namespace

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::error_code error;
  if (std::filesystem::exists(path, error)) return parts;
  for (char first = 'a'; first <= 'z'; ++first)
    for (char second = 'a'; second <= 'z'; ++second) {
      std::string part = path + '.' + first + second;
      if (!std::filesystem::is_regular_file(part, error)) return parts;
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

Model load_obj(const std::string& path, std::vector<Material>& materials, std::vector<Texture>* textures,
               std::vector<std::string>* names) {
  const tinyobj::ObjReader reader = read(path);
  const auto base = int32_t(materials.size());
  for (const tinyobj::material_t& m : reader.GetMaterials()) {
    materials.push_back(material_of(m));
    if (names) names->push_back(m.name);
    if (textures)
      add_texture(materials.back(), m.diffuse_texname, std::filesystem::path(path).parent_path(), *textures);
  }
  if (reader.GetMaterials().empty()) materials.push_back(lambertian(0.7f, 0.7f, 0.7f));

  Model model;
  model.name = std::filesystem::path(path).stem().string();
  VertexTable known(model.vertices);
  const tinyobj::attrib_t& attributes = reader.GetAttrib();
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    const tinyobj::index_t* corner = shape.mesh.indices.data();
    for (size_t face = 0; face < shape.mesh.num_face_vertices.size(); ++face) {
      const size_t corners = shape.mesh.num_face_vertices[face];
      const int32_t material = base + std::max(0, shape.mesh.material_ids[face]);
      for (size_t k = 2; k < corners; ++k)
        for (const size_t i : {size_t{0}, k - 1, k})
          model.indices.push_back(known.index_of(corner_of(attributes, corner[i], material)));
      corner += corners;
    }
  }
  if (attributes.normals.empty()) compute_smooth_normals(model);
  return model;
}

}  // namespace glint::scenes
