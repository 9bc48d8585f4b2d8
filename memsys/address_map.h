// Maps a physical address to its L2 slice and partition, and to its bank and row there.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "base/types.h"
#include "memsys/slice_classes.h"

namespace glint::mem {

// Says how chunks spread over slices.
enum class SliceHash : uint8_t { Mixed, Classes, None };
inline SliceHash slice_hash(const std::string& name) {
  return name == "mixed" ? SliceHash::Mixed : name == "classes" ? SliceHash::Classes : SliceHash::None;
}

// Spreads addresses over N L2 slices; those of one memory partition have consecutive numbers. Memory is cut
// into chunks of `interleave` bytes. With `Classes`, SliceClasses tells the slice of a chunk. Otherwise N
// chunks in a row form a group, and inside a group chunk r goes to slice (r + hash(group)) mod N. Each group
// fills every slice once, whatever N is, so slices stay equally full and their local addresses are dense. The
// hash turns each group differently, so that strides which are multiples of N chunks spread too. (IPOLY
// hashes need N = 16, 32 or 64.) Without a hash, chunk r goes to slice r, as GPGPU-Sim does with memory
// partition index 0.
class PartitionMap {
 public:
  PartitionMap(uint32_t partitions, uint32_t slices, uint32_t interleave, SliceHash hash = SliceHash::Mixed)
      : slices_(partitions * slices),
        slices_of_one_(slices),
        interleave_(interleave),
        mixed_(hash == SliceHash::Mixed),
        classes_(hash == SliceHash::Classes ? &slice_classes(slices_) : nullptr) {}

  uint32_t slice(Address address) const {
    const uint64_t chunk = address / interleave_;
    if (classes_) return classes_->slice(chunk);
    if (!mixed_) return uint32_t(chunk % slices_);
    const uint64_t group = chunk / slices_;
    return uint32_t((chunk % slices_ + (mixed_bits(group) >> 40)) % slices_);
  }
  uint32_t partition_of(uint32_t slice) const { return slices_of_one_ == 1 ? slice : slice / slices_of_one_; }
  uint32_t partition(Address address) const { return partition_of(slice(address)); }
  // Returns the address inside the partition. Such addresses are dense: the numbers of the chunk among those
  // of its slice and of the slice in its partition replace the number of the chunk.
  Address local(Address address, uint32_t slice) const {
    const uint64_t rank = classes_ ? classes_->rank(address / interleave_) : address / interleave_ / slices_;
    return (rank * slices_of_one_ + slice % slices_of_one_) * interleave_ + address % interleave_;
  }
  uint32_t slices() const { return slices_; }

 private:
  uint32_t slices_, slices_of_one_, interleave_;
  bool mixed_;
  const SliceClasses* classes_;
};

struct DramLocation {
  uint32_t bank = 0;  // bank_in_group * groups + group
  uint32_t group = 0;
  uint32_t row = 0;
};

// Finds bank and row of a local address. From its low end, the address consists of interleave chunk, bank
// group, rest of the column, bank in the group, and row. Neighbouring chunks alternate between bank groups
// and never pay the longer tCCD_L. The row number turns the bank (permutation-based interleaving; Zhang, Zhu,
// Zhang, MICRO 2000).
class DramMap {
 public:
  DramMap(uint32_t banks, uint32_t groups, uint32_t row_bytes, uint32_t interleave)
      : groups_(groups),
        per_group_(banks / groups),
        chunks_(row_bytes / interleave),
        interleave_(interleave) {}

  DramLocation locate(Address local) const {
    uint64_t rest = local / interleave_;
    const uint32_t group = uint32_t(rest % groups_);
    rest = rest / groups_ / chunks_;
    const uint64_t row = rest / per_group_;
    const uint32_t in_group = uint32_t((rest + row) % per_group_);
    return {in_group * groups_ + group, group, uint32_t(row)};
  }

 private:
  uint32_t groups_, per_group_, chunks_, interleave_;
};

}  // namespace glint::mem
