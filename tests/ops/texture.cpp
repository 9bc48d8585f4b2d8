// Checks texture ops against a scalar filter in double precision: every format, wrap mode, filter and level.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <vector>

#include "tests/ops/numbers.h"
#include "tests/ops/oracle.h"
#include "tests/ops/sampling.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Says what the name of a texture op asks for.
struct Texture {
  bool gathers = false, fetches = false, has_level = false, has_gradients = false, compares = false,
       has_offset = false, is_float = true;
  size_t component = 0, results = 4;
  Geometry geometry;
};
Texture texture_of(std::string_view name) {
  const auto parts = parts_of(name);
  Texture out;
  out.geometry = geometry_of(parts);
  out.gathers = parts[0] == "tld4";
  out.fetches = parts.back() == "s32";  // the type of the coordinates
  out.is_float = parts[parts.size() - 2] == "f32";
  out.results = 1;
  for (std::string_view part : parts) {
    out.has_level |= part == "level";
    out.has_gradients |= part == "grad";
    out.compares |= part == "compare";
    out.has_offset |= part == "offset";
    if (part == "v4") out.results = 4;
    if (part.size() == 1) out.component = std::string_view("rgba").find(part);
  }
  return out;
}

exec::Sampler sampler_for(const Texture& op, Random& random) {
  const auto filter = [&] {
    return op.is_float && random.below(3) ? exec::Filter::Linear : exec::Filter::Nearest;
  };
  exec::Sampler out;
  out.mag = filter(), out.min = filter(), out.mip = filter();
  for (exec::Wrap& wrap : out.wrap) wrap = exec::Wrap(random.below(5));
  for (uint32_t& word : out.border)
    word = op.is_float ? uint32_t(bits_of(kSingle, double(random.below(4097)) / 1024 - 2))
                       : uint32_t(random.next());
  out.lod_bias = float(random.below(9)) / 4 - 1;
  out.min_lod = float(random.below(3)) / 2;
  out.max_lod = random.below(2) ? 1000.0f : 2.25f;
  out.compare = exec::Comparison(random.below(8));
  if (!op.compares && random.below(3) == 0) out.reduction = exec::Reduction(1 + random.below(2));
  constexpr float kAnisotropies[] = {1, 2, 2.5f, 4, 16};
  out.max_anisotropy = kAnisotropies[random.below(5)];
  out.unnormalized = !op.geometry.is_cube && random.below(5) == 0;
  return out;
}

// Returns a number of few bits between the two.
double between(double low, double high, double step, Random& random) {
  return low + step * random.below(uint32_t((high - low) / step) + 1);
}

Request request_for(const Texture& op, const PlainImage& image, const exec::Sampler& sampler,
                    Random& random) {
  Request out;
  const size_t coordinates = op.geometry.is_cube ? 3 : size_t(op.geometry.axes);
  for (size_t i = 0; i < coordinates; ++i) {
    const auto size = double(image.extent(int(i), 0));
    out.at[i] = op.geometry.is_cube    ? between(-1, 1, 1.0 / 64, random)
                : sampler.unnormalized ? between(-8, size + 8, 0.25, random)
                                       : between(-1.5, 2.5, 1.0 / 256, random);
    if (op.has_gradients && random.below(4)) {
      out.dx[i] = between(-0.25, 0.25, 1.0 / 128, random);
      out.dy[i] = between(-0.25, 0.25, 1.0 / 128, random);
    }
    if (op.has_offset) out.offset[i] = int64_t(random.below(16)) - 8;
  }
  out.layer = int64_t(random.below(8)) - 2;
  out.has_level = op.has_level, out.has_gradients = op.has_gradients, out.compares = op.compares;
  if (op.has_level) out.level = between(-2, 6, 1.0 / 8, random);
  out.reference = random.below(2) ? random.below(3) * 0.5 : between(-2.5, 2.5, 1.0 / 512, random);
  return out;
}

uint32_t word(double x) {
  return uint32_t(bits_of(kSingle, x));
}

// Returns the words of the operands, in their order.
std::vector<uint32_t> operands_of(const Texture& op, uint32_t handle, const Request& request) {
  std::vector<uint32_t> out{handle};
  const size_t coordinates = op.geometry.is_cube ? 3 : size_t(op.geometry.axes);
  if (op.geometry.has_layers) out.push_back(uint32_t(request.layer));
  for (size_t i = 0; i < coordinates; ++i) out.push_back(word(request.at[i]));
  if (op.has_level) out.push_back(word(request.level));
  for (size_t i = 0; op.has_gradients && i < coordinates; ++i) out.push_back(word(request.dx[i]));
  for (size_t i = 0; op.has_gradients && i < coordinates; ++i) out.push_back(word(request.dy[i]));
  uint32_t offsets = uint32_t(0xa5) << 24;  // The highest byte means nothing.
  for (size_t i = 0; i < 3; ++i) offsets |= uint32_t(uint8_t(request.offset[i])) << (8 * i);
  if (op.has_offset) out.push_back(offsets);
  if (op.compares) out.push_back(word(request.reference));
  return out;
}

// Holds what the lanes give to the op, and what they should get: numbers, because filters round.
struct TexturePlan {
  std::vector<std::vector<uint32_t>> operands;
  std::vector<Colour> expected;
  std::vector<const Format*> format;
};

TexturePlan sampling_plan(const Texture& op, OpLab& lab, const std::vector<PlainImage>& images,
                          const Spaces& spaces, Random& random) {
  TexturePlan out;
  for (const PlainImage& image : images) lab.world.images[image.handle].sampler = sampler_for(op, random);
  for (int i = 0; i < 20; ++i) lab.world.samplers.push_back(sampler_for(op, random));
  while (out.operands.size() < kThreads) {
    const PlainImage& image = images[random.below(uint32_t(images.size()))];
    // The upper bits of a handle choose the image's own sampler, or another.
    const uint32_t chosen = random.below(21);
    const exec::Sampler& sampler =
        chosen ? lab.world.samplers[chosen - 1] : lab.world.images[image.handle].sampler;
    const Request request = request_for(op, image, sampler, random);
    if (op.geometry.is_cube && request.at == std::array<double, 3>{}) continue;
    Sampling sampling(image, sampler, op.geometry, spaces.images[image.handle]);
    const Colour expected = op.gathers ? sampling.gather(request, op.component) : sampling.sample(request);
    if (!sampling.is_sharp()) continue;
    out.operands.push_back(operands_of(op, image.handle | chosen << 20, request));
    out.expected.push_back(expected);
    out.format.push_back(&image.format);
  }
  return out;
}

// Fetches name texels by integers. Outside of the image, robust access reads zeros, and one where the format
// has no alpha.
TexturePlan fetch_plan(const Texture& op, const std::vector<PlainImage>& images, const Spaces& spaces,
                       Random& random) {
  TexturePlan out;
  for (size_t t = 0; t < kThreads; ++t) {
    const PlainImage& image = images[random.below(uint32_t(images.size()))];
    const bool strays = random.below(4) == 0;
    const auto pick = [&](int64_t size) {
      return strays ? int64_t(random.below(uint32_t(size + 4))) - 2 : int64_t(random.below(uint32_t(size)));
    };
    TexelAt at;
    at.level = op.has_level ? pick(image.view.levels) : 0;
    const bool has_level = at.level >= 0 && at.level < image.view.levels;
    bool is_inside = has_level;
    for (int axis = 0; axis < op.geometry.axes; ++axis) {
      const int64_t size = image.extent(axis, has_level ? at.level : 0);
      at.at[size_t(axis)] = pick(size);
      is_inside &= at.at[size_t(axis)] >= 0 && at.at[size_t(axis)] < size;
    }
    if (op.geometry.has_layers) at.layer = pick(image.view.layers);
    is_inside &= at.layer >= 0 && at.layer < image.view.layers;
    std::vector<uint32_t> operands{image.handle};
    if (op.geometry.has_layers) operands.push_back(uint32_t(at.layer));
    for (int axis = 0; axis < op.geometry.axes; ++axis) operands.push_back(uint32_t(at.at[size_t(axis)]));
    if (op.has_level) operands.push_back(uint32_t(at.level));
    out.operands.push_back(operands);
    out.expected.push_back(is_inside ? image.read(spaces.images[image.handle], at) : kept(image.format, {}));
    out.format.push_back(&image.format);
  }
  return out;
}

// Returns how a lane's words differ from the expected numbers, or "".
std::string wrong_words(const Texture& op, const TexturePlan& plan, const Outcome& outcome,
                        uint64_t enabled) {
  for (size_t t = 0; t < kThreads; ++t)
    for (size_t i = 0; i < op.results; ++i) {
      const uint32_t is = outcome.results[i][t];
      const bool is_enabled = enabled >> t & 1;
      const double expected = plan.expected[t][i], number = value_of(kSingle, is);
      // Single precision moves a weight by up to 1e-5, and texels differ by up to 4.
      const bool fits = !is_enabled    ? is == OpLab::kUntouched
                        : !op.is_float ? is == words_of(*plan.format[t], plan.expected[t])[i]
                                       : std::fabs(number - expected) <= 1e-4;
      if (!fits)
        return fmt::format("thread {}, result {}: {} ({:#x}) and not {}, from {}", t, i, number, is,
                           is_enabled ? expected : 0, plan.format[t]->name);
    }
  return "";
}

uint64_t check_once(const isa::OpRow& row, const Texture& op, uint64_t enabled, uint64_t seed) {
  OpLab lab(row);
  Random random{seed};
  const std::vector<PlainImage> images =
      add_images(lab, op.geometry, op.is_float ? Formats::Floats : Formats::Integers,
                 op.geometry.is_buffer ? 1 : 4, random);
  Spaces before = lab.random_spaces(random);
  fill_moderate(images, before, random);
  lab.world.robust_images = true;
  const TexturePlan plan =
      op.fetches ? fetch_plan(op, images, before, random) : sampling_plan(op, lab, images, before, random);
  REQUIRE(lab.num_sources() == plan.operands.front().size());
  REQUIRE(lab.num_results() == op.results);
  std::vector<Column> sources(lab.num_sources());
  for (size_t t = 0; t < kThreads; ++t)
    for (size_t i = 0; i < sources.size(); ++i) sources[i][t] = plan.operands[t][i];
  const Outcome outcome = lab.run(sources, enabled, before);
  CHECK(outcome.fault == "");
  CHECK(wrong_words(op, plan, outcome, enabled) == "");
  CHECK(difference(outcome, {}, before) == "");
  if (!op.fetches) return outcome.lanes;
  // Without robust access, a fetch outside of the image is a fault.
  lab.world.robust_images = false;
  for (size_t i = 1; i <= op.geometry.operands(); ++i) sources[i][7] = uint32_t(-1);
  CHECK(lab.run(sources, 1 << 7, before).fault.find("reads texel") != std::string::npos);
  return outcome.lanes;
}

}  // namespace

uint64_t check_texture(const isa::OpRow& row) {
  const Texture op = texture_of(row.name);
  return check_once(row, op, ~uint64_t{0}, 1) + check_once(row, op, 0x8421'0f07'1357'9bdf, 2) +
         check_once(row, op, ~uint64_t{0}, 3);
}

}  // namespace glint::test
