// Implements the parking `none`: a warp keeps its place in its core to its end.
// SPDX-License-Identifier: Apache-2.0
#include "core/parking.h"

namespace glint::core {
namespace {

class NoParking final : public Parking {
 public:
  static constexpr std::string_view kName = "none";
  static constexpr std::string_view kDoc = "Warps keep their places while their rays are in the RT unit.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  NoParking(Params, Context) {}
  bool is_used() const override { return false; }
  bool gives_up(const View&) override { return false; }
};

const Register<Parking, NoParking> registered;

}  // namespace
}  // namespace glint::core
