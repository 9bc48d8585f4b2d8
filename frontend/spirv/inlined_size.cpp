// Counts calls along the call graph.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/inlined_size.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <span>
#include <spirv/unified1/spirv.hpp11>

#include "base/diagnostics.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

constexpr uint64_t kMany = uint64_t{1} << 40;  // all counts saturate at this value

struct FunctionSize {
  uint64_t instructions = 0;
  std::vector<uint32_t> callees;  // one for each call
  uint64_t copies = 0;
  int calls_left = 0;  // calls of this function that were not yet counted
};

struct CallGraph {
  std::map<uint32_t, FunctionSize> functions;
  std::map<uint32_t, std::string> names;
  std::vector<uint32_t> entries;
};

CallGraph read(const std::vector<uint32_t>& spirv) {
  CallGraph out;
  FunctionSize* current = nullptr;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t* const words = &spirv[at];
    switch (spv::Op(words[0] & 0xffff)) {
      case spv::Op::OpName:
        out.names[words[1]] = reinterpret_cast<const char*>(words + 2);
        break;
      case spv::Op::OpEntryPoint:
        out.entries.push_back(words[2]);
        break;
      case spv::Op::OpFunction:
        current = &out.functions[words[2]];
        break;
      case spv::Op::OpFunctionEnd:
        current = nullptr;
        break;
      case spv::Op::OpLine:
      case spv::Op::OpNoLine:
        break;
      case spv::Op::OpFunctionCall:
        if (current) current->callees.push_back(words[3]);
        [[fallthrough]];
      default:
        if (current) ++current->instructions;
    }
  }
  return out;
}

// Counts the copies of each function, callers before callees. Functions that call themselves are left out,
// because they are refused elsewhere.
void count_copies(CallGraph& graph) {
  for (const auto& [id, function] : graph.functions)
    for (const uint32_t callee : function.callees) ++graph.functions.at(callee).calls_left;
  std::vector<uint32_t> ready;
  for (auto& [id, function] : graph.functions)
    if (function.calls_left == 0) ready.push_back(id);
  for (const uint32_t entry : graph.entries) graph.functions.at(entry).copies = 1;
  while (!ready.empty()) {
    const FunctionSize& caller = graph.functions.at(ready.back());
    ready.pop_back();
    for (const uint32_t id : caller.callees) {
      FunctionSize& callee = graph.functions.at(id);
      callee.copies = std::min(kMany, callee.copies + caller.copies);
      if (--callee.calls_left == 0) ready.push_back(id);
    }
  }
}

}  // namespace

InlinedSize check_inlined_size(const std::vector<uint32_t>& spirv, const std::string& name) {
  CallGraph graph = read(spirv);
  count_copies(graph);
  uint64_t all = 0, most = 0, calls = 0;
  uint32_t largest = 0;
  for (const auto& [id, function] : graph.functions) {
    const uint64_t size =
        std::min(kMany, function.copies) * std::min<uint64_t>(function.instructions, 1u << 20);
    all = std::min(kMany, all + size);
    calls = std::min(kMany, calls + function.copies * function.callees.size());
    if (size > most) most = size, largest = id;
  }
  if (all <= kMostInlined) return {all, calls};
  const auto amount = [](uint64_t n) {
    return n >= kMany ? std::string("more than a million million") : fmt::format("{}", n);
  };
  std::string function = graph.names.count(largest) ? graph.names.at(largest) : fmt::format("%{}", largest);
  // glslang's names end in the types of the parameters, which are dropped.
  function = function.substr(0, function.find('('));
  throw UnsupportedError(fmt::format(
      "{}: not supported:\n  {}: inlining all calls makes {} instructions (the limit is {}): '{}' is inlined "
      "{} times",
      name, name, amount(all), kMostInlined, function, amount(graph.functions.at(largest).copies)));
}

}  // namespace glint::frontend
