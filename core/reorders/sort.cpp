// Implements the reordering `sort`: warps that wait at a call of reorderThread are sorted by hit object and
// hint.
// SPDX-License-Identifier: Apache-2.0
#include "core/reorder.h"

namespace glint::core {
namespace {

// VK_EXT_ray_tracing_invocation_reorder leaves the order to the implementation, and says that the hit object
// should count more than the hint. Model: threads meet those of their own core only.
class SortThreads final : public Reorder {
 public:
  static constexpr std::string_view kName = "sort";
  static constexpr std::string_view kDoc =
      "Warps of a core that wait at a call of reorderThread are sorted by the shader record of the hit "
      "object "
      "and the hint (shader execution reordering).";
  struct Params {
    bool hint_first = false;
    static ParamList params() {
      return {flag(&Params::hint_first, "hint_first",
                   "True: the hint counts more than the shader record. False: the record counts more.")};
    }
  };
  SortThreads(const Params& params, Context) : params_(params) {}

  Where where() const override { return Where::Calls; }
  uint64_t key(const exec::ReorderCall& call) const override {
    const uint64_t record = record_key(call), hint = call.hint;
    return params_.hint_first ? hint << 32 | record : record << 32 | hint;
  }

 private:
  const Params params_;
};

const Register<Reorder, SortThreads> registered;

}  // namespace
}  // namespace glint::core
