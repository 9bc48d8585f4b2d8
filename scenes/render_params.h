// Declares what a frame is rendered with: size, samples, lengths of paths, rays and seed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::scenes {

inline constexpr uint32_t kMaxSide = 16384;  // pixels, the most that the PNG encoder takes

struct RenderParam;

// Holds the parameters of one frame. The default counts of rays are LumiBench's benchmark values.
struct RenderParams {
  uint32_t width = 128, height = 128;
  uint32_t samples = 2;
  uint32_t seed = 1;
  uint32_t bounces = 16;
  uint32_t shadow_rays = 2;
  uint32_t ao_rays = 4;

  // Lists every parameter in the order of run.json. The command line, run.json, the resume keys of suites and
  // the models' repeated runs all follow this list.
  static constexpr std::array<RenderParam, 7> params();
};

// Describes one parameter of a frame.
struct RenderParam {
  uint32_t RenderParams::*field;
  std::string_view key;     // key in run.json; a dot leads into a table
  std::string_view option;  // option of `glint run`; empty when the option --size gives the parameter
  std::string_view unit, doc;
  uint32_t min, max;
};

constexpr std::array<RenderParam, 7> RenderParams::params() {
  constexpr uint32_t kAny = ~0u;
  using P = RenderParams;
  return {{{&P::width, "width", "", "pixel", "Width of the image.", 1, kMaxSide},
           {&P::height, "height", "", "pixel", "Height of the image.", 1, kMaxSide},
           {&P::samples, "samples", "--spp", "sample", "Samples per pixel.", 1, 65536},
           {&P::seed, "seed", "--seed", "", "Seed of the pixel jitter.", 0, kAny},
           {&P::bounces, "rays.bounces", "--bounces", "ray", "Number of rays of the longest path in pt.", 1,
            1000},
           {&P::shadow_rays, "rays.shadow_rays", "--shadow-rays", "ray",
            "Number of shadow rays per hit in sh.", 1, 4096},
           {&P::ao_rays, "rays.ao_rays", "--ao-rays", "ray", "Number of occlusion rays per hit in ao.", 1,
            4096}}};
}

// Returns the key and the value of every parameter, in the order of declaration.
std::vector<std::pair<std::string, uint64_t>> values_of(const RenderParams& params);

}  // namespace glint::scenes
