// Implements the traversal order `two_stacks`: a ray visits the open nodes of its treelet before all others
// (Chou, Nowicki, Aamodt: "Treelet Prefetching For Ray Tracing", MICRO 2023).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "base/registry.h"
#include "base/stats.h"
#include "rtunit/traversal/traversal.h"
#include "rtunit/traversal_order.h"
#include "rtunit/treelets.h"

namespace glint::rt {
namespace {

// The published design has a stack for the nodes of the current treelet and one for the others; when the
// first is empty, the top of the second is the next node, and its treelet the current one. Here both are one
// stack, in which the nodes of the current treelet lie on top: a new node of another treelet goes below them.
// Model: each structure has its own two stacks, so an instance is walked to its end before the other nodes of
// the top level.
class TwoStacks final : public TraversalOrder {
 public:
  static constexpr std::string_view kName = "two_stacks";
  static constexpr std::string_view kDoc =
      "A ray visits the nodes of its treelet before those of other treelets (MICRO 2023).";
  struct Params {
    static ParamList params() { return {}; }
  };
  TwoStacks(Params, const Context& context)
      : treelets_(context.memory), group_(context.stats, "two_stacks") {}

  bool needs_treelets() const override { return true; }

  void arrange(const OpenNodes& open) override {
    const TreeletId current = treelets_.of(open.visited.address);
    const auto is_current = [&](size_t entry) {
      return treelets_.of(fetch_of_entry(open.ray, entry).address) == current;
    };
    size_t others = open.first;  // The entries of the current treelet begin here.
    while (others > open.bottom && is_current(others - 1)) --others;
    // Each new node of another treelet goes below the current ones, the lowest first.
    for (size_t entry = open.first; entry < open.end; ++entry) {
      if (is_current(entry)) continue;
      ++left_for_later_;
      move_below(open.ray.stack, others++, entry, entry + 1);
    }
  }

 private:
  const Treelets treelets_;
  stats::Group group_;
  stats::Counter left_for_later_{&group_, "left_for_later", "node",
                                 "Number of nodes that rays met in another treelet than the one above them."};
};

const Register<TraversalOrder, TwoStacks> registered;

}  // namespace
}  // namespace glint::rt
