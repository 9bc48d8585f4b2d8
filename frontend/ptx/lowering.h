// Lowers one kernel from its text to graphs of blocks: one for the kernel, with most functions inlined, and
// one for each function that has code of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/ptx/call_graph.h"
#include "frontend/ptx/contraction.h"
#include "frontend/ptx/draft.h"
#include "frontend/ptx/ptx.h"
#include "frontend/ptx/row_names.h"
#include "frontend/ptx/syntax.h"

namespace glint::frontend::ptx {

// Says what a name means.
struct Symbol {
  enum class Kind : uint8_t {
    Register,   // held in `reg`, or in `elements` for .v2 and .v4
    Variable,   // at `address` of its space
    Parameter,  // of a function; `elements` are its 32-bit words
    Label,      // of `block`
    Targets,    // list of a brx.idx or of a call through a register
    Prototype   // of a call through a register
  } kind = Kind::Register;
  Type type;
  VirtualRegister reg = kNoRegister;
  std::vector<VirtualRegister> elements;
  VariableSpace space = VariableSpace::Global;
  // For Global, this is the place of the variable's address in the constant bank, from kPushConstantOffset.
  uint64_t address = 0;
  BlockId block = kNoBlock;
  const std::vector<std::string>* targets = nullptr;
  const Signature* signature = nullptr;  // of a Prototype
};

struct Scope {
  std::map<std::string, Symbol> names;
  std::vector<const Declaration*> ranges;  // such as .reg .b32 %r<10>
  bool is_function = false;                // names not found here are looked up in the module
};

struct VideoForm;       // what the words of a video instruction ask for (lowering_video.cpp)
struct FragmentAccess;  // where the parts of a wmma fragment lie in memory (lowering_fragments.cpp)

// Holds a move of a result to a register that is wider or narrower than the row's.
struct LateMove {
  uint16_t op;
  VirtualOperand to, from;
};

class KernelLowering {
 public:
  KernelLowering(const Module& module, const Function& entry, const PtxOptions& options, Kernel& kernel,
                 Diagnostics& errors, Diagnostics& unsupported);
  // Returns the programs before register allocation: the kernel, and then the functions that it calls.
  // Mistakes are reported to the diagnostics.
  std::vector<VirtualProgram> run();
  uint64_t static_shared_bytes() const { return static_shared_; }

 private:
  // These functions are in lowering_variables.cpp.
  void place_parameters();
  void place_variables();
  void collect_names(const std::vector<Statement>& statements, std::set<std::string>& used);
  void place_shared(const std::vector<const Declaration*>& declarations);
  Symbol module_variable(const Declaration& d);
  void declare(const Declaration& d);

  // These functions are in lowering.cpp: bodies, names, blocks, statements.
  VirtualProgram lower_body(const Function& f);
  void statements(const std::vector<Statement>& list);
  void predeclare_labels(const std::vector<Statement>& list);
  void lower(const Instruction& inst);
  void zero_what_nobody_wrote(VirtualProgram& program);

  const Symbol* find(const std::string& name);
  Symbol* find_range(Scope& scope, const std::string& name);
  BlockId new_block(const std::string& name);
  void begin(BlockId block);
  void end_goto(BlockId next);
  void end_branch(VirtualRegister condition, bool negate, BlockId taken, BlockId next, bool uniform);
  void end_exit();

  SourceLocation where(TextPosition position) const { return {module_.file, position.line, position.column}; }
  void error(TextPosition position, const std::string& what, const std::string& note = {}) {
    errors_.error(where(position), what, note);
  }
  void no_support(TextPosition position, const std::string& what, const std::string& note = {}) {
    unsupported_.error(where(position), what, note);
  }

  // This function is in lowering_types.cpp.
  void check_types(const Instruction& inst);

  // These functions are in lowering_operands.cpp.
  VirtualRegister temporary(RegisterClass c) { return program_.new_register(c); }
  // emit() appends an instruction under the guard of the PTX instruction. compute() appends one without a
  // guard, for temporaries.
  VirtualInst& emit(int op, std::vector<VirtualOperand> operands, int64_t imm = 0);
  VirtualInst& compute(std::string_view op, std::vector<VirtualOperand> operands, int64_t imm = 0);
  VirtualOperand compute32(std::string_view op, std::vector<VirtualOperand> sources);
  VirtualOperand compute64(std::string_view op, std::vector<VirtualOperand> sources);
  VirtualOperand compute_predicate(std::string_view op, std::vector<VirtualOperand> sources);
  VirtualOperand source(const Operand& o, isa::OperandKind kind, const Type& type);
  VirtualOperand name_source(const Operand& o, bool wide);
  VirtualOperand special_source(const Operand& o, bool wide, bool& found);
  VirtualOperand literal(const Operand& o, bool wide, const Type& type);
  VirtualOperand predicate_source(const Operand& o);
  VirtualOperand destination(const Operand& o, isa::OperandKind kind, const Type& type);
  VirtualOperand widened(VirtualOperand narrow, bool with_sign);
  VirtualOperand address_of(const Symbol& symbol, int64_t offset, bool wide);
  VirtualOperand address(const Operand& o, bool wide, int64_t& imm);
  VirtualRegister predicate_register(const std::string& name, TextPosition position);
  const Symbol* register_symbol(const Operand& o);
  void finish_moves();

  // These functions are in lowering_instructions.cpp.
  bool lower_special(const Instruction& inst);
  void lower_row(const Instruction& inst, int row, std::vector<const Operand*> operands);
  void lower_generic(const Instruction& inst);
  bool lower_half_conversion(const Instruction& inst);
  void lower_move(const Instruction& inst);
  void lower_vector_move(const Instruction& inst);
  void join_parts(const Instruction& inst, const Operand& to, const std::vector<Operand>& parts);
  void split_parts(const Instruction& inst, const std::vector<Operand>& parts, const Operand& from);
  void lower_setp(const Instruction& inst);
  void lower_carry(const Instruction& inst);
  void lower_address_conversion(const Instruction& inst);
  void lower_barrier(const Instruction& inst);
  void lower_fence(const Instruction& inst);
  void lower_old_warp_op(const Instruction& inst);
  void report_no_row(const Instruction& inst);
  void note_free_arithmetic(const Instruction& inst, const std::vector<VirtualOperand>& operands);

  // These functions are in lowering_video.cpp.
  bool lower_video(const Instruction& inst);
  VirtualOperand video_result(const Instruction& inst, const VideoForm& form, VirtualOperand third);
  void finish_video(const Instruction& inst, VirtualOperand result, VirtualOperand third, bool adds);

  // These functions are in lowering_tensor.cpp.
  bool lower_tensor(const Instruction& inst);
  std::vector<VirtualOperand> registers_to(const Operand& o, isa::OperandKind kind);
  std::vector<VirtualOperand> registers_from(const Operand& o, isa::OperandKind kind);
  bool has_registers(const Instruction& inst, std::vector<size_t> wanted);
  void multiply(int row, const std::vector<VirtualOperand>& d, const std::vector<VirtualOperand>& a,
                const std::vector<VirtualOperand>& b, const std::vector<VirtualOperand>& c);
  void lower_product(const Instruction& inst);
  void lower_fp8_product(const Instruction& inst);
  void lower_double_product(const Instruction& inst);
  void lower_matrix_access(const Instruction& inst);

  // These functions are in lowering_fragments.cpp.
  void lower_fragments(const Instruction& inst);
  void lower_fragment_product(const Instruction& inst);
  void lower_fragment_access(const Instruction& inst);
  std::vector<VirtualOperand> singles_of(const std::vector<VirtualOperand>& pairs);
  std::vector<VirtualOperand> halves_of(const std::vector<VirtualOperand>& singles);
  void access_whole_words(const FragmentAccess& access);
  void access_transposed(const FragmentAccess& access);
  void access_elements(const FragmentAccess& access);
  void load_by_rows(const FragmentAccess& access);
  template <class Visit>
  void for_each_place(const FragmentAccess& access, bool across, uint32_t elements, Visit&& visit);
  VirtualOperand line_address(const FragmentAccess& access, VirtualOperand index, VirtualOperand more);

  // These functions are in lowering_async.cpp.
  bool lower_async(const Instruction& inst);
  void lower_copy(const Instruction& inst);
  void lower_copy_group(const Instruction& inst);
  void lower_copy_arrival(const Instruction& inst);
  void lower_mbarrier(const Instruction& inst);
  void lower_pending_count(const Instruction& inst);
  VirtualOperand source_bytes(const Instruction& inst, const Operand& o, uint32_t bytes);
  VirtualOperand whole_address(const Operand& o);
  VirtualOperand barrier_address(const Operand& o, bool is_generic, int64_t& imm);

  // These functions are in lowering_textures.cpp.
  bool lower_image(const Instruction& inst);
  void lower_image_row(const Instruction& inst);
  void lower_surface_bits(const Instruction& inst);
  std::vector<VirtualOperand> image_place(const Instruction& inst, const Operand& at,
                                          const isa::ImageAccess& image);

  // These functions are in lowering_memory.cpp.
  void lower_memory(const Instruction& inst);
  void lower_atomic(const Instruction& inst, const MemoryForm& form);
  void lower_access(const Instruction& inst, const MemoryForm& form);
  void access_parts(const Instruction& inst, MemoryForm form, const std::vector<const Operand*>& parts,
                    const Operand& at);
  void load_short_parts(const MemoryForm& form, const std::vector<const Operand*>& parts, const Operand& at);
  void access_pairs(const Instruction& inst, const MemoryForm& form, int row,
                    const std::vector<const Operand*>& parts, const Operand& at);
  void access_words(const Instruction& inst, const MemoryForm& form, const Symbol& words, int64_t offset,
                    const std::vector<const Operand*>& parts);
  void load_word_part(const MemoryForm& form, const Symbol& words, uint32_t at, const Operand& to);
  void store_word_part(const MemoryForm& form, const Symbol& words, uint32_t at, const Operand& from);

  // These functions are in lowering_control.cpp.
  bool lower_control(const Instruction& inst);
  void lower_branch(const Instruction& inst);
  void lower_indexed_branch(const Instruction& inst);
  void lower_return(const Instruction& inst, bool whole_kernel);
  BlockId label(const std::string& name, TextPosition position);

  // These functions are in lowering_calls.cpp.
  struct Call {
    const Function* callee = nullptr;  // null: a call through a register
    const Signature* signature = nullptr;
    std::string name;
    VirtualOperand number;  // of the function (CallGraph::number_of)
    std::vector<Operand> results, arguments;
  };
  void lower_call(const Instruction& inst);
  bool find_callee(const Instruction& inst, const Operand& name, size_t at, Call& call);
  void inline_call(const Call& call, BlockId behind);
  void call_function(const Call& call);
  void lower_function(const Function& f);
  Symbol bind_parameter(const Declaration& formal, const Operand* actual);
  Symbol words_for(Declaration formal, const Operand* actual);
  void copy_result(const Symbol& symbol, const Operand& to);
  void move_frame_words(bool is_store, const VirtualOperand& frame, uint32_t at,
                        const std::vector<VirtualRegister>& words);

  // These functions are in lowering_runtime.cpp.
  bool lower_runtime_call(const Call& call);
  void lower_vprintf(const Call& call, const std::vector<Symbol>& parameters);
  void lower_assertfail(const Call& call, const std::vector<Symbol>& parameters);
  void lower_malloc(const Call& call, const std::vector<Symbol>& parameters);
  void lower_free(const Call& call, const std::vector<Symbol>& parameters);
  void give_result(const Call& call, const VirtualOperand& value, bool wide);
  void print(const std::string& text, std::vector<VirtualOperand> words, bool ends);
  VirtualOperand pointer_of(const Symbol& parameter);
  const VirtualInst* definition(VirtualRegister r) const;
  std::optional<std::string> constant_text(const Symbol& parameter) const;
  std::optional<std::string> text_of_variable(uint64_t place) const;
  uint64_t heap_place();

  const Module& module_;
  const Function& entry_;
  const PtxOptions& options_;
  Kernel& kernel_;
  Diagnostics& errors_;
  Diagnostics& unsupported_;
  VirtualProgram program_;
  Draft draft_;
  BlockId block_ = kNoBlock;  // block under construction; kNoBlock: the code that follows is unreachable
  std::vector<Scope> scopes_;
  std::map<std::string, const Declaration*> module_variables_;
  std::map<std::string, const Function*> functions_;
  std::map<const Declaration*, uint64_t> shared_;  // offsets of static shared variables
  std::map<std::string, Symbol> placed_;           // variables of the module that the kernel uses
  uint32_t bank_bytes_ = 0;                        // bytes used, from kPushConstantOffset
  uint64_t static_shared_ = 0;
  std::optional<uint64_t> heap_place_;  // heap_place(), once it is there
  const CallGraph graph_;
  std::vector<BlockId> returns_to_;  // where `ret` goes, in open inlined functions and in a called one
  VirtualRegister guard_ = kNoRegister;
  bool guard_negate_ = false;
  isa::Line line_;
  std::vector<LateMove> late_;  // emitted after the instruction
  FreeArithmetic free_;
};

// Puts each call of a function, the stores of its parameters before it and the loads of its results behind it
// between SaveLive and RestoreLive. It runs after the passes that change drafts, which do not know regions.
void enclose_calls(VirtualProgram& program);

// Returns the parts of an operand in braces, or the operand itself where it stands without them.
std::vector<const Operand*> parts_of(const Operand& o);

// Returns the class of a PTX register: 8, 16 and 32 bits need one register of the ISA, 64 bits need a pair.
RegisterClass class_of(const Type& type);

}  // namespace glint::frontend::ptx
