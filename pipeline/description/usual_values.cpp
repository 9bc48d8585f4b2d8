// Holds the usual values by name.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/usual_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstddef>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <initializer_list>
#include <vector>

#include "exec/texture_format.h"

namespace glint::pipeline {
namespace {

using frontend::BlockType;
using Matrix4 = std::array<double, 16>;  // column after column

constexpr uint32_t kMostWritten = 64;  // elements of an array that are written out

// The camera stands at (0, 1, 4) and looks at the origin: a turn about x whose sine is 1 / sqrt(17).
constexpr double kSine = 0.242536, kCosine = 0.970143, kDistance = 4.123106;
constexpr Matrix4 kView{1, 0, 0, 0, 0, kCosine, kSine, 0, 0, -kSine, kCosine, 0, 0, 0, -kDistance, 1};
constexpr Matrix4 kViewInverse{1, 0, 0, 0, 0, kCosine, -kSine, 0, 0, kSine, kCosine, 0, 0, 1, 4, 1};
// This is a perspective of 60 degrees onto a square, from 0.1 to 100, with depths from 0 to 1 and y downwards
// as in Vulkan's pictures.
constexpr double kFocal = 1.732051, kNear = 0.1, kFar = 100;
constexpr Matrix4 kProjection{
    kFocal, 0, 0, 0, 0, -kFocal, 0, 0, 0, 0, kFar / (kNear - kFar), -1, 0, 0, kNear* kFar / (kNear - kFar),
    0};
constexpr Matrix4 kProjectionInverse{
    1 / kFocal, 0, 0, 0, 0, -1 / kFocal, 0, 0, 0, 0, 0, (kNear - kFar) / (kNear * kFar), 0, 0, -1, 1 / kNear};
constexpr Matrix4 kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix4 product(const Matrix4& a, const Matrix4& b) {
  Matrix4 out{};
  for (size_t column = 0; column < 4; ++column)
    for (size_t row = 0; row < 4; ++row)
      for (size_t k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return out;
}

std::string lower(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return name;
}

// Returns a block of a run-time array of numbers of 32 bits.
BlockType list_of(const std::string& number) {
  BlockType each, list, block;
  each.number = number, each.offsets = {0}, each.bytes = 4;
  list.kind = BlockType::Kind::Array, list.stride = 4, list.element = {each};
  block.kind = BlockType::Kind::Struct, block.members = {{"values", 0, list}};
  return block;
}

bool has_any(const std::string& name, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return name.find(word) != std::string::npos; });
}

Matrix4 matrix_of(const std::string& name) {
  const bool is_inverse = has_any(name, {"inv", "toworld", "to_world"});
  const bool is_view = has_any(name, {"view", "camera", "cam"}), is_projection = has_any(name, {"proj"});
  if (is_view && is_projection)
    return is_inverse ? product(kViewInverse, kProjectionInverse) : product(kProjection, kView);
  if (is_projection) return is_inverse ? kProjectionInverse : kProjection;
  if (is_view) return is_inverse ? kViewInverse : kView;
  return kIdentity;
}

// Returns the numbers of a vector or of one number; vectors take as many as they have.
std::array<double, 4> vector_of(const std::string& name, bool is_vector, uint32_t side) {
  const double s = side;
  if (has_any(name, {"time", "frame", "seed", "offset"})) return {0, 0, 0, 0};
  if (!is_vector) return {1, 1, 1, 1};
  if (has_any(name, {"resolution", "size", "extent", "viewport", "dimension"})) return {s, s, 1, 1};
  const bool is_direction = has_any(name, {"dir", "forward", "front"});
  if (has_any(name, {"light", "sun"}) && is_direction) return {0.48, 0.8, 0.36, 0};
  if (has_any(name, {"light", "sun"}) && has_any(name, {"pos"})) return {2, 4, 3, 1};
  if (is_direction) return {0, -kSine, -kCosine, 0};
  if (has_any(name, {"target", "lookat", "look_at", "center", "centre"})) return {0, 0, 0, 1};
  if (has_any(name, {"eye", "pos", "origin", "camera"})) return {0, 1, 4, 1};
  if (name == "up" || name.ends_with("up")) return {0, kCosine, -kSine, 0};
  if (name.ends_with("right")) return {1, 0, 0, 0};
  return {1, 1, 1, 1};
}

uint32_t integer_of(const std::string& name, uint32_t side) {
  if (has_any(name, {"width", "height", "resolution", "size", "extent"})) return side;
  return has_any(name, {"num", "count", "samples", "spp", "rays", "bounces", "depth", "steps", "iterations"})
             ? 4
             : 0;
}

std::string number_text(double value, bool is_real) {
  if (!is_real) return fmt::format("{}", int64_t(value));
  const std::string text = fmt::format("{:.6g}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text == "-0.0" ? "0.0" : text;
}

std::string numbers_text(const std::string& name, const BlockType& type, uint32_t side) {
  const bool is_real = type.number[0] == 'f';
  const size_t count = type.offsets.size();
  std::vector<std::string> out;
  const Matrix4 matrix = matrix_of(name);
  const std::array<double, 4> vector = vector_of(name, count > 1, side);
  for (size_t i = 0; i < count; ++i) {
    double value = integer_of(name, side);
    // Matrices of 3 x 3 and 3 x 4 numbers have 9 and 12; only square ones can be told apart by their number.
    if (is_real && count > 4)
      value = count == 16 ? matrix[i] : count == 9 ? matrix[i / 3 * 4 + i % 3] : double(i % 5 == 0);
    else if (is_real)
      value = vector[std::min<size_t>(i, 3)];
    out.push_back(number_text(value, is_real));
  }
  return count == 1 ? out[0] : fmt::format("[{}]", fmt::join(out, ", "));
}

}  // namespace

std::string default_text(const frontend::SpecConstant& c) {
  if (c.number == "bool") return c.value ? "true" : "false";
  if (c.number == "f16") return fmt::format("{}", exec::from_half(uint16_t(c.value)));
  if (c.number == "f32") return fmt::format("{}", std::bit_cast<float>(uint32_t(c.value)));
  if (c.number == "f64") return fmt::format("{}", std::bit_cast<double>(c.value));
  if (c.number[0] == 's' && c.number != "s64") return fmt::format("{}", int32_t(c.value));
  return fmt::format("{}", int64_t(c.value));
}

const BlockType* target_of(const std::string& name, const BlockType& type) {
  static const BlockType kFloats = list_of("f32"), kWholeNumbers = list_of("u32");
  if (!type.target.empty()) return &type.target[0];
  const std::string small = lower(name);
  const bool is_address = type.kind == BlockType::Kind::Numbers && type.number == "u64" &&
                          type.offsets.size() == 1 && has_any(small, {"addr", "pointer", "ptr"});
  if (!is_address) return nullptr;
  return has_any(small, {"ind"}) ? &kWholeNumbers : &kFloats;
}

bool has_targets(const std::string& name, const BlockType& type) {
  return target_of(name, type) ||
         std::any_of(type.element.begin(), type.element.end(),
                     [&](const BlockType& element) { return has_targets(name, element); }) ||
         std::any_of(type.members.begin(), type.members.end(), [](const frontend::BlockMember& member) {
           return has_targets(member.name, member.type);
         });
}

std::string usual_value(const std::string& name, const BlockType& type, uint32_t side,
                        const NameTarget& name_target) {
  if (const BlockType* target = target_of(name, type))
    return fmt::format("\"{}\"", name_target(name, *target));
  if (type.kind == BlockType::Kind::Array) {
    const uint32_t count = type.count == 0 ? has_targets(name, type) : std::min(type.count, kMostWritten);
    const std::string each = count ? usual_value(name, type.element[0], side, name_target) : "";
    return fmt::format("[{}]", fmt::join(std::vector<std::string>(count, each), ", "));
  }
  if (type.kind == BlockType::Kind::Struct) {
    std::vector<std::string> members;
    for (const auto& member : type.members)
      members.push_back(
          fmt::format("{} = {}", member.name, usual_value(member.name, member.type, side, name_target)));
    return fmt::format("{{ {} }}", fmt::join(members, ", "));
  }
  return numbers_text(lower(name), type, side);
}

}  // namespace glint::pipeline
