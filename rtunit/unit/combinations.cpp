// Says which policies of the RT unit do not go together, and which need treelets.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <string>
#include <string_view>

#include "rtunit/unit/rt_unit.h"
#include "rtunit/unit/stack_mover.h"

namespace glint::rt {
namespace {

std::string chosen(const PolicyKind& kind, const AnyPolicyChoice& choice) {
  return fmt::format("{} = \"{}\"", kind.key, choice.name);
}

bool prefetches_treelets(const Params& params) {
  const mem::AddressSpace none;
  PrefetchQueue queue(1, none, nullptr);
  return params.prefetch.make({nullptr, queue, none, 1})->needs_treelets();
}

// Returns why the ray pool does not go with another choice, or nothing when it does.
std::string why_no_pool(const Params& params) {
  const auto why = [&](std::string_view key, std::string_view value, std::string_view reason) {
    return fmt::format("rt.pool = \"{}\" does not go with {} = \"{}\": {}", params.pool.name, key, value,
                       reason);
  };
  if (params.mapping.name != WorkMapping::kOwnRay)
    return why("rt.mapping", params.mapping.name,
               "lanes that work for one ray would have to move together when it changes its warp");
  if (params.oracle.any_lane)
    return why("rt.oracle.any_lane", "true", "with that oracle, no lane is without a ray already");
  if (params.any_hit.make({})->table_rows() != 0 && !params.shortcuts.store_each_hit)
    return why("rt.any_hit", params.any_hit.name,
               "lanes of a warp share the lines of their candidate tables, and a pool takes the lanes apart");
  return {};
}

}  // namespace

std::string RtUnit::why_not_together(const Params& params) {
  if (params.unit == kSoftware && params.leaf_filter.name != LeafFilter::kNone)
    return fmt::format(
        "{} does not go with rt.unit = \"{}\": instructions of the core walk the rays then, and ask no "
        "filter",
        chosen(LeafFilter::kKind, params.leaf_filter), kSoftware);
  if (params.scheduler.make({})->needs_treelet_ahead() && !prefetches_treelets(params))
    return fmt::format(
        "{} does not go with {}: that scheduler goes by the treelet that is read ahead; choose rt.prefetch = "
        "\"treelet\"",
        chosen(RayScheduler::kKind, params.scheduler), chosen(Prefetcher::kKind, params.prefetch));
  const auto stack = params.stack.make({});
  const std::string stack_name = chosen(StackModel::kKind, params.stack);
  if (params.mapping.name != WorkMapping::kOwnRay && stack->keeps_path())
    return fmt::format(
        "{} does not go with {}: that stack follows the path of a whole ray, and lanes that share a ray each "
        "follow a part of it",
        chosen(WorkMapping::kKind, params.mapping), stack_name);
  if (params.pool.name != RayPool::kNone)
    if (const std::string why = why_no_pool(params); !why.empty()) return why;
  if (params.order.name == TraversalOrder::kDepthFirst) return {};
  const std::string order_name = chosen(TraversalOrder::kKind, params.order);
  if (StackMover::is_needed(*stack))
    return fmt::format(
        "{} does not go with {}: that stack keeps a ray's newest nodes on chip, and this order goes on with "
        "others; choose rt.stack = \"full\"",
        order_name, stack_name);
  const mem::AddressSpace none;
  if (params.entry.make({nullptr, none})->wants_path())
    return fmt::format(
        "{} does not go with {}: that entry learns the nodes above a hit from a walk that is depth first",
        order_name, chosen(RayEntry::kKind, params.entry));
  return {};
}

std::string RtUnit::who_needs_treelets(const Params& params) {
  const mem::AddressSpace none;
  if (params.order.make({nullptr, none})->needs_treelets())
    return chosen(TraversalOrder::kKind, params.order);
  if (params.pool.make({nullptr, none, 1, 1})->needs_treelets()) return chosen(RayPool::kKind, params.pool);
  if (prefetches_treelets(params)) return chosen(Prefetcher::kKind, params.prefetch);
  return {};
}

}  // namespace glint::rt
