// Implements the reordering `none`: threads stay in the lanes in which they began.
// SPDX-License-Identifier: Apache-2.0
#include "core/reorder.h"

namespace glint::core {
namespace {

class NoReorder final : public Reorder {
 public:
  static constexpr std::string_view kName = "none";
  static constexpr std::string_view kDoc = "A call of reorderThread is nothing.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  NoReorder(Params, Context) {}
  Where where() const override { return Where::Nowhere; }
};

const Register<Reorder, NoReorder> registered;

}  // namespace
}  // namespace glint::core
