// Provides a small world built by hand for shaders: buffers, images, three instances and a binding table, on
// both machines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "exec/image.h"
#include "frontend/compile.h"
#include "pipeline/params.h"

namespace glint::test {

inline uint32_t bits(float x) {
  return std::bit_cast<uint32_t>(x);
}

// Names shaders by their files in tests/shaders/glsl. An empty name is a null shader.
struct LabShaders {
  std::string raygen;
  std::vector<std::string> miss;
  struct Group {
    std::string closest, any, intersection;
  };
  std::vector<Group> hit;
  frontend::GlslOptions glsl;
  std::vector<std::string> callable = {};
};

struct LabOptions {
  uint32_t max_registers = 64;
  bool schedule = true;
  bool timing = false;
  const char* any_hit = "immediate";
  exec::OnFault on_fault = exec::OnFault::Stop;
  const char* node_format = "bvh6";
  bool software = false;  // rays are traversed in shader code
};

// Holds this scene, seen from above along -z. Lane (x, y) of a launch of kWidth x kHeight shoots at (x + 1/2,
// y + 1/2):
//   x 0, 1  nothing
//   x 2     instance 0 (custom index 100, record 0, moved by (2, 0, 0)):
//           geometry 0, an opaque quad [0,1] x [0,6], z 0
//   x 3     the same instance, geometry 1: the quad moved by one, not opaque
//   x 4, 5  instance 1 (custom index 200, record 0): the same quads at (4, 0, 2), z scaled by 3
//   x 6, 7  instance 2 (custom index 300, record 4): boxes of one unit, z in [-1, 1], primitive y;
//           geometry 0 opaque, geometry 1 not opaque
// The triangles of a quad have the corners (0,0) (1,0) (1,6) and (0,0) (1,6) (0,6).
class RayLab {
 public:
  static constexpr uint32_t kWidth = 8, kHeight = 6, kLanesUsed = kWidth * kHeight;
  static constexpr uint32_t kImageWidth = 8, kImageHeight = 6;

  // Descriptor set 0 has: at binding 0 the top level, at 1 the results (uint[]), at 2 a storage image of
  // kImageWidth x kImageHeight, and at 3 two textures of 2 x 2 texels. `buffers` adds buffers by binding, and
  // `set1` fills set 1.
  std::map<uint32_t, std::vector<uint32_t>> buffers, set1;
  std::vector<uint32_t> push_constants;
  uint32_t words_per_lane = 8;
  uint32_t max_trace_depth = 1, max_callable_depth = 31;
  // The data of records, in words and by record; a record that is left out has no data. Binding 30 holds the
  // top level's address, and binding 31 an array of a null structure and the top level.
  std::vector<uint32_t> raygen_data;
  std::vector<std::vector<uint32_t>> miss_data, hit_data, callable_data;

  explicit RayLab(LabShaders shaders) : shaders_(std::move(shaders)) {}

  // Compiles, verifies and runs the launch, and returns the results, words_per_lane for each lane. After the
  // run, `image` and `buffers_after` hold the storage image and the buffers. Throws the same errors as
  // pipeline::render().
  std::vector<uint32_t> run(const LabOptions& options = {});
  std::vector<float> image;
  exec::FaultLog faults;  // faults that were let pass
  std::map<uint32_t, std::vector<uint32_t>> buffers_after;

 private:
  LabShaders shaders_;
};

// Compiles one file of tests/shaders/glsl and verifies the program.
isa::Program compile_lab(const std::string& file, const frontend::GlslOptions& glsl = {},
                         const LabOptions& options = {});
std::string lab_file(const std::string& file);

// Returns the machines and register limits with which every check runs.
const std::vector<LabOptions>& all_lab_options();
std::string to_string(const LabOptions& options);

}  // namespace glint::test
