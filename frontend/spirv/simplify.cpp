// Runs the pass list R1 of SPIRV-Tools (passes.h) and what Glint does before, between and after its passes.
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
#include "frontend/spirv/passes.h"
#include "frontend/spirv/promoted_variables.h"
#include "frontend/spirv/shared_blocks.h"
#include "frontend/spirv/short_blocks.h"
#include "frontend/spirv/spirv.h"
#include "frontend/spirv/vendor_ray_tracing.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

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

bool has_local_variables(const std::vector<uint32_t>& spirv) {
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16)
    if (op_of(spirv[at]) == spv::Op::OpVariable &&
        spv::StorageClass(spirv[at + 3]) == spv::StorageClass::Function)
      return true;
  return false;
}

// Returns the module after `passes`. When they fail, it returns nothing, and the report says why.
std::vector<uint32_t> after_passes(const std::vector<uint32_t>& spirv, const PassList& passes,
                                   Report* report) {
  std::vector<uint32_t> extensions;
  std::vector<uint32_t> output = without_extensions(spirv, &extensions);
  allow_inlining(output);
  const bool has_overlap = has_overlapping_shared_blocks(output);
  if (has_overlap) move_variables(output, spv::StorageClass::Workgroup, spv::StorageClass::CrossWorkgroup);
  const auto end = passes.names.end();
  for (auto first = passes.names.begin(); first != end && !output.empty();) {
    const auto last = passes.promotes_over ? std::find(first + 1, end, kSsaRewrite) : end;
    if (*first == kSsaRewrite && passes.promotes_over) {
      const PassTimer timer(report->times, "promotion", "");
      output = with_promoted_variables(std::move(output), *passes.promotes_over);
      if (!has_local_variables(output)) ++first;  // Nothing is left for ssa-rewrite.
    }
    output = optimise(output, {first, last}, report);
    first = last;
  }
  if (output.empty()) return {};
  if (has_overlap) move_variables(output, spv::StorageClass::CrossWorkgroup, spv::StorageClass::Workgroup);
  return with_extensions(std::move(output), extensions);
}

// Returns the module after `passes`, or nothing when they fail or their result is not valid.
std::vector<uint32_t> valid_after_passes(const std::vector<uint32_t>& spirv, const PassList& passes,
                                         Report* report) {
  std::vector<uint32_t> output = after_passes(spirv, passes, report);
  if (output.empty()) return {};
  output = with_marks_in_place(with_debug_prints(without_marks(output)));
  const std::string after = [&] {
    const PassTimer timer(report->times, "validation", "after");
    return validate_made_spirv(output);
  }();
  report->messages += after;
  return after.empty() ? output : std::vector<uint32_t>{};
}

// Choice: with more calls, inlined code does not name its calls. The optimiser looks at the marks of all
// inlined calls whenever it removes a variable; 8,000 calls take it 12 s so, and 2,000 take it 0.7 s.
constexpr uint64_t kMostMarkedCalls = 2000;

// Returns the valid module after `passes`. Functions are marked first, if possible, so that inlined code
// names its calls.
std::vector<uint32_t> optimised(const std::vector<uint32_t>& spirv, const PassList& passes,
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
    PassList later = passes;
    later.names.erase(later.names.begin());
    std::vector<uint32_t> output = valid_after_passes(*marked, later, &of_marks);
    if (!output.empty()) return output;
  }
  return valid_after_passes(input, passes, report);
}

// Changes array lengths from 0 to 1 when they are 0 because nobody set a specialisation constant.
std::vector<uint32_t> with_lengths(std::vector<uint32_t> spirv, const std::string& name,
                                   Diagnostics& warnings) {
  if (!has_specialised_lengths(spirv)) return spirv;
  Report report;
  std::vector<std::string> names;
  std::vector<uint32_t> folded = after_passes(spirv, constants_only(), &report);
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
  const PassTimer timer(times, "validation", "before");
  const std::string before =
      spirv.size() < kHeaderWords ? "too short to hold a header\n" : validate_spirv(spirv);
  if (!before.empty()) throw UserError({name, 0, 0}, "invalid SPIR-V\n" + before);
}

std::vector<uint32_t> simplified(std::vector<uint32_t> spirv, const std::string& name, Diagnostics& warnings,
                                 Validity validity, PassTimes* times) {
  check_limits(spirv, name);
  if (validity == Validity::Unknown) check_validity(spirv, name, times);
  spirv =
      with_references(with_lengths(with_standard_traces(with_local_size(std::move(spirv))), name, warnings));
  const InlinedSize size = check_inlined_size(spirv, name);
  Report report{{}, times};
  for (const PassList& passes : {passes_of(spirv, size), inlining_only()}) {
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
