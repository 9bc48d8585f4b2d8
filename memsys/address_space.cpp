// Allocates simulated memory, and explains where an access outside all allocations would have gone.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/address_space.h"

#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "base/diagnostics.h"
#include "memsys/request.h"

namespace glint::mem {
namespace {

constexpr uint64_t kSlot = uint64_t{1} << AddressSpace::kShift;
constexpr uint64_t kPhysicalAlignment = 256;

uint64_t slots_of(uint64_t bytes) {
  return bytes <= kSlot ? 1 : (bytes + kSlot - 1) / kSlot;
}

}  // namespace

Address AddressSpace::allocate(std::string name, uint64_t bytes) {
  return adopt(std::move(name), HostBlock(bytes));
}

Address AddressSpace::adopt(std::string name, HostBlock block) {
  const Address address = Address(allocations_.size()) << kShift;
  const uint64_t bytes = block.size();
  // Slot i of a large allocation spans from its own start to the end of the allocation, so that find() needs
  // no special case for ranges that cross a multiple of 4 GiB.
  for (uint64_t i = 0; i < slots_of(bytes); ++i)
    allocations_.push_back({name, bytes - i * kSlot, next_physical_ + i * kSlot, block.data() + i * kSlot});
  blocks_.push_back(std::move(block));
  reserve(bytes);
  return address;
}

Address AddressSpace::reserve(uint64_t bytes) {
  const Address first = next_physical_;
  next_physical_ += (bytes + kPhysicalAlignment - 1) / kPhysicalAlignment * kPhysicalAlignment;
  if (next_physical_ >= kMaxPhysicalBytes)
    throw UserError(
        {},
        fmt::format("the program and the machine need {} GiB of simulated memory, and there are {}",
                    next_physical_ >> 30, kMaxPhysicalBytes >> 30),
        "use smaller buffers, less local memory or fewer cores");
  return first;
}

std::string AddressSpace::explain(Address address, uint64_t bytes) const {
  const uint64_t index = address >> kShift;
  const uint64_t offset = address & (kSlot - 1);
  if (index == 0 && offset < kSlot / 2)
    return fmt::format("a null pointer plus {} bytes: nothing is bound there, or the address was never set",
                       offset);
  if (index > 0 && index < allocations_.size()) {
    const Allocation& a = allocations_[index];
    if (offset + bytes <= a.bytes) return fmt::format("{} bytes inside '{}'", bytes, a.name);
    if (offset < a.bytes)
      return fmt::format("{} bytes across the end of '{}' ({} bytes), {} of them past it", bytes, a.name,
                         a.bytes, offset + bytes - a.bytes);
    // The upper half of a slot is nearer to the next allocation, whose index was below its start.
    const bool before_next = offset >= kSlot / 2 && index + 1 < allocations_.size();
    if (!before_next)
      return fmt::format("{} bytes past the end of '{}' ({} bytes)", offset - a.bytes, a.name, a.bytes);
  }
  if (index + 1 < allocations_.size())
    return fmt::format("{} bytes before the start of '{}' ({} bytes)", kSlot - offset,
                       allocations_[index + 1].name, allocations_[index + 1].bytes);
  return "no allocation is near";
}

}  // namespace glint::mem
