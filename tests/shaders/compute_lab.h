// Runs compute shaders over buffers, tables of buffers, images and samplers, in real blocks, on both
// machines.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "exec/image.h"
#include "tests/shaders/ray_lab.h"

namespace glint::test {

struct LabImage {
  exec::ImageView view;          // its base is set when it runs
  std::vector<uint32_t> texels;  // in the order of memory
};

using Words = std::vector<uint32_t>;

// Holds descriptor set 0 by binding. After a run, the buffers and images hold what the run left in them.
class ComputeLab {
 public:
  std::map<uint32_t, Words> buffers;
  std::map<uint32_t, std::vector<Words>> buffer_arrays;
  std::map<uint32_t, std::vector<LabImage>> images;
  std::map<uint32_t, std::vector<exec::Sampler>> samplers;
  std::vector<uint32_t> addressed;  // bindings of `buffers` whose addresses are the push constants
  // Describes a buffer of `count` nodes of `bytes` bytes. Each node begins with the address of the next, and
  // the last with 0.
  struct Chain {
    uint32_t binding = 0, bytes = 0, count = 0;
  } linked;
  std::array<uint32_t, 3> grid{1, 1, 1};
  frontend::GlslOptions glsl;
  exec::FaultLog faults;  // faults that the last run let pass

  explicit ComputeLab(std::string file) : file_(std::move(file)) {}
  void run(const LabOptions& options = {});

 private:
  std::string file_;
};

// Returns the machines and register limits for compute shaders. They are fewer than for rays, because
// checking a whole world at once is cheap.
const std::vector<LabOptions>& compute_lab_options();

}  // namespace glint::test
