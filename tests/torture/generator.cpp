// Picks statements at random, with every exit that the place allows.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

using Op = Expr::Op;
using Kind = Stmt::Kind;
using Style = Stmt::Style;

constexpr uint32_t kWords = 5, kBools = 2, kFloats = 2;  // variables besides counters
constexpr int kMostDepth = 5;

struct Place {
  int depth = 0;
  bool in_loop = false, switch_is_nearer = false, in_continue = false;
  // The place is directly in a branch of an `if` (may_leave), or in a case with a next one (may_fall).
  bool may_leave = false, may_fall = false;
  bool is_uniform = false;       // all lanes of the group come here together
  bool loop_is_uniform = false;  // the loop has exchanges, so no lane may leave it alone
};

class Generator {
 public:
  Generator(Random& random, bool spirv, uint32_t callable, bool is_entry, bool exchanges)
      : random_(random), spirv_(spirv), callable_(callable), is_entry_(is_entry), exchanges_(exchanges) {}

  FunctionTree run(uint32_t statements) {
    left_ = int(statements);
    for (uint32_t i = 0; i < kWords; ++i) declare(Sort::Word);
    for (uint32_t i = 0; i < kBools; ++i) declare(Sort::Bool);
    for (uint32_t i = 0; i < kFloats; ++i) declare(Sort::Float);
    Place top;
    top.is_uniform = is_entry_ && exchanges_;
    tree_.body = list(top, 12);
    return std::move(tree_);
  }

 private:
  uint32_t declare(Sort sort) {
    tree_.variables.push_back(sort);
    tree_.in_memory.push_back(random_.chance(spirv_ ? 35 : 0));
    return uint32_t(tree_.variables.size() - 1);
  }
  uint32_t word_variable() {  // including the hash and counters
    uint32_t v;
    do v = random_.below(uint32_t(tree_.variables.size()));
    while (tree_.variables[v] != Sort::Word);
    return v;
  }

  Expr word(int depth);
  Expr condition(int depth);
  Expr number(int depth);
  Expr make(Op op, std::vector<Expr> args, uint32_t value = 0) { return {op, value, std::move(args)}; }

  std::vector<Stmt> list(Place place, uint32_t most);
  Stmt simple();
  Stmt assign();
  bool add_exit(const Place& place, std::vector<Stmt>& to);
  std::vector<Kind> exits(const Place& place, bool bare);
  Stmt branch(Place place);
  Stmt loop(Place place);
  Stmt choice(Place place);

  Random& random_;
  const bool spirv_;
  const uint32_t callable_;  // functions that may be called
  const bool is_entry_, exchanges_;
  FunctionTree tree_;
  int left_ = 0;
};

Expr Generator::word(int depth) {
  if (depth <= 0 || random_.chance(25)) switch (random_.below(6)) {
      case 0:
        return make(Op::Lane, {});
      case 1:
        return make(Op::Constant, {}, random_.chance(70) ? random_.below(8) : uint32_t(random_.bits()));
      default:
        return make(Op::Variable, {}, word_variable());
    }
  switch (random_.below(10)) {
    case 0:
      return make(Op::Input, {word(depth - 1)});
    case 1:
      return make(Op::Element, {word(depth - 1)});
    case 2:
      return make(Op::Own, {word(depth - 1)});
    case 3:
      return make(Op::Select, {condition(depth - 1), word(depth - 1), word(depth - 1)});
    case 4:
      return make(Op::Truncate, {number(depth - 1)});
    default:
      break;
  }
  static constexpr Op kBinary[] = {Op::Add, Op::Sub, Op::Mul, Op::And, Op::Or,
                                   Op::Xor, Op::Shl, Op::Shr, Op::Div, Op::Mod};
  const Op op = kBinary[random_.below(std::size(kBinary))];
  return make(op, {word(depth - 1), word(depth - 1)});
}

Expr Generator::condition(int depth) {
  if (depth <= 0 || random_.chance(20)) {
    if (random_.chance(40)) return make(Op::BoolVariable, {}, kWords + random_.below(kBools));
    // A bit of the lane or of data gives a part of the warp each time.
    const Expr bit = make(Op::And, {make(Op::Shr, {word(0), make(Op::Constant, {}, random_.below(5))}),
                                    make(Op::Constant, {}, 1 + random_.below(3))});
    return make(Op::Equal, {bit, make(Op::Constant, {}, 0)});
  }
  switch (random_.below(8)) {
    case 0:
      return make(Op::Both, {condition(depth - 1), condition(depth - 1)});
    case 1:
      return make(Op::Either, {condition(depth - 1), condition(depth - 1)});
    case 2:
      return make(Op::Not, {condition(depth - 1)});
    case 3:
      return make(Op::FloatLess, {number(depth - 1), number(depth - 1)});
    case 4:
      return make(Op::Equal, {make(Op::And, {word(1), make(Op::Constant, {}, 3)}),
                              make(Op::Constant, {}, random_.below(4))});
    case 5:
      return make(Op::SignedLess, {word(depth - 1), word(depth - 1)});
    default:
      return make(Op::Less, {make(Op::And, {word(depth - 1), make(Op::Constant, {}, 7)}),
                             make(Op::Constant, {}, random_.below(8))});
  }
}

Expr Generator::number(int depth) {
  if (depth <= 0 || random_.chance(30)) {
    if (random_.chance(30)) return make(Op::FloatConstant, {}, 0x3f80'0000u + (random_.below(64) << 18));
    return make(Op::FloatVariable, {}, kWords + kBools + random_.below(kFloats));
  }
  switch (random_.below(4)) {
    case 0:
      return make(Op::FloatAdd, {number(depth - 1), number(depth - 1)});
    case 1:
      return make(Op::FloatMul, {number(depth - 1), number(depth - 1)});
    case 2:
      return make(Op::FloatSelect, {condition(depth - 1), number(depth - 1), number(depth - 1)});
    default:
      return make(Op::ToFloat, {word(depth - 1)});
  }
}

Stmt Generator::assign() {
  Stmt s;
  s.kind = Kind::Assign;
  s.value = 1 + random_.below(kWords + kBools + kFloats - 1);
  const Sort sort = tree_.variables[s.value];
  s.args = {sort == Sort::Word ? word(3) : sort == Sort::Bool ? condition(2) : number(2)};
  return s;
}

Stmt Generator::simple() {
  Stmt s;
  switch (random_.below(8)) {
    case 0:
      s.kind = Kind::SetElement;
      s.args = {word(1), word(2)};
      return s;
    case 1:
      s.kind = Kind::SetOwn;
      s.args = {word(1), word(2)};
      return s;
    case 2:
      if (callable_ == 0) return assign();
      s.kind = Kind::Call;
      s.value = 1 + random_.below(kWords - 1);
      s.other = random_.below(callable_);
      s.args = {word(2), word(2)};
      return s;
    case 3:
    case 4:
    case 5:
      return assign();
    default:
      s.kind = Kind::Trace;
      s.value = uint32_t(random_.bits());
      s.args = {word(1)};
      return s;
  }
}

// Returns the ways out. Bare ones are branches, not ends of the function.
std::vector<Kind> Generator::exits(const Place& place, bool bare) {
  std::vector<Kind> all;
  if (place.in_continue || place.is_uniform) return all;
  const bool may_leave_loop = place.in_loop && !place.loop_is_uniform;
  if (may_leave_loop || place.switch_is_nearer) all.push_back(Kind::Break);
  if (may_leave_loop) all.push_back(Kind::Continue);
  if (may_leave_loop && place.switch_is_nearer && spirv_) all.push_back(Kind::LoopBreak);
  if (!bare && !(is_entry_ && exchanges_)) all.push_back(Kind::Return);
  if (bare && place.may_leave) all.push_back(Kind::Leave);
  if (bare && place.may_fall) all.push_back(Kind::NextCase);
  return all;
}

// Adds an exit under a condition, or one without (then the list is over).
bool Generator::add_exit(const Place& place, std::vector<Stmt>& to) {
  const bool bare = spirv_ && random_.chance(60);
  const std::vector<Kind> kinds = exits(place, bare);
  if (kinds.empty()) return false;
  Stmt exit;
  exit.kind = kinds[random_.below(uint32_t(kinds.size()))];
  if (exit.kind == Kind::Return) exit.args = {word(1)};
  if (place.depth > 0 && random_.chance(35) && exit.kind != Kind::Leave && exit.kind != Kind::NextCase) {
    to.push_back(exit);
    return true;
  }
  Stmt s;
  s.kind = Kind::If;
  s.bare = bare;
  s.args = {condition(2)};
  s.bodies = {{exit}, {}};
  to.push_back(s);
  return false;
}

Stmt Generator::branch(Place place) {
  Stmt s;
  s.kind = Kind::If;
  s.dead = random_.chance(50);
  s.args = {condition(3)};
  ++place.depth;
  place.may_leave = true;
  place.may_fall = place.is_uniform = false;
  s.bodies.push_back(list(place, 5));
  s.bodies.push_back(random_.chance(50) ? list(place, 4) : std::vector<Stmt>{});
  return s;
}

Stmt Generator::loop(Place place) {
  Stmt s;
  s.kind = Kind::Loop;
  s.dead = random_.chance(50);
  s.style = spirv_ ? Style(random_.below(6)) : Style(std::array{0, 2, 3}[random_.below(3)]);
  s.value = declare(Sort::Word);
  s.args = {word(1), condition(2)};
  const bool stays_uniform = place.is_uniform && s.style != Style::Single && random_.chance(50);
  if (stays_uniform)
    s.args = {make(Op::Constant, {}, random_.below(3)),
              make(Op::Less, {make(Op::Constant, {}, 0), make(Op::Constant, {}, 1)})};
  ++place.depth;
  place.in_loop = true;
  place.switch_is_nearer = place.may_leave = place.may_fall = false;
  place.is_uniform = place.loop_is_uniform = stays_uniform;
  const bool was_continue = place.in_continue;
  if (s.style == Style::Single) {
    s.bodies = {{simple(), simple()}, {}};
    std::erase_if(s.bodies[0], [](const Stmt& x) { return x.kind == Kind::Call; });
    return s;
  }
  place.in_continue = false;
  s.bodies.push_back(was_continue ? std::vector<Stmt>{simple()} : list(place, 6));
  place.in_continue = true;
  s.bodies.push_back(spirv_ && random_.chance(50) ? list(place, 3) : std::vector<Stmt>{});
  return s;
}

Stmt Generator::choice(Place place) {
  Stmt s;
  s.kind = Kind::Switch;
  s.dead = random_.chance(50);
  s.args = {word(2)};
  ++place.depth;
  place.switch_is_nearer = true;
  place.may_leave = place.is_uniform = false;
  const uint32_t cases = 1 + random_.below(4);
  uint32_t label = 0;
  s.default_case = random_.chance(70) ? int(random_.below(cases)) : -1;
  for (uint32_t c = 0; c < cases; ++c) {
    s.labels.emplace_back();
    for (uint32_t n = 1 + random_.below(2); n > 0; --n) s.labels.back().push_back(label++);
    if (s.default_case == int(c) && random_.chance(50)) s.labels.back().clear();
    s.falls.push_back(c + 1 < cases && random_.chance(35));
    place.may_fall = c + 1 < cases;
    s.bodies.push_back(list(place, 4));
  }
  return s;
}

std::vector<Stmt> Generator::list(Place place, uint32_t most) {
  std::vector<Stmt> result;
  const uint32_t n = 1 + random_.below(most);
  for (uint32_t i = 0; i < n && left_ > 0; ++i) {
    --left_;
    const uint32_t what = random_.below(100);
    if (what < 15 && place.is_uniform) {
      Stmt s;
      s.kind = Kind::Exchange;
      s.value = 1 + random_.below(40);
      result.push_back(s);
    } else if (what < 35 || place.depth >= kMostDepth) {
      result.push_back(simple());
    } else if (what < 50) {
      if (add_exit(place, result)) return result;
    } else if (what < 70) {
      result.push_back(branch(place));
    } else if (what < 88) {
      if (!(place.in_continue && !spirv_)) result.push_back(loop(place));
    } else {
      result.push_back(choice(place));
    }
  }
  if (result.empty()) result.push_back(simple());
  return result;
}

}  // namespace

ProgramTree generate(uint64_t seed, bool spirv) {
  Random random(seed * 2 + spirv);
  ProgramTree program;
  program.seed = seed;
  program.spirv = spirv;
  program.is_compute = spirv || random.chance(50);
  static constexpr uint32_t kGroups[] = {32, 64, 20, 33, 7, 48, 96, 1};
  program.group = kGroups[random.below(8)];
  program.groups = program.group > 64 ? 1 : 2;
  const uint32_t functions = random.below(3);
  const bool exchanges = program.is_compute && random.chance(25);
  for (uint32_t i = 0; i < functions; ++i) {
    program.functions.push_back(Generator(random, spirv, i, false, false).run(4 + random.below(10)));
  }
  program.functions.push_back(
      Generator(random, spirv, functions, true, exchanges).run(10 + random.below(30)));
  return program;
}

static size_t count_statements(const std::vector<Stmt>& list) {
  size_t count = list.size();
  for (const Stmt& s : list)
    for (const auto& body : s.bodies) count += count_statements(body);
  return count;
}
size_t count_statements(const ProgramTree& program) {
  size_t count = 0;
  for (const FunctionTree& f : program.functions) count += count_statements(f.body);
  return count;
}

}  // namespace glint::test::torture
