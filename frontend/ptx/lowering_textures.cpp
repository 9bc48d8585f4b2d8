// Lowers accesses of textures and surfaces, whose handles are numbers of images that a launch binds.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <set>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {

using isa::OperandKind;

namespace {

bool is_store(const Instruction& inst) {
  return inst.words[0] == "sust" || inst.words[0] == "sured";
}

// Returns the values of a surface access: how many there are, and their bits.
struct SurfaceValues {
  uint32_t count = 1, bits = 32;
};
SurfaceValues surface_values(const Words& words) {
  SurfaceValues out;
  for (const std::string& word : words) {
    if (word == "v2" || word == "v4") out.count = word == "v2" ? 2 : 4;
    if (const auto type = type_of(word)) out.bits = type->bits;
  }
  return out;
}

// Returns the words with the row's vector and type for so many bytes: unconverted bits move in words.
Words words_of_row(const Words& words, uint32_t bytes) {
  Words out;
  for (const std::string& word : words) {
    if (word == "v2" || word == "v4") continue;
    if (!type_of(word)) {
      out.push_back(word);
      continue;
    }
    if (bytes > 4) out.push_back(bytes == 8 ? "v2" : "v4");
    out.push_back(bytes == 1 ? "b8" : bytes == 2 ? "b16" : "b32");
  }
  return out;
}

}  // namespace

bool KernelLowering::lower_image(const Instruction& inst) {
  static const std::set<std::string, std::less<>> kOps{"tex", "tld4", "txq", "suld", "sust", "sured", "suq"};
  if (!kOps.contains(inst.words[0])) return false;
  const bool moves_bits = inst.words.size() > 1 && inst.words[1] == "b" && inst.words[0] != "sured";
  if (moves_bits)
    lower_surface_bits(inst);
  else
    lower_image_row(inst);
  return true;
}

// Returns the handle and the coordinates of `[handle, coordinates]`, as many as the shape has. CUDA's
// compiler writes coordinates of three numbers as four.
std::vector<VirtualOperand> KernelLowering::image_place(const Instruction& inst, const Operand& at,
                                                        const isa::ImageAccess& image) {
  if (at.kind != Operand::Kind::Address || at.parts.empty() || at.parts.size() > 2) {
    error(at.position, fmt::format("'{}' takes a place such as [%rd1, {{%f1, %f2}}]", joined(inst.words)));
    return {};
  }
  std::vector<VirtualOperand> out{
      compute32("cvt.u32.u64", {source(at.parts[0], OperandKind::Src64, {'u', 64})})};
  if (image.request == isa::ImageRequest::Query) return out;
  std::vector<const Operand*> coordinates;
  if (at.parts.size() == 2) coordinates = parts_of(at.parts[1]);
  const bool is_float =
      image.request == isa::ImageRequest::Sample || image.request == isa::ImageRequest::Gather;
  const auto wanted = size_t(isa::num_coordinates(image.shape)) + isa::has_layers(image.shape);
  if (coordinates.size() < wanted) {
    error(at.position, fmt::format("'{}' takes {} coordinates, and there are {}", joined(inst.words), wanted,
                                   coordinates.size()));
    return {};
  }
  for (size_t i = 0; i < wanted; ++i) {
    const bool is_layer = i == 0 && isa::has_layers(image.shape);
    out.push_back(source(*coordinates[i], OperandKind::Src32, {is_float && !is_layer ? 'f' : 's', 32}));
  }
  return out;
}

// Lowers an access that has a row of its own name.
void KernelLowering::lower_image_row(const Instruction& inst) {
  const int index = isa::find_op(joined(inst.words));
  if (index < 0) return report_no_row(inst);
  const isa::OpRow& row = isa::op_table()[size_t(index)];
  const size_t place = is_store(inst) ? 0 : 1;
  if (inst.operands.size() <= place)
    return error(inst.position, fmt::format("'{}' takes more operands", joined(inst.words)));
  if (inst.operands.size() > 2 && (row.image.has_offset || row.image.has_compare)) return report_no_row(inst);
  std::vector<VirtualOperand> operands = image_place(inst, inst.operands[place], row.image);
  if (operands.empty()) return;
  // The level or the gradients are behind the place, a vector for each gradient; CUDA's compiler pads them,
  // too.
  for (size_t i = place + 1; i < inst.operands.size(); ++i) {
    std::vector<VirtualOperand> more = registers_from(inst.operands[i], OperandKind::Src32);
    if (row.image.lod == isa::ImageLod::Gradients)
      more.resize(std::min(more.size(), size_t(isa::num_coordinates(row.image.shape))));
    operands.insert(operands.end(), more.begin(), more.end());
  }
  if (place == 1) {
    const std::vector<VirtualOperand> results = registers_to(inst.operands[0], OperandKind::Dst32);
    operands.insert(operands.begin(), results.begin(), results.end());
  }
  size_t slots = 0;
  for (const OperandKind kind : row.operands.view()) slots += size_t(isa::slots_of(kind));
  if (slots != operands.size())
    return error(inst.position, fmt::format("'{}' takes {} values in all, and there are {}",
                                            joined(inst.words), slots, operands.size()));
  emit(index, std::move(operands));
  finish_moves();
}

// Lowers suld.b and sust.b, which move bits as they are: values of 8 and 16 bits share words, and those of 64
// bits take two.
void KernelLowering::lower_surface_bits(const Instruction& inst) {
  const SurfaceValues values = surface_values(inst.words);
  const uint32_t bytes = values.count * values.bits / 8;
  const int index = bytes > 16 ? -1 : isa::find_op(joined(words_of_row(inst.words, bytes)));
  if (index < 0) return report_no_row(inst);
  const bool stores = is_store(inst);
  if (inst.operands.size() != 2)
    return error(inst.position, fmt::format("'{}' takes a place and values", joined(inst.words)));
  const Operand& list = inst.operands[stores ? 1 : 0];
  const std::vector<const Operand*> parts = parts_of(list);
  if (parts.size() != values.count)
    return error(list.position, fmt::format("'{}' moves {} values, but the operand has {}",
                                            joined(inst.words), values.count, parts.size()));
  std::vector<VirtualOperand> place =
      image_place(inst, inst.operands[stores ? 0 : 1], isa::op_table()[size_t(index)].image);
  if (place.empty()) return;
  Symbol words;
  words.kind = Symbol::Kind::Parameter;
  for (uint32_t at = 0; at < bytes; at += 4) words.elements.push_back(temporary(RegisterClass::B32));
  MemoryForm form;
  form.type = {'b', values.bits};
  const auto each_part = [&](auto&& move) {
    for (uint32_t i = 0; i < values.count; ++i) move(form, words, i * values.bits / 8, *parts[i]);
  };
  if (stores) each_part([&](auto&&... part) { store_word_part(part...); });
  std::vector<VirtualOperand> operands;
  for (const VirtualRegister word : words.elements) operands.push_back(VirtualOperand::of(word));
  operands.insert(stores ? operands.begin() : operands.end(), place.begin(), place.end());
  emit(index, std::move(operands));
  if (!stores) each_part([&](auto&&... part) { load_word_part(part...); });
}

}  // namespace glint::frontend::ptx
