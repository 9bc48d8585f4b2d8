// Builds SSA form as described by M. Braun et al., "Simple and Efficient Construction of Static Single
// Assignment Form" (2013): a variable is looked up along the predecessors, and phis that turn out to have one
// value only are dropped at the end.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/promoted_variables.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <spirv-tools/libspirv.h>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace glint::frontend {
namespace {

using enum spv::Op;

// Describes an instruction of the module. Offsets count words from its first one.
struct ParsedInst {
  spv::Op op = OpNop;
  size_t at = 0;  // index of its first word in the module
  uint32_t num_words = 0, type = 0, result = 0;
  std::vector<uint16_t> ids;  // offsets of the operands that are ids, without its type and result
};

struct ParsedModule {
  std::vector<ParsedInst> insts;
  size_t next = kHeaderWords;
};

spv_result_t take_instruction(void* module, const spv_parsed_instruction_t* parsed) {
  auto& out = *static_cast<ParsedModule*>(module);
  ParsedInst inst{spv::Op(parsed->opcode), out.next,          parsed->num_words,
                  parsed->type_id,         parsed->result_id, {}};
  for (uint16_t i = 0; i < parsed->num_operands; ++i) {
    const spv_parsed_operand_t& operand = parsed->operands[i];
    const bool is_id = operand.type == SPV_OPERAND_TYPE_ID || operand.type == SPV_OPERAND_TYPE_SCOPE_ID ||
                       operand.type == SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID;
    if (is_id) inst.ids.push_back(operand.offset);
  }
  out.next += parsed->num_words;
  out.insts.push_back(std::move(inst));
  return SPV_SUCCESS;
}

// Returns the instructions of a module, or none when it cannot be parsed.
std::vector<ParsedInst> parsed(const Words& words) {
  ParsedModule module;
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  const spv_result_t result =
      spvBinaryParse(context, &module, words.data(), words.size(), nullptr, take_instruction, nullptr);
  spvContextDestroy(context);
  return result == SPV_SUCCESS ? std::move(module.insts) : std::vector<ParsedInst>{};
}

bool is_note(spv::Op op) {
  return op == OpName || op == OpDecorate || op == OpDecorateId || op == OpDecorateString;
}

struct FlowBlock {
  uint32_t label = 0;
  size_t first = 0, last = 0;                // indices of instructions: its label, and behind its end
  std::vector<uint32_t> next, before;        // each block once; `before` has reachable blocks only
  std::vector<uint32_t> unreachable_before;  // labels
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

  // Takes variables with their types of value and their values at first (0: undefined).
  void run(std::map<uint32_t, std::pair<uint32_t, uint32_t>> variables) {
    variables_ = std::move(variables);
    find_blocks();
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

  void visit(uint32_t block, bool is_reachable) {
    for (size_t i = blocks_[block].first; i < blocks_[block].last; ++i) {
      const ParsedInst& inst = insts_[i];
      if (inst.op != OpLoad && inst.op != OpStore) continue;
      const uint32_t variable = word(inst, inst.ids[0]);
      const auto known = variables_.find(variable);
      if (known == variables_.end()) continue;
      if (inst.op == OpStore)
        values_[key_of(block, variable)] = word(inst, inst.ids[1]);
      else
        changes_.value_of[inst.result] =
            is_reachable ? value_in(block, variable) : changes_.undefined_of(known->second.first);
    }
  }

  // Returns the value that a variable has at the end of what was visited of a block. It makes a phi where
  // several blocks come together.
  uint32_t value_in(uint32_t block, uint32_t variable) {
    std::vector<uint64_t> passed;
    uint32_t value = 0;
    for (uint32_t b = block;; b = blocks_[b].before[0]) {
      passed.push_back(key_of(b, variable));
      if (const auto known = values_.find(passed.back()); known != values_.end()) {
        value = known->second;
        break;
      }
      if (blocks_[b].before.empty()) {
        const auto [type, first] = variables_.at(variable);
        value = first != 0 ? first : changes_.undefined_of(type);
        break;
      }
      if (blocks_[b].before.size() > 1) {
        value = changes_.bound++;
        phi_of_[value] = phis_.size();
        phis_.push_back({value, b, variable, {}, {}});
        break;
      }
    }
    for (const uint64_t key : passed) values_[key] = value;
    return value;
  }

  void complete(size_t phi) {
    for (const uint32_t before : blocks_[phis_[phi].block].before) {
      const uint32_t value = value_in(before, phis_[phi].variable);
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
        users.insert(users.end(), phi.users.begin(), phi.users.end());
      }
      work.insert(work.end(), phi.users.begin(), phi.users.end());
    }
  }

  void write(const NewPhi& phi) {
    if (changes_.value_of.count(phi.id)) return;
    const FlowBlock& block = blocks_[phi.block];
    const uint32_t type = variables_.at(phi.variable).first;
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
  std::map<uint32_t, std::pair<uint32_t, uint32_t>> variables_;
  std::vector<FlowBlock> blocks_;
  std::vector<bool> is_reachable_;
  std::vector<uint32_t> order_;                    // of reachable blocks
  std::unordered_map<uint64_t, uint32_t> values_;  // by block and variable
  std::vector<NewPhi> phis_;
  std::unordered_map<uint32_t, size_t> phi_of_;  // by result
};

// Chooses functions and their variables, and writes the module anew.
class Promoter {
 public:
  Promoter(const Words& words, uint32_t most) : words_(words), most_(most), insts_(parsed(words)) {
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
    std::map<uint32_t, std::pair<uint32_t, uint32_t>> variables;
    std::unordered_map<uint32_t, uint32_t> accesses;
    uint32_t most = 0;
    for (const ParsedInst& inst : function)
      if (inst.op == OpVariable && plain_types_.count(pointees_[inst.type]))
        variables[inst.result] = {pointees_[inst.type], inst.ids.empty() ? 0 : word(inst, inst.ids[0])};
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
