// Lowers one SPIR-V module to a VirtualProgram. This file holds what the families of lowering functions
// share.
//
// Every SSA value is a list of scalar operands. Each SPIR-V opcode has one row in a table, and a row names a
// function that reads the operands of one instruction and emits code. An unsupported op is noted and gets the
// value 0, so that one run finds all unsupported ops; lower_to_virtual() then throws.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "frontend/lower/emitter.h"
#include "frontend/lower/layout.h"
#include "frontend/spirv/module.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Runs the lowering without the backend, for tests and for `--emit virtual`. Throws UnsupportedError as
// lower() does.
VirtualProgram lower_to_virtual(const std::vector<uint32_t>& spirv, const std::string& name,
                                const std::string& entry_point = {}, bool contract = false,
                                bool reorders = false);

// Says what memory a pointer points into. An AttributePair is hit attributes of two or three floats, of which
// hit shaders find the first two in %hit.u and %hit.v. A Resource is a descriptor; a buffer is one only while
// the index into an array of descriptors is missing. A Texel is a texel of a storage image, for atomics.
enum class PointerSpace : uint8_t {
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
  Id type = 0;  // type of the pointee
  PointerSpace space = PointerSpace::Nowhere;
  // Local, Shared and Constant have a 32-bit address here, Global has a 64-bit address, and Resource and
  // RayQuery have an index.
  Operand base = Operand::value(0);
  int64_t displacement = 0;       // bytes; for Builtin and AttributePair, parts
  uint32_t alignment = 16;        // of base, in bytes
  uint32_t known_alignment = 0;   // of base and displacement together, in bytes; 0: unknown
  uint32_t component_stride = 0;  // bytes; not 0 in a column of a row-major matrix
  MatrixLayout matrix;
  Id variable = 0;                         // variable that the pointer leads to
  bool is_constant = false;                // No shader writes the memory.
  bool is_volatile = false;                // Two loads may give different values.
  Operand part_index = Operand::value(0);  // Builtin, AttributePair: dynamic part index
  Operand entry;                           // Global, in an array of buffers: address of the descriptor
  Operand table;                           // Resource, from a pointer value: address of descriptor 0
  Operands texel;                          // Texel: handle, layer of an array, coordinates
  std::string_view shape;                  // Texel: the geometry as image ops name it
};

// Is the null of pointers to shared memory, and to memory of one lane. It is not 0, because a variable may
// lie at address 0 there. No variable begins at the last byte.
inline constexpr uint32_t kNullAddress = 0xffff'ffff;

inline Pointer nowhere(Id pointee) {
  Pointer pointer;
  pointer.type = pointee;
  return pointer;
}

class ModuleLowering;
struct LoweringRow {
  spv::Op op;
  void (*lower)(ModuleLowering&, const Instruction&, const LoweringRow&);
  std::string_view name32;  // ISA op for 32-bit parts, if the family uses one; see typed.h
  std::string_view name64 = {};
};
// Each family has one table; find_lowering_row() searches them all.
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

// Lowers a function of the GLSL.std.450 instruction set. operands[0] is the import and operands[1] the
// function's number.
void lower_glsl_std(ModuleLowering& lowering, const Instruction& inst);
// Lowers a function of a vendor's set. Returns false where the function is unknown.
bool lower_vendor_set(ModuleLowering& lowering, const std::string& set, const Instruction& inst);
// Lowers NonSemantic.DebugPrintf, whose format is operands[2]. Throws UserError when the format does not fit
// its arguments.
void lower_print(ModuleLowering& lowering, const Instruction& inst);

class ModuleLowering {
 public:
  // `contract` allows products and sums to become one op (contract.cpp). `reorders` is
  // BackendOptions::reorder_calls.
  ModuleLowering(const Module& module, const std::string& name, const EntryPoint& entry,
                 bool contract = false, bool reorders = false);
  VirtualProgram run();
  bool reorders() const { return reorders_; }

  // --- Control. lower_control() calls these functions block by block.
  void prologue();                            // emits initialisers of variables
  void instruction(const Instruction& inst);  // lowers any instruction except phis and terminators
  const Function& function() const { return *function_; }

  // --- Values
  const Operands& value(Id id);  // a constant is made at its first use
  Operand scalar(Id id) { return value(id).at(0); }
  Operand word(Id id);  // an integer as 32 bits: 64 bits are cut, narrow signed integers are extended
  void set(Id id, Operands parts);
  Pointer pointer(Id id);
  void set_pointer(Id id, Pointer pointer) { pointers_[id] = pointer; }
  Id type_of(Id id) const { return type_of_id_.at(id); }
  const Instruction* definition(Id id) const;  // in the function; null for constants and variables

  // Returns the type of the first part. All parts of one value have the same type, except in structs.
  Part part_of(Id type);

  // --- Memory
  Operands load(const Pointer& pointer);
  void store(const Pointer& pointer, const Operands& parts);
  Operands load_builtin(spv::BuiltIn builtin, Id type);
  std::optional<Operand> address_of(Id pointer);  // none: not a pointer that is a value
  // Returns none for a built-in that is not of compute shaders or subgroups.
  std::optional<Operands> load_compute_builtin(spv::BuiltIn builtin);
  // Returns the address of the descriptor for an index into an array of buffers.
  Operand buffer_entry(const Pointer& pointer);
  // Turns the index of a buffer in an array into a pointer to that buffer.
  Pointer buffer_element(Pointer pointer);
  uint32_t local_offset(Id variable);  // bytes in the frame; allocated at the first use
  // Returns the number of the first query or hit object of a variable, which is assigned at the first use.
  uint32_t ray_query(Id variable);
  void hand_over_attributes();          // copies to the buffer that the next report reads
  uint32_t attribute_buffers();         // offset in the frame of the two buffers of 64 bytes
  void note_store(PointerSpace space);  // loads of that space are not reused any more

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
  Pointer interface_pointer(const Variable& variable, Pointer p);
  Pointer buffer_pointer(const Variable& variable, Pointer pointer);
  Pointer pointer_from_value(Id id);
  uint32_t shared_offset(Id variable);
  void set_zero(const Instruction& inst);
  void throw_if_unsupported() const;

  const Module& module_;
  const EntryPoint& entry_;
  const bool contract_, reorders_;
  Layout layout_;
  VirtualProgram program_;
  Emitter emitter_;
  const Function* function_ = nullptr;
  std::map<Id, Operands> values_;
  std::map<Id, Pointer> pointers_;
  std::map<Id, Id> type_of_id_;
  std::map<Id, const Instruction*> definition_;
  std::map<Id, Variable> local_variables_;  // variables of Function storage
  std::map<Id, uint32_t> frame_;            // byte offset of each variable
  std::map<Id, uint32_t> shared_;           // byte offset of each variable in shared memory
  std::map<Id, uint32_t> ray_queries_;      // first query of each variable
  uint32_t num_ray_queries_ = 0;
  uint32_t attribute_buffers_ = 0xffff'ffff;
  bool attributes_in_frame_ = false;  // set for an intersection shader that may report more than once
  // The versions of memory decide whether a load may be reused.
  uint64_t local_version_ = 1, global_version_ = 1, shared_version_ = 1;
  uint64_t& version_of(PointerSpace space);
  std::map<std::tuple<uint16_t, uint32_t, std::string>, int> unsupported_;  // file, line, what: count
  std::set<Id> reported_types_;
};

// Lowers a trace (docs/abi.md, Calls and rays). The arguments are: structure, flags, mask, offset, stride,
// miss index, origin, t min, direction, t max. `finish` emits the code that runs after the traversal.
void lower_trace(ModuleLowering& lowering, std::span<const uint32_t> arguments, const Pointer& payload,
                 const std::function<void()>& finish);
// Returns the lane's local address of a pointer, in a register.
Operand local_address(ModuleLowering& lowering, const Pointer& pointer);
Operand attribute_buffers_address(ModuleLowering& lowering);
// Forgets everything that was read from memory or computed, because other shaders have run.
void forget_after_call(ModuleLowering& lowering);

// Lowers all reachable blocks of the entry function: phis, structured control flow, terminators.
void lower_control(ModuleLowering& lowering);

// Returns true for capabilities that need no lowering, or that only add opcodes which are reported where they
// are used.
bool is_known_capability(spv::Capability capability);

// Adds a displacement to the base if the 32-bit field of an instruction cannot hold it.
Pointer in_reach(ModuleLowering& lowering, Pointer pointer);

// Fuses sums with products that nothing else reads. `free` holds the results of products and sums that may
// fuse.
void contract(VirtualProgram* program, const std::set<VirtualRegister>& free);

// Removes instructions that have no effect and whose results nobody reads.
void remove_dead_code(VirtualProgram* program);

}  // namespace glint::frontend
