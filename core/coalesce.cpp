// Merges the addresses of a warp's lanes into sectors of cache lines.
// SPDX-License-Identifier: Apache-2.0
#include "core/coalesce.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace glint::core {

void LineList::add_by_sector(Address physical, uint32_t bytes, int lane) {
  const Address end = physical + bytes;
  for (Address at = physical; at < end;) {
    const Address sector_end = std::min(end, (at | (mem::kSectorBytes - 1)) + 1);
    add_in_sector(at, uint32_t(sector_end - at), lane);
    at = sector_end;
  }
}

void LineList::add_row(Address physical, LaneMask lanes) {
  if (mask_ + 1 != kRowBytes || (physical & mask_) != 0)
    return for_each_lane(lanes, [&](int lane) { add(physical + Address(lane) * 4, 4, lane); });
  constexpr uint32_t kLanesPerSector = mem::kSectorBytes / 4;
  LineSectors& line = at_line(physical);
  for (uint32_t sector = 0; sector < kRowBytes / mem::kSectorBytes; ++sector)
    if (lanes >> (sector * kLanesPerSector) & ((1u << kLanesPerSector) - 1))
      line.sectors |= uint8_t(1u << sector);
  line.words |= lanes;  // A part of a line is a word here.
  line.lanes |= lanes;
}

LineSectors& LineList::other_line(Address line) {
  for (uint32_t i = count_; i-- > 0;)
    if (lines_[i].line == line) return lines_[last_ = i];
  GLINT_CHECK(count_ < kMaxLines, "an access of more than {} lines", kMaxLines);
  last_ = count_;
  return lines_[count_++] = {line, 0, 0, 0, 0, 0};
}

bool LineList::merge(const LineList& later) {
  if (!std::ranges::equal(lines(), later.lines(), {}, &LineSectors::line, &LineSectors::line)) return false;
  for (uint32_t i = 0; i < count_; ++i) {
    const LineSectors& more = later.lines_[i];
    lines_[i].sectors |= more.sectors;
    lines_[i].words |= more.words;
    lines_[i].lanes |= more.lanes;
  }
  return true;
}

uint32_t LineList::num_sectors() const {
  uint32_t sum = 0;
  for (const LineSectors& line : lines()) sum += mem::num_sectors(line.sectors);
  return sum;
}

void coalesce_global(LineList& out, const mem::AddressSpace& memory, const isa::Access& access,
                     LaneMask lanes, uint32_t bytes) {
  for_each_lane(lanes,
                [&](int lane) { out.add(memory.physical(access.address[size_t(lane)]), bytes, lane); });
}

void coalesce_local(LineList& out, const LocalLayout& layout, uint32_t warp_slot, const isa::Access& access,
                    LaneMask lanes, uint32_t bytes) {
  if (lanes == 0) return;
  if (layout.by_thread)
    return for_each_lane(lanes, [&](int lane) {
      const Address offset = access.address[size_t(lane)];
      out.add(layout.word(warp_slot, offset / 4, lane) + offset % 4, bytes, lane);
    });
  const auto word_of = [&](LaneMask rest) { return access.address[size_t(std::countr_zero(rest))] / 4; };
  const auto with_word = [&](Address word, LaneMask rest) {
    LaneMask same = 0;
    for_each_lane(rest,
                  [&](int lane) { same |= LaneMask{access.address[size_t(lane)] / 4 == word} << lane; });
    return same;
  };
  const LaneMask first = with_word(word_of(lanes), lanes);  // mostly all lanes
  // The access is taken part by part, because the hardware moves one word of every lane at a time. Lanes that
  // want the same word of their stacks have it in one row.
  for (uint32_t byte = 0; byte < bytes; byte += 4)
    for (LaneMask rest = lanes, same = first; rest; rest &= ~same) {
      const Address wanted = word_of(rest);
      if (rest != lanes) same = with_word(wanted, rest);
      out.add_row(layout.word(warp_slot, wanted + byte / 4, 0), same);
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
    return lines.set_atomic(0, 1, 1);
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
    lines.set_atomic(i, uint8_t(std::popcount(lanes)), count);
  }
}

uint32_t bank_passes(const isa::Access& access, LaneMask lanes, uint32_t bytes, bool is_atomic) {
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

namespace {

// Returns whether all lanes have the address of the lane `distance` further, where both take part.
bool pairs_agree(const isa::Access& access, LaneMask lanes, int distance) {
  bool agree = true;
  for_each_lane(lanes, [&](int lane) {
    const int other = lane ^ distance;
    agree &= (lanes >> other & 1) == 0 || access.address[size_t(lane)] == access.address[size_t(other)];
  });
  return agree;
}

}  // namespace

uint32_t shared_passes(const isa::Access& access, LaneMask lanes, uint32_t bytes, bool is_store) {
  if (bytes <= 4) return bank_passes(access, lanes, bytes, false);
  const uint32_t words = bytes / 4;
  const bool is_paired = !is_store && (pairs_agree(access, lanes, 1) || pairs_agree(access, lanes, 2));
  const uint32_t parts = is_paired ? words / 2 : words, width = uint32_t(kLanes) / parts;
  uint32_t passes = 0;
  for (uint32_t part = 0; part < parts; ++part) {
    const LaneMask in_part = LaneMask((uint64_t{1} << width) - 1) << part * width;
    passes += bank_passes(access, lanes & in_part, bytes, false);
  }
  return passes;
}

uint32_t matrix_passes(const isa::Access& access, LaneMask lanes, uint32_t matrices, uint32_t bytes) {
  uint32_t passes = 0;
  for (uint32_t m = 0; m < matrices; ++m)
    passes += bank_passes(access, lanes & LaneMask{0xff} << 8 * m, bytes, false);
  return passes;
}

}  // namespace glint::core
