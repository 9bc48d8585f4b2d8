// Implements the stack model `short_stack`: the top of the stack is on chip and the rest in local memory.
// Entries move a sector at a time.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/stack_model.h"

namespace glint::rt {
namespace {

// Model: when a shader has cut off entries, those that lie in memory are read and dropped, as they must be in
// hardware that keeps distances with them. Entries that are on chip when a shader is called stay there with
// the rest of the ray's state.
class ShortStack final : public StackModel {
 public:
  static constexpr std::string_view kName = "short_stack";
  static constexpr std::string_view kDoc =
      "A ray keeps its newest entries on chip and the others in local memory.";
  struct Params {
    // This is the smallest stack of AMD's DS_BVH_STACK instructions (RDNA 3 ISA guide, 2023: 8, 16, 32 or 64
    // entries).
    uint32_t entries = 8;
    static ParamList params() {
      return {param(&Params::entries, "entries", "entry",
                    "Number of stack entries that a ray has on chip. Four entries spill or fill at a time.",
                    kEntriesPerSector, kStackEntries)};
    }
  };
  ShortStack(Params params, Context) : params_(params) {}

  uint32_t rows() const override { return kStackEntries / kEntriesPerSector; }

  StackWork settle(RayState& state) const override {
    int16_t& in_memory = state.stack_off_chip;
    StackWork work;
    work.row = uint16_t(in_memory / kEntriesPerSector);
    if (has_left_stack(state)) in_memory = 0;
    while (in_memory > 0 && state.stack_size <= in_memory) {
      in_memory -= kEntriesPerSector;
      ++work.fills;
    }
    while (state.stack_size - in_memory > int(params_.entries)) {
      in_memory += kEntriesPerSector;
      ++work.spills;
    }
    return work;
  }

 private:
  const Params params_;
};

const Register<StackModel, ShortStack> registered;

}  // namespace
}  // namespace glint::rt
