// Reads ACCELERATION_STRUCTURE: geometries of bottom levels and instances of top levels.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "amber/parse.h"

namespace glint::amber {
namespace {

constexpr int64_t k24Bits = 0xff'ffff;

void parse_geometry(Parsing& p, BottomLevel& level) {
  const std::string kind = p.tokens.word("the kind of geometry");
  if (kind != "TRIANGLES" && kind != "AABBS") p.unsupported("GEOMETRY " + kind);
  BottomLevel::Geometry geometry;
  std::vector<float> numbers;
  Token token = p.tokens.next_after_line_ends();
  if (token.is("FLAGS")) {
    for (token = p.tokens.next(); token.is_word(); token = p.tokens.next()) {
      if (token.text == "OPAQUE")
        geometry.opaque = true;
      else if (token.text == "NO_DUPLICATE_ANY_HIT")
        geometry.no_duplicate_any_hit = true;
      else
        p.wrong(fmt::format("there is no geometry flag '{}'", token.text));
    }
    token = p.tokens.next_after_line_ends();
  }
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends()) {
    double value = 0;
    if (!parse_real(token.text, value)) p.wrong(fmt::format("'{}' is not a coordinate", token.text));
    numbers.push_back(float(value));
  }
  if (!token.is_word()) p.wrong("END is missing");
  const size_t each = kind == "TRIANGLES" ? 9 : 6;
  if (numbers.empty() || numbers.size() % each)
    p.wrong(fmt::format("found {} coordinates, but {} need {} each", numbers.size(), kind, each));
  if (kind == "TRIANGLES")
    geometry.vertices = numbers;
  else
    for (size_t i = 0; i < numbers.size(); i += 6)
      geometry.boxes.push_back(
          {{numbers[i], numbers[i + 1], numbers[i + 2]}, {numbers[i + 3], numbers[i + 4], numbers[i + 5]}});
  if (!level.geometries.empty() && level.geometries[0].boxes.empty() != geometry.boxes.empty())
    p.wrong("a bottom level cannot hold both triangles and AABBs");
  level.geometries.push_back(std::move(geometry));
}

uint32_t flag_named(Parsing& p, const std::string& name) {
  int64_t number = 0;
  if (name == "TRIANGLE_FACING_CULL_DISABLE") return rt::instance_flag::kFacingCullDisable;
  if (name == "TRIANGLE_FLIP_FACING") return rt::instance_flag::kFlipFacing;
  if (name == "FORCE_OPAQUE") return rt::instance_flag::kForceOpaque;
  if (name == "FORCE_NO_OPAQUE") return rt::instance_flag::kForceNoOpaque;
  if (name == "FORCE_OPACITY_MICROMAP_2_STATE" || name == "DISABLE_OPACITY_MICROMAPS")
    return 0;  // Scripts have no micromaps.
  if (!parse_integer(name, number) || number < 0 || number > 0xf)
    p.wrong(fmt::format("there is no instance flag '{}'", name));
  return uint32_t(number);
}

// Reads flags that stand on the line or, if the line has no flags, on the lines up to END.
void parse_flags(Parsing& p, rt::Instance& instance) {
  if (p.tokens.peek().is_word()) {
    while (p.tokens.peek().is_word()) instance.flags |= flag_named(p, p.tokens.next().text);
    return;
  }
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends())
    instance.flags |= flag_named(p, token.text);
  if (!token.is_word()) p.wrong("END is missing");
}

void parse_transform(Parsing& p, rt::Instance& instance) {
  for (float& each : instance.transform) {
    double value = 0;
    const Token token = p.tokens.next_after_line_ends();
    if (!token.is_word() || !parse_real(token.text, value)) p.wrong("a transform has twelve numbers");
    each = float(value);
  }
  if (!p.tokens.next_after_line_ends().is("END"))
    p.wrong("END of the transform is missing: it has twelve numbers");
}

void parse_instance(Parsing& p, TopLevel& level) {
  const std::string name = p.tokens.word("the bottom level");
  p.find(p.script.bottom_levels, name, "bottom level");
  rt::Instance instance;
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends()) {
    if (token.text == "INDEX")
      instance.custom_index = uint32_t(p.tokens.integer("the index", 0, k24Bits));
    else if (token.text == "OFFSET")
      instance.sbt_offset = uint32_t(p.tokens.integer("the offset", 0, k24Bits));
    else if (token.text == "MASK")
      instance.mask = uint32_t(p.tokens.integer("the mask", 0, 0xff));
    else if (token.text == "FLAGS")
      parse_flags(p, instance);
    else if (token.text == "TRANSFORM")
      parse_transform(p, instance);
    else
      p.unsupported("instance attribute " + token.text);
  }
  if (!token.is_word()) p.wrong("END is missing");
  level.instances.emplace_back(name, instance);
}

}  // namespace

void parse_structure(Parsing& p) {
  const std::string kind = p.tokens.word("BOTTOM_LEVEL or TOP_LEVEL"),
                    name = p.tokens.word("the structure's name");
  if (kind != "BOTTOM_LEVEL" && kind != "TOP_LEVEL")
    p.wrong(fmt::format("'{}' is neither BOTTOM_LEVEL nor TOP_LEVEL", kind));
  const bool is_bottom = kind == "BOTTOM_LEVEL";
  BottomLevel bottom;
  TopLevel top;
  Token token = p.tokens.next_after_line_ends();
  for (; token.is_word() && token.text != "END"; token = p.tokens.next_after_line_ends()) {
    if (is_bottom && token.text == "GEOMETRY")
      parse_geometry(p, bottom);
    else if (!is_bottom && token.text == "BOTTOM_LEVEL_INSTANCE")
      parse_instance(p, top);
    else if (!is_bottom && token.text == "BLAS_INSTANCE" && p.tokens.accept("USE")) {
      const std::string used = p.tokens.word("the bottom level");
      p.find(p.script.bottom_levels, used, "bottom level");
      top.instances.emplace_back(used, rt::Instance{});
    } else
      p.unsupported(fmt::format("{} {}", kind, token.text));
  }
  if (!token.is_word()) p.wrong("END is missing");
  if (is_bottom)
    p.declare(p.script.bottom_levels, name, "bottom level") = bottom;
  else
    p.declare(p.script.top_levels, name, "top level") = top;
}

}  // namespace glint::amber
