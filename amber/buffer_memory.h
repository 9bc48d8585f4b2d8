// Holds the buffers of a script in simulated memory, with an allocation for each range that a descriptor
// names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "amber/script.h"
#include "memsys/address_space.h"

namespace glint::amber {

// An access past the range of a descriptor is outside of all allocations, even where another descriptor names
// these bytes: ranges are windows on one copy of the buffer.
class BufferMemory {
 public:
  explicit BufferMemory(mem::AddressSpace& memory) : memory_(memory) {}

  // Returns the address of bytes [first, end) of a buffer, which is uploaded at the first call.
  Address range(const Buffer& buffer, uint64_t first, uint64_t end);
  Address whole(const Buffer& buffer) { return range(buffer, 0, buffer.bytes.size()); }
  // Copies the bytes in memory to a buffer, if it was uploaded.
  void read_back(Buffer& buffer) const;
  // Takes over what the host has written to a buffer. Its addresses stay, unless its size has changed.
  void update(const Buffer& buffer);

 private:
  struct Copy {
    uint64_t bytes = 0;  // of the buffer
    mem::Backing backing{};
    std::map<std::pair<uint64_t, uint64_t>, Address> ranges;
  };
  mem::AddressSpace& memory_;
  std::map<std::string, Copy> copies_;  // by name of the buffer
};

}  // namespace glint::amber
