// Sums areas of boxes over a structure.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/cost.h"

#include <array>
#include <cstdint>
#include <vector>

#include "base/check.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/structure.h"
#include "rtunit/structure/tree.h"

namespace glint::rt {

double expected_visits(std::span<const std::byte> structure, const std::function<double(Address)>& below) {
  const auto header = load<StructureHeader>(structure.data());
  const NodeFormat* const format = find_format(header.format);
  GLINT_CHECK(format, "node format {:#x} is not registered", header.format);
  if (header.num_primitives == 0) return 1;
  const double root = half_area(header.bounds);
  std::array<DecodedChild, kMaxWidth> children;
  std::vector<uint32_t> open{kRootBlock};
  double visits = 1;
  while (!open.empty()) {
    const std::byte* const node = structure.data() + size_t{open.back()} * kBlockBytes;
    open.pop_back();
    const uint32_t count = format->decode(node, children);
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t block = block_of(children[i].node);
      const NodeKind kind = kind_of(children[i].node);
      const double weight = root > 0 ? half_area(children[i].bounds) / root : 1;
      visits += weight;
      if (kind == NodeKind::Internal) open.push_back(block);
      if (kind == NodeKind::Instance && below)
        visits +=
            weight * below(load<InstanceLeaf>(structure.data() + size_t{block} * kBlockBytes).structure);
    }
  }
  return visits;
}

}  // namespace glint::rt
