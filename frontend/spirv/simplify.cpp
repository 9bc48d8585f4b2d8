// Runs the pass list R1 of SPIRV-Tools: everything is inlined, scalarised and in SSA form, and no result of
// arithmetic changes.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <span>
#include <spirv-tools/optimizer.hpp>
#include <spirv/unified1/spirv.hpp11>
#include <sstream>

#include "frontend/compile.h"
#include "frontend/deep_stack.h"
#include "frontend/glsl/debug_print.h"
#include "frontend/pass_times.h"
#include "frontend/spirv/by_reference.h"
#include "frontend/spirv/inline_scopes.h"
#include "frontend/spirv/inlined_size.h"
#include "frontend/spirv/kept_loops.h"
#include "frontend/spirv/limits.h"
#include "frontend/spirv/module_repairs.h"
#include "frontend/spirv/promoted_variables.h"
#include "frontend/spirv/shared_blocks.h"
#include "frontend/spirv/short_blocks.h"
#include "frontend/spirv/spirv.h"
#include "frontend/spirv/vendor_ray_tracing.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

// This pass is always first, because imports of non-semantic sets make later passes skip the module.
constexpr const char* kStripForeign = "--strip-nonsemantic";
constexpr const char* kSsaRewrite = "--ssa-rewrite";

// Choice: modules with more instructions after inlining are optimised in parts (after_passes()). Smaller ones
// cannot have functions that need it, and reading them again for each part would cost time.
constexpr uint64_t kLargeModule = 8192;

// Choice: from this many instructions after inlining on, all variables are promoted by Glint, and passes are
// left out that then find little. This halves the time of a public path tracer of 100,000 instructions, whose
// program gets 3 % longer. Inserts into vectors and structs that nobody reads stay, too; to drop them takes
// that path tracer more than a minute. Lowering makes no instructions of them, because it knows the scalars
// of a value.
constexpr uint64_t kVeryLargeModule = 32'768;

// Some passes of -O are left out on purpose. Redundancy elimination merges loads of volatile built-ins across
// reportIntersectionEXT, simplify-instructions contracts a*b+c to Fma, ccp folds sin and cos with the host's
// libm, and if-conversion removes divergence that hardware has.
const std::vector<std::string>& passes_until_inlined() {
  static const std::vector<std::string> kPasses = {
      kStripForeign, "--freeze-spec-const", "--fold-spec-const-op-composite", "--wrap-opkill",
      "--eliminate-dead-branches", "--merge-return",
      // Each function is optimised on its own first, because code that is already in SSA form costs little in
      // the copies that inlining makes.
      "--eliminate-dead-functions", "--eliminate-local-single-block", "--eliminate-local-single-store",
      "--scalar-replacement=100", "--convert-local-access-chains", "--eliminate-local-single-block",
      "--eliminate-local-single-store", kSsaRewrite,
      // Two passes are left out here. Removal of dead code crashes on calls that take addresses of buffers.
      // Merging of blocks moves calls into continue constructs, where functions that end an any-hit shader
      // are not inlined.
      "--inline-entry-points-exhaustive", "--eliminate-dead-functions", "--eliminate-dead-code-aggressive"};
  return kPasses;
}

const std::vector<std::string>& passes_when_inlined() {
  static const std::vector<std::string> kPasses = {"--private-to-local",
                                                   "--eliminate-local-single-block",
                                                   "--eliminate-local-single-store",
                                                   "--eliminate-dead-code-aggressive",
                                                   "--scalar-replacement=100",
                                                   "--convert-local-access-chains",
                                                   "--eliminate-local-single-block",
                                                   "--eliminate-local-single-store",
                                                   "--eliminate-dead-code-aggressive",
                                                   kSsaRewrite,
                                                   "--eliminate-dead-code-aggressive",
                                                   "--vector-dce",
                                                   "--eliminate-dead-inserts",
                                                   "--eliminate-dead-branches",
                                                   "--cfg-cleanup",
                                                   "--merge-blocks",
                                                   "--eliminate-dead-code-aggressive",
                                                   "--eliminate-dead-const"};
  return kPasses;
}

// These passes are those of a very large module.
const std::vector<std::string>& few_passes_when_inlined() {
  static const std::vector<std::string> kPasses = {"--private-to-local",
                                                   "--scalar-replacement=100",
                                                   "--convert-local-access-chains",
                                                   kSsaRewrite,
                                                   "--eliminate-dead-code-aggressive",
                                                   "--vector-dce",
                                                   "--eliminate-dead-branches",
                                                   "--cfg-cleanup",
                                                   "--merge-blocks",
                                                   "--eliminate-dead-const"};
  return kPasses;
}

std::vector<std::string> pass_list(const InlinedSize& size) {
  std::vector<std::string> out = passes_until_inlined();
  const bool is_very_large = size.instructions > kVeryLargeModule;
  const std::vector<std::string>& more = is_very_large ? few_passes_when_inlined() : passes_when_inlined();
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

// These passes only fold constants, before lengths of arrays are looked at.
const std::vector<std::string>& constants_only() {
  static const std::vector<std::string> kPasses = {kStripForeign, "--freeze-spec-const",
                                                   "--fold-spec-const-op-composite"};
  return kPasses;
}

// These passes are used when R1 makes an invalid module. They only inline functions.
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

// Removes declarations of extensions, because many passes silently skip a module that declares an extension
// they do not list. The capability that the extension allows stays, so the declaration is needed again only
// for validation.
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

// Removes the marks that keep functions from being inlined, because calls are not supported after the
// optimiser.
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

// Holds what the passes of a module report besides their result.
struct Report {
  std::string messages;
  PassTimes* times = nullptr;  // null: not wanted
};

// Adds a row for each line "name seconds ..." of the optimiser's report.
void add_pass_times(const std::string& text, PassTimes& times) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    PassTime row{"optimiser", {}, 0};
    if (words >> row.pass >> row.seconds) times.push_back(row);
  }
}

std::string timed_validation(const std::vector<uint32_t>& spirv, const char* when, PassTimes* times) {
  const PassTimer timer(times, "validation", when);
  return validate_spirv(spirv);
}

// Runs passes over a module without extensions. It returns nothing when they fail.
std::vector<uint32_t> optimise(const std::vector<uint32_t>& input, std::span<const std::string> passes,
                               Report* report) {
  std::vector<uint32_t> output;
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
        if (level <= SPV_MSG_ERROR) report->messages += fmt::format("{}\n", text);
      });
  if (!optimizer.RegisterPassesFromFlags({passes.begin(), passes.end()}))
    throw Error(Exit::Failure, "SPIRV-Tools lacks a pass of R1: " + report->messages);
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);  // The module is validated later, with the extensions in place.
  std::ostringstream times;
  if (report->times) optimizer.SetTimeReport(&times);
  const bool done = [&] {
    const PassTimer timer(report->times, "optimiser", "");
    return optimizer.Run(input.data(), input.size(), &output, options);
  }();
  if (report->times) add_pass_times(times.str(), *report->times);
  return done ? output : std::vector<uint32_t>{};
}

// Returns the module after `passes`. When they fail, it returns nothing, and the report says why. In a large
// module, what is too much for ssa-rewrite is promoted before it, and in a very large one all that can be.
std::vector<uint32_t> after_passes(const std::vector<uint32_t>& spirv, const std::vector<std::string>& passes,
                                   const InlinedSize& size, Report* report) {
  const bool is_large = size.instructions > kLargeModule;
  std::vector<uint32_t> extensions;
  std::vector<uint32_t> output = without_extensions(spirv, &extensions);
  allow_inlining(output);
  const bool has_overlap = has_overlapping_shared_blocks(output);
  if (has_overlap) move_variables(output, spv::StorageClass::Workgroup, spv::StorageClass::CrossWorkgroup);
  const uint32_t most_accesses = size.instructions > kVeryLargeModule ? 0 : kMostAccesses;
  for (auto first = passes.begin(); first != passes.end() && !output.empty();) {
    const auto last = is_large ? std::find(first + 1, passes.end(), kSsaRewrite) : passes.end();
    if (*first == kSsaRewrite) {
      const PassTimer timer(report->times, "promotion", "");
      output = with_promoted_variables(std::move(output), most_accesses);
    }
    output = optimise(output, {first, last}, report);
    first = last;
  }
  if (output.empty()) return {};
  if (has_overlap) move_variables(output, spv::StorageClass::CrossWorkgroup, spv::StorageClass::Workgroup);
  return with_extensions(std::move(output), extensions);
}

// Returns the module after `passes`, or nothing when they fail or their result is not valid.
std::vector<uint32_t> valid_after_passes(const std::vector<uint32_t>& spirv,
                                         const std::vector<std::string>& passes, const InlinedSize& size,
                                         Report* report) {
  std::vector<uint32_t> output = after_passes(spirv, passes, size, report);
  if (output.empty()) return {};
  output = with_marks_in_place(with_debug_prints(without_marks(output)));
  const std::string after = timed_validation(output, "after", report->times);
  report->messages += after;
  return after.empty() ? output : std::vector<uint32_t>{};
}

// Choice: with more calls, inlined code does not name its calls. The optimiser looks at the marks of all
// inlined calls whenever it removes a variable; 8,000 calls take it 12 s so, and 2,000 take it 0.7 s.
constexpr uint64_t kMostMarkedCalls = 2000;

// Returns the valid module after `passes`. Functions are marked first, if possible, so that inlined code
// names its calls.
std::vector<uint32_t> optimised(const std::vector<uint32_t>& spirv, const std::vector<std::string>& passes,
                                const InlinedSize& size, Report* report) {
  // A block with few calls can become one with many, when the callees have calls in their turn.
  const uint32_t calls_of_block = size.calls <= kMostMarkedCalls ? 64 : 1;
  const std::vector<uint32_t> input =
      with_plain_lines(with_kept_loops(with_known_prints(with_short_blocks(spirv, calls_of_block))));
  const std::optional<std::vector<uint32_t>> marked =
      size.calls <= kMostMarkedCalls ? with_inline_scopes(input) : std::nullopt;
  if (marked) {
    // The first pass strips foreign sets, so it would strip the marks. A marked module does not need it,
    // because it has no other such sets.
    Report of_marks{{}, report->times};
    std::vector<uint32_t> output =
        valid_after_passes(*marked, {passes.begin() + 1, passes.end()}, size, &of_marks);
    if (!output.empty()) return output;
  }
  return valid_after_passes(input, passes, size, report);
}

// Changes array lengths from 0 to 1 when they are 0 because nobody set a specialisation constant.
std::vector<uint32_t> with_lengths(std::vector<uint32_t> spirv, const std::string& name,
                                   Diagnostics& warnings) {
  if (!has_specialised_lengths(spirv)) return spirv;
  Report report;
  std::vector<std::string> names;
  std::vector<uint32_t> folded = after_passes(spirv, constants_only(), {}, &report);
  if (folded.empty()) return spirv;
  std::vector<uint32_t> output = with_positive_lengths(folded, &names);
  if (output.size() == folded.size()) return spirv;
  warnings.warning(
      {name, 0, 0},
      fmt::format("array lengths that specialisation constants set to 0 by default are taken as 1{}{}; "
                  "set the constants to run the shader",
                  names.empty() ? "" : ": ", fmt::join(names, ", ")));
  return output;
}

}  // namespace

namespace {

void check_validity(const std::vector<uint32_t>& spirv, const std::string& name, PassTimes* times) {
  const std::string before =
      spirv.size() < kHeaderWords ? "too short to hold a header\n" : timed_validation(spirv, "before", times);
  if (!before.empty()) throw UserError({name, 0, 0}, "invalid SPIR-V\n" + before);
}

std::vector<uint32_t> simplified(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings,
                                 Validity validity, PassTimes* times) {
  check_limits(spirv, name);
  if (validity == Validity::Unknown) check_validity(spirv, name, times);
  spirv = with_references(with_lengths(with_standard_traces(spirv), name, warnings));
  const InlinedSize size = check_inlined_size(spirv, name);
  Report report{{}, times};
  for (const std::vector<std::string>& passes : {pass_list(size), inlining_only()}) {
    std::vector<uint32_t> output = optimised(spirv, passes, size, &report);
    if (output.empty()) continue;
    if (!has_calls(output)) return output;
    const std::vector<uint32_t> again = optimised(with_ends_that_return(spirv), passes, size, &report);
    return again.empty() || has_calls(again) ? output : again;
  }
  warnings.warning({name, 0, 0},
                   "the SPIR-V optimiser failed and the module is used unoptimised: " + report.messages);
  return spirv;
}

}  // namespace

std::vector<uint32_t> simplify(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings,
                               Validity validity, PassTimes* times) {
  return with_deep_stack([&] { return simplified(std::move(spirv), name, warnings, validity, times); });
}

std::vector<uint32_t> simplify(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings,
                               Validity validity) {
  return simplify(std::move(spirv), name, warnings, validity, nullptr);
}

}  // namespace glint::frontend
