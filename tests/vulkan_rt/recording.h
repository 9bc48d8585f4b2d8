// Holds the recorded conformance set: its scene, rays, records and picture as the driver of a GPU left them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::vulkan_rt {

using Vec3 = std::array<float, 3>;

struct Ray {  // struct Ray of shaders/common.glsl
  Vec3 origin;
  float tmin;
  Vec3 direction;
  float tmax;
};

struct Record {  // struct Rec of shaders/common.glsl
  uint32_t kind, instance, custom, primitive, geometry, hit_kind, tag, flags, anyhits, hash, inters, call;
  float t, u, v, tmin;
  Vec3 origin;
  float nx;
  Vec3 direction;
  float ny;
};
static_assert(sizeof(Ray) == 32 && sizeof(Record) == 96);

struct Geometry {
  bool triangles = true, opaque = false;
  uint32_t first_vertex = 0, count = 0;  // of triangles or boxes
};

struct Instance {
  uint32_t bottom = 0, mask = 0, custom = 0, sbt_offset = 0, flags = 0;
  std::array<float, 12> transform{};
};

struct Mode {
  std::string name;
  uint32_t pattern = 0, ray_flags = 0, mask = 0, sbt_offset = 0, sbt_stride = 0, miss_index = 0,
           any_hit_mode = 0, callable = 0;
};

struct Recording {
  std::filesystem::path folder;
  std::vector<std::array<float, 4>> vertices, spheres;
  std::vector<std::vector<Geometry>> bottoms;
  std::vector<Instance> instances;
  std::vector<Mode> modes;
  uint32_t rays_per_pattern = 0, first_launch_index = 0;
  std::vector<Ray> rays;        // [pattern][ray]
  std::vector<Record> records;  // [mode][ray]
  uint32_t image_size = 0;
  std::vector<float> image;  // RGBA

  const Ray& ray(const Mode& mode, uint32_t i) const {
    return rays[size_t(mode.pattern) * rays_per_pattern + i];
  }
};

// Returns GLINT_VULKAN_RT_DIR, or the folder beside the repository.
std::filesystem::path recording_folder();
bool has_recording();
// Reads the files, which are plain or packed with zstd. Throws std::runtime_error when something is missing
// or does not fit.
const Recording& recording();

}  // namespace glint::vulkan_rt
