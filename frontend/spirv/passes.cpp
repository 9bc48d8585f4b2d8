// Lists passes, and drops those that take long in large modules and find little there.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/passes.h"

#include <algorithm>
#include <spirv/unified1/spirv.hpp11>

#include "frontend/spirv/limits.h"
#include "frontend/spirv/promoted_variables.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using PassNames = std::vector<std::string>;

// This pass is always first, because imports of non-semantic sets make later passes skip the module.
constexpr const char* kStripForeign = "--strip-nonsemantic";
constexpr const char* kSplit = "--scalar-replacement=100";
constexpr const char* kDropCode = "--eliminate-dead-code-aggressive";
constexpr const char* kDropConstants = "--eliminate-dead-const";

// Choice: modules with more instructions after inlining are optimised in parts (PassList::promotes_over).
// Smaller ones cannot have functions that need it, and reading them again for each part would cost time.
constexpr uint64_t kLargeModule = 8192;

// Choice: from this many instructions after inlining on, all variables are promoted by Glint, and passes are
// left out that then find little. This halves the time of a public path tracer of 100,000 instructions, whose
// program gets 3 % longer. Inserts into vectors and structs that nobody reads stay, too; to drop them takes
// that path tracer more than a minute. Lowering makes no instructions of them, because it knows the scalars
// of a value.
constexpr uint64_t kVeryLargeModule = 32'768;

// Choice: in modules with a local variable of more bytes, structs and arrays of every length are split where
// all indices are constants. What is not split is loaded and stored as a whole for each access to a member,
// which takes time and memory that grow with the square of the members: 500 selections around accesses to an
// array of 20,000 numbers did not end in 70 s.
constexpr uint64_t kLargeVariable = 1024;

// Choice: unused constants stay in modules with a constant of more members, because the pass that drops them
// looks at all members for each. 20,000 members take it 1.3 s. Lowering makes no code of unused constants.
constexpr uint32_t kMostConstantMembers = 2000;

// Returns the number of members of the constant that has most.
uint32_t most_constant_members(const std::vector<uint32_t>& spirv) {
  uint32_t most = 0;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    if (op_of(spirv[at]) == spv::Op::OpFunction) break;
    if (op_of(spirv[at]) == spv::Op::OpConstantComposite) most = std::max(most, (spirv[at] >> 16) - 3);
  }
  return most;
}

// Some passes of -O are left out on purpose. Redundancy elimination merges loads of volatile built-ins across
// reportIntersectionEXT, simplify-instructions contracts a*b+c to Fma, ccp folds sin and cos with the host's
// libm, and if-conversion removes divergence that hardware has.
const PassNames& passes_before_all() {
  static const PassNames kPasses = {kStripForeign,
                                    "--freeze-spec-const",
                                    "--fold-spec-const-op-composite",
                                    "--wrap-opkill",
                                    "--eliminate-dead-branches",
                                    "--merge-return",
                                    "--eliminate-dead-functions"};
  return kPasses;
}

const PassNames& passes_until_inlined() {
  static const PassNames kPasses = {
      // Each function is optimised on its own first, because code that is already in SSA form costs little in
      // the copies that inlining makes.
      "--eliminate-local-single-block", "--eliminate-local-single-store", kSplit,
      "--convert-local-access-chains", "--eliminate-local-single-block", "--eliminate-local-single-store",
      kSsaRewrite,
      // Two passes are left out here. Removal of dead code crashes on calls that take addresses of buffers.
      // Merging of blocks moves calls into continue constructs, where functions that end an any-hit shader
      // are not inlined.
      "--inline-entry-points-exhaustive", "--eliminate-dead-functions", kDropCode};
  return kPasses;
}

const PassNames& passes_when_inlined() {
  static const PassNames kPasses = {"--private-to-local",
                                    "--eliminate-local-single-block",
                                    "--eliminate-local-single-store",
                                    kDropCode,
                                    kSplit,
                                    "--convert-local-access-chains",
                                    "--eliminate-local-single-block",
                                    "--eliminate-local-single-store",
                                    kDropCode,
                                    kSsaRewrite,
                                    kDropCode,
                                    "--vector-dce",
                                    "--eliminate-dead-inserts",
                                    "--eliminate-dead-branches",
                                    "--cfg-cleanup",
                                    "--merge-blocks",
                                    kDropCode,
                                    kDropConstants};
  return kPasses;
}

// These passes are those of a very large module, and of a large one without calls.
const PassNames& few_passes_when_inlined() {
  static const PassNames kPasses = {"--private-to-local",
                                    kSplit,
                                    "--convert-local-access-chains",
                                    kSsaRewrite,
                                    kDropCode,
                                    "--vector-dce",
                                    "--eliminate-dead-branches",
                                    "--cfg-cleanup",
                                    "--merge-blocks",
                                    kDropConstants};
  return kPasses;
}

void append_passes(PassNames& names, const PassNames& more) {
  names.insert(names.end(), more.begin(), more.end());
}

}  // namespace

PassList passes_of(const std::vector<uint32_t>& spirv, const InlinedSize& size) {
  const bool is_large = size.instructions > kLargeModule, calls_nothing = is_large && size.calls == 0;
  const bool has_few = calls_nothing || size.instructions > kVeryLargeModule;
  PassList out{passes_before_all(), std::nullopt};
  // Without calls, the passes before inlining would do the same work as those after it.
  if (!calls_nothing) append_passes(out.names, passes_until_inlined());
  append_passes(out.names, has_few ? few_passes_when_inlined() : passes_when_inlined());
  if (is_large) out.promotes_over = has_few ? 0 : kMostAccesses;
  if (largest_variable(spirv) > kLargeVariable)
    std::replace(out.names.begin(), out.names.end(), std::string(kSplit),
                 std::string("--scalar-replacement=0"));
  if (most_constant_members(spirv) > kMostConstantMembers) std::erase(out.names, kDropConstants);
  return out;
}

PassList constants_only() {
  return {{kStripForeign, "--freeze-spec-const", "--fold-spec-const-op-composite"}, std::nullopt};
}

PassList inlining_only() {
  return {{kStripForeign, "--freeze-spec-const", "--fold-spec-const-op-composite", "--wrap-opkill",
           "--merge-return", "--inline-entry-points-exhaustive", "--eliminate-dead-functions"},
          std::nullopt};
}

}  // namespace glint::frontend
