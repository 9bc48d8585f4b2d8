// Pass list R1 of SPIRV-Tools: everything inlined, scalarised and in SSA form, nothing numerically changed.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spirv-tools/optimizer.hpp>
#include <spirv/unified1/spirv.hpp11>

#include "frontend/compile.h"
#include "frontend/glsl/debug_print.h"
#include "frontend/spirv/by_reference.h"
#include "frontend/spirv/inline_scopes.h"
#include "frontend/spirv/inlined_size.h"
#include "frontend/spirv/module_repairs.h"
#include "frontend/spirv/spirv.h"
#include "frontend/spirv/vendor_ray_tracing.h"

namespace glint::frontend {
namespace {

constexpr const char* kStripForeign =
    "--strip-nonsemantic";  // always first: imports of such sets make later passes skip the module

// Left out on purpose: the passes behind -O that merge loads of volatile built-ins across
// reportIntersectionEXT (redundancy elimination), contract a*b+c to Fma (simplify-instructions), fold sin and
// cos with the host's libm (ccp) or remove divergence that hardware has (if-conversion).
const std::vector<std::string>& pass_list() {
  static const std::vector<std::string> kPasses = {
      kStripForeign, "--freeze-spec-const", "--fold-spec-const-op-composite", "--wrap-opkill",
      "--eliminate-dead-branches", "--merge-return",
      // Each function on its own first: what is in SSA form before it is copied into its callers costs little
      // there.
      "--eliminate-dead-functions", "--eliminate-local-single-block", "--eliminate-local-single-store",
      "--scalar-replacement=100", "--convert-local-access-chains", "--eliminate-local-single-block",
      "--eliminate-local-single-store", "--ssa-rewrite",
      // Not here: removal of dead code, which crashes on calls that take addresses of buffers; and merging of
      // blocks, which moves calls into continue constructs, where functions that end an any-hit shader are
      // not inlined.
      "--inline-entry-points-exhaustive", "--eliminate-dead-functions", "--eliminate-dead-code-aggressive",
      "--private-to-local", "--eliminate-local-single-block", "--eliminate-local-single-store",
      "--eliminate-dead-code-aggressive", "--scalar-replacement=100", "--convert-local-access-chains",
      "--eliminate-local-single-block", "--eliminate-local-single-store", "--eliminate-dead-code-aggressive",
      "--ssa-rewrite", "--eliminate-dead-code-aggressive", "--vector-dce", "--eliminate-dead-inserts",
      "--eliminate-dead-branches", "--cfg-cleanup", "--merge-blocks", "--eliminate-dead-code-aggressive",
      "--eliminate-dead-const"};
  return kPasses;
}

// Constants alone, before lengths of arrays are looked at.
const std::vector<std::string>& constants_only() {
  static const std::vector<std::string> kPasses = {kStripForeign, "--freeze-spec-const",
                                                   "--fold-spec-const-op-composite"};
  return kPasses;
}

// When R1 makes a module that is not valid: functions inlined and nothing else.
const std::vector<std::string>& inlining_only() {
  static const std::vector<std::string> kPasses = {kStripForeign,
                                                   "--freeze-spec-const",
                                                   "--fold-spec-const-op-composite",
                                                   "--wrap-opkill",
                                                   "--merge-return",
                                                   "--inline-entry-points-exhaustive",
                                                   "--eliminate-dead-functions"};
  return kPasses;
}

constexpr size_t kHeaderWords = 5;  // SPIR-V specification, 2.3 Physical Layout

// Many passes skip a whole module that declares an extension they do not list, and say nothing. The
// capability that the extension allows stays, so the declaration is only needed again for validation.
std::vector<uint32_t> without_extensions(const std::vector<uint32_t>& words, std::vector<uint32_t>* removed) {
  std::vector<uint32_t> kept(words.begin(), words.begin() + kHeaderWords);
  for (size_t i = kHeaderWords; i < words.size();) {
    const size_t length = words[i] >> 16;
    const bool is_extension = spv::Op(words[i] & 0xffff) == spv::Op::OpExtension;
    std::vector<uint32_t>& to = is_extension ? *removed : kept;
    to.insert(to.end(), words.begin() + long(i), words.begin() + long(i + length));
    i += length;
  }
  return kept;
}

// The optimiser leaves calls of functions marked so, and nothing here calls.
void allow_inlining(std::vector<uint32_t>& words) {
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16)
    if (spv::Op(words[i] & 0xffff) == spv::Op::OpFunction)
      words[i + 3] &= ~uint32_t(spv::FunctionControlMask::DontInline);
}

// Puts the extension declarations back where the logical layout wants them: after the capabilities.
std::vector<uint32_t> with_extensions(std::vector<uint32_t> words, const std::vector<uint32_t>& extensions) {
  size_t at = kHeaderWords;
  while (at < words.size() && spv::Op(words[at] & 0xffff) == spv::Op::OpCapability) at += words[at] >> 16;
  words.insert(words.begin() + long(at), extensions.begin(), extensions.end());
  return words;
}

// The module after `passes`; empty, and `messages` says why, when they fail.
std::vector<uint32_t> after_passes(const std::vector<uint32_t>& spirv, const std::vector<std::string>& passes,
                                   std::string* messages) {
  std::vector<uint32_t> extensions, output;
  std::vector<uint32_t> input = without_extensions(spirv, &extensions);
  allow_inlining(input);
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR) *messages += fmt::format("{}\n", text);
      });
  if (!optimizer.RegisterPassesFromFlags(passes))
    throw Error(Exit::Failure, "SPIRV-Tools lacks a pass of R1: " + *messages);
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);  // done here, with the extensions in place
  if (!optimizer.Run(input.data(), input.size(), &output, options)) return {};
  return with_extensions(std::move(output), extensions);
}

// The same; empty, too, when what the passes make is not valid.
std::vector<uint32_t> valid_after_passes(const std::vector<uint32_t>& spirv,
                                         const std::vector<std::string>& passes, std::string* messages) {
  std::vector<uint32_t> output = after_passes(spirv, passes, messages);
  if (output.empty()) return {};
  output = without_stray_lines(with_debug_prints(output));
  const std::string after = validate_spirv(output);
  *messages += after;
  return after.empty() ? output : std::vector<uint32_t>{};
}

// The same, of a module whose functions are marked, where they can be, so that what is inlined says where it
// was called.
std::vector<uint32_t> optimised(const std::vector<uint32_t>& spirv, const std::vector<std::string>& passes,
                                std::string* messages) {
  const std::vector<uint32_t> input = with_plain_lines(with_known_prints(spirv));
  if (const std::optional<std::vector<uint32_t>> marked = with_inline_scopes(input)) {
    // What strips foreign sets strips the marks, too; and there are marks only where there are no such sets.
    std::string of_marks;
    std::vector<uint32_t> output = valid_after_passes(*marked, {passes.begin() + 1, passes.end()}, &of_marks);
    if (!output.empty()) return output;
  }
  return valid_after_passes(input, passes, messages);
}

// Lengths that are 0 because nobody set a specialisation constant are 1 from here on.
std::vector<uint32_t> with_lengths(std::vector<uint32_t> spirv, const std::string& name,
                                   Diagnostics& warnings) {
  if (!has_specialised_lengths(spirv)) return spirv;
  std::string messages;
  std::vector<std::string> names;
  std::vector<uint32_t> folded = after_passes(spirv, constants_only(), &messages);
  if (folded.empty()) return spirv;
  std::vector<uint32_t> output = with_positive_lengths(folded, &names);
  if (output.size() == folded.size()) return spirv;
  warnings.warning(
      {name, 0, 0},
      fmt::format("lengths of arrays are 0 by the defaults of specialisation constants, and taken as 1{}{}; "
                  "set the constants to run the shader",
                  names.empty() ? "" : ": ", fmt::join(names, ", ")));
  return output;
}

}  // namespace

std::vector<uint32_t> simplify(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings) {
  const std::string before =
      spirv.size() < kHeaderWords ? "too short to hold a header\n" : validate_spirv(spirv);
  if (!before.empty()) throw UserError({name, 0, 0}, "invalid SPIR-V\n" + before);
  spirv = with_references(with_lengths(with_standard_traces(spirv), name, warnings));
  check_inlined_size(spirv, name);
  std::string messages;
  for (const auto* passes : {&pass_list(), &inlining_only()}) {
    std::vector<uint32_t> output = optimised(spirv, *passes, &messages);
    if (output.empty()) continue;
    if (!has_calls(output)) return output;
    const std::vector<uint32_t> again = optimised(with_ends_that_return(spirv), *passes, &messages);
    return again.empty() || has_calls(again) ? output : again;
  }
  warnings.warning({name, 0, 0},
                   "the SPIR-V optimiser failed, going on with the module as it was: " + messages);
  return spirv;
}

}  // namespace glint::frontend
