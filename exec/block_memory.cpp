// Keeps what a block writes apart until its turn.
// SPDX-License-Identifier: Apache-2.0
#include "exec/block_memory.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "rtunit/structure/structure.h"

namespace glint::exec {

namespace {

constexpr uintptr_t kHostLine = 64;  // bytes on the host

// Returns whether a slot begins with an acceleration structure.
bool holds_structure(const mem::AddressSpace::Slot& slot) {
  uint32_t magic = 0;
  if (slot.bytes < sizeof(rt::StructureHeader)) return false;
  std::memcpy(&magic, slot.data, sizeof magic);
  return magic == rt::StructureHeader::kMagic;
}

}  // namespace

// In order of their places on the host, slots that share lines follow each other.
MemoryUses::MemoryUses(const mem::AddressSpace& memory) : numbers_(memory.slots().size()) {
  const auto slots = memory.slots();
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < slots.size(); ++i)
    if (slots[i].bytes) order.push_back(i);
  const auto place_of = [&](uint32_t i) { return reinterpret_cast<uintptr_t>(slots[i].data); };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return place_of(a) != place_of(b) ? place_of(a) < place_of(b) : a < b;
  });
  uintptr_t end = 0;  // of the allocation's last line
  uses_.push_back(AllocationUse::Read);
  for (const uint32_t i : order) {
    if (place_of(i) >= end) uses_.push_back(AllocationUse::Read);
    end = std::max(end, (place_of(i) + uintptr_t(slots[i].bytes) + kHostLine - 1) / kHostLine * kHostLine);
    numbers_[i] = uint32_t(uses_.size() - 1);
    if (holds_structure(slots[i])) uses_.back() = AllocationUse::Structure;
  }
}

size_t LineIndex::slot_of(const std::byte* place) const {
  size_t i = size_t((reinterpret_cast<uintptr_t>(place) / 64) * 0x9e3779b97f4a7c15ull >> 24);
  for (;; ++i) {
    const Slot& slot = slots_[i & (slots_.size() - 1)];
    if (slot.place == place || !slot.place) return i & (slots_.size() - 1);
  }
}

uint32_t& LineIndex::add(const std::byte* place) {
  if (2 * (size_ + 1) > slots_.size()) {
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    for (const Slot& slot : old)
      if (slot.place) slots_[slot_of(slot.place)] = slot;
  }
  Slot& slot = slots_[slot_of(place)];
  size_ += !slot.place;
  slot.place = place;
  return slot.number;
}

void LineIndex::clear() {
  if (size_) std::fill(slots_.begin(), slots_.end(), Slot{});
  size_ = 0;
}

void WrittenBytes::clear() {
  index_.clear();
  lines_.clear();
  std::fill(is_written_.begin(), is_written_.end(), uint8_t{0});
}

BlockMemory::Line& BlockMemory::line_of(size_t allocation, std::byte* place) {
  if (last_ && last_->place == place) return *last_;
  uint32_t& number = index_.add(place);
  if (number != LineIndex::kNone) return *(last_ = &line(number));
  if (num_lines_ % kLines == 0) lines_.push_back(std::make_unique<std::array<Line, kLines>>());
  number = uint32_t(num_lines_++);
  last_ = &line(number);
  *last_ = {place, allocation, 0, 0, {}};
  std::memcpy(last_->data.data(), place, kLine);
  return *last_;
}

std::byte* BlockMemory::place_in_line(size_t allocation, std::byte* at, uint32_t bytes, isa::Effect effect) {
  const size_t offset = reinterpret_cast<uintptr_t>(at) & (kLine - 1);
  const uint64_t mask = (bytes >= kLine ? ~uint64_t{0} : (uint64_t{1} << bytes) - 1) << offset;
  Line& line = line_of(allocation, at - offset);
  const bool is_store = effect == isa::Effect::Store || effect == isa::Effect::SurfaceStore;
  if (!is_store) line.read |= mask & ~line.written;
  if (!is_load(effect)) {
    line.written |= mask;
    is_own_[allocation] = 1;
    // An earlier read of the allocation as a whole stays one; a store into a structure cannot be followed.
    is_unsuited_ |= uses_[allocation] == AllocationUse::Structure;
  }
  return line.data.data() + offset;
}

bool BlockMemory::has_read(const WrittenBytes& written) const {
  for (size_t i = 0; i < is_read_.size(); ++i)
    if (is_read_[i] && written.is_written_[i]) return true;
  if (written.lines_.empty()) return false;
  for (size_t i = 0; i < num_lines_; ++i) {
    const Line& mine = line(i);
    if (!mine.read || !written.is_written_[mine.allocation]) continue;
    const uint32_t other = written.index_.find(mine.place);
    if (other != LineIndex::kNone && (written.lines_[other] & mine.read)) return true;
  }
  return false;
}

void BlockMemory::commit(WrittenBytes& written, MemoryUses& uses) const {
  for (size_t n = 0; n < num_lines_; ++n) {
    const Line& mine = line(n);
    if (!mine.written) continue;
    if (mine.written == ~uint64_t{0})
      std::memcpy(mine.place, mine.data.data(), kLine);
    else
      for (uint64_t rest = mine.written; rest; rest &= rest - 1)
        mine.place[std::countr_zero(rest)] = mine.data[size_t(std::countr_zero(rest))];
    uint32_t& number = written.index_.add(mine.place);
    if (number == LineIndex::kNone) number = uint32_t(written.lines_.size()), written.lines_.push_back(0);
    written.lines_[number] |= mine.written;
    written.is_written_[mine.allocation] = 1;
    uses[mine.allocation] = AllocationUse::Written;
  }
}

}  // namespace glint::exec
