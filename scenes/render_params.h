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
  uint32_t width = 128, height = 128;  // of the picture
  // A picture may be a window of a larger frame, with the pixels that the frame has there. It begins at
  // (crop_x, crop_y) from the top left. With zeros the picture is the frame.
  uint32_t crop_x = 0, crop_y = 0, frame_width = 0, frame_height = 0;
  uint32_t whole_width() const { return frame_width ? frame_width : width; }
  uint32_t whole_height() const { return frame_height ? frame_height : height; }
  uint32_t samples = 2;
  uint32_t seed = 1;
  uint32_t bounces = 16;
  uint32_t shadow_rays = 2;
  uint32_t ao_rays = 4;
  uint32_t ao_reach = 0;  // percent of the diagonal of the scene's bounding box; 0: as LumiBench has it

  // Lists every parameter in the order of run.json. The command line, run.json, the resume keys of suites and
  // the models' repeated runs all follow this list.
  static constexpr std::array<RenderParam, 12> params();
};

// Describes one parameter of a frame.
struct RenderParam {
  uint32_t RenderParams::*field;
  std::string_view key;     // key in run.json; a dot leads into a table
  std::string_view option;  // option of `glint run`; empty when the option --size gives the parameter
  std::string_view unit, doc;
  uint32_t min, max;
  bool is_optional = false;  // left out of run.json where the value is 0, and 0 where run.json lacks it
};

constexpr std::array<RenderParam, 12> RenderParams::params() {
  constexpr uint32_t kAny = ~0u;
  using P = RenderParams;
  return {
      {{&P::width, "width", "", "pixel", "Width of the image.", 1, kMaxSide},
       {&P::height, "height", "", "pixel", "Height of the image.", 1, kMaxSide},
       {&P::samples, "samples", "--spp", "sample", "Samples per pixel.", 1, 65536},
       {&P::seed, "seed", "--seed", "", "Seed of the pixel jitter.", 0, kAny},
       {&P::bounces, "rays.bounces", "--bounces", "ray", "Number of rays of the longest path in pt.", 1,
        1000},
       {&P::shadow_rays, "rays.shadow_rays", "--shadow-rays", "ray", "Number of shadow rays per hit in sh.",
        1, 4096},
       {&P::ao_rays, "rays.ao_rays", "--ao-rays", "ray", "Number of occlusion rays per hit in ao.", 1, 4096},
       {&P::ao_reach, "rays.ao_reach", "--ao-reach", "%",
        "Length of occlusion rays in ao, as a percentage of the diagonal of the scene's bounding box; 0: 10 "
        "world units in every scene, as in LumiBench.",
        0, 100, true},
       {&P::crop_x, "crop.x", "", "pixel", "First column of the window.", 0, kMaxSide, true},
       {&P::crop_y, "crop.y", "", "pixel", "First row of the window.", 0, kMaxSide, true},
       {&P::frame_width, "crop.frame_width", "", "pixel", "Width of the frame that has the window.", 0,
        kMaxSide, true},
       {&P::frame_height, "crop.frame_height", "", "pixel", "Height of the frame that has the window.", 0,
        kMaxSide, true}}};
}

// Returns the key and the value of every parameter that run.json has, in the order of declaration.
std::vector<std::pair<std::string, uint64_t>> values_of(const RenderParams& params);

}  // namespace glint::scenes
