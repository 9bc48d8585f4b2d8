// Finds scenes by name, and counts what is in one.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene.h"

#include <bit>
#include <cctype>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/diagnostics.h"
#include "scenes/import/scene_file.h"
#include "scenes/instancing.h"
#include "scenes/lumibench/builders.h"
#include "scenes/motions/built_in.h"

namespace glint::scenes {
namespace {

struct Entry {
  const char* name;
  const char* doc;
  uint64_t triangles;  // triangles of the original, as the paper counts them
  Scene (*build)(const LoadOptions&);
  std::shared_ptr<const Motion> (*move)(const Scene&) = nullptr;  // null: nothing moves
};

// Lists the scenes in the paper's order, by triangles.
constexpr Entry kScenes[] = {
    {"WKND", "487 procedural spheres under a sky; the scene is complete.", 0, build_weekend,
     whirl_of_spheres},
    {"SHIP", "A schooner with thin masts and rigging, in one structure.", 6'255, build_ship},
    {"BUNNY", "A bunny in a Cornell box.", 144'058, build_bunny, swaying_model},
    {"SPNZA", "A colonnaded hall with 24 large textures, in one structure.", 262'267, build_sponza,
     walk_through_sponza},
    {"CHSNT", "A chestnut tree whose leaves are cut out by their texture's alpha in any-hit shaders.",
     313'000, build_chestnut},
    {"BATH", "A bathroom with a mirror and lamps.", 423'821, build_bathroom},
    {"REF", "A statue and a glass sphere in a box with mirror walls.", 448'912, build_mirror_box},
    {"CRNVL", "A fairground, in one structure.", 449'600, build_carnival},
    {"FOX", "A fox in thick fur of long thin triangles, among flowers.", 1'600'000, build_fox},
    {"PARTY", "A harbour town of 320 structures.", 1'700'000, build_party},
    {"SPRNG", "A figure close to the camera, with grass and a mountain that fills the view.", 1'900'000,
     build_spring},
    {"LANDS", "Cliffs and boats on reflecting water.", 3'300'000, build_lands},
    {"FRST", "An autumn forest of 283 structures.", 4'200'000, build_forest},
    {"PARK", "Long thin grass, trees and mountains on a procedural ground.", 6'000'000, build_park},
    {"CAR", "A racing car of 302 structures with 244 textures.", 12'700'000, build_car},
    {"ROBOT", "A machine of 248 structures, with the most triangles of all scenes.", 20'600'000, build_robot},
    {"CORNELL", "The Cornell box alone, for tests; not a LumiBench scene.", 0, build_cornell},
};

// Hashes contents with FNV-1a, widened to 64-bit words and finished as in MurmurHash3. It takes values, never
// the bytes of structs, so neither padding nor byte order changes the hash.
class ContentHash {
 public:
  void add(uint64_t word) { state_ = (state_ ^ word) * 0x100000001b3 ^ state_ >> 29; }
  void add(float value) { add(uint64_t{std::bit_cast<uint32_t>(value)}); }
  // Takes a vector, or a matrix in the order of its floats.
  template <class Values>
  requires(Values::length() > 0) void add(const Values& values) {
    for (size_t i = 0; i < Values::length(); ++i) add(values[i]);
  }
  uint64_t result() const {
    uint64_t x = state_;
    x = (x ^ x >> 33) * 0xff51afd7ed558ccd;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53;
    return x ^ x >> 33;
  }

 private:
  uint64_t state_ = 0xcbf29ce484222325;
};

void add(ContentHash& hash, const Model& model) {
  hash.add(uint64_t{model.vertices.size()});
  for (const Vertex& v : model.vertices) {
    hash.add(v.position);
    hash.add(v.normal);
    hash.add(v.texture_coordinate);
    hash.add(uint64_t(uint32_t(v.material)));
  }
  hash.add(uint64_t{model.indices.size()});
  for (const uint32_t index : model.indices) hash.add(uint64_t{index});
  hash.add(model.center);
  hash.add(model.radius);
}

void add(ContentHash& hash, const Texture& texture) {
  hash.add(uint64_t{texture.width} << 32 | texture.height);
  if (texture.srgb || texture.repeat) hash.add(uint64_t{texture.srgb} << 1 | uint64_t{texture.repeat});
  for (const uint8_t byte : texture.rgba) hash.add(uint64_t{byte});
}

void add(ContentHash& hash, const Camera& c) {
  for (const Vec3& v : {c.eye, c.target, c.up, c.light_position}) hash.add(v);
  for (const float value : {c.field_of_view, c.aperture, c.focus_distance, c.light_radius}) hash.add(value);
  hash.add(uint64_t{c.has_sky});
}

uint64_t triangles_of(const Model& model) {
  return model.is_procedural() ? 0 : model.indices.size() / 3;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

// Returns the scene of a name. Sets `entry` to its row.
Scene build_scene(const std::string& name, const LoadOptions& options, const Entry*& found) {
  const std::string wanted = upper_case(name);
  std::vector<std::string> names;
  for (const Entry& entry : kScenes) {
    names.push_back(entry.name);
    if (wanted != entry.name) continue;
    found = &entry;
    Scene scene = entry.build(options);
    scene.original_triangles = entry.triangles;
    if (entry.triangles > 0)
      scene.note += fmt::format(" It has {:.1f} % of the original's triangles.", 100 * scene.fraction());
    return scene;
  }
  const std::string near = nearest(wanted, names);
  throw UserError({}, fmt::format("unknown scene '{}'", name),
                  near.empty() ? fmt::format("the scenes are {}", fmt::join(names, ", "))
                               : fmt::format("did you mean '{}'?", near));
}

}  // namespace

uint64_t Scene::stored_triangles() const {
  uint64_t count = 0;
  for (const Model& model : models) count += triangles_of(model);
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
    for (const Vertex& vertex : scene.models[instance.model].vertices) {
      const Vec3 place = Vec4(vertex.position, 1.0f) * instance.to_world;  // GLM's columns are the rows
      lower = glm::min(lower, place);
      upper = glm::max(upper, place);
    }
  return lower[0] <= upper[0] ? glm::length(upper - lower) : 0;
}

uint64_t Scene::triangles() const {
  uint64_t count = 0;
  for (const Instance& instance : instances_of(*this)) count += triangles_of(models[instance.model]);
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

uint64_t Scene::hash() const {
  ContentHash content;
  content.add(uint64_t{models.size()});
  for (const Model& model : models) add(content, model);
  for (const Instance& instance : instances) {
    content.add(uint64_t{instance.model});
    content.add(instance.to_world);
  }
  content.add(uint64_t{materials.size()});
  for (const Material& m : materials) {
    content.add(m.diffuse);
    content.add(uint64_t(uint32_t(m.texture)));
    content.add(m.fuzziness);
    content.add(m.refraction_index);
    content.add(uint64_t(m.model));
  }
  content.add(uint64_t{textures.size()});
  for (const Texture& texture : textures) add(content, texture);
  add(content, camera);
  content.add(uint64_t{alpha_test});
  return content.result();
}

std::vector<SceneInfo> scene_list() {
  std::vector<SceneInfo> list;
  for (const Entry& entry : kScenes) list.push_back({entry.name, entry.doc, entry.move != nullptr});
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

}  // namespace

Scene load_scene(const std::string& name, const LoadOptions& options) {
  const Entry* entry = nullptr;
  Scene scene = names_scene_file(name) ? load_scene_file(name, options) : build_scene(name, options, entry);
  name_materials(scene);
  if (options.instancing) share_copies(scene);
  if (options.moving && entry && entry->move) scene.motion = entry->move(scene);
  return scene;
}

}  // namespace glint::scenes
