// Implements the stack model `restart_trail`: a short stack forgets its oldest entries, and the ray finds
// them again from the root.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/stack_model.h"

namespace glint::rt {
namespace {

// Sources: Laine 2010, "Restart Trail for Stackless BVH Traversal"; Vaidyanathan et al. 2019 for wide nodes.
// A few bits per level say which children are done. A ray whose stack is empty goes down from the root again,
// past what is done, and its stack keeps the entries that it meets on the way. Model: entries that have been
// cut off cost one restart, however many they are; the trail needs no memory. A ray that began below the root
// goes down from the node where it began, until it has finished with that.
class RestartTrail final : public StackModel {
 public:
  static constexpr std::string_view kName = "restart_trail";
  static constexpr std::string_view kDoc =
      "A ray keeps its newest entries on chip and finds the others again from the root.";
  struct Params {
    uint32_t entries = 8;  // Choice: as many as `short_stack` has, to compare them
    static ParamList params() {
      return {param(&Params::entries, "entries", "entry", "Number of stack entries that a ray has on chip.",
                    1, kStackEntries)};
    }
  };
  RestartTrail(Params params, Context) : params_(params) {}

  bool keeps_path() const override { return true; }

  StackWork settle(RayState& state) const override {
    int16_t& forgotten = state.stack_off_chip;
    StackWork work;
    // A ray without a path has the rest of its stack on chip.
    if (!state.path || has_left_stack(state)) forgotten = 0;
    if (forgotten > 0 && state.stack_size <= forgotten) {
      // The ray goes down again to find the newest of these entries.
      const int sought = state.stack_size > 0 ? state.stack_size : forgotten;
      work.replays = uint8_t(state.path->parent[size_t(sought) - 1] + 1);  // 0: it is the root
      forgotten = 0;
    }
    if (state.path && state.stack_size - forgotten > int(params_.entries))
      forgotten = int16_t(state.stack_size - int(params_.entries));
    return work;
  }

 private:
  const Params params_;
};

const Register<StackModel, RestartTrail> registered;

}  // namespace
}  // namespace glint::rt
