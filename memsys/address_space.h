// Holds the bytes of simulated memory: allocations in a 64-bit virtual space in which every overrun shows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/types.h"
#include "memsys/host_block.h"
#include "memsys/range_allocator.h"
#include "memsys/request.h"

namespace glint::mem {

// Reports that simulated memory, the addresses of allocations or the host's memory is used up. Nothing was
// allocated, and what was allocated before stays.
class OutOfMemory : public UserError {
 public:
  using UserError::UserError;
};

// Names bytes that programs reach through windows.
enum class Backing : uint32_t {};

// Every allocation starts at a multiple of 4 GiB. The upper 32 bits of an address name the allocation, and an
// index that runs past the end, or before the start, falls where nothing is. Allocation 0 is never used, so
// null pointers fault. Choice: Vulkan leaves addresses open.
// An allocation is a window on a backing: bytes of the host with physical addresses. allocate() makes both at
// once. Several windows may show the same bytes, each with addresses and an end of its own.
// Physical addresses pack the backings densely, as a driver would do. Caches and DRAM see only physical
// addresses, so an access through any window meets the same lines.
class AddressSpace {
 public:
  static constexpr int kShift = 32;
  static constexpr uint64_t kMaxSlots = uint64_t{1} << 16;             // Choice: addresses have 48 bits.
  static constexpr uint64_t kWindowAlignment = HostBlock::kAlignment;  // bytes

  // Says what a multiple of 4 GiB stands for. An allocation past 4 GiB has several slots; each reaches to the
  // allocation's end. Slots keep their places for as long as the space lives.
  struct Slot {
    uint64_t bytes = 0;    // 0: nothing is here
    Address physical = 0;  // address of byte 0
    std::byte* data = nullptr;
    Backing backing{};
    uint8_t skipped = 0;  // bytes before the window's first one (open_window())
    enum class Part : uint8_t { None, First, Rest } part = Part::None;  // of an allocation
    bool owns = false;   // The backing ends with this allocation.
    bool ended = false;  // The backing has been freed.
  };

  // Programs and the machine share `physical_bytes` of memory.
  explicit AddressSpace(uint64_t physical_bytes = kMaxPhysicalBytes);
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;

  // Allocates bytes that are 0 and aligned to 64 bytes on the host. The name is for messages, such as
  // "binding 4 (Vertices)". A size past 4 GiB takes several consecutive allocation numbers. All functions
  // that allocate throw OutOfMemory.
  Address allocate(std::string name, uint64_t bytes);
  // Takes bytes as an allocation, as they are.
  Address adopt(std::string name, HostBlock block);

  // Makes bytes that are 0, or takes bytes as they are. They have no address before a window shows them.
  Backing add_backing(uint64_t bytes);
  Backing add_backing(HostBlock block);
  // Takes bytes of somebody else, which have to stay until the backing is freed. Throws UserError unless the
  // pointer and the size are multiples of kWindowAlignment.
  Backing import_backing(std::byte* data, uint64_t bytes);
  std::byte* data(Backing backing) const { return backings_[size_t(backing)].data; }
  uint64_t size(Backing backing) const { return backings_[size_t(backing)].bytes; }  // bytes

  // Gives [offset, offset + bytes) of a backing an address of their own and an end of their own. Throws
  // UserError when they reach past the backing.
  // Choice: the address equals the offset modulo kWindowAlignment, so that what is aligned in the backing is
  // aligned in the window. With another offset than a multiple of that, up to 63 bytes before the window can
  // be reached, too.
  Address open_window(std::string name, Backing backing, uint64_t offset, uint64_t bytes);
  // Frees the allocation or window at an address that allocate(), adopt() or open_window() returned. Its
  // addresses are not used again soon, so that stale pointers are found.
  void free(Address address);
  // Frees bytes. Windows on them stay, but nothing is in them.
  void free(Backing backing);
  void rename(Address address, std::string name);

  // Reserves physical bytes for the machine, which no program can address. Returns the address of the first.
  Address reserve(uint64_t bytes);
  // Gives back bytes that were reserved at once.
  void release(Address first, uint64_t bytes);

  // Returns a host pointer to [address, address + bytes), or null when any byte lies outside an allocation.
  std::byte* find(Address address, uint64_t bytes) const {
    const uint64_t index = address >> kShift;
    const uint64_t offset = address & ((uint64_t{1} << kShift) - 1);
    if (index >= kMaxSlots || offset + bytes > slots_[index].bytes) [[unlikely]]
      return nullptr;
    return slots_[index].data + offset;
  }
  Address physical(Address address) const {
    return slots_[address >> kShift].physical + (address & ((uint64_t{1} << kShift) - 1));
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
  // Says which bytes of which allocation find() returns: "byte 8 of 'binding 4 (Vertices)' (1200 bytes)".
  std::string describe(Address address) const;
  uint64_t bytes_allocated() const { return physical_.end(); }  // one past the last physical byte
  uint64_t bytes_in_use() const { return physical_.num_taken(); }
  // Returns the slots up to the last one that is used. Some may be empty.
  std::span<const Slot> slots() const { return {slots_.data(), size_t(numbers_.end())}; }

 private:
  struct Bytes {
    HostBlock own;  // empty if somebody else has the bytes
    std::byte* data = nullptr;
    uint64_t bytes = 0;
    Address physical = 0;
  };

  void check_room(uint64_t bytes) const;
  HostBlock zeros(uint64_t bytes) const;
  Backing add(Bytes bytes);
  uint64_t take_slots(uint64_t count);
  uint64_t num_slots(uint64_t first) const;
  uint64_t size_of(const Slot& slot) const { return slot.bytes - slot.skipped; }

  HostArray<Slot> slots_{kMaxSlots, Filling::Sparse};
  std::vector<std::string> names_;  // by slot; those of freed allocations stay for messages
  std::vector<Bytes> backings_;
  std::vector<Backing> free_backings_;
  RangeAllocator numbers_{kMaxSlots};
  std::deque<std::pair<uint64_t, uint64_t>> freed_numbers_;  // first and count, the oldest first
  RangeAllocator physical_;
};

}  // namespace glint::mem
