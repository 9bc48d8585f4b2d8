// Builds SSA form from the places where phis may be needed (phi_places.h): a phi is made when a load or
// another phi asks for its value, and phis that turn out to have one value only are dropped at the end.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/promoted_variables.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "frontend/spirv/parsed_instructions.h"
#include "frontend/spirv/phi_places.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

bool is_note(spv::Op op) {
  return op == OpName || op == OpDecorate || op == OpDecorateId || op == OpDecorateString;
}

struct FlowBlock {
  uint32_t label = 0;
  size_t first = 0, last = 0;                // indices of instructions: its label, and behind its end
  std::vector<uint32_t> next, before;        // each block once; `before` has reachable blocks only
  std::vector<uint32_t> unreachable_before;  // labels
};

struct PromotedVariable {
  uint32_t type = 0, first = 0;  // of its value, and its value at first (0: undefined)
  AccessedBlocks blocks;
  Definitions definitions;
};

struct NewPhi {
  uint32_t id = 0, block = 0, variable = 0;
  std::vector<uint32_t> values;  // one for each of the block's `before`
  std::vector<size_t> users;     // other phis that have it as a value
};

// Promotes the variables of one function and notes what becomes of its instructions.
class Promotion {
 public:
  // Holds what has changed in the module so far.
  struct Changes {
    uint32_t bound = 0;
    std::unordered_map<uint32_t, uint32_t> value_of;  // of loads and dropped phis, by result
    std::unordered_set<uint32_t> dropped_variables;
    std::map<uint32_t, uint32_t> undefined;    // by type
    std::unordered_map<uint32_t, Words> phis;  // by label: instructions

    uint32_t value(uint32_t id) {
      uint32_t last = id;
      for (auto at = value_of.find(last); at != value_of.end(); at = value_of.find(last)) last = at->second;
      for (auto at = value_of.find(id); at != value_of.end() && at->second != last; at = value_of.find(id))
        id = std::exchange(at->second, last);
      return last;
    }
    uint32_t undefined_of(uint32_t type) {
      const auto [at, is_new] = undefined.try_emplace(type, bound);
      if (is_new) ++bound;
      return at->second;
    }
  };

  Promotion(const Words& words, std::span<const ParsedInst> insts, Changes& changes)
      : words_(words), insts_(insts), changes_(changes) {}

  void run(std::map<uint32_t, PromotedVariable> variables) {
    variables_ = std::move(variables);
    find_blocks();
    for (const uint32_t block : order_) note_accesses(block);
    for (auto& [id, variable] : variables_) variable.definitions = places_->definitions(variable.blocks);
    for (const uint32_t block : order_) visit(block, true);
    for (uint32_t block = 0; block < blocks_.size(); ++block)
      if (!is_reachable_[block]) visit(block, false);
    for (size_t phi = 0; phi < phis_.size(); ++phi) complete(phi);  // This may add phis.
    drop_needless_phis();
    for (const NewPhi& phi : phis_) write(phi);
    for (const auto& [id, about] : variables_) changes_.dropped_variables.insert(id);
  }

 private:
  uint32_t word(const ParsedInst& inst, size_t offset) const { return words_[inst.at + offset]; }

  void find_blocks() {
    std::unordered_map<uint32_t, uint32_t> index;
    for (size_t i = 0; i < insts_.size(); ++i) {
      if (insts_[i].op == OpLabel) {
        index[insts_[i].result] = uint32_t(blocks_.size());
        blocks_.push_back({insts_[i].result, i, i, {}, {}, {}});
      }
      if (!blocks_.empty()) blocks_.back().last = i + 1;
    }
    for (FlowBlock& block : blocks_) {
      for (size_t i = block.first; i < block.last; ++i) {
        const ParsedInst& inst = insts_[i];
        if (inst.op != OpBranch && inst.op != OpBranchConditional && inst.op != OpSwitch) continue;
        for (const uint16_t offset : inst.ids)
          if (const auto to = index.find(word(inst, offset)); to != index.end())
            block.next.push_back(to->second);
      }
      std::sort(block.next.begin(), block.next.end());
      block.next.erase(std::unique(block.next.begin(), block.next.end()), block.next.end());
    }
    find_order();
    for (uint32_t b = 0; b < blocks_.size(); ++b)
      for (const uint32_t to : blocks_[b].next)
        if (is_reachable_[b])
          blocks_[to].before.push_back(b);
        else
          blocks_[to].unreachable_before.push_back(blocks_[b].label);
    Edges next;
    for (const FlowBlock& block : blocks_) next.push_back(block.next);
    places_.emplace(next);
  }

  // Sorts the reachable blocks so that each comes behind one of those before it.
  void find_order() {
    is_reachable_.assign(blocks_.size(), false);
    is_reachable_[0] = true;
    std::vector<std::pair<uint32_t, size_t>> stack{{0, 0}};  // block, next successor to visit
    while (!stack.empty()) {
      const auto [block, at] = stack.back();
      if (at == blocks_[block].next.size()) {
        order_.push_back(block);
        stack.pop_back();
        continue;
      }
      ++stack.back().second;
      const uint32_t to = blocks_[block].next[at];
      if (is_reachable_[to]) continue;
      is_reachable_[to] = true;
      stack.push_back({to, 0});
    }
    std::reverse(order_.begin(), order_.end());
  }

  static uint64_t key_of(uint32_t block, uint32_t variable) { return uint64_t(block) << 32 | variable; }

  // Returns the variable that an instruction loads or stores, or null when it is not to be promoted.
  PromotedVariable* accessed(const ParsedInst& inst) {
    if (inst.op != OpLoad && inst.op != OpStore) return nullptr;
    const auto known = variables_.find(word(inst, inst.ids[0]));
    return known == variables_.end() ? nullptr : &known->second;
  }

  void note_accesses(uint32_t block) {
    for (size_t i = blocks_[block].first; i < blocks_[block].last; ++i) {
      const ParsedInst& inst = insts_[i];
      PromotedVariable* const variable = accessed(inst);
      if (!variable) continue;
      auto& [stores, open_loads] = variable->blocks;
      const bool is_stored = !stores.empty() && stores.back() == block;
      if (inst.op == OpStore) {
        last_store_[key_of(block, word(inst, inst.ids[0]))] = word(inst, inst.ids[1]);
        if (!is_stored) stores.push_back(block);
      } else if (!is_stored && (open_loads.empty() || open_loads.back() != block)) {
        open_loads.push_back(block);
      }
    }
  }

  void visit(uint32_t block, bool is_reachable) {
    std::unordered_map<uint32_t, uint32_t> values;  // by variable
    for (size_t i = blocks_[block].first; i < blocks_[block].last; ++i) {
      const ParsedInst& inst = insts_[i];
      const PromotedVariable* const variable = accessed(inst);
      if (!variable) continue;
      const uint32_t id = word(inst, inst.ids[0]);
      if (inst.op == OpStore) {
        values[id] = word(inst, inst.ids[1]);
      } else if (!is_reachable) {
        changes_.value_of[inst.result] = changes_.undefined_of(variable->type);
      } else {
        const auto [value, is_new] = values.try_emplace(id, 0);
        if (is_new) value->second = value_at_begin(block, id);
        changes_.value_of[inst.result] = value->second;
      }
    }
  }

  uint32_t value_at_begin(uint32_t block, uint32_t variable) {
    if (variables_.at(variable).definitions.meet_at(block)) return phi_at(block, variable);
    return block == 0 ? value_at_first(variable) : value_at_end(places_->dominator(block), variable);
  }

  uint32_t value_at_end(uint32_t block, uint32_t variable) {
    const uint32_t definition = variables_.at(variable).definitions.at_end_of(block);
    if (definition == kNoBlock) return value_at_first(variable);
    const auto stored = last_store_.find(key_of(definition, variable));
    return stored != last_store_.end() ? stored->second : phi_at(definition, variable);
  }

  uint32_t value_at_first(uint32_t variable) {
    const PromotedVariable& about = variables_.at(variable);
    return about.first != 0 ? about.first : changes_.undefined_of(about.type);
  }

  uint32_t phi_at(uint32_t block, uint32_t variable) {
    const auto [at, is_new] = phi_at_.try_emplace(key_of(block, variable), changes_.bound);
    if (is_new) {
      phi_of_[changes_.bound] = phis_.size();
      phis_.push_back({changes_.bound++, block, variable, {}, {}});
    }
    return at->second;
  }

  void complete(size_t phi) {
    for (const uint32_t before : blocks_[phis_[phi].block].before) {
      const uint32_t value = value_at_end(before, phis_[phi].variable);
      phis_[phi].values.push_back(value);
    }
  }

  // Returns the only value of a phi besides itself, or 0 when it has several.
  uint32_t only_value(const NewPhi& phi) {
    uint32_t only = 0;
    for (const uint32_t each : phi.values) {
      const uint32_t value = changes_.value(each);
      if (value == phi.id || value == only) continue;
      if (only != 0) return 0;
      only = value;
    }
    return only;
  }

  void drop_needless_phis() {
    for (size_t phi = 0; phi < phis_.size(); ++phi)
      for (const uint32_t each : phis_[phi].values)
        if (const auto other = phi_of_.find(changes_.value(each)); other != phi_of_.end())
          phis_[other->second].users.push_back(phi);
    std::vector<size_t> work(phis_.size());
    for (size_t i = 0; i < work.size(); ++i) work[i] = work.size() - 1 - i;
    while (!work.empty()) {
      NewPhi& phi = phis_[work.back()];
      work.pop_back();
      const uint32_t only = changes_.value_of.count(phi.id) ? 0 : only_value(phi);
      if (only == 0) continue;
      changes_.value_of[phi.id] = only;
      // Its users now have another value, and may in their turn have one only.
      if (const auto other = phi_of_.find(only); other != phi_of_.end()) {
        std::vector<size_t>& users = phis_[other->second].users;
        std::copy_if(phi.users.begin(), phi.users.end(), std::back_inserter(users),
                     [&](size_t user) { return !changes_.value_of.count(phis_[user].id); });
      }
      work.insert(work.end(), phi.users.begin(), phi.users.end());
    }
  }

  void write(const NewPhi& phi) {
    if (changes_.value_of.count(phi.id)) return;
    const FlowBlock& block = blocks_[phi.block];
    const uint32_t type = variables_.at(phi.variable).type;
    Words operands;
    for (size_t i = 0; i < phi.values.size(); ++i)
      operands.insert(operands.end(), {changes_.value(phi.values[i]), blocks_[block.before[i]].label});
    for (const uint32_t label : block.unreachable_before)
      operands.insert(operands.end(), {changes_.undefined_of(type), label});
    append(changes_.phis[block.label], OpPhi, {type, phi.id}, operands);
  }

  const Words& words_;
  const std::span<const ParsedInst> insts_;
  Changes& changes_;
  std::map<uint32_t, PromotedVariable> variables_;
  std::vector<FlowBlock> blocks_;
  std::vector<bool> is_reachable_;
  std::vector<uint32_t> order_;  // of reachable blocks
  std::optional<PhiPlaces> places_;
  std::unordered_map<uint64_t, uint32_t> last_store_;  // by block and variable: value
  std::unordered_map<uint64_t, uint32_t> phi_at_;      // by block and variable: result
  std::vector<NewPhi> phis_;
  std::unordered_map<uint32_t, size_t> phi_of_;  // by result
};

// Chooses functions and their variables, and writes the module anew.
class Promoter {
 public:
  Promoter(const Words& words, uint32_t most)
      : words_(words), most_(most), insts_(parsed_instructions(words)) {
    changes_.bound = words[kBoundWord];
  }

  Words run() {
    size_t function = 0;
    for (size_t i = 0; i < insts_.size(); ++i) {
      note_type(insts_[i]);
      if (insts_[i].op == OpFunction) function = i;
      if (insts_[i].op == OpFunctionEnd) promote({&insts_[function], i - function});
    }
    if (changes_.dropped_variables.empty()) return words_;
    Words out(words_.begin(), words_.begin() + kHeaderWords);
    bool is_first = true;
    for (const ParsedInst& inst : insts_) {
      if (inst.op == OpFunction && std::exchange(is_first, false))
        for (const auto& [type, id] : changes_.undefined) append(out, OpUndef, {type, id});
      write(inst, out);
    }
    out[kBoundWord] = changes_.bound;
    return out;
  }

 private:
  uint32_t word(const ParsedInst& inst, size_t offset) const { return words_[inst.at + offset]; }

  void note_type(const ParsedInst& inst) {
    if (inst.op == OpTypeInt || inst.op == OpTypeFloat || inst.op == OpTypeBool || inst.op == OpTypeVector ||
        inst.op == OpTypeMatrix || inst.op == OpTypeArray || inst.op == OpTypeStruct)
      plain_types_.insert(inst.result);
    if (inst.op == OpTypePointer) pointees_[inst.result] = word(inst, 3);
  }

  void promote(std::span<const ParsedInst> function) {
    std::map<uint32_t, PromotedVariable> variables;
    std::unordered_map<uint32_t, uint32_t> accesses;
    uint32_t most = 0;
    for (const ParsedInst& inst : function)
      if (inst.op == OpVariable && plain_types_.count(pointees_[inst.type]))
        variables[inst.result] = {
            pointees_[inst.type], inst.ids.empty() ? 0 : word(inst, inst.ids[0]), {}, {}};
    for (const ParsedInst& inst : function) {
      const bool is_access = inst.op == OpLoad || inst.op == OpStore;
      // The mask of an access stands behind its ids. A volatile access stays.
      const size_t mask = is_access && !inst.ids.empty() ? size_t(inst.ids[inst.op == OpStore]) + 1 : 0;
      const bool is_plain = is_access && (mask >= inst.num_words ||
                                          !(word(inst, mask) & uint32_t(spv::MemoryAccessMask::Volatile)));
      for (size_t i = 0; i < inst.ids.size(); ++i) {
        const uint32_t id = word(inst, inst.ids[i]);
        if (is_plain && i == 0)
          most = std::max(most, ++accesses[id]);
        else
          variables.erase(id);
      }
    }
    if (most > most_ && !variables.empty()) Promotion(words_, function, changes_).run(std::move(variables));
  }

  void write(const ParsedInst& inst, Words& out) {
    const bool is_gone =
        changes_.dropped_variables.count(inst.result) || changes_.value_of.count(inst.result) ||
        (inst.op == OpStore && changes_.dropped_variables.count(word(inst, inst.ids[0]))) ||
        (is_note(inst.op) &&
         (changes_.dropped_variables.count(word(inst, 1)) || changes_.value_of.count(word(inst, 1))));
    if (is_gone) return;
    const size_t begin = out.size();
    out.insert(out.end(), words_.begin() + long(inst.at), words_.begin() + long(inst.at + inst.num_words));
    for (const uint16_t offset : inst.ids) out[begin + offset] = changes_.value(out[begin + offset]);
    if (inst.op != OpLabel) return;
    if (const auto phis = changes_.phis.find(inst.result); phis != changes_.phis.end())
      out.insert(out.end(), phis->second.begin(), phis->second.end());
  }

  const Words& words_;
  const uint32_t most_;
  const std::vector<ParsedInst> insts_;
  std::unordered_set<uint32_t> plain_types_;
  std::unordered_map<uint32_t, uint32_t> pointees_;  // of pointer types
  Promotion::Changes changes_;
};

}  // namespace

Words with_promoted_variables(Words spirv, uint32_t most) {
  return Promoter(spirv, most).run();
}

}  // namespace glint::frontend
