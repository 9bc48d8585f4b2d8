// Walks the functions of a module.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/call_graph.h"

#include <algorithm>

namespace glint::frontend::ptx {

CallGraph::CallGraph(const Module& module, const Function& entry) {
  uint32_t number = 0;
  for (const Function& f : module.functions) {
    functions_[f.name] = &f;
    number_[f.name] = ++number;
  }
  for (const Function& f : module.functions) collect(f.body, uses_[&f]);
  find_addresses(module);
  reach(entry);
  for (const Function& f : module.functions)
    if (f.has_body && !f.is_entry && reached_.contains(&f) && (addresses_.contains(&f) || reaches_itself(f)))
      called_.push_back(&f);
}

bool CallGraph::is_called(const Function& f) const {
  return std::find(called_.begin(), called_.end(), &f) != called_.end();
}

void CallGraph::collect(const std::vector<Statement>& statements, Uses& uses) const {
  const auto function = [&](const Operand& o) -> const Function* {
    const auto f = o.kind == Operand::Kind::Name ? functions_.find(o.name) : functions_.end();
    return f == functions_.end() ? nullptr : f->second;
  };
  for (const Statement& s : statements) {
    collect(s.body, uses);
    const Instruction& inst = s.instruction;
    if (s.kind != Statement::Kind::Instruction) continue;
    const bool is_call = !inst.words.empty() && inst.words[0] == "call";
    // The callee stands behind the list of results, if there is one.
    const size_t callee = is_call && !inst.operands.empty() && inst.operands[0].kind == Operand::Kind::List;
    for (size_t i = 0; i < inst.operands.size(); ++i) {
      const Function* f = function(inst.operands[i]);
      if (is_call && i == callee && !f) uses.calls_through_register = true;
      if (f) (is_call && i == callee ? uses.callees : uses.addresses).insert(f);
      for (const Operand& part : inst.operands[i].parts)
        if (const Function* g = function(part)) uses.addresses.insert(g);
    }
  }
}

void CallGraph::find_addresses(const Module& module) {
  for (const auto& [f, uses] : uses_) addresses_.insert(uses.addresses.begin(), uses.addresses.end());
  for (const Declaration& d : module.variables)
    for (const Initializer& value : d.initial)
      if (const auto f = functions_.find(value.symbol); f != functions_.end()) addresses_.insert(f->second);
}

// A call through a register may reach each function whose address the module takes, also where another kernel
// does so: the address may come from memory.
void CallGraph::reach(const Function& f) {
  if (!reached_.insert(&f).second) return;
  const Uses& uses = uses_.at(&f);
  for (const Function* callee : uses.callees) reach(*callee);
  if (uses.calls_through_register)
    for (const Function* callee : addresses_) reach(*callee);
}

bool CallGraph::reaches_itself(const Function& f) const {
  std::set<const Function*> seen;
  std::vector<const Function*> pending{&f};
  while (!pending.empty()) {
    const Function* at = pending.back();
    pending.pop_back();
    for (const Function* callee : uses_.at(at).callees) {
      if (callee == &f) return true;
      if (seen.insert(callee).second) pending.push_back(callee);
    }
  }
  return false;
}

}  // namespace glint::frontend::ptx
