// Lowers calls of functions that a GPU's runtime brings: printing, failed assertions and the heap.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "frontend/backend/slots.h"
#include "frontend/message_numbers.h"
#include "frontend/ptx/lowering.h"
#include "isa/generic_address.h"
#include "isa/message.h"

namespace glint::frontend::ptx {

bool KernelLowering::lower_runtime_call(const Call& call) {
  // Source: CUDA C++ Programming Guide, "Formatted Output", "Assertion" and "Dynamic Global Memory
  // Allocation"; nvcc declares the functions with these names and numbers of parameters.
  struct Row {
    size_t parameters, results;
    void (KernelLowering::*lower)(const Call& call, const std::vector<Symbol>& parameters);
  };
  static const std::map<std::string, Row, std::less<>> kRows{
      {"vprintf", {2, 1, &KernelLowering::lower_vprintf}},
      {"__assertfail", {5, 0, &KernelLowering::lower_assertfail}},
      {"malloc", {1, 1, &KernelLowering::lower_malloc}},
      {"free", {1, 0, &KernelLowering::lower_free}}};
  const auto row = kRows.find(call.name);
  if (row == kRows.end() || call.arguments.size() != row->second.parameters ||
      call.results.size() != row->second.results)
    return false;
  std::vector<Symbol> parameters;
  for (size_t i = 0; i < call.arguments.size(); ++i)
    parameters.push_back(words_for(call.callee->parameters[i], &call.arguments[i]));
  (this->*row->second.lower)(call, parameters);
  return true;
}

// Gives the call's result, a word or a pair.
void KernelLowering::give_result(const Call& call, const VirtualOperand& value, bool wide) {
  Symbol symbol;
  symbol.type = {'b', wide ? 64u : 32u};
  symbol.reg = temporary(class_of(symbol.type));
  emit(isa::op_index(wide ? "mov.b64" : "mov.b32"), {VirtualOperand::of(symbol.reg), value});
  const Symbol* given = find(call.results[0].name);
  if (!given || given->kind != Symbol::Kind::Parameter) return copy_result(symbol, call.results[0]);
  if (!wide)
    emit(isa::op_index("mov.b32"), {VirtualOperand::of(given->elements[0]), VirtualOperand::of(symbol.reg)});
  else
    emit(isa::op_index("unpack.b64"),
         {VirtualOperand::of(given->elements[0]), VirtualOperand::of(given->elements[1]),
          VirtualOperand::of(symbol.reg)});
}

VirtualOperand KernelLowering::pointer_of(const Symbol& parameter) {
  return compute64("pack.b64",
                   {VirtualOperand::of(parameter.elements[0]), VirtualOperand::of(parameter.elements[1])});
}

// Returns the instruction that alone writes the register, or null.
const VirtualInst* KernelLowering::definition(VirtualRegister r) const {
  const VirtualInst* found = nullptr;
  for (const DraftBlock& block : draft_.blocks)
    for (const VirtualInst& inst : block.code) {
      bool writes = false;
      for_each_def(inst, [&](VirtualRegister written) { writes |= written == r; });
      if (!writes) continue;
      if (found) return nullptr;
      found = &inst;
    }
  return found;
}

// Returns the text at the address that a parameter holds, if it is the address of a variable of the module
// that begins with characters. The address is followed back through moves.
std::optional<std::string> KernelLowering::constant_text(const Symbol& parameter) const {
  VirtualRegister at = parameter.elements[0];
  for (const VirtualInst* inst = definition(at); inst; inst = definition(at)) {
    const std::string_view op = isa::op_table()[inst->op].name;
    const bool is_move = op == "mov.b32" || op == "mov.b64";
    if (op == "ld.param.b64") return text_of_variable(uint64_t(inst->imm));
    const size_t source = op == "unpack.b64" ? 2 : 1;
    if ((!is_move && op != "unpack.b64" && op != "pack.b64") ||
        inst->operands[source].kind != VirtualOperand::Kind::Register)
      return {};
    at = inst->operands[source].reg;
  }
  return {};
}

// Returns the characters of the variable whose address lies at that place of the constant bank.
std::optional<std::string> KernelLowering::text_of_variable(uint64_t place) const {
  for (const auto& [name, symbol] : placed_) {
    if (symbol.space != VariableSpace::Global || symbol.address != place) continue;
    std::string text;
    for (const Initializer& value : module_variables_.at(name)->initial) {
      if (!value.symbol.empty() || value.value == 0) break;
      text += char(value.value);
    }
    return text;
  }
  return {};
}

// Appends a print of `text`, whose conversions take `words`.
void KernelLowering::print(const std::string& text, std::vector<VirtualOperand> words, bool ends) {
  std::vector<VirtualOperand> operands{VirtualOperand::value(number_of_message(program_.messages, text))};
  operands.insert(operands.end(), words.begin(), words.end());
  operands.resize(1 + isa::kMessageWords, VirtualOperand::value(0));
  compute(ends ? "print" : "print.part", std::move(operands));
}

namespace {

// Cuts a format of printf into messages of at most isa::kMessageWords words, each of which ends where a line
// does or where the next value has no room.
struct FormatCutter {
  struct Value {
    isa::Conversion conversion;
    char length = '\0';  // b: hh, h: h, l: l, ll and others of 64 bits
  };
  struct Part {
    std::string text;
    std::vector<Value> values;
    bool ends = false;
  };
  std::vector<Part> parts;
  std::string error;  // empty: the format is well formed

  explicit FormatCutter(const std::string& format) {
    Part part;
    size_t words = 0;
    const auto end = [&](bool ends) {
      part.ends = ends;
      parts.push_back(std::move(part));
      part = {}, words = 0;
    };
    for (size_t at = 0; at < format.size() && error.empty(); ++at) {
      if (format[at] != '%') {
        part.text += format[at];
        if (format[at] == '\n') end(true);
      } else if (at + 1 < format.size() && format[at + 1] == '%') {
        part.text += "%%", ++at;
      } else {
        Value value;
        at = read(format, at, value);
        const size_t size = value.conversion.is_wide ? 2 : 1;
        if (words + size > isa::kMessageWords) end(false);
        words += size;
        part.text += isa::to_text(value.conversion);
        part.values.push_back(value);
      }
    }
    if (!part.text.empty()) end(false);
  }

 private:
  // Reads one conversion and returns the place of its letter.
  size_t read(const std::string& format, size_t first, Value& value) {
    isa::Conversion& c = value.conversion;
    size_t at = isa::parse_flags(format, first + 1, c);
    const auto is = [&](char letter) { return at < format.size() && format[at] == letter; };
    for (; is('h') || is('l') || is('z') || is('j') || is('t') || is('L') || is('q'); ++at)
      value.length = !is('h') ? 'l' : value.length == 'h' ? 'b' : 'h';
    c.letter = at < format.size() ? format[at] : '\0';
    const std::string spelled = format.substr(first, at + 1 - first);
    if (is('*'))
      error = fmt::format("'{}' takes its width from an argument, which Glint does not do", spelled);
    else if (c.letter == '\0' ||
             std::string_view("diuxXofFeEgGaAcsp").find(c.letter) == std::string_view::npos)
      error = fmt::format("'{}' is not a conversion", spelled);
    else if (std::max(c.width, c.precision) > isa::kMaxMessageWidth)
      error = fmt::format("'{}' has more than {} characters", spelled, isa::kMaxMessageWidth);
    c.is_wide =
        isa::is_float(c) || c.letter == 's' || c.letter == 'p' || (value.length == 'l' && c.letter != 'c');
    if (c.letter == 'p') c.letter = 'x', c.alternative = true;
    return at;
  }
};

}  // namespace

// Lowers a printf. Its arguments lie in memory, each at a multiple of its size; smaller numbers have become
// int or double.
void KernelLowering::lower_vprintf(const Call& call, const std::vector<Symbol>& parameters) {
  const std::optional<std::string> format = constant_text(parameters[0]);
  if (!format)
    return no_support({int(line_.line), 1},
                      "not supported: a printf whose format is not a constant of the module");
  const FormatCutter cut(*format);
  if (!cut.error.empty())
    return error({int(line_.line), 1}, fmt::format("the format \"{}\" of a printf: {}", *format, cut.error));
  const VirtualOperand arguments = pointer_of(parameters[1]);
  int64_t at = 0;
  uint32_t count = 0;
  for (const FormatCutter::Part& part : cut.parts) {
    std::vector<VirtualOperand> words;
    for (const auto& [conversion, length] : part.values) {
      ++count;
      const int64_t bytes = conversion.is_wide ? 8 : 4;
      at = (at + bytes - 1) / bytes * bytes;
      for (int64_t word = 0; word < bytes; word += 4) {
        words.push_back(VirtualOperand::of(temporary(RegisterClass::B32)));
        compute("ld.b32", {words.back(), arguments}, at + word);
      }
      at += bytes;
      if (length != 'h' && length != 'b') continue;
      const bool is_signed = conversion.letter == 'd' || conversion.letter == 'i';
      words.back() =
          compute32(is_signed ? "bfe.s32" : "bfe.u32",
                    {words.back(), VirtualOperand::value(0), VirtualOperand::value(length == 'h' ? 16 : 8)});
    }
    print(part.text, std::move(words), part.ends);
  }
  give_result(call, VirtualOperand::value(count), false);
}

// Lowers what an assertion does that does not hold: it prints what it was, and the launch ends.
void KernelLowering::lower_assertfail(const Call&, const std::vector<Symbol>& parameters) {
  const auto text = [&](size_t i) {
    std::string out;
    for (char c : constant_text(parameters[i]).value_or("?")) out += c == '%' ? "%%" : std::string(1, c);
    return out;
  };
  print(fmt::format("{}:%u: {}: Assertion `{}` failed.", text(1), text(3), text(0)),
        {VirtualOperand::of(parameters[2].elements[0])}, true);
  compute("trap", {});
}

// Returns the place of the heap's address in the constant bank. The heap begins with the number of bytes that
// are in use, and its blocks lie behind its first kHeapHeader bytes.
uint64_t KernelLowering::heap_place() {
  if (heap_place_) return *heap_place_;
  bank_bytes_ = (bank_bytes_ + 7) / 8 * 8;
  heap_place_ = bank_bytes_;
  bank_bytes_ += 8;
  ModuleVariable heap;
  heap.name = "(heap)";
  heap.bytes = kHeapHeader + options_.heap_bytes;
  heap.offset = uint32_t(isa::kPushConstantOffset + *heap_place_);
  kernel_.variables.push_back(std::move(heap));
  return *heap_place_;
}

// Takes a block from the end of what is in use. Model: hardware looks for a block that was given back, which
// takes much longer. Choice: when there is no room the result is null, as in CUDA, also for 0 bytes.
void KernelLowering::lower_malloc(const Call& call, const std::vector<Symbol>& parameters) {
  constexpr uint64_t kAlignment = 16;
  const auto value = [](uint64_t v) { return VirtualOperand::value(v); };
  const VirtualOperand bytes = pointer_of(parameters[0]);
  const VirtualOperand rounded =
      compute64("and.b64", {compute64("add.u64", {bytes, value(kAlignment - 1)}), value(~(kAlignment - 1))});
  const VirtualOperand heap = VirtualOperand::of(temporary(RegisterClass::B64));
  compute("ld.param.b64", {heap, value(0)}, int64_t(heap_place()));
  // A size that could never fit takes nothing, so that the sum cannot overflow.
  const VirtualOperand fits_at_all = compute_predicate("setp.le.u64", {bytes, value(options_.heap_bytes)});
  const VirtualOperand taken = compute64("selp.b64", {rounded, value(0), fits_at_all});
  const VirtualOperand before = VirtualOperand::of(temporary(RegisterClass::B64));
  compute("atom.global.add.u64", {before, heap, taken});
  const VirtualOperand after = compute64("add.u64", {before, taken});
  const VirtualOperand has_room = compute_predicate("setp.le.u64", {after, value(options_.heap_bytes)});
  const VirtualOperand some = compute_predicate("setp.ne.u64", {taken, value(0)});
  const VirtualOperand is_given = compute_predicate("and.pred", {has_room, some});
  // What did not fit is given back, so that a smaller block may still fit.
  const VirtualOperand back = compute64("selp.b64", {value(0), compute64("neg.s64", {taken}), has_room});
  compute("red.global.add.u64", {heap, back});
  const VirtualOperand block =
      compute64("add.u64", {compute64("add.u64", {heap, value(kHeapHeader)}), before});
  give_result(call, compute64("selp.b64", {block, value(0), is_given}), true);
}

// Model: a block that is given back is not used again.
void KernelLowering::lower_free(const Call&, const std::vector<Symbol>&) {
}

}  // namespace glint::frontend::ptx
