// Looks rays up before they begin, leads them to the node that the look-up gives, and sees what comes of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/stats.h"
#include "memsys/address_space.h"
#include "rtunit/ray_entry.h"
#include "rtunit/unit/test_pipelines.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

struct EntryStats {
  explicit EntryStats(stats::Group* parent) : group(parent, "entry") {}
  stats::Group group;
  stats::Counter looked_up{&group, "looked_up", "ray",
                           "Number of rays that were looked up before they began."};
  stats::Counter predicted{&group, "predicted", "ray", "Number of rays whose look-up gave a node."};
  stats::Counter verified{&group, "verified", "ray",
                          "Number of rays with a hit in the subtree of the node that they began at."};
  stats::Counter wrong{&group, "wrong", "ray",
                       "Number of rays without a hit in the subtree of the node that they began at."};
  stats::Value undecided{
      &group, "undecided", "ray",
      [this] { return double(predicted.value() - verified.value() - wrong.value()); },
      "Number of rays that were in the subtree that they began at when another lane found the hit that ended "
      "them (rt.mapping)."};
  stats::Counter predicted_nodes{
      &group, "predicted_nodes", "node",
      "Number of nodes visited in subtrees that rays began at. The leaves of their "
      "instances, which are read once a ray, are not counted."};
  stats::Counter wasted_nodes{&group, "wasted_nodes", "node",
                              "Number of nodes visited in subtrees that rays began at without a hit there."};
  stats::Ratio accuracy{&group,    "accuracy",
                        "ray/ray", verified,
                        predicted, "Share of the rays with a predicted node that had a hit below it."};
};

// A look-up is a test in a pipeline of its own. A ray whose look-up gives a node then reads the leaf of the
// instance, which the transform pipeline tests, and goes on at the node.
// Model: nothing is learned from a hit that another lane has found for the ray (rt.mapping), because that
// lane has no path.
class EntryLookUp final : public WalkHook {
 public:
  EntryLookUp(std::unique_ptr<RayEntry> policy, const mem::AddressSpace& memory, WarpBuffer& buffer,
              TestPipelines& pipelines, RtStats& stats);

  void entered(uint32_t slot, int lane, Cycle now) override;
  void moved(uint32_t /*slot*/, int /*lane*/, Cycle /*now*/) override {}  // What is held goes with the ray.
  // Returns whether the look-up of the lane's ray has given a node that the ray has not begun to walk to.
  bool has_prediction(uint32_t slot, int lane) const;
  bool detour(uint32_t slot, int lane, Cycle now) override;
  void errand_started(uint32_t slot, int lane) override;
  void visited(const Visit& visit) override;
  void stopped(uint32_t slot, int lane) override;

 private:
  enum class Phase : uint8_t {
    Other,      // The policy does not deal with the ray.
    New,        // The ray waits for its look-up.
    LookingUp,  // The look-up has begun.
    Entering,   // The leaf of the predicted instance is read.
    Ahead,      // The ray walks the subtree of the predicted node.
    Walking,    // It walks from the root.
  };
  struct Lane {
    Phase phase = Phase::Other;
    uint32_t nodes = 0;  // visited in the predicted subtree
    std::optional<Start> start;
    RayEntry::Ending ending;
  };

  Lane& lane_of(uint32_t slot, int lane) {
    const auto [warp_slot, own_lane] = buffer_[slot].place_of(lane);
    return lanes_[warp_slot][size_t(own_lane)];
  }
  void miss_subtree(Lane& lane);

  const std::unique_ptr<RayEntry> policy_;
  const mem::AddressSpace& memory_;
  WarpBuffer& buffer_;
  TestPipelines& pipelines_;
  EntryStats stats_;
  const Pipe pipe_;
  std::vector<std::array<Lane, kLanes>> lanes_;  // by the core's warp slot; what they hold of their own rays
};

}  // namespace glint::rt
