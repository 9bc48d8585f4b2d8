// Drives the lowering: entry point, constants, dispatch of instructions, and the report of what is
// unsupported.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/lowering.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/check.h"
#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "frontend/deep_stack.h"
#include "frontend/glsl/debug_print.h"
#include "frontend/lower/query_calls.h"
#include "frontend/lower/trace_reorders.h"
#include "frontend/lower/typed.h"
#include "frontend/pass_times.h"
#include "frontend/spirv/source_lines.h"
#include "frontend/spirv/spirv.h"

namespace glint::frontend {
ModuleLowering::ModuleLowering(const Module& module, const std::string& name, const EntryPoint& entry,
                               bool contract, bool reorders)
    : module_(module),
      entry_(entry),
      contract_(contract),
      reorders_(reorders),
      layout_(module),
      emitter_(program_) {
  program_.name = name;
  program_.files = module.files;
  program_.scopes = module.scopes;
}

VirtualProgram ModuleLowering::run() {
  choose_entry_point();
  check_capabilities();
  index_definitions();
  note_interface();
  choose_attribute_place();
  lower_control(*this);
  throw_if_unsupported();
  emitter_.finish();
  if (contract_) contract(&program_, emitter_.free_results());
  remove_dead_code(&program_);
  program_.local_bytes = (program_.local_bytes + 15) / 16 * 16;
  return std::move(program_);
}

void ModuleLowering::choose_entry_point() {
  const std::optional<isa::Stage> stage = stage_of(entry_.model);
  if (!stage)
    throw UnsupportedError(fmt::format("{}: a shader of execution model {}", program_.name,
                                       name_of_execution_model(uint32_t(entry_.model))));
  program_.stage = *stage;
  program_.local_size = entry_.local_size;
  function_ = module_.function(entry_.function);
  if (!function_ || function_->blocks.empty())
    throw UserError({program_.name, 0, 0}, "the entry point has no function body");
}

// Returns whether a variable belongs to the entry point. Before SPIR-V 1.4, interfaces list only inputs and
// outputs, so every variable may belong to it.
bool ModuleLowering::is_in_interface(Id variable) const {
  constexpr uint32_t kVersion14 = 0x10400;
  return module_.version < kVersion14 || entry_.interface.count(variable) != 0;
}

void ModuleLowering::check_capabilities() {
  for (const auto& [capability, line] : module_.capabilities)
    if (!is_known_capability(capability))
      unsupported("capability " + name_of_capability(uint32_t(capability)), line);
  // The lowering stops here for values of these types, because it cannot handle anything made of them.
  constexpr auto kCooperativeMatrixKHR = spv::Op(4456);  // newer than the packaged headers
  for (const auto& [id, type] : module_.types)
    if (type.op == spv::Op::OpTypeCooperativeMatrixNV || type.op == kCooperativeMatrixKHR)
      throw_if_unsupported();
}

void ModuleLowering::index_definitions() {
  for (const auto& [id, constant] : module_.constants) type_of_id_[id] = constant.type;
  for (const auto& [id, variable] : module_.variables) type_of_id_[id] = variable.type;
  for (const Block& block : function_->blocks)
    for (const Instruction& inst : block.code) {
      if (inst.result == 0) continue;
      type_of_id_[inst.result] = inst.type;
      definition_[inst.result] = &inst;
      if (inst.op == spv::Op::OpVariable)
        local_variables_[inst.result] = {inst.result, inst.type, spv::StorageClass(inst.operands[0]),
                                         inst.operands.size() > 1 ? inst.operands[1] : 0, inst.line};
    }
}

// Notes the payload size: that of the payload the shader reads, otherwise the largest that it passes.
void ModuleLowering::note_interface() {
  uint32_t incoming = 0, outgoing = 0;
  for (const auto& [id, variable] : module_.variables) {
    if (!is_in_interface(id)) continue;
    const Id type = module_.type(variable.type).element;
    if (variable.storage == spv::StorageClass::IncomingRayPayloadKHR ||
        variable.storage == spv::StorageClass::IncomingCallableDataKHR)
      incoming = std::max(incoming, layout_.size(type));
    if (variable.storage == spv::StorageClass::RayPayloadKHR)
      outgoing = std::max(outgoing, layout_.size(type));
    if (variable.storage == spv::StorageClass::HitAttributeKHR)
      program_.attribute_bytes = std::max(program_.attribute_bytes, layout_.size(type));
  }
  program_.payload_bytes = incoming != 0 ? incoming : outgoing;
  constexpr uint32_t kAttributeBytes = 64;  // docs/abi.md, Calls and rays
  if (program_.attribute_bytes > kAttributeBytes)
    unsupported(fmt::format("hit attributes of {} bytes", program_.attribute_bytes));
}

// Emits the code before the first instruction. It computes operations on constants that do not fold (64 bits,
// floats) before anything uses them.
void ModuleLowering::prologue() {
  for (const auto& [id, constant] : module_.constants)
    if (constant.op == spv::Op::OpSpecConstantOp) value(id);
  const auto initialise = [&](const Variable& variable) {
    if (variable.initializer != 0) store(variable_pointer(variable), value(variable.initializer));
  };
  for (const auto& [id, variable] : module_.variables)
    if (variable.storage == spv::StorageClass::Private && is_in_interface(id)) initialise(variable);
  for (const auto& [id, variable] : local_variables_) initialise(variable);
}

// Decides where hit attributes live. An accepted report keeps its buffer of attributes, and the next report
// uses the other buffer. A shader that may report more than once therefore keeps its attributes in its frame
// and copies all of them for each report.
void ModuleLowering::choose_attribute_place() {
  int reports = 0;
  bool has_loop = false;
  for (const Block& block : function_->blocks) {
    has_loop |= block.merge == spv::Op::OpLoopMerge;
    for (const Instruction& inst : block.code) reports += inst.op == spv::Op::OpReportIntersectionKHR;
  }
  attributes_in_frame_ = reports > 1 || (reports == 1 && has_loop);
}

void ModuleLowering::hand_over_attributes() {
  if (!attributes_in_frame_) return;
  for (const auto& [id, variable] : module_.variables) {
    if (variable.storage != spv::StorageClass::HitAttributeKHR) continue;
    Pointer to = pointer(id);
    const Operands parts = load(to);
    to.base = Operand::of(isa::Special::Attribute);
    to.displacement = 0;
    store(to, parts);
  }
}

void ModuleLowering::instruction(const Instruction& inst) {
  emitter_.set_line(inst.line);
  if (inst.op == spv::Op::OpVariable) return;
  // The expansions of extended functions are never fused: their errors were bounded with every rounding in
  // place.
  emitter_.set_free(contract_ && inst.op != spv::Op::OpExtInst && !decorations(inst.result).no_contraction);
  if (inst.op == spv::Op::OpExtInst) {
    const auto import = module_.imports.find(inst.operands[0]);
    if (import != module_.imports.end() && import->second == "GLSL.std.450")
      lower_glsl_std(*this, inst);
    else if (import != module_.imports.end() && import->second == kDebugPrintSet)
      lower_print(*this, inst);
    else if (import == module_.imports.end() ||
             (import->second.rfind("NonSemantic.", 0) != 0 && !lower_vendor_set(*this, import->second, inst)))
      unsupported("OpExtInst of an unknown set");
  } else if (const LoweringRow* row = find_lowering_row(inst.op)) {
    row->lower(*this, inst, *row);
  } else {
    unsupported(name_of_opcode(uint32_t(inst.op)));
  }
  if (inst.result != 0) set_zero(inst);
  for (Id type : layout_.unsupported())
    if (reported_types_.insert(type).second) {
      const Type& what = module_.type(type);
      unsupported(fmt::format("{}{}", name_of_opcode(uint32_t(what.op)),
                              what.width ? fmt::format(" {}", what.width) : ""));
    }
}

// Gives the result a value after something unsupported, so that the search for more can continue.
void ModuleLowering::set_zero(const Instruction& inst) {
  if (inst.type == 0 || values_.count(inst.result) || pointers_.count(inst.result)) return;
  if (module_.type(inst.type).kind == Type::Kind::Pointer)
    pointers_[inst.result] = nowhere(module_.type(inst.type).element);
  else
    values_[inst.result] = Operands(layout_.num_parts(inst.type), Operand::value(0));
}

void ModuleLowering::set(Id id, Operands parts) {
  const Id type = type_of(id);
  GLINT_CHECK(parts.size() == layout_.num_parts(type), "%{} has {} parts, its type {}", id, parts.size(),
              layout_.num_parts(type));
  values_[id] = std::move(parts);
}

const Operands& ModuleLowering::value(Id id) {
  if (const auto it = values_.find(id); it != values_.end()) return it->second;
  if (module_.constants.count(id)) return values_[id] = constant_parts(id);
  if (const std::optional<Operand> address = address_of(id)) return values_[id] = {*address};
  unsupported(fmt::format("{} as a value", module_.name_of(id)));  // A pointer is used as a value.
  const auto type = type_of_id_.find(id);
  const uint32_t parts = type == type_of_id_.end() ? 1 : layout_.num_parts(type->second);
  return values_[id] = Operands(std::max(parts, 1u), Operand::value(0));
}

// Returns the address of a pointer that is used as a value. The result is not kept, for the same reason as in
// pointer().
std::optional<Operand> ModuleLowering::address_of(Id id) {
  const bool is_variable = module_.variables.count(id) != 0;
  if (!is_variable && !pointers_.count(id)) return std::nullopt;
  const Pointer p = pointer(id);
  if (p.space == PointerSpace::Global)
    return emitter_.value("add.u64", {p.base, Operand::value(uint64_t(p.displacement))});
  if (p.space == PointerSpace::Shared)
    return emitter_.value("add.u32", {p.base, Operand::value(uint32_t(p.displacement))});
  if (p.space == PointerSpace::Resource && layout_.is_array_of_blocks(p.type)) return buffer_entry(p);
  return std::nullopt;
}

Operand ModuleLowering::word(Id id) {
  const Part part = part_of(type_of(id));
  const Operand x = scalar(id);
  if (bytes_of(part) == 8)
    return x.kind == Operand::Kind::Constant ? Operand::value(uint32_t(x.constant))
                                             : emitter_.value("cvt.u32.u64", {x});
  return widened(emitter_, part, x, part == Part::Int8 || part == Part::Int16);
}

namespace {

Operands null_parts(const Module& module, Layout& layout, Id id) {
  const Type& type = module.type(id);
  if (type.kind == Type::Kind::Pointer && type.storage == spv::StorageClass::Workgroup)
    return {Operand::value(kNullAddress)};
  Operands parts;
  const auto append = [&](const Operands& more) { parts.insert(parts.end(), more.begin(), more.end()); };
  if (type.kind == Type::Kind::Struct) {
    for (const Type::Member& member : type.members) append(null_parts(module, layout, member.type));
  } else if (type.kind == Type::Kind::Array) {
    const Operands element = null_parts(module, layout, type.element);
    for (uint32_t i = 0; i < type.count; ++i) append(element);
  } else {
    parts.assign(layout.num_parts(id), Operand::value(0));
  }
  return parts;
}

}  // namespace

Operands ModuleLowering::constant_parts(Id id) {
  const Instruction& constant = module_.constants.at(id);
  switch (constant.op) {
    case spv::Op::OpConstantTrue:
    case spv::Op::OpSpecConstantTrue:
      return {Operand::value(1)};
    case spv::Op::OpConstantFalse:
    case spv::Op::OpSpecConstantFalse:
      return {Operand::value(0)};
    case spv::Op::OpConstant:
    case spv::Op::OpSpecConstant: {
      uint64_t bits = constant.operands[0];
      if (constant.operands.size() > 1) bits |= uint64_t(constant.operands[1]) << 32;
      // A literal of a narrow signed type carries its sign beyond its width.
      if (const uint32_t bytes = bytes_of(part_of(constant.type)); bytes < 4) bits &= (1u << 8 * bytes) - 1;
      return {Operand::value(bits)};
    }
    case spv::Op::OpConstantComposite:
    case spv::Op::OpSpecConstantComposite: {
      Operands parts;
      for (Id member : constant.operands) {
        const Operands& more = value(member);
        parts.insert(parts.end(), more.begin(), more.end());
      }
      return parts;
    }
    case spv::Op::OpSpecConstantOp:
      return specialised_parts(constant);
    case spv::Op::OpConstantNull:
      return null_parts(module_, layout_, constant.type);
    default:
      unsupported(name_of_opcode(uint32_t(constant.op)), constant.line);
      [[fallthrough]];
    case spv::Op::OpUndef:  // Choice: an undefined value is 0.
      return Operands(layout_.num_parts(constant.type), Operand::value(0));
  }
}

// Lowers the op as if it stood in the function. The emitter folds most ops, because all their operands are
// constants.
Operands ModuleLowering::specialised_parts(const Instruction& constant) {
  Instruction inst = constant;
  inst.op = spv::Op(constant.operands[0]);
  inst.operands.erase(inst.operands.begin());
  const LoweringRow* row = find_lowering_row(inst.op);
  if (row) row->lower(*this, inst, *row);
  if (const auto done = values_.find(inst.result); done != values_.end()) return Operands(done->second);
  unsupported(fmt::format("OpSpecConstantOp {}", name_of_opcode(uint32_t(inst.op))), constant.line);
  return Operands(layout_.num_parts(constant.type), Operand::value(0));
}

Part ModuleLowering::part_of(Id type) {
  const std::vector<Part>& parts = layout_.parts(type);
  return parts.empty() ? Part::Uint32 : parts[0];
}

const Instruction* ModuleLowering::definition(Id id) const {
  const auto it = definition_.find(id);
  return it == definition_.end() ? nullptr : it->second;
}

const Decorations& ModuleLowering::decorations(Id id) const {
  static const Decorations kNone;
  const auto it = module_.decorations.find(id);
  return it == module_.decorations.end() ? kNone : it->second;
}

void ModuleLowering::unsupported(const std::string& what) {
  unsupported(what, emitter_.line());
}

void ModuleLowering::unsupported(const std::string& what, isa::Line line) {
  ++unsupported_[{line.file, line.line, what}];
}

void ModuleLowering::throw_if_unsupported() const {
  if (unsupported_.empty()) return;
  std::string message = fmt::format("{}: not supported:", program_.name);
  for (const auto& [place, count] : unsupported_) {
    const auto& [file, line, what] = place;
    const std::string& name =
        line != 0 && file < program_.files.size() ? program_.files[file] : program_.name;
    message += fmt::format("\n  {}: {}", line != 0 ? fmt::format("{}:{}", name, line) : name, what);
    if (count > 1) message += fmt::format(" ({} times)", count);
  }
  throw UnsupportedError(message);
}

const LoweringRow* find_lowering_row(spv::Op op) {
  static const std::map<spv::Op, const LoweringRow*> kRows = [] {
    std::map<spv::Op, const LoweringRow*> rows;
    for (const auto family :
         {arithmetic_rows(), conversion_rows(), comparison_rows(), composite_rows(), memory_rows(),
          address_rows(), image_rows(), sample_rows(), atomic_rows(), subgroup_rows(), dot_rows(),
          derivative_rows(), ray_tracing_rows(), ray_query_rows(), hit_object_rows()})
      for (const LoweringRow& row : family)
        GLINT_CHECK(rows.emplace(row.op, &row).second, "two rows for op {}", uint32_t(row.op));
    return rows;
  }();
  const auto it = kRows.find(op);
  return it == kRows.end() ? nullptr : it->second;
}

VirtualProgram lower_to_virtual(const std::vector<uint32_t>& spirv, const std::string& name,
                                const std::string& entry_point, bool contract, bool reorders) {
  const Module module = Module::parse(spirv, name);
  VirtualProgram program =
      ModuleLowering(module, name, module.entry_point(entry_point, name), contract, reorders).run();
  std::vector<std::string> texts = listing_of(spirv);
  for (size_t i = 0; i < texts.size(); ++i)
    program.spirv.push_back({std::move(texts[i]), module.lines.at(i)});
  return program;
}

isa::Program lower(const std::vector<uint32_t>& spirv, const std::string& name, const BackendOptions& options,
                   const std::string& entry_point, PassTimes* times) {
  return with_deep_stack([&] {
    VirtualProgram program = [&] {
      const PassTimer timer(times, "lowering", "");
      return lower_to_virtual(spirv, name, entry_point, options.contract, options.reorder_calls);
    }();
    if (options.queries_call) make_queries_calls(program);
    if (options.reorder_traces) reorder_before_hit_shaders(program);
    return assemble(std::move(program), options, times);
  });
}

isa::Program lower(const std::vector<uint32_t>& spirv, const std::string& name, const BackendOptions& options,
                   const std::string& entry_point) {
  return lower(spirv, name, options, entry_point, nullptr);
}

}  // namespace glint::frontend
