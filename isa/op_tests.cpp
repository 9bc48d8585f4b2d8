// Maps effects to the oracles that check them.
// SPDX-License-Identifier: Apache-2.0
#include "isa/op_tests.h"

#include <iterator>

namespace glint::isa {
namespace {

struct EffectTest {
  Effect effect;
  std::string_view file;
};
constexpr EffectTest kTests[] = {
    {Effect::None, "tests/isa/rows_test.cpp"},
    {Effect::Load, "tests/ops/access.cpp"},
    {Effect::Store, "tests/ops/access.cpp"},
    {Effect::Atomic, "tests/ops/atomic.cpp"},
    {Effect::Texture, "tests/ops/texture.cpp"},
    {Effect::SurfaceLoad, "tests/ops/surface.cpp"},
    {Effect::SurfaceStore, "tests/ops/surface.cpp"},
    {Effect::SurfaceAtomic, "tests/ops/surface.cpp"},
    {Effect::ImageQuery, "tests/ops/image_query.cpp"},
    {Effect::Branch, "tests/ops/control.cpp"},
    {Effect::BranchIndexed, "tests/ops/control.cpp"},
    {Effect::Call, "tests/ops/control.cpp"},
    {Effect::PushReconvergence, "tests/ops/control.cpp"},
    {Effect::Join, "tests/ops/control.cpp"},
    {Effect::Exit, "tests/ops/control.cpp"},
    {Effect::Return, "tests/ops/control.cpp"},
    {Effect::Trap, "tests/ops/control.cpp"},
    {Effect::CallCandidate, "tests/ops/ray_tracing.cpp"},
    {Effect::CallAnyHit, "tests/ops/ray_tracing.cpp"},
    {Effect::CallHit, "tests/ops/ray_tracing.cpp"},
    {Effect::CallCallable, "tests/ops/callable.cpp"},
    {Effect::CallFunction, "tests/ops/control.cpp"},
    {Effect::Trace, "tests/ops/ray_tracing.cpp"},
    {Effect::Resume, "tests/ops/ray_tracing.cpp"},
    {Effect::Report, "tests/ops/ray_tracing.cpp"},
    {Effect::Accepted, "tests/ops/ray_tracing.cpp"},
    {Effect::Ignore, "tests/ops/ray_tracing.cpp"},
    {Effect::Terminate, "tests/ops/ray_tracing.cpp"},
    {Effect::EndTrace, "tests/ops/ray_tracing.cpp"},
    {Effect::Query, "tests/ops/ray_query.cpp"},
    {Effect::QueryProceed, "tests/ops/ray_query.cpp"},
    {Effect::HitObject, "tests/ops/hit_object.cpp"},
    {Effect::Reorder, "tests/ops/hit_object.cpp"},
    {Effect::Barrier, "tests/ops/control.cpp"},
    {Effect::Print, "tests/ops/control.cpp"},
    {Effect::PrintPart, "tests/ops/control.cpp"},
    {Effect::Fence, "tests/ops/control.cpp"},
    {Effect::Copy, "tests/ops/copy.cpp"},
    {Effect::CopyGroup, "tests/ops/control.cpp"},
    {Effect::Mbarrier, "tests/ops/control.cpp"},
    {Effect::Yield, "tests/ops/control.cpp"},
};
static_assert(std::size(kTests) == size_t(Effect::Count));
static_assert(
    [] {
      for (size_t i = 0; i < std::size(kTests); ++i)
        if (kTests[i].effect != Effect(i) || kTests[i].file.empty()) return false;
      return true;
    }(),
    "the rows have the order of the enum, and each has a test");

}  // namespace

std::string_view test_of(const OpRow& row) {
  // A value op without a source has no example: what activemask gives is a matter of control flow.
  if (row.effect == Effect::None && row.examples.count == 0) return "tests/ops/control.cpp";
  if (row.memory.matrices > 0) return "tests/ops/matrix_access.cpp";
  return kTests[size_t(row.effect)].file;
}

}  // namespace glint::isa
