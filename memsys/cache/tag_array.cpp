// Builds a tag array from its shape and the policy that replaces its lines.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/cache/tag_array.h"

#include <algorithm>
#include <bit>

#include "base/registry.h"

namespace glint::mem {

CacheShape cache_shape(uint64_t bytes, uint32_t ways, uint32_t line_bytes) {
  const auto lines = uint32_t(std::max<uint64_t>(bytes / line_bytes, 1));
  const uint32_t in_set = ways == 0 ? lines : std::min(ways, lines);
  return {lines / in_set, in_set, line_bytes};
}

TagArray::TagArray(const CacheShape& shape, const PolicyChoice<Replacement>& replacement)
    : shape_(shape),
      line_shift_(uint32_t(std::countr_zero(shape.line_bytes))),
      lines_(size_t{shape.sets} * shape.ways),
      has_index_(shape.ways > kMaxWaysSearched),
      index_(has_index_ ? lines_.size() : 0),
      replacement_(replacement.make({shape.sets, shape.ways})) {
}

}  // namespace glint::mem
