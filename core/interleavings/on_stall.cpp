// Implements the interleaving `on_stall`: another path of a warp runs while the first one waits for memory.
// SPDX-License-Identifier: Apache-2.0
#include "core/interleaving.h"

namespace glint::core {
namespace {

// Source: Damani, Stephenson, Rangan, Johnson, Kulkarni, Keckler, "GPU Subwarp Interleaving", HPCA 2022.
// Their core switches when a path stalls, and may do so only when enough of the other warps wait.
class OnStall final : public Interleaving {
 public:
  static constexpr std::string_view kName = "on_stall";
  static constexpr std::string_view kDoc =
      "Another path of a warp runs while the running one waits for memory (subwarp interleaving).";
  struct Params {
    double waiting = 0.5;  // Choice: the scheduler has few other warps to issue from.
    bool yields = false;
    static ParamList params() {
      return {param(&Params::waiting, "waiting", "ratio",
                    "Share of a scheduler's warps that have to wait for memory before one changes its path.",
                    0, 1),
              flag(&Params::yields, "yields",
                   "True: a path also makes room for another one as soon as it has sent a load, so that the "
                   "other one sends its own. False: it runs until it waits.")};
    }
  };
  OnStall(Params params, Context) : params_(params) {}
  bool leaves(const View& view) const override { return view.waiting >= params_.waiting * view.warps; }
  bool yields(const View& view) const override { return params_.yields && leaves(view); }

 private:
  const Params params_;
};

const Register<Interleaving, OnStall> registered;

}  // namespace
}  // namespace glint::core
