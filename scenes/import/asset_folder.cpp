// Makes a scene of all the OBJ files of a folder: one model per file, with colours by file name.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/asset_folder.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "base/diagnostics.h"
#include "scenes/import/obj_loader.h"
#include "scenes/lumibench/builders.h"
#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

namespace fs = std::filesystem;

// Describes a model of the folder: a file, or a copy of one.
struct Source {
  std::string file = {};  // an OBJ file that is there
  bool is_copy = false;
  Affine matrix = kIdentity;
};

bool is_first_part(const fs::path& path) {
  return path.extension() == ".aa" && path.stem().extension() == ".obj";
}

void read_copies(const fs::path& folder, std::map<std::string, Source>& sources) {
  std::ifstream table(folder / "instances.tsv");
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string name;
    Source source{.is_copy = true};
    fields >> name >> source.file;
    for (size_t i = 0; i < 12; ++i) fields >> source.matrix[i / 4][i % 4];
    if (!fields)
      throw UserError({(folder / "instances.tsv").string()}, "this line is not a copy: " + line,
                      "expected: name, file, 12 numbers");
    sources[fs::path(name).stem().string()] = source;
  }
}

// Returns the models of the folder, ordered by name.
std::map<std::string, Source> list_sources(const fs::path& folder) {
  std::map<std::string, Source> sources;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (path.extension() == ".obj") sources[path.stem().string()] = {.file = path.filename().string()};
    if (is_first_part(path)) sources[path.stem().stem().string()] = {.file = path.stem().string()};
  }
  read_copies(folder, sources);
  return sources;
}

class FolderLoader {
 public:
  FolderLoader(Scene& scene, const FolderRules& rules, fs::path folder, uint32_t threads)
      : scene_(scene),
        rules_(rules),
        folder_(std::move(folder)),
        threads_(threads),
        sources_(list_sources(folder_)) {
    for (const auto& [name, source] : sources_)
      if (source.is_copy) wanted_.insert(source.file);
  }

  uint64_t run(const LoadOptions& options) {
    uint64_t models = 0;
    size_t done = 0;
    for (const auto& [name, source] : sources_) {
      if (rules_.skip.empty() || name.find(rules_.skip) == std::string::npos) models += add(name, source);
      if (options.progress) options.progress(double(++done) / double(sources_.size()));
    }
    return models;
  }

  // Returns the number of material libraries without an OBJ file.
  uint64_t absent() const {
    uint64_t count = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      count += entry.path().extension() == ".mtl" && !sources_.contains(entry.path().stem().string());
    return count;
  }

 private:
  bool add(const std::string& name, const Source& source) {
    const size_t first = scene_.materials.size(), first_texture = scene_.textures.size();
    Model model = source.is_copy ? copy(name, source) : load(source.file);
    if (model.indices.empty()) {
      scene_.materials.resize(first);
      scene_.textures.resize(first_texture);
      return false;
    }
    model.name = name;
    if (rules_.scale != 1)
      for (Vertex& vertex : model.vertices) vertex.position = vertex.position * rules_.scale;
    scene_.models.push_back(std::move(model));
    recolor(name, std::span(scene_.materials).subspan(first));
    return true;
  }

  Model load(const std::string& file) {
    const size_t first = scene_.materials.size();
    Model model = load_obj((folder_ / file).string(), scene_.materials,
                           {.textures = rules_.textures ? &scene_.textures : nullptr, .threads = threads_});
    if (wanted_.contains(file)) keep(file, model, int32_t(first));
    return model;
  }

  // Keeps a model as the base of copies. The material indices of a base count from 0.
  void keep(const std::string& file, const Model& model, int32_t first) {
    Model& base = bases_[file] = model;
    for (Vertex& vertex : base.vertices) vertex.material -= first;
  }

  Model copy(const std::string& name, const Source& source) {
    if (!bases_.contains(source.file)) {
      std::vector<Material> unused;
      keep(source.file, load_obj((folder_ / source.file).string(), unused, {.threads = threads_}), 0);
    }
    const auto first = int32_t(scene_.materials.size());
    const std::vector<Material> own = load_materials((folder_ / (name + ".mtl")).string());
    scene_.materials.insert(scene_.materials.end(), own.begin(), own.end());
    if (own.empty()) scene_.materials.push_back(lambertian(0.7f, 0.7f, 0.7f));
    const auto last = int32_t(scene_.materials.size()) - 1;
    Model model;
    append_copy(model, bases_[source.file], source.matrix, -1);
    for (Vertex& vertex : model.vertices) vertex.material = std::min(first + vertex.material, last);
    return model;
  }

  void recolor(const std::string& name, std::span<Material> materials) {
    const auto contains = [&](const std::string& part) { return name.find(part) != std::string::npos; };
    for (const NameRule& rule : rules_.colors)
      if (std::any_of(rule.parts.begin(), rule.parts.end(), contains)) {
        std::fill(materials.begin(), materials.end(), rule.material);
        break;
      }
    if (rules_.recolor) rules_.recolor(name, materials);
  }

  Scene& scene_;
  const FolderRules& rules_;
  fs::path folder_;
  const uint32_t threads_;  // of the host
  std::map<std::string, Source> sources_;
  std::set<std::string> wanted_;
  std::map<std::string, Model> bases_;
};

}  // namespace

Material paint(int r, int g, int b) {
  return lambertian(float(r) / 256, float(g) / 256, float(b) / 256);
}

void append_copy(Model& model, const Model& part, const Affine& matrix, int32_t material) {
  const Vec3 rows[3] = {Vec3(matrix[0]), Vec3(matrix[1]), Vec3(matrix[2])};
  const Vec3 move{matrix[0][3], matrix[1][3], matrix[2][3]};
  // The cofactors are the inverse transpose times the determinant, whose sign turns mirrored normals round.
  const Vec3 cofactors[3] = {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
  const float sign = dot(rows[0], cofactors[0]) < 0 ? -1.0f : 1.0f;
  const auto first = uint32_t(model.vertices.size());
  for (const Vertex& v : part.vertices) {
    Vertex copy = v;
    copy.position = Vec3{dot(rows[0], v.position), dot(rows[1], v.position), dot(rows[2], v.position)} + move;
    copy.normal = normalized(
        Vec3{dot(cofactors[0], v.normal), dot(cofactors[1], v.normal), dot(cofactors[2], v.normal)} * sign);
    if (material >= 0) copy.material = material;
    model.vertices.push_back(copy);
  }
  for (const uint32_t index : part.indices) model.indices.push_back(first + index);
}

void load_folder(Scene& scene, const std::string& folder, const LoadOptions& options,
                 const FolderRules& rules) {
  FolderLoader loader(scene, rules, folder, options.threads);
  const uint64_t models = loader.run(options), absent = loader.absent();
  scene.form = absent == 0 ? "original" : "partial";
  scene.note = absent == 0 ? fmt::format("The scene is complete: it has the original's {} models.", models)
                           : fmt::format("The scene has {} models; {} files of the original are absent.",
                                         models, absent);
}

}  // namespace glint::scenes
