// Makes a scene of all the OBJ files of a folder: one model per file, with colours by file name.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/asset_folder.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/ordered_work.h"
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

// Holds a model with its own materials and textures, all numbered from 0.
struct LoadedModel {
  Model model;
  std::vector<Material> materials;
  std::vector<Texture> textures;
};

// Reads the files side by side, each on all threads if it is large, and appends the models in order.
class FolderLoader {
 public:
  FolderLoader(Scene& scene, const FolderRules& rules, fs::path folder, const LoadOptions& options)
      : scene_(scene),
        rules_(rules),
        folder_(std::move(folder)),
        options_(options),
        sources_(list_sources(folder_)) {
    std::set<std::string> wanted;
    for (const auto& [name, source] : sources_)
      if (source.is_copy) wanted.insert(source.file);
    const std::vector<std::string> files(wanted.begin(), wanted.end());
    read(
        files.size(), [&](size_t i) { return load(files[i]); },
        [&](size_t i, LoadedModel base) { bases_[files[i]] = std::move(base); });
  }

  // Returns the number of models.
  uint64_t run() {
    std::vector<std::pair<std::string, Source>> sources;
    for (const auto& entry : sources_)
      if (rules_.skip.empty() || entry.first.find(rules_.skip) == std::string::npos) sources.push_back(entry);
    uint64_t models = 0;
    read(
        sources.size(), [&](size_t i) { return model_of(sources[i].first, sources[i].second); },
        [&](size_t i, LoadedModel loaded) {
          models += add(sources[i].first, std::move(loaded));
          if (options_.progress) options_.progress(double(i + 1) / double(sources.size()));
        });
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
  template <class Make, class Take>
  void read(size_t count, Make&& make, Take&& take) const {
    OrderedWork<LoadedModel>(count, options_.threads).run(make, take);
  }

  LoadedModel load(const std::string& file) const {
    LoadedModel out;
    out.model =
        load_obj((folder_ / file).string(), out.materials,
                 {.textures = rules_.textures ? &out.textures : nullptr, .threads = options_.threads});
    return out;
  }

  LoadedModel model_of(const std::string& name, const Source& source) const {
    const auto base = bases_.find(source.file);
    LoadedModel out = base == bases_.end() ? load(source.file)
                      : source.is_copy     ? copy(name, base->second.model, source.matrix)
                                           : base->second;
    out.model.name = name;
    if (rules_.scale != 1)
      for (Vertex& vertex : out.model.vertices) vertex.position = vertex.position * rules_.scale;
    return out;
  }

  // Returns a moved copy, which has the materials of its own library.
  LoadedModel copy(const std::string& name, const Model& base, const Affine& matrix) const {
    LoadedModel out;
    out.materials = load_materials((folder_ / (name + ".mtl")).string());
    if (out.materials.empty()) out.materials.push_back(lambertian(0.7f, 0.7f, 0.7f));
    append_copy(out.model, base, matrix, -1);
    const auto last = int32_t(out.materials.size()) - 1;
    for (Vertex& vertex : out.model.vertices) vertex.material = std::min(vertex.material, last);
    return out;
  }

  // Returns whether the model has triangles, and has become one of the scene.
  bool add(const std::string& name, LoadedModel loaded) {
    if (loaded.model.indices.empty()) return false;
    const auto first = int32_t(scene_.materials.size()), first_texture = int32_t(scene_.textures.size());
    for (Vertex& vertex : loaded.model.vertices) vertex.material += first;
    for (Material& material : loaded.materials)
      if (material.texture >= 0) material.texture += first_texture;
    recolor(name, loaded.materials);
    scene_.models.push_back(std::move(loaded.model));
    scene_.materials.insert(scene_.materials.end(), loaded.materials.begin(), loaded.materials.end());
    std::move(loaded.textures.begin(), loaded.textures.end(), std::back_inserter(scene_.textures));
    return true;
  }

  void recolor(const std::string& name, std::span<Material> materials) const {
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
  const fs::path folder_;
  const LoadOptions& options_;
  const std::map<std::string, Source> sources_;
  std::map<std::string, LoadedModel> bases_;  // of copies, by file
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
  FolderLoader loader(scene, rules, folder, options);
  const uint64_t models = loader.run(), absent = loader.absent();
  scene.form = absent == 0 ? "original" : "partial";
  scene.note = absent == 0 ? fmt::format("The scene is complete: it has the original's {} models.", models)
                           : fmt::format("The scene has {} models; {} files of the original are absent.",
                                         models, absent);
}

}  // namespace glint::scenes
