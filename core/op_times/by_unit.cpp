// Implements the op times `by_unit`: every op has the latency and the interval of its unit.
// SPDX-License-Identifier: Apache-2.0

#include "core/op_times.h"

namespace glint::core {
namespace {

class ByUnit final : public OpTimes {
 public:
  static constexpr std::string_view kName = "by_unit";
  static constexpr std::string_view kDoc = "Every op has the latency and the interval of its unit.";
  struct Params {
    static ParamList params() { return {}; }
  };
  ByUnit(Params, Context) {}
  std::span<const OpTime> entries() const override { return {}; }
};

const Register<OpTimes, ByUnit> registered;

}  // namespace
}  // namespace glint::core
