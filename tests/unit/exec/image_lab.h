// Runs one image instruction on a warp, for tests of textures and storage images.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exec/executor.h"

namespace glint::exec {

inline uint32_t bits(float x) {
  return std::bit_cast<uint32_t>(x);
}
inline float number(uint32_t x) {
  return std::bit_cast<float>(x);
}
inline Words floats(float r, float g, float b, float a) {
  return {bits(r), bits(g), bits(b), bits(a)};
}

class ImageLab {
 public:
  using Column = std::array<uint32_t, kLanes>;  // one operand of all lanes
  static constexpr uint32_t kUntouched = 0xdead'beef;

  ImageLab() { world.memory = &memory; }

  // Adds an image with texels of zero bits and returns its handle.
  uint32_t add(ImageView view) {
    view.base = memory.allocate("image", view.bytes());
    view.name = "image " + std::to_string(world.images.size());
    world.images.push_back(std::move(view));
    return uint32_t(world.images.size() - 1);
  }
  ImageView& image(uint32_t handle) { return world.images[handle]; }
  std::byte* at(uint32_t handle, const TexelIndex& index) {
    return memory.find(image(handle).address_of(index), image(handle).texel_bytes());
  }
  void put(uint32_t handle, const TexelIndex& index, const Words& words) {
    encode(image(handle).format, words, at(handle, index));
  }

  static Column all(uint32_t x) {
    Column out;
    out.fill(x);
    return out;
  }
  static Column all(float x) { return all(bits(x)); }

  // Runs `op` on the sources, in the order of its operands, and returns the columns of its results. A fault
  // is kept in `fault`.
  std::vector<Column> run(std::string_view op, const std::vector<Column>& sources,
                          LaneMask exec = kAllLanes) {
    isa::Program program;
    program.code.resize(2);
    program.code[0].op = isa::op_index(op);
    program.code[1].op = isa::op_index("exit");
    program.num_registers = isa::kMaxOperands;
    size_t slots = 0, results = 0;
    for (isa::OperandKind kind : isa::op_table()[program.code[0].op].operands.view()) {
      if (isa::is_destination(kind)) results += size_t(isa::slots_of(kind));
      slots += size_t(isa::slots_of(kind));
    }
    if (slots - results != sources.size())
      throw std::logic_error(std::string(op) + ": wrong number of sources");
    for (size_t i = 0; i < slots; ++i) program.code[0].operand[i] = isa::Slot(i);
    const Image linked = link({program});
    world.image = &linked;
    world.raygen = 0;
    world.launch_size = {kLanes, 1, 1};
    Executor executor(world);
    WarpContext warp;
    executor.start(warp, 0);
    warp.simt.active = exec;
    for (size_t i = 0; i < results; ++i) std::fill_n(warp.regs.write(isa::Slot(i)), kLanes, kUntouched);
    for (size_t i = 0; i < sources.size(); ++i)
      std::copy(sources[i].begin(), sources[i].end(), warp.regs.write(isa::Slot(results + i)));
    executor.execute(warp, 0);
    fault = executor.fault();
    texels = executor.texels();
    std::vector<Column> out(results);
    for (size_t i = 0; i < results; ++i) std::copy_n(warp.regs.read(isa::Slot(i)), kLanes, out[i].begin());
    world.image = nullptr;
    return out;
  }
  // Does the same with equal operands in all lanes, and returns the results of lane 0.
  std::vector<uint32_t> run_one(std::string_view op, const std::vector<uint32_t>& sources) {
    std::vector<Column> columns;
    for (uint32_t x : sources) columns.push_back(all(x));
    std::vector<uint32_t> out;
    for (const Column& column : run(op, columns)) out.push_back(column[0]);
    return out;
  }

  mem::AddressSpace memory;
  World world;
  std::optional<Fault> fault;
  TexelList texels;  // texels of the last run
};

// Returns an image of the size that is sampled at its nearest texel.
inline ImageView view_of(isa::ImageShape shape, uint32_t width, uint32_t height = 1, uint32_t depth = 1,
                         TexelFormat format = TexelFormat::R32Float) {
  ImageView out;
  out.shape = shape;
  out.width = width, out.height = height, out.depth = depth;
  out.format = format;
  out.sampler.mag = out.sampler.min = Filter::Nearest;
  return out;
}

// Returns a number that differs from texel to texel.
inline float pattern(const TexelIndex& at) {
  return float((at.x * 37 + at.y * 101 + at.z * 53 + at.layer * 211 + at.level * 17) % 97) / 16.0f;
}

// Adds an image whose texels have the pattern, and returns its handle.
inline uint32_t add_pattern(ImageLab& lab, const ImageView& image) {
  const uint32_t handle = lab.add(image);
  for (TexelIndex at; at.level < image.levels; ++at.level)
    for (at.layer = 0; at.layer < image.layers; ++at.layer)
      for (at.z = 0; at.z < image.extent(2, at.level); ++at.z)
        for (at.y = 0; at.y < image.extent(1, at.level); ++at.y)
          for (at.x = 0; at.x < image.extent(0, at.level); ++at.x)
            lab.put(handle, at, floats(pattern(at), 0, 0, 0));
  return handle;
}

}  // namespace glint::exec
