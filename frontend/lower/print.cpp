// Lowers debugPrintfEXT. The format is matched with its arguments at compile time, and vectors become their
// components.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "base/diagnostics.h"
#include "frontend/lower/lowering.h"
#include "frontend/lower/typed.h"
#include "frontend/message_numbers.h"
#include "isa/message.h"

namespace glint::frontend {
namespace {

class Print {
 public:
  Print(ModuleLowering& l, const Instruction& inst, const std::string& format)
      : l_(l), format_(format), arguments_(inst.operands.begin() + 3, inst.operands.end()) {}

  void run() {
    for (size_t at = 0; at < format_.size(); ++at) {
      if (format_[at] != '%') {
        text_ += format_[at];
      } else if (at + 1 < format_.size() && format_[at + 1] == '%') {
        text_ += "%%", ++at;
      } else {
        at = conversion(at) - 1;
      }
    }
    if (next_ != arguments_.size())
      fail(fmt::format("the format takes {} arguments, the call gives {}", next_, arguments_.size()));
    end_message("print");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const isa::Line line = l_.emit().line();
    const auto& files = l_.module().files;
    const std::string file =
        line.line != 0 && line.file < files.size() ? files[line.file] : l_.program().name;
    throw UserError({file, int(line.line), 0}, fmt::format("debugPrintfEXT(\"{}\"): {}", format_, what));
  }

  // Reads one conversion, such as "%1.2v4f". Returns where the text goes on.
  size_t conversion(size_t first) {
    isa::Conversion c;
    size_t at = isa::parse_flags(format_, first + 1, c);
    if (at < format_.size() && format_[at] == 'v') {
      const uint32_t count = at + 1 < format_.size() ? uint32_t(format_[at + 1] - '0') : 0;
      if (count < 2 || count > 4) fail("a vector has 2 to 4 components");
      at += 2;
    }
    const size_t lengths = at;
    // The length is skipped, because the argument has a known width.
    while (at < format_.size() && (format_[at] == 'l' || format_[at] == 'h')) ++at;
    const bool has_length = at != lengths;
    const std::string spelled = format_.substr(first, at + 1 - first);
    c.letter = at < format_.size() ? format_[at] : '\0';
    if (c.letter == '\0' || std::string_view("diuxXofFeEgGaA").find(c.letter) == std::string_view::npos)
      fail(
          fmt::format("'{}' is not a conversion; the conversions are %d %i %u %x %X %o %f %F %e %E %g %G %a "
                      "%A, with vectors as %v3f",
                      spelled));
    if (std::max(c.width, c.precision) > isa::kMaxMessageWidth)
      fail(fmt::format("'{}' has more than {} characters", spelled, isa::kMaxMessageWidth));
    if (next_ == arguments_.size())
      fail(fmt::format("'{}' has no argument: the call gives {}", spelled, arguments_.size()));
    const Part part = argument(c);
    ++at;
    // Older documents of the extension write 64-bit numbers as %ul.
    if (!has_length && bytes_of(part) == 8 && at < format_.size() && format_[at] == 'l') ++at;
    return at;
  }

  Part argument(isa::Conversion& c) {
    const Id id = arguments_[next_++];
    const Part part = l_.part_of(l_.type_of(id));
    const Operands parts = l_.value(id);
    // Choice: an argument is printed as what it is where the specification leaves the result undefined: all
    // components of a vector are printed, and a float under %d is printed as a float. Drivers accept such
    // formats, and shaders contain them.
    if (is_float(part) != isa::is_float(c)) c.letter = is_float(part) ? 'f' : is_signed(part) ? 'd' : 'u';
    c.is_wide = bytes_of(part) == 8;
    for (size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) text_ += ", ";
      if (words_.size() + (c.is_wide ? 2 : 1) > isa::kMessageWords) end_message("print.part");
      text_ += isa::to_text(c);
      add_words(part, parts[i]);
    }
    return part;
  }

  void add_words(Part part, const Operand& x) {
    Emitter& e = l_.emit();
    if (part == Part::Bool)
      return words_.push_back(e.value("selp.b32", {Operand::value(1), Operand::value(0), x}));
    if (bytes_of(part) < 8)
      return words_.push_back(widened(e, part, x, part == Part::Int8 || part == Part::Int16));
    if (x.kind == Operand::Kind::Constant) {
      words_.push_back(Operand::value(uint32_t(x.constant)));
      return words_.push_back(Operand::value(x.constant >> 32));
    }
    words_.push_back(e.value("cvt.u32.u64", {x}));
    words_.push_back(e.value("cvt.u32.u64", {e.value("shr.u64", {x, Operand::value(32)})}));
  }

  void end_message(std::string_view op) {
    Operands operands{Operand::value(number_of_message(l_.program().messages, text_))};
    operands.insert(operands.end(), words_.begin(), words_.end());
    operands.resize(1 + isa::kMessageWords, Operand::value(0));
    l_.emit().effect(op, std::move(operands));
    text_.clear(), words_.clear();
  }

  ModuleLowering& l_;
  const std::string& format_;
  const std::vector<Id> arguments_;
  size_t next_ = 0;   // number of the next argument
  std::string text_;  // text of the message so far
  Operands words_;
};

}  // namespace

void lower_print(ModuleLowering& lowering, const Instruction& inst) {
  const auto& strings = lowering.module().strings;
  const auto format = inst.operands.size() > 2 ? strings.find(inst.operands[2]) : strings.end();
  if (format == strings.end()) return lowering.unsupported("a print whose format is not an OpString");
  Print(lowering, inst, format->second).run();
}

}  // namespace glint::frontend
