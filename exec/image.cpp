// Links the code of all shaders end to end, and relocates branch targets and constants.
// SPDX-License-Identifier: Apache-2.0
#include "exec/image.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "base/check.h"
#include "isa/atomic.h"
#include "isa/barrier.h"

namespace glint::exec {
namespace {

bool has_label(const isa::OpRow& row) {
  for (isa::OperandKind kind : row.operands.view())
    if (kind == isa::OperandKind::Label) return true;
  return false;
}

// Gives rows to the specials that the programs read.
void place_specials(Image& image, const std::vector<isa::Program>& programs) {
  isa::SpecialSet read;
  for (int s = int(isa::Special::LaneId); s <= int(isa::Special::LaunchZ); ++s) read.set(size_t(s));
  for (const isa::Program& program : programs) read |= isa::specials_read_by(program.code);
  for (size_t s = 0; s < read.size(); ++s)
    image.special_row[s] = read[s] ? uint8_t(image.num_special_rows++) : Image::kNoRow;
}

// Returns the instruction with the slots of its constants moved by `first_constant` rows, its specials in
// their rows and its label moved by `first_inst` instructions.
isa::Inst relocate(isa::Inst inst, const isa::OpRow& row, uint32_t first_inst, uint32_t first_constant,
                   const Image& image) {
  int slot = 0;
  for (isa::OperandKind kind : row.operands.view()) {
    const bool predicate = kind == isa::OperandKind::SrcPred || kind == isa::OperandKind::DstPred;
    for (int part = 0; part < isa::slots_of(kind); ++part, ++slot) {
      isa::Slot& operand = inst.operand[size_t(slot)];
      if (!predicate && operand >> isa::kBankShift == isa::kConstantBank >> isa::kBankShift)
        operand = isa::Slot(operand + first_constant);
      if (!predicate && operand >> isa::kBankShift == isa::kSpecialBank >> isa::kBankShift)
        operand = isa::Slot(isa::kSpecialBank + image.special_row[operand & isa::kSlotIndexMask]);
    }
  }
  if (has_label(row)) inst.imm += int32_t(first_inst);
  return inst;
}

void append(Image& image, const isa::Program& program, std::vector<uint32_t>& constants) {
  const uint32_t first = uint32_t(image.code.size());
  Shader shader;
  shader.name = program.name;
  shader.stage = program.stage;
  shader.entry = first;
  shader.end = first + uint32_t(program.code.size());
  shader.local_bytes = program.local_bytes;
  shader.specials_used = isa::specials_read_by(program.code);
  for (const std::string& message : program.messages) shader.messages.push_back(isa::parse_message(message));
  for (int s = int(isa::Special::Payload); s < isa::kNumSpecials; ++s) {
    shader.uses_ray |= shader.specials_used[size_t(s)];
    shader.uses_matrices |= s >= int(isa::Special::ObjectOriginX) && shader.specials_used[size_t(s)];
  }
  const uint32_t first_file = uint32_t(image.files.size());
  for (size_t i = 0; i < program.code.size(); ++i) {
    const isa::OpRow& row = isa::op_table()[program.code[i].op];
    image.code.emplace_back(relocate(program.code[i], row, first, uint32_t(constants.size()), image), row);
    isa::Line line = i < program.lines.size() ? program.lines[i] : isa::Line{};
    line.file = uint16_t(line.file + first_file);
    image.lines.push_back(line);
    image.shader_of.push_back(uint32_t(image.shaders.size()));
  }
  constants.insert(constants.end(), program.constants.begin(), program.constants.end());
  GLINT_CHECK_LE(constants.size(), size_t(isa::kSlotIndexMask));
  image.files.insert(image.files.end(), program.files.begin(), program.files.end());
  image.num_registers = std::max(image.num_registers, program.num_registers);
  if (program.function) {
    image.functions.resize(std::max<size_t>(image.functions.size(), program.function + 1), kNoShader);
    image.functions[program.function] = uint32_t(image.shaders.size());
  }
  image.shaders.push_back(std::move(shader));
  image.programs.push_back(program);
}

// Lanes of a loop wait for others of their warp if they ask for a lock there or look at a word, a barrier or,
// behind a fence, at what others have written, or if the program says so. Choice: loops that only load are
// left out, because most of them wait for nobody.
bool may_wait(const Step& step) {
  using isa::Effect;
  return step.effect == Effect::Yield || step.effect == Effect::Mbarrier || isa::gives_old_value(*step.row) ||
         (step.effect == Effect::Fence && isa::FenceScope(step.row->detail) != isa::FenceScope::Warp);
}

void mark_waiting_loops(Image& image) {
  for (size_t pc = 0; pc < image.code.size(); ++pc) {
    Step& step = image.code[pc];
    if (step.effect != isa::Effect::Branch || size_t(step.inst.imm) > pc) continue;
    const auto body = std::span(image.code).subspan(size_t(step.inst.imm), pc - size_t(step.inst.imm));
    step.may_wait = std::ranges::any_of(body, may_wait);
  }
}

}  // namespace

Image link(const std::vector<isa::Program>& programs) {
  Image image;
  std::vector<uint32_t> constants;
  place_specials(image, programs);
  for (const isa::Program& program : programs) append(image, program, constants);
  for (Step& step : image.code)
    step.target_is_join =
        step.effect == isa::Effect::Branch && image.code[size_t(step.inst.imm)].effect == isa::Effect::Join;
  mark_waiting_loops(image);
  image.constants = allocate_rows(constants.size());
  uint32_t* const table = image.constants.get();
  for (size_t i = 0; i < constants.size(); ++i)
    for (int lane = 0; lane < kLanes; ++lane) table[i * kLanes + size_t(lane)] = constants[i];
  return image;
}

void set_blocks(World& world, std::array<uint32_t, 3> grid, std::array<uint32_t, 3> block,
                uint32_t static_bytes, uint32_t dynamic_bytes) {
  world.block_size = block;
  for (size_t axis = 0; axis < 3; ++axis) world.launch_size[axis] = grid[axis] * block[axis];
  world.shared_bytes = static_bytes + dynamic_bytes;
  world.dynamic_shared_bytes = dynamic_bytes;
}

void set_first_block(World& world, std::array<uint32_t, 3> first) {
  for (size_t axis = 0; axis < 3; ++axis) world.first_id[axis] = first[axis] * world.block_size[axis];
}

uint64_t plain_table_bytes(const World& world) {
  return (1 + world.miss.size() + world.hit.size() + world.callable.size()) * uint64_t(kHandleBytes);
}

void place_plain_table(World& world, Address base) {
  const auto after = [](Address first, size_t records) { return first + records * kHandleBytes; };
  world.table.raygen = base;
  world.table.miss = {after(base, 1), kHandleBytes};
  world.table.hit = {after(world.table.miss.base, world.miss.size()), kHandleBytes};
  world.table.callable = {after(world.table.hit.base, world.hit.size()), kHandleBytes};
}

std::string Image::line_of(uint32_t pc) const {
  const isa::Line& line = lines[pc];
  const std::string& file = line.file < files.size() ? files[line.file] : shaders[shader_of[pc]].name;
  return line.line ? fmt::format("{}:{}", file, line.line) : file;
}

std::string Image::place_of(uint32_t pc) const {
  if (pc >= code.size()) return fmt::format("instruction {}", pc);
  return fmt::format("{} (instruction {}: {})", line_of(pc), pc - shaders[shader_of[pc]].entry,
                     code[pc].row->name);
}

}  // namespace glint::exec
