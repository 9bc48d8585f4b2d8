// Implements the entry `perfect`: every ray begins at the leaf with its hit, which no hardware can know.
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "base/registry.h"
#include "rtunit/params.h"
#include "rtunit/ray_entry.h"

namespace glint::rt {
namespace {

// Bounds what predictors can gain. A ray that misses begins at the root, because no hit that a table holds
// says that there is none.
// Model: a look-up takes a cycle, the least that a look-up can take, and all rays are looked up at once. It
// follows a copy of the ray by the rules of the unit, so the ray finds the hit that it would have found.
class Perfect final : public RayEntry {
 public:
  static constexpr std::string_view kName = "perfect";
  static constexpr std::string_view kDoc =
      "A ray with a hit begins at the leaf that has it: a bound of what predictors can gain.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Perfect(Params, Context context) : memory_(context.memory) {}

  Timing timing() const override { return {1, 1, kMostWarps * kLanes}; }
  bool wants(const Ray&) const override { return true; }
  std::optional<Start> look_up(const RayState& ray) override {
    RayState copy = ray;
    copy.path = nullptr;
    copy.table = nullptr;
    run(copy, memory_);
    if (!copy.committed.valid()) return std::nullopt;
    return Start{copy.committed.instance_leaf, copy.committed.triangle_leaf, NodeKind::Triangle};
  }

 private:
  const mem::AddressSpace& memory_;
};

const Register<RayEntry, Perfect> registered;

}  // namespace
}  // namespace glint::rt
