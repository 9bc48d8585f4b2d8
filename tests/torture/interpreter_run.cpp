// Walks invocations through a module: control, calls, memory, composites.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

#include "tests/torture/interpreter.h"

namespace glint::test::torture {

using enum spv::Op;

namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("interpreter: " + what);
}

constexpr size_t kMostFrames = 20;

// Holds a called function: where it is, its values, and which value of the caller gets its result.
struct Frame {
  const FunctionCode* function = nullptr;
  uint32_t at = 0;
  Id block = 0, result = 0;
  size_t memories = 0;  // number of memories when it was entered
  std::vector<Value> values;
};

}  // namespace

struct Interpreter::Invocation {
  std::array<uint32_t, 3> id{}, size{};
  std::vector<Frame> frames;
  const std::vector<Value>* constants = nullptr;  // with the pointers of module-level variables
  Memories* shared = nullptr;                     // buffers and workgroup variables
  Memories own;                                   // numbered after the shared ones
  uint64_t steps = 0;
  bool ended = false;

  std::vector<uint64_t>& memory(uint64_t number) {
    return number < shared->size() ? (*shared)[number] : own.at(number - shared->size());
  }
  void enter(const FunctionCode& function, Id result) {
    if (frames.size() >= kMostFrames) fail("a deep recursion");
    frames.push_back({&function, 0, 0, result, own.size(), *constants});
  }
};

// Runs all groups. The scalars that all lanes of a group see come first, then those of each lane, so numbers
// are the same in all lanes.
uint64_t Interpreter::run(ScalarLaunch& launch) const {
  Memories shared, own;
  std::vector<Value> constants = constants_;
  for (bool is_shared : {true, false})
    for (const GlobalVariable& v : globals_) {
      using Storage = spv::StorageClass;
      const bool is_buffer = v.storage == Storage::StorageBuffer || v.storage == Storage::Uniform;
      if ((is_buffer || v.storage == Storage::Workgroup) != is_shared) continue;
      Value& pointer = constants[v.id];
      pointer.count = 2;
      pointer.part = {is_shared ? shared.size() : shared.size() + own.size(), 0};
      Memories& list = is_shared ? shared : own;
      list.emplace_back(types_.at(types_.at(v.type).element).scalars);
      if (is_buffer) {
        const auto& words = launch.buffers.at(binding_of_.at(v.id));
        list.back().assign(words.begin(), words.end());
      }
      if (v.initializer)
        std::copy_n(constants_.at(v.initializer).part.begin(), list.back().size(), list.back().begin());
    }
  const std::array<uint32_t, 3> group = local_size_[0] ? local_size_ : launch.threads;
  std::array<uint32_t, 3> groups{};
  for (size_t axis = 0; axis < 3; ++axis) groups[axis] = launch.threads[axis] / group[axis];
  uint64_t longest = 0;
  for (uint32_t g = 0; g < groups[0] * groups[1] * groups[2]; ++g) {
    const std::array<uint32_t, 3> at{g % groups[0], g / groups[0] % groups[1], g / groups[0] / groups[1]};
    std::vector<Invocation> lanes(size_t{group[0]} * group[1] * group[2]);
    for (uint32_t i = 0; i < lanes.size(); ++i) {
      Invocation& lane = lanes[i];
      const std::array<uint32_t, 3> in_group{i % group[0], i / group[0] % group[1], i / group[0] / group[1]};
      for (size_t axis = 0; axis < 3; ++axis) lane.id[axis] = at[axis] * group[axis] + in_group[axis];
      lane.size = launch.threads;
      lane.shared = &shared;
      lane.own = own;
      lane.constants = &constants;
      for (const GlobalVariable& v : globals_)
        if (builtin_of_.count(v.id)) {
          const Value value = builtin(lane, builtin_of_.at(v.id));
          std::copy_n(value.part.begin(), value.count, lane.memory(constants[v.id].part[0]).begin());
        }
      lane.enter(functions_.at(entry_), 0);
    }
    longest = std::max(longest, run_group(lanes, launch.steps_a_lane));
  }
  for (const GlobalVariable& v : globals_)
    if (v.storage == spv::StorageClass::StorageBuffer) {
      const auto& words = shared[constants[v.id].part[0]];
      launch.buffers.at(binding_of_.at(v.id)).assign(words.begin(), words.end());
    }
  return longest;
}

// Runs each lane to the next barrier. Lanes that have ended are not waited for.
uint64_t Interpreter::run_group(std::vector<Invocation>& lanes, uint64_t most_steps) const {
  uint64_t longest = 0;
  for (bool all_ended = false; !all_ended;) {
    all_ended = true;
    for (Invocation& lane : lanes) {
      while (!lane.ended && step(lane))
        if (lane.steps > most_steps) fail("more steps than a lane may take");
      all_ended &= lane.ended;
      longest = std::max(longest, lane.steps);
    }
  }
  return longest;
}

Value Interpreter::builtin(const Invocation& lane, spv::BuiltIn what) const {
  Value value;
  value.count = 3;
  for (uint32_t i = 0; i < 3; ++i) switch (what) {
      case spv::BuiltIn::GlobalInvocationId:
      case spv::BuiltIn::LaunchIdKHR:
        value.part[i] = lane.id[i];
        break;
      case spv::BuiltIn::LaunchSizeKHR:
        value.part[i] = lane.size[i];
        break;
      case spv::BuiltIn::LocalInvocationId:
        value.part[i] = lane.id[i] % local_size_[i];
        break;
      case spv::BuiltIn::WorkgroupId:
        value.part[i] = lane.id[i] / local_size_[i];
        break;
      case spv::BuiltIn::WorkgroupSize:
        value.part[i] = local_size_[i];
        break;
      default:
        fail(fmt::format("built-in {}", uint32_t(what)));
    }
  return value;
}

void Interpreter::enter_block(Invocation& lane, Id label) const {
  Frame& f = lane.frames.back();
  const Id from = f.block;
  f.block = label;
  f.at = f.function->at_label.at(label) + 1;
  std::vector<std::pair<Id, Value>> together;  // phis read what held before all of them
  for (; f.function->code[f.at].op == OpPhi; ++f.at) {
    const Decoded& phi = f.function->code[f.at];
    for (size_t i = 0; i + 1 < phi.operands.size(); i += 2)
      if (phi.operands[i + 1] == from) together.emplace_back(phi.result, f.values[phi.operands[i]]);
  }
  for (const auto& [id, value] : together) f.values[id] = value;
}

bool Interpreter::step(Invocation& lane) const {
  ++lane.steps;
  Frame& f = lane.frames.back();
  const Decoded& inst = f.function->code.at(f.at++);
  if (inst.op == OpControlBarrier) return false;
  if (step_control(lane, inst) || step_memory(lane, inst) || step_composite(lane, inst)) return !lane.ended;
  const bool is_glsl = inst.op == OpExtInst && inst.operands[0] == glsl_;
  std::vector<const Value*> arguments;
  for (size_t i = is_glsl ? 2 : 0; i < inst.operands.size(); ++i)
    arguments.push_back(&f.values.at(inst.operands[i]));
  Value result;
  const Scalar to = inst.type ? types_.at(inst.type).scalar : Scalar{};
  const Id first = inst.operands.empty() ? 0 : type_of_.at(inst.operands[is_glsl ? 2 : 0]);
  const Scalar from = first ? types_.at(first).scalar : Scalar{};
  const bool done = is_glsl ? compute_glsl(inst.operands[1], to, arguments, &result)
                            : compute(inst, to, from, arguments, &result);
  if (!done)
    fail(fmt::format("opcode {}{}", uint32_t(inst.op),
                     is_glsl ? fmt::format(", function {}", inst.operands[1]) : ""));
  f.values[inst.result] = result;
  return true;
}

bool Interpreter::step_control(Invocation& lane, const Decoded& inst) const {
  Frame& f = lane.frames.back();
  const auto& o = inst.operands;
  switch (inst.op) {
    case OpLabel:  // only the function's first one; others are entered by branches
      f.block = inst.result;
      return true;
    case OpBranch:
      enter_block(lane, o[0]);
      return true;
    case OpBranchConditional:
      enter_block(lane, f.values[o[0]].part[0] ? o[1] : o[2]);
      return true;
    case OpSwitch: {
      Id to = o[1];
      const uint32_t width = types_.at(type_of_[o[0]]).scalar.width;
      const size_t literal_words = width > 32 ? 2 : 1;
      for (size_t i = 2; i < o.size(); i += literal_words + 1) {
        const uint64_t literal = literal_words == 2 ? uint64_t(o[i + 1]) << 32 | o[i] : o[i];
        if (cut(literal, width) == f.values[o[0]].part[0]) to = o[i + literal_words];
      }
      enter_block(lane, to);
      return true;
    }
    case OpFunctionCall: {
      std::vector<Value> arguments;
      for (size_t i = 1; i < o.size(); ++i) arguments.push_back(f.values[o[i]]);
      const FunctionCode& callee = functions_.at(o[0]);
      lane.enter(callee, inst.result);  // `f` is invalid from here on
      for (size_t i = 0; i < arguments.size(); ++i)
        lane.frames.back().values[callee.parameters[i]] = arguments[i];
      return true;
    }
    case OpReturn:
    case OpReturnValue: {
      const Value value = inst.op == OpReturnValue ? f.values[o[0]] : Value{};
      const Id result = f.result;
      lane.own.resize(f.memories);
      lane.frames.pop_back();
      lane.ended = lane.frames.empty();
      if (!lane.ended) lane.frames.back().values[result] = value;
      return true;
    }
    case OpUnreachable:
      fail("OpUnreachable was reached");
    default:
      return false;
  }
}

bool Interpreter::step_memory(Invocation& lane, const Decoded& inst) const {
  Frame& f = lane.frames.back();
  const auto& o = inst.operands;
  Value& result = f.values[inst.result];
  const auto cells = [&](const Value& pointer, uint32_t count) {
    auto& memory = lane.memory(pointer.part[0]);
    if (pointer.part[1] + count > memory.size())
      fail(fmt::format("scalar {} of {}", pointer.part[1], memory.size()));
    return memory.begin() + long(pointer.part[1]);
  };
  switch (inst.op) {
    case OpVariable: {
      result.count = 2;
      result.part = {lane.shared->size() + lane.own.size(), 0};
      lane.own.emplace_back(types_.at(types_.at(inst.type).element).scalars);
      if (o.size() > 1)
        std::copy_n(f.values[o[1]].part.begin(), lane.own.back().size(), lane.own.back().begin());
      return true;
    }
    case OpAccessChain:
    case OpInBoundsAccessChain: {
      Value pointer = f.values[o[0]];
      Id type = types_.at(type_of_[o[0]]).element;
      for (size_t i = 1; i < o.size(); ++i)
        pointer.part[1] += first_scalar(&type, uint32_t(f.values[o[i]].part[0]));
      result = pointer;
      return true;
    }
    case OpLoad: {
      result.count = types_.at(inst.type).scalars;
      if (result.count > Value::kMost) fail("a load of many parts");
      std::copy_n(cells(f.values[o[0]], result.count), result.count, result.part.begin());
      return true;
    }
    case OpStore:
      std::copy_n(f.values[o[1]].part.begin(), f.values[o[1]].count,
                  cells(f.values[o[0]], f.values[o[1]].count));
      return true;
    case OpMemoryBarrier:
    case OpNop:
      return true;
    default:
      return false;
  }
}

bool Interpreter::step_composite(Invocation& lane, const Decoded& inst) const {
  auto& values = lane.frames.back().values;
  const auto& o = inst.operands;
  Value& result = values[inst.result];
  // Finds the parts that literal indices choose, from operand `i` on.
  const auto find = [&](Id type, size_t i, uint32_t* first) {
    for (*first = 0; i < o.size(); ++i) *first += first_scalar(&type, o[i]);
    return types_.at(type).scalars;
  };
  switch (inst.op) {
    case OpCompositeConstruct: {
      Value whole;
      for (Id part : o)
        for (uint32_t i = 0; i < values[part].count; ++i) whole.part.at(whole.count++) = values[part].part[i];
      result = whole;
      return true;
    }
    case OpCompositeExtract: {
      uint32_t first;
      Value part;
      part.count = find(type_of_[o[0]], 1, &first);
      std::copy_n(values[o[0]].part.begin() + first, part.count, part.part.begin());
      result = part;
      return true;
    }
    case OpCompositeInsert: {
      uint32_t first;
      Value whole = values[o[1]];
      const uint32_t count = find(type_of_[o[1]], 2, &first);
      std::copy_n(values[o[0]].part.begin(), count, whole.part.begin() + first);
      result = whole;
      return true;
    }
    case OpVectorShuffle: {
      Value whole;
      const Value a = values[o[0]], b = values[o[1]];
      for (size_t i = 2; i < o.size(); ++i)
        whole.part.at(whole.count++) = o[i] == 0xffff'ffff ? 0
                                       : o[i] < a.count    ? a.part[o[i]]
                                                           : b.part.at(o[i] - a.count);
      result = whole;
      return true;
    }
    case OpVectorExtractDynamic:
    case OpCopyObject: {
      const Value from = values[o[0]];
      if (inst.op == OpCopyObject) {
        result = from;
        return true;
      }
      const uint64_t index = values[o[1]].part[0];
      if (index >= from.count) fail("a component that is not there");
      result.count = 1;
      result.part[0] = from.part[index];
      return true;
    }
    case OpUndef:
      result = Value{};
      result.count = types_.at(inst.type).scalars;
      return true;
    default:
      return false;
  }
}

}  // namespace glint::test::torture
