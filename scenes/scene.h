// A scene as the renderer's buffers will hold it: models, instances, materials, textures, camera, light.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glint::scenes {

using Vec2 = std::array<float, 2>;
using Vec3 = std::array<float, 3>;
using Vec4 = std::array<float, 4>;

enum class MaterialModel : uint32_t {
  Lambertian = 0,
  Metallic = 1,
  Dielectric = 2,
  Isotropic = 3,
  DiffuseLight = 4
};

// std430 layout of binding 6: 32 bytes.
struct Material {
  Vec4 diffuse{};
  int32_t texture = -1;  // index into Scene::textures, -1 = none
  float fuzziness = 0;
  float refraction_index = 0;
  MaterialModel model = MaterialModel::Lambertian;
};
static_assert(sizeof(Material) == 32);

// std430 layout of binding 4: 36 bytes.
struct Vertex {
  Vec3 position{}, normal{};
  Vec2 texture_coordinate{};
  int32_t material = 0;  // index into Scene::materials
};
static_assert(sizeof(Vertex) == 36);

// A model is one bottom-level structure and, unless the scene lists instances, one instance with the identity
// transform, as in the original application. Triangles, or (radius > 0) a procedural sphere whose vertices
// carry only the material.
struct Model {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;  // three a triangle, relative to `vertices`
  Vec3 center{};
  float radius = 0;  // world units; 0 = triangles
  bool is_procedural() const { return radius > 0; }
};

struct Texture {
  std::string name;
  uint32_t width = 1, height = 1;
  std::vector<uint8_t> rgba;  // 4 bytes a texel, row 0 first; no mip maps, bilinear
  // LumiBench's application reads all of its textures as they are and clamped; glTF says otherwise.
  bool srgb = false;    // colours become linear when read
  bool repeat = false;  // outside of 0 to 1, instead of clamping to the edge
};

// Row-major 3x4: what moves a point of a model into the world.
using Affine = std::array<float, 12>;
inline constexpr Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// A model where it stands in the world.
struct Instance {
  uint32_t model = 0;  // index into Scene::models
  Affine to_world = kIdentity;
};

// Look-at camera; angles in degrees, lengths in world units.
struct Camera {
  Vec3 eye{}, target{}, up{0, 1, 0};
  float field_of_view = 40;  // vertical
  float aperture = 0, focus_distance = 10;
  bool has_sky = true;
  Vec3 light_position{};  // used only without sky
  float light_radius = 0;
};

struct Scene {
  std::string name;
  std::string form;  // what the geometry really is: "original", "partial" (files of the original are absent),
                     // "stand-in" (files of another mesh) or "built-in" (generated)
  std::string note;  // one sentence for results: what differs from the original
  std::vector<Model> models;
  std::vector<Instance> instances;  // empty: every model once, in world coordinates
  std::vector<Material> materials;
  std::vector<Texture> textures;
  Camera camera;
  bool alpha_test = false;            // triangle hit groups have the any-hit alpha shader
  uint64_t original_triangles = 0;    // of the application's complete scene; 0 = it has none
  uint64_t triangles() const;         // in the world, each instance's counted
  uint64_t stored_triangles() const;  // of the models
  double fraction() const;            // of the original's triangles; 1 where it has none
  uint64_t procedurals() const;
  uint64_t hash() const;  // of everything that reaches a shader, stable across runs and machines
};

// Scene::instances, or each model once where it has none.
std::vector<Instance> instances_of(const Scene& scene);

struct LoadOptions {
  std::string assets;       // folder of original data, "" = none
  bool instancing = false;  // models that are affine copies of an earlier one become instances of it
  std::function<void(double fraction)> progress = {};  // of loading or generating; may be empty
};

struct SceneInfo {
  std::string name, doc;
};
std::vector<SceneInfo> scene_list();

// Builds a scene by name (case-insensitive), or of a file: .obj, .gltf, .glb. UserError with the nearest name
// when there is none, and when the file is not good.
Scene load_scene(const std::string& name, const LoadOptions& options);

}  // namespace glint::scenes
