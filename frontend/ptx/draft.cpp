// Turns the graph into a list of blocks.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/draft.h"

#include <algorithm>
#include <utility>

#include "frontend/backend/flow_graph.h"

namespace glint::frontend::ptx {
namespace {

VirtualInst jump(const char* op, const isa::Line& line, BlockId target = kNoBlock) {
  VirtualInst inst;
  inst.op = isa::op_index(op);
  inst.line = line;
  inst.target = target;
  return inst;
}

bool is_plain_exit(const DraftBlock& block) {
  return block.code.empty() && block.end == DraftBlock::End::Exit;
}

const char* exit_of(const DraftBlock& block) {
  return block.returns ? "ret" : "exit";
}

// Turns the ends of a block into instructions. `after` is the next block in the layout.
void append_end(VirtualBlock& out, const DraftBlock& block, const std::vector<DraftBlock>& all,
                BlockId after) {
  if (block.end == DraftBlock::End::Branch) {
    const bool leaves = is_plain_exit(all[block.taken]);
    VirtualInst choice =
        jump(leaves ? exit_of(all[block.taken]) : "bra", block.line, leaves ? kNoBlock : block.taken);
    choice.guard = block.condition;
    choice.guard_negate = block.negate;
    out.code.push_back(std::move(choice));
    if (!leaves) out.successors.push_back(block.taken);
  }
  const DraftBlock& last = block.end == DraftBlock::End::Exit ? block : all[block.next];
  if (block.end == DraftBlock::End::Exit || is_plain_exit(last)) {
    out.code.push_back(jump(exit_of(last), block.line));
    return;
  }
  out.successors.push_back(block.next);
  if (block.next != after) out.code.push_back(jump("bra", block.line, block.next));
}

}  // namespace

void keep_yields_in_loops(Draft& draft) {
  const int yield = isa::op_index("yield");
  const auto is_yield = [&](const VirtualInst& inst) { return inst.op == yield; };
  if (std::ranges::none_of(
          draft.blocks, [&](const DraftBlock& block) { return std::ranges::any_of(block.code, is_yield); }))
    return;
  Edges next;
  for (const DraftBlock& block : draft.blocks) next.push_back(block.successors());
  Blocks in_loops;
  for (const Loop& loop : natural_loops(next, draft.layout.front()))
    in_loops.insert(loop.body.begin(), loop.body.end());
  for (size_t block = 0; block < draft.blocks.size(); ++block)
    if (!in_loops.contains(BlockId(block))) std::erase_if(draft.blocks[block].code, is_yield);
}

std::vector<VirtualBlock> lay_out(Draft draft) {
  std::vector<BlockId> place(draft.blocks.size(), kNoBlock);
  for (size_t i = 0; i < draft.layout.size(); ++i) place[draft.layout[i]] = BlockId(i);
  std::vector<VirtualBlock> out(draft.layout.size());
  for (size_t i = 0; i < draft.layout.size(); ++i) {
    DraftBlock& block = draft.blocks[draft.layout[i]];
    out[i].name = block.name;
    out[i].code = std::move(block.code);
    block.code.resize(out[i].code.empty() ? 0 : 1);  // Its size still tells whether the block had code.
    append_end(out[i], block, draft.blocks, i + 1 < draft.layout.size() ? draft.layout[i + 1] : kNoBlock);
    for (VirtualInst& inst : out[i].code)
      if (inst.target != kNoBlock) inst.target = place[inst.target];
    for (BlockId& next : out[i].successors) next = place[next];
  }
  return out;
}

}  // namespace glint::frontend::ptx
