// Implements the constant cache of a core.
// SPDX-License-Identifier: Apache-2.0
#include "core/constant_cache.h"

#include <algorithm>

namespace glint::core {

uint32_t different_addresses(const isa::Access& access, LaneMask lanes) {
  std::array<Address, size_t(kLanes)> seen;
  uint32_t count = 0;
  for_each_lane(lanes, [&](int lane) {
    const Address at = access.address[size_t(lane)];
    if (std::find(seen.begin(), seen.begin() + count, at) == seen.begin() + count) seen[count++] = at;
  });
  return std::max(count, 1u);
}

ConstantCache::ConstantCache(const ConstantParams& params, Address base, uint64_t bytes, uint32_t client,
                             CodeCache& cache, CodeStats& stats)
    : line_bytes_(std::min(params.line, cache.line_bytes())),
      client_(client),
      base_(base),
      bytes_(bytes),
      cache_(cache),
      stats_(stats),
      tags_(mem::cache_shape(params.size, params.ways, line_bytes_), params.replacement) {
  waits_.reserve(kMost);
}

bool ConstantCache::look_up(uint32_t slot, const isa::Access& access, LaneMask lanes, uint64_t offset,
                            Cycle now) {
  Address last = ~Address{0};
  for_each_lane(lanes, [&](int lane) {
    const uint64_t at = offset + access.address[size_t(lane)];
    if (at >= bytes_) return;  // This is a fault that was let pass.
    const Address line = (base_ + at) & ~Address{line_bytes_ - 1};
    if (line != last) want(slot, line, now);
    last = line;
  });
  return missing_[slot] == 0;
}

void ConstantCache::want(uint32_t slot, Address line, Cycle now) {
  ++stats_.constant_lines;
  if (const uint32_t at = tags_.find(line); at != mem::TagArray::kNone) {
    tags_.touch(at);
    return;
  }
  ++stats_.constant_misses;
  bool asked = false;
  for (const Wait& wait : waits_) {
    if (wait.line == line && wait.slot == slot) return;
    asked |= outer(wait.line) == outer(line);
  }
  waits_.push_back({slot, line});
  ++missing_[slot];
  if (!asked) cache_.ask(client_, outer(line), mem::Traffic::Constant, now);
}

}  // namespace glint::core
