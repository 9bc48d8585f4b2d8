// Implements the reordering `by_shader_record`: warps whose rays have come back are sorted by what these hit.
// SPDX-License-Identifier: Apache-2.0
#include "core/reorder.h"

namespace glint::core {
namespace {

// Source: Intel describes the thread sorting unit of Xe-HPG so ("Introduction to the Xe-HPG Architecture",
// 2022): rays that have been traced become groups of threads of the same shader record. Model: there, new
// threads are spawned from a state in memory; here the threads themselves move with their stack.
class ByShaderRecord final : public Reorder {
 public:
  static constexpr std::string_view kName = "by_shader_record";
  static constexpr std::string_view kDoc =
      "Warps of a core whose rays have ended are sorted by shader record before they call hit and miss "
      "shaders "
      "(a thread sorting unit).";
  struct Params {
    static ParamList params() { return {}; }
  };
  ByShaderRecord(Params, Context) {}

  Where where() const override { return Where::Traces; }
  uint64_t key(const exec::ReorderCall& call) const override { return record_key(call); }
};

const Register<Reorder, ByShaderRecord> registered;

}  // namespace
}  // namespace glint::core
