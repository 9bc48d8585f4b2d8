// Lowers one SPIR-V module to a VirtualProgram: what the families of op-lowering functions share.
//
// Every SSA value is a list of scalar operands. Each SPIR-V opcode has one row in a table; a row names a
// function that reads the operands of one instruction and emits code. Whatever is not supported is noted
// and given the value 0, so that one run finds all of it; lower_to_virtual() then throws.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "frontend/lower/emitter.h"
#include "frontend/lower/layout.h"
#include "frontend/spirv/module.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

// The lowering without the backend: for tests and for `--emit virtual`. UnsupportedError as lower().
VirtualProgram lower_to_virtual(const std::vector<uint32_t>& spirv, const std::string& name,
                                const std::string& entry_point = {}, bool contract = false);

// Where a pointer points. Attribute pairs: hit attributes of two floats, which hit shaders find in %hit.u and
// %hit.v. Resource: a descriptor, of a buffer only while an index into an array of them is missing. Texel: of
// a storage image, for atomics.
enum class Place : uint8_t {
  Local,
  Global,
  Shared,
  Constant,
  Builtin,
  Resource,
  AttributePair,
  RayQuery,
  Texel,
  Nowhere
};

struct Pointer {
  Id type = 0;  // of the pointee
  Place place = Place::Nowhere;
  Operand base = Operand::value(
      0);  // Local, Shared, Constant: 32-bit address; Global: 64-bit; Resource, RayQuery: index
  int64_t displacement = 0;      // bytes; Builtin, AttributePair: parts
  uint32_t alignment = 16;       // bytes, of base
  uint32_t known_alignment = 0;  // bytes, of base and displacement together; 0 unless an instruction tells it
  uint32_t component_stride = 0;  // bytes; not 0 in a column of a row-major matrix
  MatrixLayout matrix;
  Id variable = 0;                         // the root
  bool is_constant = false;                // memory that no shader writes
  bool is_volatile = false;                // two loads may differ
  Operand part_index = Operand::value(0);  // Builtin, AttributePair: dynamic part index
  Operand entry;                           // Global, of an array of buffers: the address of its descriptor
  Operand table;   // Resource, of a pointer that is a value: the address of the descriptor with index 0
  Operands texel;  // Texel: handle, then the layer of arrays and coordinates
  std::string_view shape;  // Texel: the geometry as image ops name it
};

inline Pointer nowhere(Id pointee) {
  Pointer pointer;
  pointer.type = pointee;
  return pointer;
}

class ModuleLowering;
struct LoweringRow {
  spv::Op op;
  void (*lower)(ModuleLowering&, const Instruction&, const LoweringRow&);
  std::string_view name32;  // the ISA op for 32-bit parts, where the family uses one; see lower_typed.h
  std::string_view name64 = {};
};
// One table a family; find_lowering_row() searches them all.
std::span<const LoweringRow> arithmetic_rows();
std::span<const LoweringRow> conversion_rows();
std::span<const LoweringRow> comparison_rows();
std::span<const LoweringRow> composite_rows();
std::span<const LoweringRow> memory_rows();
std::span<const LoweringRow> address_rows();
std::span<const LoweringRow> image_rows();
std::span<const LoweringRow> sample_rows();
std::span<const LoweringRow> atomic_rows();
std::span<const LoweringRow> subgroup_rows();
std::span<const LoweringRow> dot_rows();
std::span<const LoweringRow> derivative_rows();
std::span<const LoweringRow> ray_tracing_rows();
std::span<const LoweringRow> ray_query_rows();
std::span<const LoweringRow> hit_object_rows();
const LoweringRow* find_lowering_row(spv::Op op);

// The GLSL.std.450 instruction set: operands[0] is the import, operands[1] the function's number.
void lower_glsl_std(ModuleLowering& lowering, const Instruction& inst);
// Of a vendor's set; false where it is not known.
bool lower_vendor_set(ModuleLowering& lowering, const std::string& set, const Instruction& inst);
// NonSemantic.DebugPrintf: operands[2] is the format. UserError when it does not fit its arguments.
void lower_print(ModuleLowering& lowering, const Instruction& inst);

class ModuleLowering {
 public:
  // `contract`: products and sums may become one op (lower_contract.cpp).
  ModuleLowering(const Module& module, const std::string& name, const EntryPoint& entry,
                 bool contract = false);
  VirtualProgram run();

  // --- Control: called block by block by lower_control()
  void prologue();                            // initialisers of variables
  void instruction(const Instruction& inst);  // neither phi nor terminator
  const Function& function() const { return *function_; }

  // --- Values
  const Operands& value(Id id);  // constants appear on first use
  Operand scalar(Id id) { return value(id).at(0); }
  Operand word(Id id);  // an integer as 32 bits: 64 are cut, narrow signed ones extended
  void set(Id id, Operands parts);
  Pointer pointer(Id id);
  void set_pointer(Id id, Pointer pointer) { pointers_[id] = pointer; }
  Id type_of(Id id) const { return type_of_id_.at(id); }
  const Instruction* definition(Id id) const;  // in the function; null for constants and variables

  // The type of the first part; parts of one value are alike but in structs.
  Part part_of(Id type);

  // --- Memory
  Operands load(const Pointer& pointer);
  void store(const Pointer& pointer, const Operands& parts);
  Operands load_builtin(spv::BuiltIn builtin, Id type);
  std::optional<Operand> address_of(Id pointer);  // none: not a pointer that is a value
  std::optional<Operands> load_compute_builtin(
      spv::BuiltIn builtin);  // none: not a built-in of compute or subgroups
  Operand buffer_entry(
      const Pointer& pointer);  // the address of the descriptor that the index of a buffer in an array means
  Pointer buffer_element(Pointer pointer);  // from the index of a buffer in an array to the buffer
  uint32_t local_offset(Id variable);       // bytes in the frame; allotted on first use
  uint32_t ray_query(
      Id variable);             // the first query or hit object of a variable; numbers are given on first use
  void hand_over_attributes();  // to the buffer that the next report reads
  uint32_t attribute_buffers();  // bytes in the frame of the two buffers of 64 bytes
  void note_store(Place place);  // loads of that place are not reused any more

  // --- Reports
  void unsupported(const std::string& what);  // at the present line
  void unsupported(const std::string& what, isa::Line line);

  Emitter& emit() { return emitter_; }
  Layout& layout() { return layout_; }
  const Module& module() const { return module_; }
  VirtualProgram& program() { return program_; }
  isa::Stage stage() const { return program_.stage; }
  const Decorations& decorations(Id id) const;

 private:
  bool is_in_interface(Id variable) const;
  void choose_entry_point();
  void index_definitions();
  void check_capabilities();
  void note_interface();
  void choose_attribute_place();
  Operands constant_parts(Id id);
  Operands specialised_parts(const Instruction& constant);
  Pointer variable_pointer(const Variable& variable);
  Pointer buffer_pointer(const Variable& variable, Pointer pointer);
  Pointer pointer_from_value(Id id);
  uint32_t shared_offset(Id variable);
  void set_zero(const Instruction& inst);
  void throw_if_unsupported() const;

  const Module& module_;
  const EntryPoint& entry_;
  const bool contract_;
  Layout layout_;
  VirtualProgram program_;
  Emitter emitter_;
  const Function* function_ = nullptr;
  std::map<Id, Operands> values_;
  std::map<Id, Pointer> pointers_;
  std::map<Id, Id> type_of_id_;
  std::map<Id, const Instruction*> definition_;
  std::map<Id, Variable> local_variables_;  // Function storage
  std::map<Id, uint32_t> frame_;            // variable to byte offset
  std::map<Id, uint32_t> shared_;           // the same for shared memory
  std::map<Id, uint32_t> ray_queries_;      // variable to its first query
  uint32_t num_ray_queries_ = 0;
  uint32_t attribute_buffers_ = 0xffff'ffff;
  bool attributes_in_frame_ = false;  // of an intersection shader that may report more than once
  uint64_t local_version_ = 1, global_version_ = 1, shared_version_ = 1;  // of memory, for the reuse of loads
  uint64_t& version_of(Place place);
  std::map<std::tuple<uint16_t, uint32_t, std::string>, int> unsupported_;  // file, line, what: how often
  std::set<Id> reported_types_;
};

// A trace (docs/abi.md, Calls and rays). Arguments: structure, flags, mask, offset, stride, miss index,
// origin, t min, direction, t max. `finish` is emitted when the rays have found what they find.
void lower_trace(ModuleLowering& lowering, std::span<const uint32_t> arguments, const Pointer& payload,
                 const std::function<void()>& finish);
// The lane's local address that a pointer means, in a register.
Operand local_address(ModuleLowering& lowering, const Pointer& pointer);
Operand attribute_buffers_address(ModuleLowering& lowering);
// After shaders have run: nothing that was read from memory or computed before is used again.
void forget_after_call(ModuleLowering& lowering);

// Lowers all reachable blocks of the entry function: phis, structured control flow, terminators.
void lower_control(ModuleLowering& lowering);

// Capabilities that add nothing to lower, or only opcodes that are reported one by one where they stand.
bool is_known_capability(spv::Capability capability);

// A displacement that the 32-bit field of an instruction cannot hold goes into the base.
Pointer in_reach(ModuleLowering& lowering, Pointer pointer);

// Fuses sums with products that nothing else reads; both of `free`, the registers of products and sums that
// may fuse.
void contract(VirtualProgram* program, const std::set<VirtualRegister>& free);

// Removes instructions whose results nobody reads and that do nothing else.
void remove_dead_code(VirtualProgram* program);

}  // namespace glint::frontend
