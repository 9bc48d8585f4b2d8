// Checks loads and stores against plain bytes: space, width, vector and sign as the op's name says them.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <stdexcept>

#include "isa/generic_address.h"
#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using isa::Space;

// Says what the name of a load or store asks for.
struct Access {
  bool store = false, is_signed = false;
  Space space = Space::Generic;
  uint32_t parts = 1, bytes = 0;
  uint32_t size() const { return parts * bytes; }
};
Access access_of(std::string_view name) {
  Access out;
  for (std::string_view part : parts_of(name)) {
    if (part == "ld" || part == "st")
      out.store = part == "st";
    else if (part == "global")
      out.space = Space::Global;
    else if (part == "shared")
      out.space = Space::Shared;
    else if (part == "local")
      out.space = Space::Local;
    else if (part == "const")
      out.space = Space::Const;
    else if (part == "param")
      out.space = Space::Param;
    else if (part == "v2" || part == "v4")
      out.parts = part == "v2" ? 2 : 4;
    else if (part.ends_with("8"))
      out.bytes = 1;
    else if (part.ends_with("16"))
      out.bytes = 2;
    else if (part.ends_with("32"))
      out.bytes = 4;
    else if (part.ends_with("64"))
      out.bytes = 8;
    else
      throw std::logic_error(fmt::format("{}: the oracle does not know '{}'", name, part));
    if (part == "s8" || part == "s16") out.is_signed = true;
  }
  return out;
}

// Holds where a thread's access goes: the bytes, the place in them, and the address that the op gets.
struct Target {
  Space space = Space::Global;
  uint32_t offset = 0;
  uint64_t address = 0;
};

// Picks an aligned place. Warps write into halves of their own, because their order is open.
Target pick(const Access& access, const OpLab& lab, size_t thread, Random& random) {
  constexpr Space kWindows[] = {Space::Global, Space::Shared, Space::Local, Space::Const};
  Target out;
  out.space = access.space == Space::Generic ? kWindows[random.below(access.store ? 3 : 4)] : access.space;
  const auto aligned = [&](uint32_t first, uint32_t bytes) {
    return first + random.below(bytes / access.size()) * access.size();
  };
  const auto half = uint32_t(thread / 32);
  if (out.space == Space::Global) out.offset = aligned(half * 512, 512);
  if (out.space == Space::Shared) out.offset = aligned(half * 512, 512);
  if (out.space == Space::Local) out.offset = aligned(0, OpLab::kLocalBytes);
  if (out.space == Space::Const) out.offset = aligned(0, isa::kConstantBankBytes);
  if (out.space == Space::Param)
    out.offset =
        aligned(OpLab::kParamBytes, isa::kConstantBankBytes - isa::kPushConstantOffset - OpLab::kParamBytes);
  out.address = out.offset + (out.space == Space::Global ? lab.global_base() : 0);
  if (access.space == Space::Generic) out.address += isa::window_of(out.space);
  return out;
}

Bytes& bytes_of(Spaces& spaces, Space space, size_t thread) {
  return space == Space::Global   ? spaces.global
         : space == Space::Shared ? spaces.shared
         : space == Space::Local  ? spaces.local[thread]
                                  : spaces.constants;
}

// Returns the value of a part, lowest byte first, extended to 64 bits.
uint64_t part_of(const Access& access, const uint8_t* from) {
  uint64_t value = 0;
  for (uint32_t i = 0; i < access.bytes; ++i) value |= uint64_t{from[i]} << (8 * i);
  if (access.is_signed && from[access.bytes - 1] >= 0x80) value |= ~uint64_t{0} << (8 * access.bytes);
  return value;
}

uint64_t check_once(const isa::OpRow& row, const Access& access, int32_t displacement, uint64_t enabled) {
  OpLab lab(row, displacement);
  Random random{enabled + uint64_t(displacement)};
  Spaces before = lab.random_spaces(random), expected = before;
  const bool is_wide = access.space == Space::Global || access.space == Space::Generic;
  const size_t address_words = is_wide ? 2 : 1,
               words = access.size() < 4 || access.bytes < 4 ? access.parts : access.size() / 4;
  REQUIRE(lab.num_sources() == address_words + (access.store ? words : 0));
  REQUIRE(lab.num_results() == (access.store ? 0 : words));
  std::vector<Column> sources(lab.num_sources()), results(lab.num_results());
  for (size_t t = 0; t < kThreads; ++t) {
    const Target target = pick(access, lab, t, random);
    const uint64_t address = target.address - uint64_t(int64_t(displacement));
    sources[0][t] = uint32_t(address);
    if (is_wide) sources[1][t] = uint32_t(address >> 32);
    for (size_t w = 0; w < words; ++w)
      (access.store ? sources[address_words + w] : results[w])[t] =
          access.store ? uint32_t(random.next()) : uint32_t(OpLab::kUntouched);
    if (!(enabled >> t & 1)) continue;
    const uint32_t base = target.offset + (target.space == Space::Param ? isa::kPushConstantOffset : 0);
    uint8_t* const at = bytes_of(expected, target.space, t).data() + base;
    const uint32_t word_bytes = access.bytes < 4 ? access.bytes : 4;
    for (size_t w = 0; w < words; ++w) {
      if (access.store)
        for (uint32_t i = 0; i < word_bytes; ++i)
          at[w * word_bytes + i] = uint8_t(sources[address_words + w][t] >> (8 * i));
      else if (access.bytes == 8)
        results[w][t] = uint32_t(part_of(access, at + w / 2 * 8) >> (w % 2 * 32));
      else
        results[w][t] = uint32_t(part_of(access, at + w * access.bytes));
    }
  }
  const Outcome outcome = lab.run(sources, enabled, before);
  CHECK(difference(outcome, results, expected) == "");
  return outcome.lanes;
}

}  // namespace

uint64_t check_access(const isa::OpRow& row) {
  const Access access = access_of(row.name);
  return check_once(row, access, 0, ~uint64_t{0}) + check_once(row, access, 32, 0x8421'0f07'1357'9bdf) +
         check_once(row, access, -48, 0x7000'0000'ffff'0000);
}

}  // namespace glint::test
