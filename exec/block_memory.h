// Shows global memory to one block that runs before its turn, and finds out whether its turn would have shown
// it another memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/types.h"
#include "isa/effects.h"
#include "memsys/address_space.h"

namespace glint::exec {

// Says what the blocks of a launch do with an allocation of memory, as far as they have run.
enum class AllocationUse : uint8_t {
  Read,       // Nobody has written it.
  Written,    // Some block has written it.
  Structure,  // It holds an acceleration structure, which rays read without asking here.
};

// Holds the use of each allocation. Windows that share a line of the host count as one allocation.
class MemoryUses {
 public:
  explicit MemoryUses(const mem::AddressSpace& memory);

  // Returns the number of the allocation at an address.
  size_t number_of(Address address) const { return numbers_[size_t(address >> mem::AddressSpace::kShift)]; }
  size_t size() const { return uses_.size(); }
  AllocationUse& operator[](size_t number) { return uses_[number]; }
  AllocationUse operator[](size_t number) const { return uses_[number]; }

 private:
  std::vector<uint32_t> numbers_;  // by slot
  std::vector<AllocationUse> uses_;
};

// Finds lines by their place in memory.
class LineIndex {
 public:
  static constexpr uint32_t kNone = ~0u;
  uint32_t find(const std::byte* place) const { return slots_[slot_of(place)].number; }
  // Returns the number of a line, which is kNone and has to be set when the line is new.
  uint32_t& add(const std::byte* place);
  void clear();

 private:
  struct Slot {
    const std::byte* place = nullptr;
    uint32_t number = kNone;
  };
  size_t slot_of(const std::byte* place) const;

  std::vector<Slot> slots_ = std::vector<Slot>(256);  // a power of two, of which at most half is used
  size_t size_ = 0;
};

// Holds which bytes of memory blocks have written since some time.
class WrittenBytes {
 public:
  explicit WrittenBytes(size_t num_allocations) : is_written_(num_allocations) {}
  void clear();

 private:
  friend class BlockMemory;
  LineIndex index_;
  std::vector<uint64_t> lines_;      // the bytes of each line
  std::vector<uint8_t> is_written_;  // by allocation
};

// Holds what one block does to global memory. Its stores and atomics go to copies of the lines that they
// touch, and what it reads is noted: by the byte in allocations that somebody writes, and as a whole in all
// others. Memory does not change while blocks run like this. Then commit() is called for one block after the
// other, in their order, for those that saw what their turn would have shown them.
class BlockMemory {
 public:
  // `uses` outlives the block's run.
  explicit BlockMemory(const MemoryUses& uses) : uses_(uses), is_own_(uses.size()), is_read_(uses.size()) {}

  // Returns where an access of up to 64 bytes, which lie in one line, finds or leaves its data. `at` is their
  // place in memory.
  std::byte* place(Address address, std::byte* at, uint32_t bytes, isa::Effect effect) {
    const size_t allocation = uses_.number_of(address);
    if (is_load(effect) && !is_own_[allocation] && uses_[allocation] != AllocationUse::Written) {
      is_read_[allocation] = 1;
      return at;
    }
    return place_in_line(allocation, at, bytes, effect);
  }
  // Notes that the block reads an allocation, and the place of the data is not asked for.
  void read_as_it_is(Address address) {
    const size_t allocation = uses_.number_of(address);
    is_read_[allocation] = 1;
    is_unsuited_ |= is_own_[allocation] || uses_[allocation] == AllocationUse::Written;
  }

  // Returns whether the block did what cannot be followed here: it wrote into a structure, or sampled an
  // image that blocks store to. Its results are wrong then.
  bool is_unsuited() const { return is_unsuited_; }
  // Returns whether the block has read what was written.
  bool has_read(const WrittenBytes& written) const;
  size_t num_lines() const { return num_lines_; }  // of copies
  // Puts what the block has written into memory, into `written` and into `uses`.
  void commit(WrittenBytes& written, MemoryUses& uses) const;

 private:
  static constexpr uint32_t kLine = 64;  // bytes; allocations are aligned to it on the host
  static constexpr size_t kLines = 64;   // lines that are allocated together, so that they never move
  struct Line {
    std::byte* place;  // place of its first byte
    size_t allocation;
    uint64_t read, written;  // by byte; what the block read before it wrote it
    std::array<std::byte, kLine> data;
  };

  static bool is_load(isa::Effect effect) {
    return effect == isa::Effect::Load || effect == isa::Effect::SurfaceLoad;
  }
  std::byte* place_in_line(size_t allocation, std::byte* at, uint32_t bytes, isa::Effect effect);
  Line& line_of(size_t allocation, std::byte* place);
  Line& line(size_t number) const { return (*lines_[number / kLines])[number % kLines]; }

  const MemoryUses& uses_;
  std::vector<uint8_t> is_own_, is_read_;  // by allocation: whether the block wrote it, or read all of it
  bool is_unsuited_ = false;
  LineIndex index_;
  std::vector<std::unique_ptr<std::array<Line, kLines>>> lines_;
  size_t num_lines_ = 0;
  Line* last_ = nullptr;
};

}  // namespace glint::exec
