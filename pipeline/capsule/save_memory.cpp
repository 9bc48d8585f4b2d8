// Finds the simulated memory that a launch can reach, takes it along, and puts it back where it was.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/capsule/save_memory.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "base/diagnostics.h"

namespace glint::pipeline {
namespace {

using MemorySlot = mem::AddressSpace::Slot;
using ByteRange = SavedMemory::Range;

constexpr uint64_t kPage = 4096;              // Bytes are taken along in whole pages that are not all 0.
constexpr uint64_t kPhysicalAlignment = 256;  // of allocations in simulated memory

uint64_t rounded(uint64_t bytes) {
  return (bytes + kPhysicalAlignment - 1) / kPhysicalAlignment * kPhysicalAlignment;
}

// Returns whether a module declares that it uses addresses of buffers, or makes structures from addresses.
bool makes_addresses(const std::vector<uint32_t>& words) {
  constexpr uint32_t kOpCapability = 17, kPhysicalStorageBufferAddresses = 5347,
                     kOpConvertUToAccelerationStructure = 4447;
  for (size_t at = 5; at < words.size() && words[at] >> 16;) {
    const uint32_t op = words[at] & 0xffff;
    if (op == kOpConvertUToAccelerationStructure) return true;
    if (op == kOpCapability && at + 1 < words.size() && words[at + 1] == kPhysicalStorageBufferAddresses)
      return true;
    at += words[at] >> 16;
  }
  return false;
}

// Collects the slots that a launch reaches.
class Reach {
 public:
  Reach(const mem::AddressSpace& memory, const Capsule& capsule)
      : memory_(memory), slots_(memory.slots()), capsule_(capsule) {
    for (const Capsule::Stage& each : capsule.stages) searches_ = searches_ || makes_addresses(each.words);
  }

  const std::set<uint64_t>& run() {
    for (const BoundResources& bound : capsule_.bindings) {
      if (const auto* buffers = std::get_if<std::vector<BufferRange>>(&bound.elements))
        for (const BufferRange& each : *buffers) add(each.address);
      if (const auto* images = std::get_if<std::vector<exec::ImageView>>(&bound.elements))
        for (const exec::ImageView& each : *images)
          if (each.is_bound) add(each.base, true);
    }
    if (capsule_.rays)
      for (const DeviceRegion& each : {capsule_.rays->table.raygen, capsule_.rays->table.miss,
                                       capsule_.rays->table.hit, capsule_.rays->table.callable})
        if (each.bytes) add(each.base);
    if (searches_) search(capsule_.push_constants.data(), capsule_.push_constants.size());
    for (; !todo_.empty(); todo_.pop_front()) look_into(todo_.front());
    return reached_;
  }

 private:
  bool is_there(Address address) const {
    const uint64_t slot = address >> mem::AddressSpace::kShift;
    return slot > 0 && slot < slots_.size() && slots_[slot].data &&
           slots_[slot].part == MemorySlot::Part::First && uint32_t(address) < slots_[slot].bytes;
  }

  void add(Address address, bool is_image = false) {
    const uint64_t slot = address >> mem::AddressSpace::kShift;
    if (!is_there(address) || !reached_.insert(slot).second) return;
    if (is_image) images_.insert(slot);
    todo_.push_back(slot);
  }

  void search(const std::byte* from, uint64_t bytes) {
    for (uint64_t at = 0; at + sizeof(Address) <= bytes; at += sizeof(Address)) {
      Address word;
      std::memcpy(&word, from + at, sizeof word);
      add(word);
    }
  }

  void look_into(uint64_t slot) {
    for (const PlacedStructure& each : capsule_.structures)
      if (each.address >> mem::AddressSpace::kShift == slot && rt::structure_at(memory_, each.address))
        for (const Address bottom : rt::bottoms_of(memory_, each.address)) add(bottom);
    if (searches_ && !images_.count(slot)) search(slots_[slot].data, slots_[slot].bytes);
  }

  const mem::AddressSpace& memory_;
  std::span<const MemorySlot> slots_;
  const Capsule& capsule_;
  bool searches_ = false;
  std::set<uint64_t> reached_, images_;
  std::deque<uint64_t> todo_;
};

// Returns the gaps in physical memory. The space hands out the lowest gap that is large enough, so it fills
// all of them before it goes past the end; what was taken for that is given back.
std::vector<ByteRange> free_ranges(mem::AddressSpace& memory) {
  std::vector<ByteRange> taken;
  const Address end = memory.bytes_allocated();
  for (uint64_t piece = uint64_t{1} << 26; piece >= kPhysicalAlignment; piece /= 4)
    for (;;) {
      const Address at = memory.reserve(piece);
      if (at >= end || at + piece > end) {
        memory.release(at, piece);
        break;
      }
      taken.push_back({at, piece});
    }
  for (auto each = taken.rbegin(); each != taken.rend(); ++each) memory.release(each->first, each->count);
  return taken;
}

std::vector<ByteRange> joined(std::vector<ByteRange> all) {
  std::sort(all.begin(), all.end(), [](const ByteRange& a, const ByteRange& b) { return a.first < b.first; });
  std::vector<ByteRange> out;
  for (const ByteRange& each : all)
    if (!out.empty() && out.back().first + out.back().count == each.first)
      out.back().count += each.count;
    else
      out.push_back(each);
  return out;
}

bool is_zero(const std::byte* from, uint64_t bytes) {
  return std::all_of(from, from + bytes, [](std::byte each) { return each == std::byte{0}; });
}

// Adds the pages of a range of a backing that are not all 0.
void add_contents(SavedMemory::Backing& to, const std::byte* data, uint64_t first, uint64_t end) {
  for (uint64_t at = first / kPage * kPage; at < end; at += kPage) {
    const uint64_t from = std::max(at, first), bytes = std::min(at + kPage, end) - from;
    if (is_zero(data + from, bytes)) continue;
    if (to.contents.empty() || to.contents.back().offset + to.contents.back().bytes.size() != from)
      to.contents.push_back({from, {}});
    to.contents.back().bytes.append(reinterpret_cast<const char*>(data + from), size_t(bytes));
  }
}

// Adds the bytes of several windows on one backing, each byte once.
void add_contents(SavedMemory::Backing& to, const std::byte* data, std::vector<ByteRange> windows) {
  std::sort(windows.begin(), windows.end(),
            [](const ByteRange& a, const ByteRange& b) { return a.first < b.first; });
  uint64_t done = 0;
  for (const ByteRange& each : windows) {
    const uint64_t end = each.first + each.count;
    if (end > done) add_contents(to, data, std::max(done, each.first), end);
    done = std::max(done, end);
  }
}

[[noreturn]] void refuse(const std::string& why) {
  throw UserError({}, "the memory of a capsule contradicts itself: " + why, "save it again");
}

// Makes backings at their physical addresses: what lies between them is taken while they are made.
std::vector<mem::Backing> restore_backings(const SavedMemory& from, mem::AddressSpace& memory) {
  std::vector<mem::Backing> out;
  Address cursor = 0;
  const auto fill = [&](Address to) {
    if (to < cursor || to % kPhysicalAlignment) refuse("allocations overlap");
    if (to > cursor && memory.reserve(to - cursor) != cursor) refuse("allocations overlap");
    cursor = to;
  };
  for (const SavedMemory::Backing& each : from.backings) {
    if (each.bytes) fill(each.physical);
    const mem::Backing backing = out.emplace_back(memory.add_backing(each.bytes));
    cursor += rounded(each.bytes);
    for (const SavedMemory::Bytes& part : each.contents) {
      if (part.offset > each.bytes || part.bytes.size() > each.bytes - part.offset)
        refuse("contents leave their allocation");
      std::memcpy(memory.data(backing) + part.offset, part.bytes.data(), part.bytes.size());
    }
  }
  fill(std::max(cursor, from.end));
  Address last = 0;
  for (const ByteRange& each : from.free) {
    if (each.first < last || each.first > from.end || each.count > from.end - each.first)
      refuse("free memory lies outside");
    last = each.first + each.count;
    for (const SavedMemory::Backing& taken : from.backings)
      if (taken.bytes && each.first < taken.physical + taken.bytes && taken.physical < last)
        refuse("free memory is taken");
    memory.release(each.first, each.count);
  }
  return out;
}

}  // namespace

void save_memory(Capsule& capsule, mem::AddressSpace& memory, std::span<const Address> own) {
  SavedMemory& out = capsule.memory;
  std::vector<ByteRange> free = free_ranges(memory);
  const auto slots = memory.slots();
  for (const Address each : own)
    if (const MemorySlot& slot = slots[each >> mem::AddressSpace::kShift]; slot.bytes)
      free.push_back({slot.physical, rounded(slot.bytes)});
  out.free = joined(std::move(free)), out.end = memory.bytes_allocated();
  const std::set<uint64_t> reached = Reach(memory, capsule).run();
  std::map<Address, std::pair<mem::Backing, std::vector<ByteRange>>> backings;  // by physical address
  const auto offset_of = [&](const MemorySlot& slot) {
    return uint64_t(slot.data - memory.data(slot.backing));
  };
  for (const uint64_t each : reached) {
    const MemorySlot& slot = slots[each];
    auto& [backing, windows] = backings[slot.physical - offset_of(slot)];
    backing = slot.backing, windows.push_back({offset_of(slot), slot.bytes});
  }
  for (const auto& [physical, backing] : backings) {
    SavedMemory::Backing& to = out.backings.emplace_back();
    to.physical = physical, to.bytes = memory.size(backing.first);
    add_contents(to, memory.data(backing.first), backing.second);
  }
  for (const uint64_t each : reached) {
    const MemorySlot& slot = slots[each];
    const auto found = backings.find(slot.physical - offset_of(slot));
    out.windows.push_back({each, uint64_t(std::distance(backings.begin(), found)),
                           offset_of(slot) + slot.skipped, slot.bytes - slot.skipped});
  }
  std::erase_if(capsule.structures, [&](const PlacedStructure& structure) {
    return !reached.count(structure.address >> mem::AddressSpace::kShift) ||
           !rt::structure_at(memory, structure.address);
  });
}

void restore_memory(const SavedMemory& from, mem::AddressSpace& memory) {
  const std::vector<mem::Backing> backings = restore_backings(from, memory);
  const mem::Backing nothing = memory.add_backing(uint64_t{0});
  uint64_t slot = 1;
  for (const SavedMemory::Window& each : from.windows) {
    if (each.backing >= backings.size() || each.slot < slot || each.slot >= mem::AddressSpace::kMaxSlots)
      refuse("windows are out of order");
    // Nothing that the launch reaches is in the places between.
    for (; slot < each.slot; ++slot) memory.open_window("memory that was not saved", nothing, 0, 0);
    const Address at = memory.open_window("allocation " + std::to_string(slot) + " of the application",
                                          backings[each.backing], each.offset, each.bytes);
    if (at >> mem::AddressSpace::kShift != slot++) refuse("a window has another address");
  }
}

}  // namespace glint::pipeline
