// Writes a tree as GLSL: compute or ray generation.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

using Op = Expr::Op;
using Kind = Stmt::Kind;
using Style = Stmt::Style;

std::string text_of(const Expr& e) {
  const auto a = [&](size_t i) { return text_of(e.args[i]); };
  switch (e.op) {
    case Op::Constant:
      return fmt::format("{}u", e.value);
    case Op::Variable:
    case Op::BoolVariable:
    case Op::FloatVariable:
      return fmt::format("v{}", e.value);
    case Op::Lane:
      return "lane";
    case Op::Input:
      return fmt::format("inputs[{} & 63u]", a(0));
    case Op::Element:
      return fmt::format("elements[{} & 3u]", a(0));
    case Op::Own:
      return fmt::format("own[lane * 4u + ({} & 3u)]", a(0));
    case Op::Add:
      return fmt::format("({} + {})", a(0), a(1));
    case Op::Sub:
      return fmt::format("({} - {})", a(0), a(1));
    case Op::Mul:
      return fmt::format("({} * {})", a(0), a(1));
    case Op::And:
      return fmt::format("({} & {})", a(0), a(1));
    case Op::Or:
      return fmt::format("({} | {})", a(0), a(1));
    case Op::Xor:
      return fmt::format("({} ^ {})", a(0), a(1));
    case Op::Shl:
      return fmt::format("({} << ({} & 31u))", a(0), a(1));
    case Op::Shr:
      return fmt::format("({} >> ({} & 31u))", a(0), a(1));
    case Op::Div:
      return fmt::format("({} / ({} | 1u))", a(0), a(1));
    case Op::Mod:
      return fmt::format("({} % ({} | 1u))", a(0), a(1));
    case Op::Select:
    case Op::FloatSelect:
      return fmt::format("({} ? {} : {})", a(0), a(1), a(2));
    case Op::Truncate:
      return fmt::format("uint(clamp({}, 0.0, 1e9))", a(0));
    case Op::Less:
      return fmt::format("({} < {})", a(0), a(1));
    case Op::SignedLess:
      return fmt::format("(int({}) < int({}))", a(0), a(1));
    case Op::Equal:
      return fmt::format("({} == {})", a(0), a(1));
    case Op::FloatLess:
      return fmt::format("({} < {})", a(0), a(1));
    case Op::Both:
      return fmt::format("({} && {})", a(0), a(1));
    case Op::Either:
      return fmt::format("({} || {})", a(0), a(1));
    case Op::Not:
      return fmt::format("!{}", a(0));
    case Op::FloatConstant:
      return fmt::format("uintBitsToFloat({}u)", e.value);
    case Op::FloatAdd:
      return fmt::format("({} + {})", a(0), a(1));
    case Op::FloatMul:
      return fmt::format("({} * {})", a(0), a(1));
    case Op::ToFloat:
      return fmt::format("float({})", a(0));
  }
  return {};
}

class Writer {
 public:
  explicit Writer(const ProgramTree& program) : program_(program) {}

  std::string run() {
    const bool compute = program_.is_compute;
    text_ = "#version 460\n";
    if (!compute) text_ += "#extension GL_EXT_ray_tracing : require\n";
    if (compute)
      text_ += fmt::format("layout(local_size_x = {}) in;\nshared uint slots[{}];\n", program_.group,
                           program_.group);
    text_ +=
        fmt::format("layout(set = 0, binding = {}, std430) readonly buffer Inputs {{ uint inputs[]; }};\n",
                    kInputBinding);
    text_ += fmt::format("layout(set = 0, binding = {}, std430) buffer Results {{ uint results[]; }};\n",
                         kResultBinding);
    text_ +=
        fmt::format("layout(set = 0, binding = {}, std430) buffer Own {{ uint own[]; }};\n", kOwnBinding);
    for (size_t f = 0; f < program_.functions.size(); ++f) function(f);
    return text_;
  }

 private:
  void line(const std::string& what) { text_ += std::string(2 * size_t(indent_), ' ') + what + "\n"; }

  void function(size_t f) {
    const FunctionTree& tree = program_.functions[f];
    is_entry_ = f + 1 == program_.functions.size();
    line(is_entry_ ? "void main() {" : fmt::format("uint f{}(uint x, uint y) {{", f));
    ++indent_;
    line(program_.is_compute ? "const uint lane = gl_GlobalInvocationID.x;"
                             : "const uint lane = gl_LaunchIDEXT.x;");
    line("uint elements[4] = uint[4](lane, 1u, 2u, 3u);");
    for (size_t v = 0; v < tree.variables.size(); ++v) switch (tree.variables[v]) {
        case Sort::Word:
          line(fmt::format("uint v{} = {};", v,
                           v == 1   ? (is_entry_ ? "lane" : "x")
                           : v == 2 ? (is_entry_ ? "inputs[lane & 63u]" : "y")
                                    : fmt::format("{}u", v)));
          break;
        case Sort::Bool:
          line(fmt::format("bool v{} = false;", v));
          break;
        case Sort::Float:
          line(fmt::format("float v{} = {}.0;", v, v));
          break;
      }
    list(tree.body);
    line(is_entry_ ? "results[lane] = v0 ^ (v3 * 31u + v4);" : "return v0 ^ (v3 * 31u + v4);");
    --indent_;
    line("}");
  }

  void list(const std::vector<Stmt>& stmts) {
    for (const Stmt& s : stmts) statement(s);
  }
  void block(const std::vector<Stmt>& stmts) {
    ++indent_;
    list(stmts);
    --indent_;
  }

  void statement(const Stmt& s) {
    const auto a = [&](size_t i) { return text_of(s.args[i]); };
    switch (s.kind) {
      case Kind::Assign:
        return line(fmt::format("v{} = {};", s.value, a(0)));
      case Kind::Trace:
        return line(fmt::format("v0 = (v0 ^ {}) * 2654435761u + {}u;", a(0), s.value));
      case Kind::SetElement:
        return line(fmt::format("elements[{} & 3u] = {};", a(0), a(1)));
      case Kind::SetOwn:
        return line(fmt::format("own[lane * 4u + ({} & 3u)] = {};", a(0), a(1)));
      case Kind::If:
        line(fmt::format("if ({}) {{", a(0)));
        block(s.bodies[0]);
        if (!s.bodies[1].empty()) {
          line("} else {");
          block(s.bodies[1]);
        }
        return line("}");
      case Kind::Loop:
        return loop(s);
      case Kind::Switch:
        return choice(s);
      case Kind::Call:
        return line(fmt::format("v{} = f{}({}, {});", s.value, s.other, a(0), a(1)));
      case Kind::Exchange:
        line("slots[gl_LocalInvocationID.x] = v0;");
        line("barrier();");
        line(fmt::format("v1 ^= slots[(gl_LocalInvocationID.x + {}u) % {}u];", s.value, program_.group));
        line("v0 = v0 * 31u + v1;");
        return line("barrier();");
      case Kind::Break:
        return line("break;");
      case Kind::Continue:
        return line("continue;");
      case Kind::Return:
        if (is_entry_) line(fmt::format("results[lane] = v0 ^ {};", a(0)));
        return line(is_entry_ ? "return;" : fmt::format("return v0 ^ {};", a(0)));
      case Kind::LoopBreak:
      case Kind::Leave:
      case Kind::NextCase:
        return line("#error not in GLSL");
    }
  }

  void loop(const Stmt& s) {
    const std::string go_on =
        fmt::format("v{} < ({} & 3u) + 1u && {}", s.value, text_of(s.args[0]), text_of(s.args[1]));
    if (s.style == Style::While) line(fmt::format("for (v{0} = 0u; {1}; ++v{0}) {{", s.value, go_on));
    if (s.style == Style::DoWhile) line(fmt::format("v{} = 0u; do {{", s.value));
    if (s.style == Style::Endless) {
      line(fmt::format("for (v{} = 0u;;) {{", s.value));
      line(fmt::format("  if (v{}++ > ({} & 3u)) break;", s.value, text_of(s.args[0])));
    }
    if (s.style == Style::DoWhile) line(fmt::format("  ++v{};", s.value));
    block(s.bodies[0]);
    line(s.style == Style::DoWhile ? fmt::format("}} while ({});", go_on) : "}");
  }

  void choice(const Stmt& s) {
    line(fmt::format("switch ({} & 7u) {{", text_of(s.args[0])));
    for (size_t c = 0; c < s.bodies.size(); ++c) {
      for (uint32_t label : s.labels[c]) line(fmt::format("case {}u:", label));
      if (s.default_case == int(c)) line("default:");
      block(s.bodies[c]);
      if (!s.falls[c]) line("  break;");
    }
    line("}");
  }

  const ProgramTree& program_;
  std::string text_;
  int indent_ = 0;
  bool is_entry_ = false;
};

}  // namespace

std::string to_glsl(const ProgramTree& program) {
  return Writer(program).run();
}

}  // namespace glint::test::torture
