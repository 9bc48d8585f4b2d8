// Declares what a frame is rendered with: size, samples, lengths of paths, rays, seed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::scenes {

inline constexpr uint32_t kMaxSide = 16384;  // pixels; images beyond it exceed what the PNG encoder takes

struct RenderParam;

// The parameters of one frame. The counts of rays are LumiBench's benchmark values.
struct RenderParams {
  uint32_t width = 128, height = 128;
  uint32_t samples = 2;
  uint32_t seed = 1;
  uint32_t bounces = 16;
  uint32_t shadow_rays = 2;
  uint32_t ao_rays = 4;

  // Every parameter, in the order in which run.json has them. The command line, run.json, the resume keys of
  // suites and repeated runs of the models all follow this list.
  static constexpr std::array<RenderParam, 7> params();
};

// One parameter of a frame.
struct RenderParam {
  uint32_t RenderParams::*field;
  std::string_view key;     // in run.json; a dot leads into a table
  std::string_view option;  // of `glint run`; empty: the option --size gives the parameter
  std::string_view unit, doc;
  uint32_t min, max;
};

constexpr std::array<RenderParam, 7> RenderParams::params() {
  constexpr uint32_t kAny = ~0u;
  using P = RenderParams;
  return {
      {{&P::width, "width", "", "pixel", "Width of the image.", 1, kMaxSide},
       {&P::height, "height", "", "pixel", "Height of the image.", 1, kMaxSide},
       {&P::samples, "samples", "--spp", "sample", "Samples per pixel.", 1, 65536},
       {&P::seed, "seed", "--seed", "", "Seed of the pixel jitter.", 0, kAny},
       {&P::bounces, "rays.bounces", "--bounces", "ray", "Rays of the longest path of pt.", 1, 1000},
       {&P::shadow_rays, "rays.shadow_rays", "--shadow-rays", "ray", "Shadow rays per hit of sh.", 1, 4096},
       {&P::ao_rays, "rays.ao_rays", "--ao-rays", "ray", "Occlusion rays per hit of ao.", 1, 4096}}};
}

// The key and the value of every parameter, in declaration order.
std::vector<std::pair<std::string, uint64_t>> values_of(const RenderParams& params);

}  // namespace glint::scenes
