// Implements the op times `vulkan_sim`: Vulkan-Sim's table of PTX opcodes and the pipeline around it.
// SPDX-License-Identifier: Apache-2.0

#include "core/op_times.h"

namespace glint::core {
namespace {

using isa::Unit;

// Source: -ptx_opcode_latency_* and -ptx_opcode_initiation_* of Vulkan-Sim 2.0.0. Its configurations
// SM75_RTX2060 and MOBILE have the same values. Opcodes that its set_opcode_and_latency() does not name take
// 1 / 1: moves, comparisons, logic, shifts and conversions. Five cycles are added to each latency: in
// Vulkan-Sim's logs (SHIP, path tracing) an arithmetic instruction takes 7.0 cycles from issue to completion,
// while the latencies of the table are 1 to 5. A division has the time of Vulkan-Sim's pair of rcp (100) and
// mul (4). An fma has that of mul and add, into which Vulkan-Sim's compiler breaks it.
constexpr uint32_t kPipe = 5;
constexpr OpTime kTimes[] = {
    {"add.*f64", 8 + kPipe, 4},
    {"sub.*f64", 8 + kPipe, 4},
    {"mul.*f64", 8 + kPipe, 4},
    {"add.*f32", 4 + kPipe, 2},
    {"sub.*f32", 4 + kPipe, 2},
    {"mul.*f32", 4 + kPipe, 2},
    {"fma.*f32", 8 + 2 * kPipe, 4},
    {"min.*f32", 13 + kPipe, 2},
    {"max.*f32", 13 + kPipe, 2},
    {"add.*32", 4 + kPipe, 2},
    {"sub.*32", 4 + kPipe, 2},
    {"mul.*32", 4 + kPipe, 2},
    {"mad.*32", 5 + kPipe, 2},
    {"add.*64", 4 + kPipe, 2},
    {"sub.*64", 4 + kPipe, 2},
    {"mul.*64", 4 + kPipe, 2},
    {"mad.*64", 5 + kPipe, 2},
    {"min.*32", 13 + kPipe, 2},
    {"max.*32", 13 + kPipe, 2},
    {"div.*f32", 104 + 2 * kPipe, 10},
    {"div.*32", 145 + kPipe, 8, Unit::Sfu},
    {"rem.*32", 1 + kPipe, 1},
    {"sqrt.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"rsqrt.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"rcp.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"sin.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"cos.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"ex2.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"lg2.*f32", 100 + kPipe, 8, Unit::Sfu},
    {"mov.*", 1 + kPipe, 1},
    {"selp.*", 1 + kPipe, 1},
    {"setp.*", 1 + kPipe, 1},
    {"set.*", 1 + kPipe, 1},
    {"cvt.*", 1 + kPipe, 1},
    {"and.*", 1 + kPipe, 1},
    {"or.*", 1 + kPipe, 1},
    {"xor.*", 1 + kPipe, 1},
    {"not.*", 1 + kPipe, 1},
    {"shl.*", 1 + kPipe, 1},
    {"shr.*", 1 + kPipe, 1},
    {"neg.*", 1 + kPipe, 1},
    {"abs.*", 1 + kPipe, 1},
};

class VulkanSim final : public OpTimes {
 public:
  static constexpr std::string_view kName = "vulkan_sim";
  static constexpr std::string_view kDoc =
      "Ops have the times of Vulkan-Sim's table of PTX opcodes: 1 cycle for what it does not name, and 100 "
      "for roots.";
  struct Params {
    static ParamList params() { return {}; }
  };
  VulkanSim(Params, Context) {}
  std::span<const OpTime> entries() const override { return kTimes; }
};

const Register<OpTimes, VulkanSim> registered;

}  // namespace
}  // namespace glint::core
