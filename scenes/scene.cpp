// Finds scenes by name, and counts what is in one.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene.h"

#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/host_threads.h"
#include "scenes/import/scene_file.h"
#include "scenes/instancing.h"
#include "scenes/lumibench/builders.h"
#include "scenes/motions/built_in.h"
#include "scenes/scene_store.h"

namespace glint::scenes {
namespace {

struct Entry {
  const char* name;
  const char* doc;
  uint64_t triangles;  // triangles of the original, as the paper counts them
  Scene (*build)(const LoadOptions& options, const std::string& original);
  // These are files, or folders of OBJ files, below the assets folder; the scene takes the first that is
  // there. None says that the code is the original.
  std::vector<std::string> originals = {};
  std::shared_ptr<const Motion> (*move)(const Scene&) = nullptr;  // null: nothing moves
};

// Return where an original may be: in the application's checkout, or in a folder that is named as the scene.
std::vector<std::string> mesh(const std::string& scene, const std::string& file) {
  return {"assets/models/" + file, "models/" + file, scene + "/" + file, file};
}
std::vector<std::string> folder(const std::string& name, const std::string& scene) {
  return {"Scenes/" + name, "assets/Scenes/" + name, scene};
}

// Lists the scenes in the paper's order, by triangles.
const std::vector<Entry>& all_scenes() {
  static const std::vector<Entry> scenes = {
      {"WKND",
       "487 procedural spheres under a sky; the scene is complete.",
       0,
       build_weekend,
       {},
       whirl_of_spheres},
      {"SHIP", "A schooner with thin masts and rigging, in one structure.", 6'255, build_ship,
       mesh("SHIP", "karimSchooner.obj")},
      {"BUNNY",
       "A bunny in a Cornell box.",
       144'058,
       build_bunny,
       {"assets/models/bunny.obj", "models/bunny.obj", "BUNNY/bunny.obj", "BUNNY/stanford-bunny.obj"},
       swaying_model},
      {"SPNZA",
       "A colonnaded hall with 24 large textures, in one structure.",
       262'267,
       build_sponza,
       {"Scenes/Sponza/sponza.obj", "assets/Scenes/Sponza/sponza.obj", "SPNZA/sponza.obj", "sponza.obj",
        "SPNZA/dabrovic/walls-lib_0.obj", "dabrovic/walls-lib_0.obj"},
       walk_through_sponza},
      {"CHSNT",
       "A chestnut tree whose leaves are cut out by their texture's alpha in any-hit shaders.",
       313'000,
       build_chestnut,
       {"assets/models/chestnut.obj", "models/chestnut.obj", "CHSNT/chestnut.obj", "chestnut.obj",
        "CHSNT/AL05y.obj", "AL05y.obj"}},
      {"BATH", "A bathroom with a mirror and lamps.", 423'821, build_bathroom, folder("Bathroom", "BATH")},
      {"REF",
       "A statue and a glass sphere in a box with mirror walls.",
       448'912,
       build_mirror_box,
       {"assets/models/lucy.obj", "models/lucy.obj", "REF/lucy.obj"}},
      {"CRNVL", "A fairground, in one structure.", 449'600, build_carnival, mesh("CRNVL", "TheCarnival.obj")},
      {"FOX", "A fox in thick fur of long thin triangles, among flowers.", 1'600'000, build_fox,
       folder("Blender_2.90", "FOX")},
      {"PARTY", "A harbour town of 320 structures.", 1'700'000, build_party, folder("Blender_2.83", "PARTY")},
      {"SPRNG", "A figure close to the camera, with grass and a mountain that fills the view.", 1'900'000,
       build_spring, folder("Blender_2.80", "SPRNG")},
      {"LANDS", "Cliffs and boats on reflecting water.", 3'300'000, build_lands,
       folder("Blender_3.2", "LANDS")},
      {"FRST", "An autumn forest of 283 structures.", 4'200'000, build_forest,
       folder("Blender_2.91", "FRST")},
      {"PARK", "Long thin grass, trees and mountains on a procedural ground.", 6'000'000, build_park,
       folder("TreesAndGrass", "PARK")},
      {"CAR", "A racing car of 302 structures with 244 textures.", 12'700'000, build_car,
       folder("Blender_2.77", "CAR")},
      {"ROBOT", "A machine of 248 structures, with the most triangles of all scenes.", 20'600'000,
       build_robot, folder("Blender_2.78", "ROBOT")},
      {"CORNELL", "The Cornell box alone, for tests; not a LumiBench scene.", 0, build_cornell},
  };
  return scenes;
}

uint64_t triangles_of(const Scene& scene, size_t model) {
  return scene.models[model].is_procedural() ? 0 : scene.indices_of(model).size() / 3;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

// Returns the row of a scene by name. Throws UserError with the nearest name when there is none.
const Entry& entry_of(const std::string& name) {
  const std::string wanted = upper_case(name);
  std::vector<std::string> names;
  for (const Entry& entry : all_scenes()) {
    if (wanted == entry.name) return entry;
    names.push_back(entry.name);
  }
  const std::string near = nearest(wanted, names);
  throw UserError({}, fmt::format("unknown scene '{}'", name),
                  near.empty() ? fmt::format("the scenes are {}", fmt::join(names, ", "))
                               : fmt::format("did you mean '{}'?", near));
}

bool holds_objects(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".obj") return true;
  return false;
}

// Returns where the data of the original scene is, or "".
std::string find_original(const Entry& entry, const std::string& assets) {
  for (const std::string& place : entry.originals) {
    const std::filesystem::path path = std::filesystem::path(assets) / place;
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error) || holds_objects(path)) return path.string();
  }
  return "";
}

Scene build_scene(const Entry& entry, const LoadOptions& options) {
  const std::string original = options.assets.empty() ? "" : find_original(entry, options.assets);
  if (original.empty() && !options.assets.empty() && !entry.originals.empty())
    throw UserError({},
                    fmt::format("no file for scene {} in the assets folder '{}'", entry.name, options.assets),
                    fmt::format("expected one of {} there; without an assets folder the scene is built in",
                                fmt::join(entry.originals, ", ")));
  Scene scene = entry.build(options, original);
  scene.original_triangles = entry.triangles;
  if (entry.triangles > 0)
    scene.note += fmt::format(" It has {:.1f} % of the original's triangles.", 100 * scene.fraction());
  return scene;
}

}  // namespace

std::span<const Vertex> Scene::vertices_of(size_t model) const {
  if (!packed) return models[model].vertices;
  const PackedContents::Range& range = packed->models[model];
  return packed->vertices.subspan(range.first_vertex, range.vertices);
}

std::span<const uint32_t> Scene::indices_of(size_t model) const {
  if (!packed) return models[model].indices;
  const PackedContents::Range& range = packed->models[model];
  return packed->indices.subspan(range.first_index, range.indices);
}

std::span<const uint8_t> Scene::texels_of(size_t texture) const {
  return packed ? std::span<const uint8_t>(packed->texels[texture]) : textures[texture].rgba;
}

uint64_t Scene::stored_triangles() const {
  uint64_t count = 0;
  for (size_t i = 0; i < models.size(); ++i) count += triangles_of(*this, i);
  return count;
}

std::vector<Instance> instances_of(const Scene& scene) {
  if (!scene.instances.empty()) return scene.instances;
  std::vector<Instance> once(scene.models.size());
  for (uint32_t i = 0; i < once.size(); ++i) once[i].model = i;
  return once;
}

float diagonal(const Scene& scene) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Vec3 lower{inf, inf, inf}, upper = -lower;
  for (const Instance& instance : instances_of(scene))
    for (const Vertex& vertex : scene.vertices_of(instance.model)) {
      const Vec3 place = Vec4(vertex.position, 1.0f) * instance.to_world;  // GLM's columns are the rows
      lower = glm::min(lower, place);
      upper = glm::max(upper, place);
    }
  return lower[0] <= upper[0] ? glm::length(upper - lower) : 0;
}

uint64_t Scene::triangles() const {
  uint64_t count = 0;
  for (const Instance& instance : instances_of(*this)) count += triangles_of(*this, instance.model);
  return count;
}

double Scene::fraction() const {
  return original_triangles == 0 ? 1 : double(triangles()) / double(original_triangles);
}

uint64_t Scene::procedurals() const {
  uint64_t count = 0;
  for (const Model& model : models) count += model.is_procedural();
  return count;
}

std::vector<SceneInfo> scene_list() {
  std::vector<SceneInfo> list;
  for (const Entry& entry : all_scenes()) list.push_back({entry.name, entry.doc, entry.move != nullptr});
  return list;
}

namespace {

// Gives each material without a name the name of the models that have it, where they all have one name.
void name_materials(Scene& scene) {
  std::vector<const Model*> users(scene.materials.size());  // the last model seen that has the material
  std::vector<bool> is_shared(scene.materials.size());
  for (const Model& model : scene.models)
    for (const Vertex& vertex : model.vertices) {
      const Model*& user = users[size_t(vertex.material)];
      if (user == &model) continue;
      if (user && user->name != model.name) is_shared[size_t(vertex.material)] = true;
      user = &model;
    }
  scene.material_names.resize(scene.materials.size());
  for (size_t i = 0; i < users.size(); ++i)
    if (scene.material_names[i].empty() && users[i] && !is_shared[i])
      scene.material_names[i] = users[i]->name;
}

// Names a scene with all that it depends on besides the program's build and the contents of files.
std::string kept_key(const std::string& name, const Entry* entry, bool instancing) {
  const std::string what =
      entry ? fmt::format("built-in {}", entry->name) : "file " + std::filesystem::absolute(name).string();
  return what + (instancing ? " instancing" : "");
}

}  // namespace

bool has_original(const std::string& name, const std::string& assets) {
  const Entry& entry = entry_of(name);
  return assets.empty() || entry.originals.empty() || !find_original(entry, assets).empty();
}

Scene load_scene(const std::string& name, const LoadOptions& given) {
  LoadOptions options = given;
  options.threads = host_threads(given.threads);
  const Entry* entry = names_scene_file(name) ? nullptr : &entry_of(name);
  const auto load = [&](LookupLog* log) {
    options.log = log;
    Scene scene = entry ? build_scene(*entry, options) : load_scene_file(name, options);
    name_materials(scene);
    if (options.instancing) share_copies(scene);
    return scene;
  };
  // What moves gets other vertices. Builders of originals do not say which files they have looked for.
  const bool is_kept =
      options.store && !options.moving && (!entry || options.assets.empty() || entry->originals.empty());
  if (is_kept) return options.store->find_or_load(kept_key(name, entry, options.instancing), load);
  Scene scene = load(given.log);
  if (options.moving && entry && entry->move) scene.motion = entry->move(scene);
  return scene;
}

}  // namespace glint::scenes
