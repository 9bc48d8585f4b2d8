// Declares a scene as the renderer's buffers hold it: models, instances, materials, textures, camera, light.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/mat3x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {
class LookupLog;  // base/lookup.h
}

namespace glint::scenes {

class SceneStore;  // scenes/scene_store.h

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;

enum class MaterialModel : uint32_t {
  Lambertian = 0,
  Metallic = 1,
  Dielectric = 2,
  Isotropic = 3,
  DiffuseLight = 4
};

// Has the std430 layout of an element of binding 6, of 32 bytes.
struct Material {
  Vec4 diffuse{};
  int32_t texture = -1;  // index into Scene::textures; -1: the material has none
  float fuzziness = 0;
  float refraction_index = 0;
  MaterialModel model = MaterialModel::Lambertian;
};
static_assert(sizeof(Material) == 32);

// Has the std430 layout of an element of binding 4, of 36 bytes.
struct Vertex {
  Vec3 position{}, normal{};
  Vec2 texture_coordinate{};
  int32_t material = 0;  // index into Scene::materials
};
static_assert(sizeof(Vertex) == 36);

// Holds one bottom-level structure. Unless the scene lists instances, a model is also one instance with the
// identity transform, as in the original application. A model holds triangles or, when radius > 0, a
// procedural sphere whose vertices carry only the material.
struct Model {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;  // three per triangle, relative to `vertices`
  Vec3 center{};
  float radius = 0;  // world units; 0 for triangles
  bool is_procedural() const { return radius > 0; }
};

struct Texture {
  std::string name;
  uint32_t width = 1, height = 1;
  std::vector<uint8_t> rgba;  // 4 bytes per texel, row 0 first; no mip maps; filtered bilinearly
  // LumiBench's application reads all of its textures without conversion and clamps them. glTF files may say
  // otherwise.
  bool srgb = false;    // colours become linear when read
  bool repeat = false;  // coordinates outside of 0 to 1 repeat the picture instead of clamping to its edge
};

// Holds the vertices, indices and texels of a scene in one block of memory: those of all models one after
// another, as the renderer's buffers have them, and then each texture. Models and textures have empty vectors
// then.
struct PackedContents {
  struct Range {
    uint64_t vertices = 0, indices = 0;  // numbers of the model
    uint64_t first_vertex = 0, first_index = 0;
  };
  std::vector<Range> models;
  std::span<Vertex> vertices;
  std::span<uint32_t> indices;
  std::vector<std::span<uint8_t>> texels;  // of each texture
  // Owns the block. Vertices, indices and each texture begin at a multiple of 64 bytes, and
  // FileStore::kRestSlack bytes more can be read behind the last of them.
  std::shared_ptr<void> memory;
  std::vector<uint64_t> hashes;  // of the contents, as Scene::hash() takes them
};

// Holds a 3x4 matrix that moves a point of a model into the world: affine[r] is row r, and affine[r][3] is
// the translation. GLM's columns are these rows, so the 12 floats lie in the order of VkTransformMatrixKHR.
using Affine = glm::mat3x4;
inline constexpr Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// Places a model in the world.
struct Instance {
  uint32_t model = 0;  // index into Scene::models
  Affine to_world = kIdentity;
};

// Describes a look-at camera. Angles are in degrees and lengths in world units.
struct Camera {
  Vec3 eye{}, target{}, up{0, 1, 0};
  float field_of_view = 40;  // vertical
  float aperture = 0, focus_distance = 10;
  bool has_sky = true;
  Vec3 light_position{};  // used only without a sky
  float light_radius = 0;
};

class Motion;  // scenes/motion.h

struct Scene {
  std::string name;
  // This says what the geometry really is: "original", "partial" (files of the original are absent),
  // "stand-in" (files of another mesh) or "built-in" (generated).
  std::string form;
  std::string note;  // sentences for results: what differs from the original
  std::vector<Model> models;
  std::vector<Instance> instances;  // empty: every model stands once, in world coordinates
  std::vector<Material> materials;
  std::vector<std::string> material_names;  // of each material; empty where nothing names it
  std::vector<Texture> textures;
  std::shared_ptr<PackedContents> packed;  // null: models and textures have their contents themselves
  Camera camera;
  bool alpha_test = false;               // Triangle hit groups have the any-hit alpha shader.
  std::shared_ptr<const Motion> motion;  // what moves by itself; null: nothing
  uint64_t original_triangles = 0;  // triangles of the application's complete scene; 0: it has no such scene
  // Return the contents of a model or a texture, wherever they are.
  std::span<const Vertex> vertices_of(size_t model) const;
  std::span<const uint32_t> indices_of(size_t model) const;
  std::span<const uint8_t> texels_of(size_t texture) const;
  uint64_t triangles() const;         // triangles in the world, with those of each instance
  uint64_t stored_triangles() const;  // triangles of the models, each counted once
  double fraction() const;            // share of the original's triangles; 1 when there is no original
  uint64_t procedurals() const;
  // Returns a hash of everything that reaches a shader, on up to `threads` threads of the host (0: one for
  // each processor). It is the same at any number of threads, in every run and on every machine.
  uint64_t hash(uint32_t threads = 1) const;
};

// Returns Scene::instances, or each model once when the scene lists no instances.
std::vector<Instance> instances_of(const Scene& scene);

// Returns the length of the diagonal of the box around everything in the world, in world units. It is 0 for
// an empty scene.
float diagonal(const Scene& scene);

struct LoadOptions {
  std::string assets = {};  // folder of original data; empty: there is none
  bool instancing = false;  // Models that are affine copies of an earlier one become instances of it.
  // It is called while a scene is loaded or generated, and may be empty.
  std::function<void(double fraction)> progress = {};
  // Up to this many threads of the host read or make a scene, and 0 stands for one for each processor. They
  // do not show in it.
  uint32_t threads = 1;
  // Scene::motion is wanted. Skins and morph targets of a glTF file are then read, too, and a file is in its
  // pose at time 0.
  bool moving = false;
  std::string animation = {};  // name or number of the glTF animation to play; empty: the first one
  // A scene that was loaded before is taken from here, and is packed then (Scene::packed). Null: it is loaded
  // each time.
  SceneStore* store = nullptr;
  LookupLog* log = nullptr;  // It gets the paths of all files that are read or looked for, unless it is null.
};

struct SceneInfo {
  std::string name, doc;
  bool moves = false;  // It has a motion.
};
std::vector<SceneInfo> scene_list();

// Returns whether load_scene() finds the data of a scene in a folder of original data. Without a folder, and
// of a scene that is complete as code, it needs none.
bool has_original(const std::string& name, const std::string& assets);

// Builds a scene by name (case-insensitive), or loads one from a file: .obj, .gltf, .glb. Throws UserError
// with the nearest name when no scene has this name, and when the file cannot be read.
Scene load_scene(const std::string& name, const LoadOptions& options);

}  // namespace glint::scenes
