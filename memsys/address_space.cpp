// Allocates simulated memory, and explains where an access outside all allocations would have gone.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/address_space.h"

#include <algorithm>
#include <fmt/format.h>
#include <new>

#include "base/check.h"

namespace glint::mem {
namespace {

constexpr uint64_t kSlot = uint64_t{1} << AddressSpace::kShift;
constexpr uint64_t kPhysicalAlignment = 256;
constexpr size_t kFreedNumbers = 64;  // freed allocations whose addresses wait before they are used again

uint64_t slots_of(uint64_t bytes) {
  return bytes <= kSlot ? 1 : (bytes + kSlot - 1) / kSlot;
}
uint64_t physical_size(uint64_t bytes) {
  return (bytes + kPhysicalAlignment - 1) / kPhysicalAlignment * kPhysicalAlignment;
}
uint64_t in_mib(uint64_t bytes) {
  return (bytes >> 20) + (bytes % (1 << 20) != 0);
}

}  // namespace

// The last line that caches could name is kNoLine.
AddressSpace::AddressSpace(uint64_t physical_bytes)
    : names_(1), physical_(std::min(physical_bytes, kMaxPhysicalBytes - kPhysicalAlignment)) {
  numbers_.take(1);
}

HostBlock AddressSpace::zeros(uint64_t bytes) const {
  check_room(bytes);
  try {
    return HostBlock(bytes);
  } catch (const std::bad_alloc&) {
    throw OutOfMemory({}, fmt::format("the host has no memory for {} bytes of simulated memory", bytes),
                      "use smaller buffers");
  }
}

void AddressSpace::check_room(uint64_t bytes) const {
  if (bytes <= physical_.limit() && physical_.has_room(physical_size(bytes))) return;
  throw OutOfMemory(
      {},
      fmt::format(
          "the program and the machine need {} MiB of simulated memory besides {} MiB that are in use, "
          "and there are {}",
          in_mib(bytes), in_mib(physical_.num_taken()), physical_.limit() >> 20),
      "use smaller buffers, less local memory or fewer cores");
}

Address AddressSpace::allocate(std::string name, uint64_t bytes) {
  return adopt(std::move(name), zeros(bytes));
}

Address AddressSpace::adopt(std::string name, HostBlock block) {
  const uint64_t bytes = block.size();
  const Backing backing = add_backing(std::move(block));
  try {
    const Address address = open_window(std::move(name), backing, 0, bytes);
    slots_[address >> kShift].owns = true;
    return address;
  } catch (const OutOfMemory&) {
    free(backing);
    throw;
  }
}

Backing AddressSpace::add(Bytes bytes) {
  bytes.physical = reserve(bytes.bytes);
  if (free_backings_.empty()) {
    backings_.push_back(std::move(bytes));
    return Backing(backings_.size() - 1);
  }
  const Backing backing = free_backings_.back();
  free_backings_.pop_back();
  backings_[size_t(backing)] = std::move(bytes);
  return backing;
}

Backing AddressSpace::add_backing(uint64_t bytes) {
  return add_backing(zeros(bytes));
}

Backing AddressSpace::add_backing(HostBlock block) {
  Bytes bytes;
  bytes.data = block.data(), bytes.bytes = block.size();
  bytes.own = std::move(block);
  return add(std::move(bytes));
}

// Executors copy whole lines of the host, so bytes of somebody else have to be whole lines.
Backing AddressSpace::import_backing(std::byte* data, uint64_t bytes) {
  if (!data || reinterpret_cast<uintptr_t>(data) % kWindowAlignment || bytes % kWindowAlignment)
    throw UserError({}, "the host's bytes that become simulated memory are not aligned",
                    fmt::format("pass a pointer and a size that are multiples of {}", kWindowAlignment));
  return add({{}, data, bytes, 0});
}

uint64_t AddressSpace::take_slots(uint64_t count) {
  const auto give_back_oldest = [&] {
    numbers_.give_back(freed_numbers_.front().first, freed_numbers_.front().second);
    freed_numbers_.pop_front();
  };
  while (freed_numbers_.size() > kFreedNumbers) give_back_oldest();
  for (;;) {
    if (const auto first = numbers_.take(count)) {
      names_.resize(std::max<size_t>(names_.size(), size_t(*first + count)));
      return *first;
    }
    if (freed_numbers_.empty())
      throw OutOfMemory({},
                        fmt::format("the program needs more than {} allocations at a time", kMaxSlots - 1),
                        "free buffers, or use fewer");
    give_back_oldest();
  }
}

Address AddressSpace::open_window(std::string name, Backing backing, uint64_t offset, uint64_t bytes) {
  const Bytes& from = backings_[size_t(backing)];
  if (offset > from.bytes || bytes > from.bytes - offset)
    throw UserError({}, fmt::format("'{}' is at bytes {} to {} of memory that has {} bytes", name, offset,
                                    offset + bytes, from.bytes));
  const uint64_t skipped = offset % kWindowAlignment, start = offset - skipped, size = bytes + skipped;
  const uint64_t count = slots_of(size), first = take_slots(count);
  // Slot i of a large allocation spans from its own start to the end of the allocation, so that find() needs
  // no special case for ranges that cross a multiple of 4 GiB.
  for (uint64_t i = 0; i < count; ++i) {
    slots_[first + i] = {.bytes = size - i * kSlot,
                         .physical = from.physical + start + i * kSlot,
                         .data = from.data + start + i * kSlot,
                         .backing = backing,
                         .skipped = uint8_t(i ? 0 : skipped),
                         .part = i ? Slot::Part::Rest : Slot::Part::First};
    names_[first + i] = name;
  }
  return (first << kShift) + skipped;
}

uint64_t AddressSpace::num_slots(uint64_t first) const {
  uint64_t count = 1;
  while (first + count < numbers_.end() && slots_[first + count].part == Slot::Part::Rest) ++count;
  return count;
}

void AddressSpace::free(Address address) {
  const uint64_t first = address >> kShift;
  GLINT_CHECK(first < numbers_.end() && slots_[first].part == Slot::Part::First,
              "only what was allocated can be freed");
  const Slot slot = slots_[first];
  const uint64_t count = num_slots(first);
  for (uint64_t i = 0; i < count; ++i) slots_[first + i] = {};
  freed_numbers_.emplace_back(first, count);
  if (slot.owns) free(slot.backing);
}

void AddressSpace::free(Backing backing) {
  Bytes& bytes = backings_[size_t(backing)];
  release(bytes.physical, bytes.bytes);
  for (Slot& slot : std::span(slots_.data(), size_t(numbers_.end())))
    if (slot.part != Slot::Part::None && slot.backing == backing)
      slot.bytes = 0, slot.data = nullptr, slot.owns = false, slot.ended = true;
  bytes = {};
  free_backings_.push_back(backing);
}

void AddressSpace::rename(Address address, std::string name) {
  const uint64_t first = address >> kShift;
  for (uint64_t i = num_slots(first); i-- > 0;) names_[first + i] = name;
}

Address AddressSpace::reserve(uint64_t bytes) {
  check_room(bytes);
  return *physical_.take(physical_size(bytes));
}

void AddressSpace::release(Address first, uint64_t bytes) {
  physical_.give_back(first, physical_size(bytes));
}

std::string AddressSpace::describe(Address address) const {
  const Slot& slot = slots_[address >> kShift];
  return fmt::format("byte {} of '{}' ({} bytes)", (address & (kSlot - 1)) - slot.skipped,
                     names_[address >> kShift], size_of(slot));
}

std::string AddressSpace::explain(Address address, uint64_t bytes) const {
  const uint64_t index = address >> kShift;
  const uint64_t offset = address & (kSlot - 1);
  if (index == 0 && offset < kSlot / 2)
    return fmt::format("a null pointer plus {} bytes: nothing is bound there, or the address was never set",
                       offset);
  const auto is_used = [&](uint64_t i) {
    return i < numbers_.end() && slots_[i].part != Slot::Part::None && !slots_[i].ended;
  };
  const bool has_next = is_used(index + 1);
  // The upper half of a slot is nearer to the next allocation, whose index was below its start.
  if (index > 0 && index < names_.size() && !(has_next && offset >= kSlot / 2)) {
    const Slot& slot = slots_[index];
    const std::string& name = names_[index];
    if (!is_used(index)) return fmt::format("byte {} of '{}', which has been freed", offset, name);
    if (offset + bytes <= slot.bytes) return fmt::format("{} bytes inside '{}'", bytes, name);
    if (offset < slot.bytes)
      return fmt::format("{} bytes across the end of '{}' ({} bytes), {} of them past it", bytes, name,
                         size_of(slot), offset + bytes - slot.bytes);
    return fmt::format("{} bytes past the end of '{}' ({} bytes)", offset - slot.bytes, name, size_of(slot));
  }
  if (has_next)
    return fmt::format("{} bytes before the start of '{}' ({} bytes)", kSlot - offset, names_[index + 1],
                       size_of(slots_[index + 1]));
  return "no allocation is near";
}

}  // namespace glint::mem
