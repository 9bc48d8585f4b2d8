// Merges the addresses of a warp's lanes into sectors of cache lines.
// SPDX-License-Identifier: Apache-2.0
#include "core/coalesce.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace glint::core {

void LineList::add(Address physical, uint32_t bytes, int lane) {
  const Address first = physical / mem::kSectorBytes;
  const Address last = (physical + bytes - 1) / mem::kSectorBytes;
  for (Address sector = first; sector <= last; ++sector) {
    const Address address = sector * mem::kSectorBytes, line = address & ~mask_;
    // These are the parts of the line that lie as a whole in the sector and in [physical, physical + bytes).
    const uint64_t round_up = (uint64_t{1} << part_shift_) - 1;
    const uint64_t begin = (std::max(physical, address) - line + round_up) >> part_shift_;
    const uint64_t end = (std::min(physical + bytes, address + mem::kSectorBytes) - line) >> part_shift_;
    const uint64_t words = begin < end ? (uint64_t{1} << end) - (uint64_t{1} << begin) : 0;
    add_sector(line, uint32_t((address & mask_) / mem::kSectorBytes), mem::WordMask(words),
               LaneMask{1} << lane);
  }
}

void LineList::add_sector(Address line, uint32_t sector, mem::WordMask words, LaneMask lanes) {
  const auto bit = uint8_t(1u << sector);
  // Neighbouring lanes mostly share a line, so the line hit last is tried first.
  if (count_ > 0 && lines_[last_].line == line) {
    lines_[last_].sectors |= bit;
    lines_[last_].words |= words;
    lines_[last_].lanes |= lanes;
    return;
  }
  for (uint32_t i = count_; i-- > 0;) {
    if (lines_[i].line == line) {
      lines_[i].sectors |= bit;
      lines_[i].words |= words;
      lines_[i].lanes |= lanes;
      last_ = i;
      return;
    }
  }
  GLINT_CHECK(count_ < kMaxLines, "an access of more than {} lines", kMaxLines);
  last_ = count_;
  lines_[count_++] = {line, bit, {}, words, lanes};
}

uint32_t LineList::num_sectors() const {
  uint32_t sum = 0;
  for (const LineSectors& line : lines()) sum += uint32_t(std::popcount(line.sectors));
  return sum;
}

void coalesce_global(LineList& out, const mem::AddressSpace& memory, const isa::Access& access,
                     LaneMask lanes, uint32_t bytes) {
  for_each_lane(lanes,
                [&](int lane) { out.add(memory.physical(access.address[size_t(lane)]), bytes, lane); });
}

void coalesce_local(LineList& out, const LocalLayout& layout, uint32_t warp_slot, const isa::Access& access,
                    LaneMask lanes, uint32_t bytes) {
  // The access is taken part by part, because the hardware moves one word of every lane at a time.
  for (uint32_t byte = 0; byte < bytes; byte += 4) {
    for_each_lane(lanes, [&](int lane) {
      const uint64_t word = (access.address[size_t(lane)] + byte) / 4;
      out.add(layout.base + ((uint64_t{warp_slot} * layout.words + word) * kLanes + uint64_t(lane)) * 4, 4,
              lane);
    });
  }
}

void count_turns(LineList& lines, const mem::AddressSpace& memory, const isa::Access& access, uint32_t bytes,
                 bool turns, bool returns) {
  const auto address = [&](int lane) { return access.address[size_t(lane)]; };
  const auto is_one_word = [&](const LineSectors& line) {
    bool same = true;
    for_each_lane(line.lanes,
                  [&](int lane) { same &= address(lane) == address(std::countr_zero(line.lanes)); });
    return same;
  };
  if (turns && !returns && lines.lines().size() == 1 && is_one_word(lines.lines()[0]))
    return lines.set_atomic(0, {1, 1});
  const uint32_t words = (1u << std::max(bytes / 4, 1u)) - 1;
  for (size_t i = 0; i < lines.lines().size(); ++i) {
    const LaneMask lanes = lines.lines()[i].lanes;
    std::array<uint32_t, 8> taken{};  // words of each sector that its latest turn has
    uint8_t count = 0;
    for_each_lane(turns ? lanes : 0, [&](int lane) {
      const Address offset = lines.offset(memory.physical(address(lane)));
      uint32_t& turn = taken[offset / mem::kSectorBytes];
      const uint32_t wanted = words << (offset % mem::kSectorBytes / 4);
      const bool is_new = turn == 0 || (turn & wanted) != 0;
      count += is_new;
      turn = is_new ? wanted : turn | wanted;
    });
    lines.set_atomic(i, {uint8_t(std::popcount(lanes)), count});
  }
}

uint32_t shared_passes(const isa::Access& access, LaneMask lanes, uint32_t bytes, bool is_atomic) {
  constexpr size_t kBanks = 32;
  constexpr size_t kMost = 4 * size_t(kLanes);  // words of a warp's widest access
  std::array<std::array<uint32_t, kMost>, kBanks> words;
  std::array<uint32_t, kBanks> count{};
  uint32_t passes = 1;
  for_each_lane(lanes, [&](int lane) {
    for (uint32_t byte = 0; byte < bytes; byte += 4) {
      const auto word = uint32_t((access.address[size_t(lane)] + byte) / 4);
      const size_t bank = word % kBanks;
      const auto known = words[bank].begin() + count[bank];
      if (!is_atomic && std::find(words[bank].begin(), known, word) != known) continue;
      words[bank][count[bank]++] = word;
      passes = std::max(passes, count[bank]);
    }
  });
  return passes;
}

}  // namespace glint::core
