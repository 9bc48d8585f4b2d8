// Parses modules, functions, declarations and statements.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/parser.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace glint::frontend::ptx {

std::optional<Type> type_of(const std::string& word) {
  if (word == "pred") return Type{'p', 1};
  static constexpr std::string_view kOthers[] = {"f16x2", "bf16x2", "tf32", "u16x2", "s16x2"};
  for (std::string_view other : kOthers)
    if (word == other) return Type{other[0] == 'u' || other[0] == 's' ? other[0] : 'f', 32};
  if (word == "bf16") return Type{'f', 16};
  static const std::map<std::string, uint32_t> kBits{
      {"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}};
  if (word.size() < 2 || std::string_view("busf").find(word[0]) == std::string_view::npos) return {};
  const auto bits = kBits.find(word.substr(1));
  if (bits == kBits.end() || (word[0] == 'f' && bits->second == 8)) return {};
  return Type{word[0], bits->second};
}

uint64_t Declaration::count() const {
  uint64_t count = 1;
  for (uint64_t dimension : dimensions) count *= dimension;
  return count;
}

namespace {

std::optional<VariableSpace> space_of(const std::string& word) {
  static const std::map<std::string, VariableSpace> kSpaces{
      {"reg", VariableSpace::Register}, {"shared", VariableSpace::Shared}, {"local", VariableSpace::Local},
      {"const", VariableSpace::Const},  {"global", VariableSpace::Global}, {"param", VariableSpace::Param}};
  const auto found = kSpaces.find(word.substr(0, word.find("::")));
  return found == kSpaces.end() ? std::nullopt : std::optional(found->second);
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : in_(tokenize(text, file), file) {
    module_.file = file;
  }

  Module run() {
    while (!in_.at_end()) module_item();
    return std::move(module_);
  }

 private:
  bool at_declaration() const { return in_.is(Token::Kind::DotWord) && space_of(in_.peek().text); }

  void module_item() {
    if (in_.accept(";")) return;
    if (!in_.is(Token::Kind::DotWord)) in_.fail("a directive such as .entry");
    bool is_extern = false;
    while (in_.is_dot("visible") || in_.is_dot("extern") || in_.is_dot("weak") || in_.is_dot("common"))
      is_extern |= in_.next().text == "extern";
    if (in_.is_dot("entry") || in_.is_dot("func")) return function();
    if (at_declaration()) {
      for (Declaration& d : declarations()) {
        d.is_extern = is_extern;
        module_.variables.push_back(std::move(d));
      }
      return;
    }
    const std::string directive = in_.next().text;
    if (directive == "version") {
      in_.next();
    } else if (directive == "target") {
      do in_.expect_word("a target such as sm_90");
      while (in_.accept(","));
    } else if (directive == "address_size") {
      module_.address_size = uint32_t(in_.constant("32 or 64"));
    } else if (directive == "file" || directive == "loc") {
      skip_line_directive();
    } else if (directive == "section") {
      skip_braces();
    } else if (directive == "pragma" || directive == "alias") {
      skip_to_semicolon();
    } else {
      in_.fail(fmt::format("a directive, not '.{}'", directive));
    }
  }

  void skip_to_semicolon() {
    while (!in_.at_end() && !in_.accept(";")) in_.next();
  }
  void skip_braces() {
    while (!in_.at_end() && !in_.is_mark("{")) in_.next();
    int depth = 0;
    do {
      if (in_.is_mark("{")) ++depth;
      if (in_.is_mark("}")) --depth;
      in_.next();
    } while (depth > 0 && !in_.at_end());
  }
  // .file and .loc end with their line.
  void skip_line_directive() {
    const int line = in_.peek().position.line;
    while (!in_.at_end() && in_.peek().position.line == line) in_.next();
  }

  void function() {
    Function f;
    f.is_entry = in_.next().text == "entry";
    f.position = in_.peek().position;
    if (in_.is_mark("(")) f.results = parameters();
    f.name = in_.expect_word("the name of a function");
    if (in_.is_mark("(")) f.parameters = parameters();
    while (!in_.is_mark("{") && !in_.is_mark(";")) function_directive(f);
    if (!in_.accept(";")) {
      f.has_body = true;
      in_.expect("{");
      f.body = statements();
    }
    // A declaration before or after its definition is the same function.
    for (Function& other : module_.functions)
      if (other.name == f.name) {
        if (other.has_body && f.has_body)
          in_.fail(f.position, fmt::format("function '{}' is defined twice", f.name));
        if (f.has_body) other = std::move(f);
        return;
      }
    module_.functions.push_back(std::move(f));
  }

  void function_directive(Function& f) {
    if (!in_.is(Token::Kind::DotWord)) in_.fail("'{'");
    const std::string directive = in_.next().text;
    if (directive == "maxntid" || directive == "reqntid") {
      (directive == "maxntid" ? f.largest_block : f.required_block) = size("a number of threads");
    } else if (directive == "reqnctapercluster") {
      f.required_cluster = size("a number of blocks");
    } else if (directive == "pragma") {
      skip_to_semicolon();
    } else {  // These are hints: .minnctapersm 2, .maxnreg 64, .noreturn, .abi_preserve 8 ...
      while (in_.is(Token::Kind::Integer) || in_.is_mark(",")) in_.next();
    }
  }

  // Reads up to three numbers. Those that are left out are 1.
  std::array<uint32_t, 3> size(const char* what) {
    std::array<uint32_t, 3> axes{1, 1, 1};
    for (uint32_t& axis : axes) {
      axis = uint32_t(in_.constant(what));
      if (!in_.accept(",")) break;
    }
    return axes;
  }

  std::vector<Declaration> parameters() {
    std::vector<Declaration> out;
    in_.expect("(");
    while (!in_.accept(")")) {
      if (!out.empty()) in_.expect(",");
      if (!at_declaration()) in_.fail("a parameter such as .param .u64 name");
      Declaration d = declaration_head();
      declarator(d);
      out.push_back(std::move(d));
    }
    return out;
  }

  // Reads everything before the name, such as `.shared .align 16 .b8`.
  Declaration declaration_head() {
    Declaration d;
    d.position = in_.peek().position;
    d.space = *space_of(in_.next().text);
    bool has_type = false;
    while (in_.is(Token::Kind::DotWord)) {
      const std::string word = in_.next().text;
      if (word == "align") {
        const uint32_t align = uint32_t(in_.constant("an alignment"));
        if (!is_pointer_) d.align = align;
      } else if (word == "v2" || word == "v4") {
        d.vector = word == "v2" ? 2 : 4;
      } else if (word == "ptr") {
        is_pointer_ = true;  // The words that follow describe what the pointer points to.
      } else if (word == "attribute") {
        in_.expect("(");
        while (!in_.at_end() && !in_.accept(")")) in_.next();
      } else if (const auto type = type_of(word); type && !has_type) {
        d.type = *type;
        if (word == "f16x2") d.type.kind = 'b';  // Such a register fits where any 32 bits do.
        has_type = true;
      } else if (!is_pointer_ || !space_of(word)) {
        in_.fail(d.position, fmt::format("'.{}' is not a type of variable that Glint knows", word));
      }
    }
    is_pointer_ = false;
    if (!has_type) in_.fail("a type such as .b32");
    return d;
  }

  // Reads `name`, `name<10>`, `name[4][2]` and an initialiser such as `= { 1, 2 }`.
  void declarator(Declaration& d) {
    d.position = in_.peek().position;
    d.name = in_.expect_word("a name");
    if (in_.accept("<")) {
      d.range = uint32_t(in_.next().value);
      in_.expect(">");
    }
    while (in_.accept("[")) {
      if (in_.accept("]")) {
        d.has_open_dimension = true;
        d.dimensions.push_back(0);
        continue;
      }
      d.dimensions.push_back(in_.constant("an array size"));
      in_.expect("]");
    }
    if (in_.accept("=")) {
      initial_value(d);
      if (d.has_open_dimension && d.dimensions.size() == 1) d.dimensions[0] = d.initial.size();
    }
  }

  void initial_value(Declaration& d) {
    if (in_.accept("{")) {
      while (!in_.accept("}")) {
        initial_value(d);
        if (!in_.is_mark("}")) in_.expect(",");
      }
      return;
    }
    if (in_.is(Token::Kind::Word) && in_.peek().text == "generic" && in_.peek(1).text == "(") {
      in_.next();
      in_.next();
      initial_value(d);
      in_.expect(")");
      return;
    }
    const Operand o = in_.operand();
    switch (o.kind) {
      case Operand::Kind::Integer:
      case Operand::Kind::Float32:
        d.initial.push_back({o.value, {}});
        return;
      case Operand::Kind::Float64:
        d.initial.push_back(
            {d.type.bits == 32 ? std::bit_cast<uint32_t>(float(std::bit_cast<double>(o.value))) : o.value,
             {}});
        return;
      case Operand::Kind::Name:
        d.initial.push_back({uint64_t(o.offset), o.name});
        return;
      default:
        in_.fail(o.position, "expected a number or the name of a variable");
    }
  }

  std::vector<Declaration> declarations() {
    const Declaration head = declaration_head();
    std::vector<Declaration> out;
    do {
      out.push_back(head);
      declarator(out.back());
    } while (in_.accept(","));
    in_.expect(";");
    return out;
  }

  // Reads statements up to and including the closing brace.
  std::vector<Statement> statements() {
    std::vector<Statement> out;
    while (!in_.accept("}")) {
      if (in_.at_end()) in_.fail("'}'");
      if (in_.accept(";")) continue;
      statement(out);
    }
    return out;
  }

  void statement(std::vector<Statement>& out) {
    Statement s;
    s.position = in_.peek().position;
    if (in_.accept("{")) {
      s.kind = Statement::Kind::Scope;
      s.body = statements();
    } else if (at_declaration()) {
      for (Declaration& d : declarations()) {
        Statement each = s;
        each.kind = Statement::Kind::Declaration;
        each.declaration = std::move(d);
        out.push_back(std::move(each));
      }
      return;
    } else if (in_.is(Token::Kind::DotWord)) {
      const std::string directive = in_.next().text;
      if (directive == "loc" || directive == "file") return skip_line_directive();
      if (directive != "pragma") in_.fail(s.position, fmt::format("'.{}' has no meaning here", directive));
      s.kind = Statement::Kind::Pragma;
      while (!in_.at_end() && !in_.accept(";")) s.label += in_.next().text;
    } else if (in_.is(Token::Kind::Word) && in_.peek(1).kind == Token::Kind::Mark &&
               in_.peek(1).text == ":") {
      s.label = in_.next().text;
      in_.next();
      if (in_.is_dot("branchtargets") || in_.is_dot("calltargets") || in_.is_dot("callprototype"))
        return list_or_prototype(std::move(s), out);
      s.kind = Statement::Kind::Label;
    } else {
      s.instruction = instruction();
    }
    out.push_back(std::move(s));
  }

  void list_or_prototype(Statement s, std::vector<Statement>& out) {
    const std::string directive = in_.next().text;
    if (directive == "callprototype") {
      prototype(s);
    } else {
      s.kind = directive == "branchtargets" ? Statement::Kind::Targets : Statement::Kind::CallTargets;
      do s.targets.push_back(in_.expect_word(directive == "branchtargets" ? "a label" : "a function"));
      while (in_.accept(","));
    }
    in_.expect(";");
    out.push_back(std::move(s));
  }

  // Reads what follows .callprototype, such as `(.param .b32 _) _ (.param .b64 _) .noreturn`.
  void prototype(Statement& s) {
    s.kind = Statement::Kind::Prototype;
    if (in_.is_mark("(")) s.signature.results = parameters();
    in_.expect_word("'_'");
    if (in_.is_mark("(")) s.signature.parameters = parameters();
    while (!in_.at_end() && !in_.is_mark(";")) in_.next();  // .noreturn and hints
  }

  Instruction instruction() {
    Instruction inst;
    if (in_.accept("@")) {
      inst.guard_negated = in_.accept("!");
      inst.guard = in_.expect_word("a predicate");
    }
    inst.position = in_.peek().position;
    inst.words.push_back(in_.expect_word("an instruction"));
    while (in_.is(Token::Kind::DotWord)) inst.words.push_back(in_.next().text);
    while (!in_.accept(";")) {
      if (!inst.operands.empty()) in_.expect(",");
      inst.operands.push_back(in_.operand());
    }
    return inst;
  }

  Cursor in_;
  Module module_;
  bool is_pointer_ = false;
};

}  // namespace

Module parse(std::string_view text, const std::string& file) {
  return Parser(text, file).run();
}

}  // namespace glint::frontend::ptx
