// Implements the stack model `shared_memory`: the top of the stack is on chip, what is below it in the SM's
// shared memory, and the rest in local memory.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/stack_model.h"

namespace glint::rt {
namespace {

// Sources: AMD's DS_BVH_STACK instructions keep 8, 16, 32 or 64 entries of a lane in the memory that a
// workgroup shares (RDNA 3 ISA guide, 2023). No source gives the ports of such an area, so those are guesses.
// Model: a row moves between registers and the area, and from there to memory; a row that comes from memory
// goes to registers at once. The unit's ports are its own: loads and stores of shaders to shared memory do
// not meet it there. As with `short_stack`, entries that a shader has cut off are read and dropped.
class SharedMemory final : public StackModel {
 public:
  static constexpr std::string_view kName = "shared_memory";
  static constexpr std::string_view kDoc =
      "A ray keeps its newest entries on chip, older ones in shared memory, and the others in local memory.";
  struct Params {
    uint32_t entries = 8;         // as many as `short_stack` has, to compare them
    uint32_t shared_entries = 8;  // guess: 64 KiB of shared memory hold so many for 32 warps
    uint32_t ports = 1;           // guess
    uint32_t latency = 23;        // as core.shared.latency
    bool interleaved = true;      // guess
    static ParamList params() {
      return {param(&Params::entries, "entries", "entry",
                    "Number of stack entries that a ray has on chip. Four entries move at a time.",
                    kEntriesPerSector, kStackEntries),
              param(&Params::shared_entries, "shared_entries", "entry",
                    "Number of stack entries that a ray has in shared memory, 8 B each, rounded down to a "
                    "multiple of four. Each warp of a launch that traces rays takes the room of its 32 rays "
                    "from core.shared_bytes.",
                    kEntriesPerSector, kStackEntries),
              param(&Params::ports, "ports", "pass",
                    "Number of passes through the banks in a cycle. A pass moves up to four rows of four "
                    "entries, each in other banks.",
                    1, 8),
              param(&Params::latency, "latency", "cycle",
                    "Cycles from the pass that reads entries to the ray's next node.", 1, 1000),
              flag(&Params::interleaved, "interleaved",
                   "True: rows of neighbouring lanes lie next to each other. False: the rows of a ray do, so "
                   "that more of them meet in the same banks.")};
    }
  };
  SharedMemory(Params params, Context) : params_(params), rows_(params.shared_entries / kEntriesPerSector) {}

  uint32_t rows() const override { return kStackEntries / kEntriesPerSector; }
  SharedArea shared_area() const override {
    return {rows_, params_.ports, params_.latency, params_.interleaved};
  }

  StackWork settle(RayState& state) const override {
    int16_t &off_chip = state.stack_off_chip, &in_memory = state.stack_in_memory;
    StackWork work;
    work.row = uint16_t(in_memory / kEntriesPerSector);
    work.shared_row = uint16_t(off_chip / kEntriesPerSector);
    if (has_left_stack(state)) off_chip = in_memory = 0;
    for (; off_chip > in_memory && state.stack_size <= off_chip; ++work.loads) off_chip -= kEntriesPerSector;
    for (; off_chip > 0 && state.stack_size <= off_chip; ++work.fills)
      in_memory = off_chip -= kEntriesPerSector;
    for (; state.stack_size - off_chip > int(params_.entries); ++work.stores) {
      if (off_chip - in_memory == int(rows_) * kEntriesPerSector) {
        in_memory += kEntriesPerSector;
        ++work.spills;
      }
      off_chip += kEntriesPerSector;
    }
    return work;
  }

 private:
  const Params params_;
  const uint32_t rows_;
};

const Register<StackModel, SharedMemory> registered;

}  // namespace
}  // namespace glint::rt
