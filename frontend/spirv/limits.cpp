// Adds up sizes of types, and depths of constructs along the call graph.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/limits.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <set>
#include <span>
#include <spirv/unified1/spirv.hpp11>
#include <tuple>
#include <utility>

#include "base/diagnostics.h"
#include "frontend/spirv/source_lines.h"
#include "frontend/spirv/words.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {
namespace {

using enum spv::Op;
using Inst = std::span<const uint32_t>;

// Counts constructs around a place, of both kinds and of loops alone.
enum Construct : size_t { kConstructs, kLoops, kNumKinds };

struct Place {
  std::array<uint32_t, kNumKinds> depth{};
  isa::Line line;
};

// Holds what limits apply to.
struct SizeSurvey {
  struct Variable {
    uint64_t bytes = 0;
    isa::Line line;  // of the first instruction that uses it
  };
  struct Call {
    uint32_t callee = 0;
    Place at;
  };
  struct Function {
    std::array<Place, kNumKinds> deepest;
    std::vector<Call> calls;
  };
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, uint64_t> type_bytes;  // saturated at kHuge
  std::map<uint32_t, uint64_t> constants;
  std::map<uint32_t, uint32_t> pointees;  // of pointers to memory of one thread
  std::map<uint32_t, Variable> variables;
  std::map<uint32_t, Function> functions;
};

constexpr uint64_t kHuge = uint64_t{1} << 40;

uint64_t times(uint64_t a, uint64_t b) {
  return b != 0 && a > kHuge / b ? kHuge : a * b;
}

class Reader {
 public:
  SizeSurvey read(const std::vector<uint32_t>& words) {
    for (size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
      const size_t length = words[at] >> 16;
      if (length == 0 || at + length > words.size()) break;  // The validator says what is wrong.
      const Inst inst(&words[at], length);
      if (!lines.read(inst)) instruction(inst);
    }
    return std::move(out_);
  }
  SourceLines lines;

 private:
  void instruction(Inst w) {
    const spv::Op op = op_of(w[0]);
    if (op == OpName && w.size() > 2) out_.names[w[1]] = text_at(w.subspan(2));
    if (w.size() > 3 && (op == OpConstant || op == OpSpecConstant)) out_.constants[w[2]] = w[3];
    if (w.size() >= 2) type(op, w);
    if (op == OpVariable && w.size() > 3)
      if (const auto pointee = out_.pointees.find(w[1]); pointee != out_.pointees.end())
        out_.variables[w[2]] = {bytes_of(pointee->second), {}};
    if (function_) control(op, w);
    if (op == OpFunction && w.size() > 2)
      function_ = &out_.functions[w[2]], around_.clear(), depth_before_.clear();
    if (op == OpFunctionEnd) function_ = nullptr;
  }

  uint64_t bytes_of(uint32_t type) const {
    const auto found = out_.type_bytes.find(type);
    return found == out_.type_bytes.end() ? 4 : found->second;
  }

  void type(spv::Op op, Inst w) {
    uint64_t bytes = 0;
    if ((op == OpTypeInt || op == OpTypeFloat) && w.size() > 2) bytes = std::max(w[2] / 8, 1u);
    if ((op == OpTypeVector || op == OpTypeMatrix) && w.size() > 3) bytes = times(bytes_of(w[2]), w[3]);
    if (op == OpTypeArray && w.size() > 3)
      if (const auto count = out_.constants.find(w[3]); count != out_.constants.end())
        bytes = times(bytes_of(w[2]), count->second);
    if (op == OpTypeStruct)
      for (const uint32_t member : w.subspan(2)) bytes = std::min(kHuge, bytes + bytes_of(member));
    if (bytes != 0) out_.type_bytes[w[1]] = bytes;
    if (op != OpTypePointer || w.size() < 4) return;
    const auto storage = spv::StorageClass(w[2]);
    if (storage == spv::StorageClass::Function || storage == spv::StorageClass::Private)
      out_.pointees[w[1]] = w[3];
  }

  // The blocks of a construct stand between its header and its merge block.
  void control(spv::Op op, Inst w) {
    if (op == OpLabel && w.size() > 1)
      if (const auto ended = depth_before_.find(w[1]); ended != depth_before_.end())
        while (around_.size() > ended->second) around_.pop_back();
    if ((op == OpSelectionMerge || op == OpLoopMerge) && w.size() > 1) {
      depth_before_[w[1]] = around_.size();
      around_.push_back((around_.empty() ? 0 : around_.back()) + (op == OpLoopMerge));
    }
    const Place here{{uint32_t(around_.size()), around_.empty() ? 0 : around_.back()}, lines.line()};
    for (const Construct kind : {kConstructs, kLoops})
      if (here.depth[kind] > function_->deepest[kind].depth[kind]) function_->deepest[kind] = here;
    if (op == OpFunctionCall && w.size() > 3) function_->calls.push_back({w[3], here});
    const bool is_access = op == OpStore || op == OpLoad || op == OpAccessChain ||
                           op == OpInBoundsAccessChain || op == OpFunctionCall || op == OpCopyMemory;
    if (!is_access || lines.line().line == 0) return;
    for (const uint32_t operand : w.subspan(1))
      if (const auto v = out_.variables.find(operand); v != out_.variables.end() && v->second.line.line == 0)
        v->second.line = lines.line();
  }

  SizeSurvey out_;
  SizeSurvey::Function* function_ = nullptr;
  std::vector<uint32_t> around_;             // of each construct around the present block: the loops up to it
  std::map<uint32_t, size_t> depth_before_;  // by merge block: the depth around its construct
};

// Returns the deepest place of a function with what it calls. A function that calls itself is refused
// elsewhere, and its inner call is not followed.
Place deepest_of(const SizeSurvey& module, Construct kind, uint32_t id, std::map<uint32_t, Place>& known) {
  if (const auto found = known.find(id); found != known.end()) return found->second;
  const auto function = module.functions.find(id);
  if (function == module.functions.end()) return {};
  Place deepest = known[id] = function->second.deepest[kind];
  for (const SizeSurvey::Call& call : function->second.calls) {
    Place inner = deepest_of(module, kind, call.callee, known);
    inner.depth[kind] += call.at.depth[kind];
    if (inner.depth[kind] > deepest.depth[kind]) deepest = inner;
  }
  return known[id] = deepest;
}

Place deepest_of(const SizeSurvey& module, Construct kind) {
  std::map<uint32_t, Place> known;
  Place deepest;
  for (const auto& [id, function] : module.functions)
    if (const Place here = deepest_of(module, kind, id, known); here.depth[kind] > deepest.depth[kind])
      deepest = here;
  return deepest;
}

// Returns how many calls lie in each other below a function. A function that calls itself is refused
// elsewhere.
uint32_t call_depth_of(const SizeSurvey& module, uint32_t id, std::map<uint32_t, uint32_t>& known) {
  if (const auto found = known.find(id); found != known.end()) return found->second;
  uint32_t depth = known[id] = 0;
  if (const auto function = module.functions.find(id); function != module.functions.end())
    for (const SizeSurvey::Call& call : function->second.calls)
      depth = std::max(depth, 1 + call_depth_of(module, call.callee, known));
  return known[id] = depth;
}

// Returns the depth of calls, and the line of the first one that lies deeper than kDeepestCalls.
std::pair<uint32_t, isa::Line> deepest_call(const SizeSurvey& module) {
  std::map<uint32_t, uint32_t> depth;
  uint32_t at = 0;  // an id
  for (const auto& [id, function] : module.functions)
    if (call_depth_of(module, id, depth) > depth[at]) at = id;
  const uint32_t deepest = depth[at];
  isa::Line line;
  for (uint32_t i = 0; i <= kDeepestCalls && i < deepest; ++i) {
    const std::vector<SizeSurvey::Call>& calls = module.functions.at(at).calls;
    const auto next = std::find_if(calls.begin(), calls.end(), [&](const SizeSurvey::Call& call) {
      return depth[call.callee] + 1 == depth[at];
    });
    line = next->at.line;
    at = next->callee;
  }
  return {deepest, line};
}

}  // namespace

uint32_t selections_and_loops_of(const std::vector<uint32_t>& words) {
  uint32_t count = 0;
  for (size_t at = kHeaderWords; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16)
    count += op_of(words[at]) == OpSelectionMerge || op_of(words[at]) == OpLoopMerge;
  return count;
}

uint32_t nesting_of(const std::vector<uint32_t>& words) {
  return deepest_of(Reader().read(words), kConstructs).depth[kConstructs];
}

uint64_t largest_variable(const std::vector<uint32_t>& words) {
  uint64_t most = 0;
  for (const auto& [id, variable] : Reader().read(words).variables) most = std::max(most, variable.bytes);
  return most;
}

void check_limits(const std::vector<uint32_t>& words, const std::string& name, uint32_t deepest) {
  Reader reader;
  const SizeSurvey module = reader.read(words);
  std::string message;
  const auto add = [&](const isa::Line& line, const std::string& text) {
    const bool known = line.line != 0 && line.file < reader.lines.files.size();
    message += fmt::format(
        "\n  {}: {}", known ? fmt::format("{}:{}", reader.lines.files[line.file], line.line) : name, text);
  };
  for (const auto& [id, variable] : module.variables) {
    if (variable.bytes <= kMostLocalBytes) continue;
    const auto called = module.names.find(id);
    add(variable.line,
        fmt::format(
            "variable {} takes {} bytes of every thread, and at most {} are possible",
            called == module.names.end() ? fmt::format("%{}", id) : "'" + called->second + "'",
            variable.bytes >= kHuge ? "more than a million million" : fmt::format("{}", variable.bytes),
            kMostLocalBytes));
  }
  for (const auto& [kind, what, most] :
       {std::tuple{kConstructs, "selections and loops", deepest}, {kLoops, "loops", kDeepestLoops}})
    if (const Place place = deepest_of(module, kind); place.depth[kind] > most)
      add(place.line,
          fmt::format("{} lie {} deep in each other, with those of called functions, and at most {} "
                      "are possible",
                      what, place.depth[kind], most));
  if (const auto [depth, line] = deepest_call(module); depth > kDeepestCalls)
    add(line, fmt::format("calls of functions lie {} deep in each other, and at most {} are possible", depth,
                          kDeepestCalls));
  if (!message.empty()) throw UnsupportedError(fmt::format("{}: not supported:{}", name, message));
}

}  // namespace glint::frontend
