// Tests control flow: reconvergence pairs, phis, and random structured programs against an interpreter.
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <random>
#include <set>

#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

using lab::run;

const std::string kBuffer =
    "layout(local_size_x = 32) in;\nlayout(binding = 0) buffer B { int a[]; } b;\nvoid main() {\n  int x = "
    "b.a[gl_GlobalInvocationID.x];\n";

// Checks that each ssy names a block that begins with join, and that exactly one ssy names each join. It
// counts pairs and does not follow paths.
void check_pairs(const VirtualProgram& program, int expected_pairs) {
  std::map<BlockId, int> named;
  std::set<BlockId> joins;
  for (BlockId b = 0; b < program.blocks.size(); ++b)
    for (size_t i = 0; i < program.blocks[b].code.size(); ++i) {
      const VirtualInst& inst = program.blocks[b].code[i];
      const std::string_view op = isa::op_table()[inst.op].name;
      if (op == "ssy") ++named[inst.target];
      if (op != "join") continue;
      CHECK(i == 0);
      joins.insert(b);
    }
  CHECK(int(joins.size()) == expected_pairs);
  CHECK(named.size() == joins.size());
  for (const auto& [block, times] : named) {
    CHECK(joins.count(block) == 1);
    CHECK(times == 1);
  }
}

TEST_CASE("a selection has one reconvergence pair, a loop two") {
  check_pairs(lab::lowered(".comp", kBuffer + "  if (x > 1) b.a[0] = x; else b.a[1] = x;\n}"), 1);
  check_pairs(lab::lowered(".comp", kBuffer + "  for (int i = 0; i < x; ++i) b.a[i] = x;\n}"), 2);
  check_pairs(lab::lowered(".comp", kBuffer + "  for (int i = 0; i < x; ++i) { if (b.a[i] == 3) break; if "
                                              "(b.a[i] == 4) continue; b.a[i] = x; }\n}"),
              4);
}

TEST_CASE("a region whose end nobody reaches has no pair") {
  check_pairs(lab::lowered(".rahit",
                           "layout(location = 0) rayPayloadInEXT vec4 p;\nvoid main() { if (p.x > 0) "
                           "ignoreIntersectionEXT; else terminateRayEXT; }\n"),
              0);
}

TEST_CASE("every block ends in a branch or falls into the next, and successors are where it may go") {
  const VirtualProgram program =
      lab::lowered(".comp", kBuffer +
                                "  switch (x) { case 0: b.a[0] = 1; case 1: b.a[1] = 2; break; case 2: case "
                                "3: b.a[2] = 3; break; default: return; }\n  b.a[3] = x;\n}");
  for (BlockId at = 0; at < program.blocks.size(); ++at) {
    const VirtualBlock& block = program.blocks[at];
    std::set<BlockId> expected;
    bool open = true;
    for (const VirtualInst& inst : block.code) {
      CHECK(open);
      const std::string_view op = isa::op_table()[inst.op].name;
      if (op == "bra") expected.insert(inst.target);
      if ((op == "bra" && inst.guard == kNoRegister) || op == "exit") open = false;
    }
    if (open) expected.insert(at + 1);
    CHECK(std::set<BlockId>(block.successors.begin(), block.successors.end()) == expected);
  }
}

TEST_CASE("variables that swap around a loop keep their values apart") {
  // The phis of a and b read each other, so copying them one after the other would lose a value.
  std::vector<uint32_t> in{0, 1, 2, 3, 4, 5}, expected;
  for (uint32_t x : in) {
    uint32_t a = 1, b = 2, c = 3;
    for (uint32_t k = 0; k < x; ++k) {
      const uint32_t t = a;
      a = b;
      b = c;
      c = t;
    }
    expected.push_back(a * 100 + b * 10 + c);
  }
  CHECK(run(in,
            "uint a = 1, b = 2, c = 3; for (uint k = 0; k < x; ++k) { uint t = a; a = b; b = c; c = t; } y = "
            "a * 100 + b * 10 + c;") == expected);
}

TEST_CASE("the value of a variable before the last step is kept after the loop") {
  CHECK(run({0, 1, 5}, "uint last = 99, k = 0; do { last = k; ++k; } while (k < x); y = last * 10 + k;") ==
        std::vector<uint32_t>{1, 1, 45});
}

TEST_CASE("switch cases fall through, share targets and break") {
  const std::string s =
      "switch (x) { case 0: y += 1; case 1: y += 10; break; case 2: case 3: y += 100; break; case 4: break; "
      "default: y += 1000; case 9: y += 10000; }";
  CHECK(run({0, 1, 2, 3, 4, 5, 9}, s) == std::vector<uint32_t>{11, 10, 100, 100, 0, 11000, 10000});
}

TEST_CASE("early returns out of nested loops of an inlined function come back to its caller") {
  const std::string f =
      "uint search(uint n) { for (uint i = 0; i < 10u; ++i) { for (uint j = 0; j < 10u; ++j) { if (i * j > "
      "n) return i * 100u + j; if (j > i) break; } if (i == 7u) return 1u; } return 2u; }\n";
  std::vector<uint32_t> in, expected;
  for (uint32_t n = 0; n < 64; ++n) {
    in.push_back(n);
    const auto reference = [](uint32_t v) -> uint32_t {
      for (uint32_t i = 0; i < 10; ++i) {
        for (uint32_t j = 0; j < 10; ++j) {
          if (i * j > v) return i * 100 + j;
          if (j > i) break;
        }
        if (i == 7) return 1;
      }
      return 2;
    };
    expected.push_back(reference(n) * 3 + reference(n / 2));
  }
  CHECK(run(in, "y = search(x) * 3u + search(x / 2u);", f) == expected);
}

// --- Random structured programs: one tree is printed as GLSL and interpreted.

struct Node {
  enum Kind { Assign, If, For, While, Switch, Break, Continue, Return } kind = Assign;
  int target = 0, left = 0, right = 0;  // numbers of variables
  uint32_t constant = 0;
  int op = 0;
  std::vector<std::vector<Node>> bodies;
};

constexpr int kVariables = 4;

class Generator {
 public:
  explicit Generator(uint32_t seed) : random_(seed) {}

  std::vector<Node> block(int depth, bool in_loop, bool in_switch) {
    std::vector<Node> result;
    for (int n = 1 + below(3); n > 0; --n) {
      result.push_back(node(depth, in_loop, in_switch));
      const Node::Kind kind = result.back().kind;
      if (kind == Node::Break || kind == Node::Continue || kind == Node::Return) break;
    }
    return result;
  }

 private:
  int below(int n) { return int(random_() % uint32_t(n)); }

  Node node(int depth, bool in_loop, bool in_switch) {
    Node result;
    result.target = below(kVariables), result.left = below(kVariables), result.right = below(kVariables);
    result.constant = uint32_t(below(7));
    result.op = below(4);
    const int pick = below(depth > 0 ? 10 : 3);
    if (pick == 2 && (in_loop || in_switch))
      result.kind = in_loop && below(2) ? Node::Continue : Node::Break;
    else if (pick == 2 && below(6) == 0)
      result.kind = Node::Return;
    else if (pick >= 3 && pick < 6)
      result.kind = Node::If,
      result.bodies = {block(depth - 1, in_loop, in_switch), block(depth - 1, in_loop, in_switch)};
    else if (pick == 6)
      result.kind = Node::While, result.bodies = {block(depth - 1, true, false)};
    else if (pick == 7)
      result.kind = Node::For, result.bodies = {block(depth - 1, true, false)};
    else if (pick == 8)
      result.kind = Node::Switch,
      result.bodies = {block(depth - 1, in_loop, true), block(depth - 1, in_loop, true),
                       block(depth - 1, in_loop, true)};
    return result;
  }

  std::mt19937 random_;
};

std::string v(int i) {
  return "v" + std::to_string(i);
}

// Prints a tree. `number` makes the counters of loops distinct. Every loop runs at most 4 times.
std::string print(const std::vector<Node>& nodes, int& number) {
  static const char* const kOps[] = {" + ", " * ", " ^ ", " - "};
  std::string text;
  for (const Node& n : nodes) {
    const std::string c = std::to_string(n.constant) + "u",
                      condition = "((" + v(n.left) + " + " + c + ") & 3u) > (" + v(n.right) + " & 3u)";
    const auto body = [&](size_t i) { return "{ " + print(n.bodies[i], number) + "}"; };
    const std::string k = "k" + std::to_string(number++);
    switch (n.kind) {
      case Node::Assign:
        text += v(n.target) + " = " + v(n.left) + kOps[n.op] + "(" + v(n.right) + " + " + c + "); ";
        break;
      case Node::If:
        text += "if (" + condition + ") " + body(0) + " else " + body(1) + " ";
        break;
      case Node::For:
        text += "for (uint " + k + " = 0; " + k + " < (" + v(n.left) + " & 3u) + 1u; ++" + k + ") " +
                body(0) + " ";
        break;
      case Node::While:
        text += "uint " + k + " = 0; do { if (++" + k + " > 3u) break; " + print(n.bodies[0], number) +
                "} while (" + condition + "); ";
        break;
      case Node::Switch:
        text += "switch ((" + v(n.left) + " + " + c + ") & 3u) { case 0u: " + body(0) +
                " case 2u: " + body(1) + " break; default: " + body(2) + " } ";
        break;
      case Node::Break:
        text += "break; ";
        break;
      case Node::Continue:
        text += "continue; ";
        break;
      case Node::Return:
        text += "return f(" + v(n.left) + "); ";
        break;
    }
  }
  return text;
}

enum class Flow { Next, Break, Continue, Return };

struct Interpreter {
  uint32_t var[kVariables] = {};
  uint32_t returned = 0;

  static uint32_t f(uint32_t x) { return x * 7 + 1; }
  bool condition(const Node& n) const { return ((var[n.left] + n.constant) & 3) > (var[n.right] & 3); }

  Flow run(const std::vector<Node>& nodes) {
    for (const Node& n : nodes)
      if (const Flow flow = step(n); flow != Flow::Next) return flow;
    return Flow::Next;
  }
  Flow step(const Node& n) {
    switch (n.kind) {
      case Node::Assign: {
        const uint32_t a = var[n.left], b = var[n.right] + n.constant;
        var[n.target] = n.op == 0 ? a + b : n.op == 1 ? a * b : n.op == 2 ? (a ^ b) : a - b;
        return Flow::Next;
      }
      case Node::If:
        return run(n.bodies[condition(n) ? 0 : 1]);
      case Node::For:
        for (uint32_t k = 0; k < (var[n.left] & 3) + 1; ++k) {
          const Flow flow = run(n.bodies[0]);
          if (flow == Flow::Return) return flow;
          if (flow == Flow::Break) break;
        }
        return Flow::Next;
      case Node::While: {
        uint32_t k = 0;
        do {
          if (++k > 3) break;
          const Flow flow = run(n.bodies[0]);
          if (flow == Flow::Return) return flow;
          if (flow == Flow::Break) break;
        } while (condition(n));
        return Flow::Next;
      }
      case Node::Switch: {
        const uint32_t selector = (var[n.left] + n.constant) & 3;
        Flow flow = Flow::Next;
        if (selector == 0) flow = run(n.bodies[0]);
        if (flow == Flow::Next && (selector == 0 || selector == 2))
          flow = run(n.bodies[1]);
        else if (flow == Flow::Next)
          flow = run(n.bodies[2]);
        return flow == Flow::Break ? Flow::Next : flow;
      }
      case Node::Break:
        return Flow::Break;
      case Node::Continue:
        return Flow::Continue;
      case Node::Return:
        returned = f(var[n.left]);
        return Flow::Return;
    }
    return Flow::Next;
  }
};

TEST_CASE("random structured programs compute what an interpreter computes, lane by lane") {
  std::vector<uint32_t> in;
  for (uint32_t i = 0; i < 64; ++i) in.push_back(i * 2654435761u >> 7);
  for (uint32_t seed = 1; seed <= 60; ++seed) {
    const std::vector<Node> program = Generator(seed).block(4, false, false);
    int number = 0;
    const std::string body = print(program, number);
    const std::string function =
        "uint f(uint x) { return x * 7u + 1u; }\nuint g(uint v0, uint v1, uint v2, uint v3) { " + body +
        " return v0 ^ v1 * 3u ^ v2 * 5u ^ v3 * 11u; }\n";
    INFO("seed " << seed << "\n" << function);
    const auto got = run(in, "y = g(x, x >> 3, x * 5u, 9u);", function);
    std::vector<uint32_t> expected;
    for (uint32_t x : in) {
      Interpreter interpreter{{x, x >> 3, x * 5, 9}, 0};
      const bool returned = interpreter.run(program) == Flow::Return;
      const auto& r = interpreter.var;
      expected.push_back(returned ? interpreter.returned : (r[0] ^ r[1] * 3 ^ r[2] * 5 ^ r[3] * 11));
    }
    REQUIRE(got == expected);
  }
}

}  // namespace
}  // namespace glint::frontend
