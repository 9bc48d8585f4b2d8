// Holds the bytes of simulated memory: allocations in a 64-bit virtual space in which every overrun shows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "base/types.h"
#include "memsys/host_block.h"

namespace glint::mem {

// Every allocation starts at a multiple of 4 GiB. The upper 32 bits of an address name the allocation, and an
// index that runs past the end, or before the start, falls where nothing is. Allocation 0 is never used, so
// null pointers fault. Choice: Vulkan leaves addresses open.
// Physical addresses pack the allocations densely, as a driver would do. Caches and DRAM see only physical
// addresses.
class AddressSpace {
 public:
  static constexpr int kShift = 32;

  struct Allocation {
    std::string name;  // name in messages, such as "binding 4 (Vertices)"
    uint64_t bytes = 0;
    Address physical = 0;  // address of byte 0; aligned to 256 bytes
    std::byte* data = nullptr;
  };

  AddressSpace() : allocations_(1) {}
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;

  // Allocates bytes that are 0 and aligned to 64 bytes on the host. A size past 4 GiB takes several
  // consecutive allocation numbers.
  Address allocate(std::string name, uint64_t bytes);
  // Takes bytes as an allocation, as they are.
  Address adopt(std::string name, HostBlock block);
  // Reserves physical bytes for the machine, which no program can address. Returns the address of the first.
  // Throws UserError when physical memory becomes larger than kMaxPhysicalBytes.
  Address reserve(uint64_t bytes);

  // Returns a host pointer to [address, address + bytes), or null when any byte lies outside an allocation.
  std::byte* find(Address address, uint64_t bytes) const {
    const uint64_t index = address >> kShift;
    const uint64_t offset = address & ((uint64_t{1} << kShift) - 1);
    if (index >= allocations_.size() || offset + bytes > allocations_[index].bytes) [[unlikely]]
      return nullptr;
    return allocations_[index].data + offset;
  }
  Address physical(Address address) const {
    return allocations_[address >> kShift].physical + (address & ((uint64_t{1} << kShift) - 1));
  }
  // Returns `count` objects of T, which must lie inside an allocation. The host uses it; shaders use find().
  template <class T>
  std::span<T> view(Address address, uint64_t count) const {
    return {reinterpret_cast<T*>(find(address, count * sizeof(T))), size_t(count)};
  }
  void write(Address address, const void* from, uint64_t bytes) {
    std::memcpy(find(address, bytes), from, bytes);
  }

  // Says where an access that find() refuses would have gone, relative to the nearest allocation: "16 bytes
  // past the end of 'binding 4 (Vertices)' (1200 bytes)".
  std::string explain(Address address, uint64_t bytes) const;
  uint64_t bytes_allocated() const { return next_physical_; }
  const std::vector<Allocation>& allocations() const { return allocations_; }

 private:
  std::vector<Allocation> allocations_;
  std::vector<HostBlock> blocks_;  // what the allocations point into
  Address next_physical_ = 0;
};

}  // namespace glint::mem
