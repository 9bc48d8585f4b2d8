// Implements the parking `at_rays`: a warp that waits for its rays makes room for others.
// SPDX-License-Identifier: Apache-2.0
#include "core/parking.h"

namespace glint::core {
namespace {

// Source: Chou and Aamodt, ASPLOS 2025 (doi 10.1145/3676641.3716279), who call it ray virtualisation: a block
// whose rays wait gives up its place and is injected again.
class AtRays final : public Parking {
 public:
  static constexpr std::string_view kName = "at_rays";
  static constexpr std::string_view kDoc =
      "A warp gives up its place when the RT unit has taken its rays, if a block or another warp wants it "
      "(ray "
      "virtualisation).";
  struct Params {
    static ParamList params() { return {}; }
  };
  AtRays(Params, Context) {}
  bool gives_up(const View& view) override { return view.has_blocks || view.returning > 0; }
};

const Register<Parking, AtRays> registered;

}  // namespace
}  // namespace glint::core
