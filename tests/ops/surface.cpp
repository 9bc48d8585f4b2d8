// Checks loads, stores, atomics and reductions of storage images against plain bytes and a codec of formats.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

#include "tests/ops/image_set.h"
#include "tests/ops/numbers.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Says what the name of a surface op asks for.
struct Surface {
  std::string_view verb;       // suld, sust, suatom, sured
  std::string_view operation;  // of suatom and sured: add, min and so on
  std::string_view type, outside;
  bool counts_bytes = false;
  uint32_t words = 1, bytes = 4;  // of the data in registers and in memory
  Geometry geometry;
  bool stores() const { return verb == "sust"; }
  bool changes() const { return verb == "suatom" || verb == "sured"; }
};
Surface surface_of(std::string_view name) {
  const auto parts = parts_of(name);
  Surface out;
  out.verb = parts[0];
  out.counts_bytes = parts[1] == "b";
  if (out.changes()) out.operation = parts[2];
  out.outside = parts.back();
  out.type = parts[parts.size() - 2];
  out.geometry = geometry_of(parts);
  for (std::string_view part : parts)
    if (part == "v2" || part == "v4") out.words = uint32_t(part[1] - '0');
  const uint32_t bits = out.type == "b8" ? 8 : out.type == "b16" ? 16 : out.type == "b64" ? 64 : 32;
  if (bits == 64) out.words = 2;
  out.bytes = bits == 64 ? 8 : bits / 8 * out.words;
  return out;
}

bool is_for(const Surface& op, const Format& format) {
  if (!op.changes() || op.counts_bytes) return true;
  // An atomic changes one word of 32 bits, or two.
  return format.channels.front().bits == 32 && format.bytes() == op.bytes;
}

// Returns what an atomic leaves.
uint64_t turn(const Surface& op, uint64_t old, uint64_t b, uint64_t c) {
  const auto as_signed = [](uint64_t x) { return int64_t(int32_t(uint32_t(x))); };
  const bool is_signed = op.type == "s32";
  if (op.operation == "add" && op.type == "f32") {
    const double sum = value_of(kSingle, old) + value_of(kSingle, b);
    return std::isnan(sum) ? 0x7fff'ffff : bits_of(kSingle, sum);
  }
  if (op.operation == "add") return uint32_t(old + b);
  if (op.operation == "min" || op.operation == "max") {
    const bool less = is_signed ? as_signed(old) < as_signed(b) : old < b;
    return less == (op.operation == "min") ? old : b;
  }
  if (op.operation == "and") return old & b;
  if (op.operation == "or") return old | b;
  if (op.operation == "xor") return old ^ b;
  if (op.operation == "exch") return b;
  if (op.operation == "cas") return old == b ? c : old;
  throw std::logic_error(fmt::format("the oracle does not know the atomic '{}'", op.operation));
}

enum class Where { Inside, Anywhere };

// Picks a place: inside of the image, or also outside on any side. Atomics of a warp meet in few texels, and
// warps stay apart.
TexelAt pick(const Surface& op, const PlainImage& image, size_t thread, Where where, Random& random) {
  TexelAt out;
  const uint32_t step = op.counts_bytes ? op.bytes : 1;
  for (int axis = 0; axis < op.geometry.axes; ++axis) {
    const int64_t size = axis == 0 && op.counts_bytes ? image.extent(0, 0) * image.format.bytes() / step
                                                      : image.extent(axis, 0);
    int64_t& at = out.at[size_t(axis)];
    at = where == Where::Inside ? int64_t(random.below(uint32_t(size)))
                                : int64_t(random.below(uint32_t(2 * size))) - size / 2;
    // Warps use even and odd columns of texels, so that no order of theirs counts.
    if (axis == 0 && where == Where::Inside) {
      at = op.changes() ? random.below(2) * 2 : at / 2 * 2;
      at = std::min<int64_t>(at, (size - 2) / 2 * 2) + int64_t(thread / 32);
    }
    if (axis > 0 && op.changes()) at = std::min<int64_t>(at, 1);
    if (axis == 0) at *= step;
  }
  if (op.geometry.has_layers)
    out.layer = where == Where::Inside ? random.below(image.view.layers)
                                       : int64_t(random.below(image.view.layers + 4)) - 2;
  return out;
}

// Returns the byte of the image where the access goes, or nothing when it goes nowhere.
std::optional<size_t> place_of(const Surface& op, const PlainImage& image, TexelAt place) {
  const int64_t row_bytes = image.extent(0, 0) * image.format.bytes();
  const auto inside = [&](int64_t& at, int64_t size, int64_t step) {
    const int64_t last = (size - step) / step * step;
    if (at >= 0 && at <= last) return true;
    if (op.outside == "clamp") at = std::clamp<int64_t>(at, 0, last);
    return op.outside == "clamp";
  };
  bool is_inside =
      op.counts_bytes ? inside(place.at[0], row_bytes, op.bytes) : inside(place.at[0], image.extent(0, 0), 1);
  for (int axis = 1; axis < op.geometry.axes; ++axis)
    is_inside = inside(place.at[size_t(axis)], image.extent(axis, 0), 1) && is_inside;
  is_inside = inside(place.layer, image.view.layers, 1) && is_inside;
  if (!is_inside) return std::nullopt;
  if (!op.counts_bytes) return image.offset(place);
  const auto skipped = size_t(place.at[0]);
  place.at[0] = 0;
  return image.offset(place) + skipped;
}

uint32_t data_word(const Surface& op, const Format& format, Random& random) {
  const uint64_t r = random.next();
  const bool is_float = op.changes() ? op.type == "f32" : !format.is_integer();
  if (op.operation == "cas") return uint32_t(r % 3);
  if (!is_float) return uint32_t(r >> (r >> 59));
  return uint32_t(r >> 62 == 0 ? corner_of(kSingle, random.next())
                               : bits_of(kSingle, double(r % 4096) / 1024 - 2));
}

// Holds one run: what the lanes give to the op, and what has to come of it.
struct Plan {
  std::vector<Column> sources, results;
  Spaces before, expected;
};

void apply(const Surface& op, const PlainImage& image, std::optional<size_t> place, const Words& data,
           uint64_t swap, Bytes& bytes, Words& result) {
  if (!place) return;
  uint8_t* const at = bytes.data() + *place;
  if (op.changes()) {
    uint64_t old = 0, operand = data[0];
    std::memcpy(&old, at, op.bytes);
    if (op.bytes == 8) operand |= uint64_t{data[1]} << 32;
    const uint64_t left = turn(op, old, operand, swap);
    std::memcpy(at, &left, op.bytes);
    result = {uint32_t(old), uint32_t(old >> 32)};
  } else if (op.stores()) {
    const auto texel = texel_of(image.format, data);
    op.counts_bytes ? std::memcpy(at, data.data(), op.bytes) : std::memcpy(at, texel.data(), texel.size());
  } else if (op.counts_bytes) {
    std::memcpy(result.data(), at, op.bytes);
  } else {
    result = words_of(image.format, read_texel(image.format, at));
  }
}

Plan plan_of(const Surface& op, const OpLab& lab, const std::vector<PlainImage>& images, uint64_t enabled,
             Where where, Random& random) {
  Plan out{std::vector<Column>(lab.num_sources()),
           std::vector<Column>(lab.num_results()),
           lab.random_spaces(random),
           {}};
  if (!op.counts_bytes && !op.changes()) fill_moderate(images, out.before, random);
  if (op.changes())
    for (const PlainImage& image : images)
      for (size_t at = 0; at + 4 <= out.before.images[image.handle].size(); at += 4) {
        const uint32_t word = data_word(op, image.format, random);
        std::memcpy(out.before.images[image.handle].data() + at, &word, 4);
      }
  out.expected = out.before;
  for (size_t t = 0; t < kThreads; ++t) {
    const PlainImage& image = images[random.below(uint32_t(images.size()))];
    const TexelAt texel = pick(op, image, t, where, random);
    size_t source = 0;
    out.sources[source++][t] = image.handle;
    if (op.geometry.has_layers) out.sources[source++][t] = uint32_t(texel.layer);
    for (int axis = 0; axis < op.geometry.axes; ++axis)
      out.sources[source++][t] = uint32_t(texel.at[size_t(axis)]);
    Words data{}, result{OpLab::kUntouched, OpLab::kUntouched, OpLab::kUntouched, OpLab::kUntouched};
    const size_t first = source;
    for (; source < lab.num_sources(); ++source) out.sources[source][t] = data_word(op, image.format, random);
    for (size_t i = 0; i < op.words && first + i < source; ++i) data[i] = out.sources[first + i][t];
    uint64_t swap = 0;
    for (size_t i = 0; op.operation == "cas" && i < op.words; ++i)
      swap |= uint64_t{out.sources[first + op.words + i][t]} << (32 * i);
    if (enabled >> t & 1) {
      result = {};
      apply(op, image, place_of(op, image, texel), data, swap, out.expected.images[image.handle], result);
    }
    for (size_t i = 0; i < out.results.size(); ++i) out.results[i][t] = result[i];
  }
  return out;
}

// Stores outside of an image meet in clamped texels, so only one warp runs them.
constexpr uint64_t kFirstWarp = 0xffff'ffff, kSparse = 0x8421'0f07'1357'9bdf, kEverybody = ~uint64_t{0};

uint64_t check_once(const isa::OpRow& row, const Surface& op, uint64_t enabled, Where where, uint64_t seed) {
  OpLab lab(row);
  Random random{seed};
  std::vector<PlainImage> images = add_images(lab, op.geometry, Formats::All, 1, random);
  std::erase_if(images, [&](const PlainImage& image) { return !is_for(op, image.format); });
  const size_t data = op.verb == "suld" ? 0 : op.words * (op.operation == "cas" ? 2 : 1);
  REQUIRE(lab.num_sources() == 1 + op.geometry.operands() + data);
  REQUIRE(lab.num_results() == (op.verb == "suld" || op.verb == "suatom" ? op.words : 0));
  const Plan plan = plan_of(op, lab, images, enabled, where, random);
  const Outcome outcome = lab.run(plan.sources, enabled, plan.before);
  if (where == Where::Anywhere && op.outside == "trap") {
    CHECK(outcome.fault.find(op.verb == "suld" ? "reads texel" : "writes texel") != std::string::npos);
    return 0;
  }
  CHECK(difference(outcome, plan.results, plan.expected) == "");
  return outcome.lanes;
}

}  // namespace

uint64_t check_surface(const isa::OpRow& row) {
  const Surface op = surface_of(row.name);
  return check_once(row, op, kEverybody, Where::Inside, 1) + check_once(row, op, kSparse, Where::Inside, 2) +
         check_once(row, op, kFirstWarp, Where::Anywhere, 3);
}

}  // namespace glint::test
