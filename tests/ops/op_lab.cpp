// Writes the program around an op: it loads the sources, fills the spaces, runs the op, and saves everything.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/op_lab.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "base/diagnostics.h"
#include "isa/text.h"
#include "isa/verify.h"
#include "tests/ops/machine_run.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using isa::OperandKind;

constexpr uint32_t kFirstSource = 10, kFirstResult = 60, kFirstExtra = 100;

// Names the registers of an op's operands. Parts of a vector lie apart and in reverse, because they may.
class Registers {
 public:
  explicit Registers(uint32_t first) : next_(first) {}
  // Returns the registers of one operand, one for each word.
  std::vector<uint32_t> take(size_t words, bool is_vector) {
    std::vector<uint32_t> out;
    for (size_t i = 0; i < words; ++i) out.push_back(next_ + uint32_t(is_vector ? words - 1 - i : i));
    next_ += uint32_t(words + words % 2);
    return out;
  }

 private:
  uint32_t next_;
};

bool is_vector(OperandKind kind) {
  return kind == OperandKind::DstVec2 || kind == OperandKind::DstVec4 || kind == OperandKind::SrcVec2 ||
         kind == OperandKind::SrcVec4;
}
size_t words_of(OperandKind kind) {
  if (kind == OperandKind::Dst64 || kind == OperandKind::Src64 || kind == OperandKind::Address64) return 2;
  return size_t(isa::slots_of(kind));
}

std::string operand_text(OperandKind kind, const std::vector<uint32_t>& registers, int32_t displacement) {
  const std::string moved = fmt::format(" {} {}", displacement < 0 ? '-' : '+', std::abs(displacement));
  switch (kind) {
    case OperandKind::Dst64:
    case OperandKind::Src64:
      return fmt::format("%rd{}", registers[0]);
    case OperandKind::Address64:
      return fmt::format("[%rd{}{}]", registers[0], moved);
    case OperandKind::Address32:
      return fmt::format("[%r{}{}]", registers[0], moved);
    case OperandKind::DstPred:
      return "%p2";
    case OperandKind::SrcPred:
      return "%p3";
    default:
      break;
  }
  if (!is_vector(kind)) return fmt::format("%r{}", registers[0]);
  std::string out = "{";
  for (uint32_t r : registers) out += fmt::format("{}%r{}", out.size() > 1 ? ", " : "", r);
  return out + "}";
}

template <class T>
void append(Bytes& out, const T& value) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

// Returns the first byte in which two spaces differ, or "".
std::string byte_difference(std::string_view name, const Bytes& is, const Bytes& expected) {
  const auto [a, b] = std::mismatch(is.begin(), is.end(), expected.begin(), expected.end());
  if (a == is.end() && b == expected.end()) return "";
  return fmt::format("byte {} of {} is {:#x} and not {:#x}", a - is.begin(), name, *a, *b);
}

}  // namespace

std::string difference(const Outcome& outcome, const std::vector<Column>& results, const Spaces& after) {
  if (!outcome.fault.empty()) return outcome.fault;
  for (size_t r = 0; r < results.size(); ++r)
    for (size_t t = 0; t < kThreads; ++t)
      if (outcome.results[r][t] != results[r][t])
        return fmt::format("result {} of thread {} is {:#x} and not {:#x}", r, t, outcome.results[r][t],
                           results[r][t]);
  std::string out = byte_difference("global memory", outcome.after.global, after.global) +
                    byte_difference("shared memory", outcome.after.shared, after.shared);
  for (size_t t = 0; t < kThreads; ++t)
    out += byte_difference(fmt::format("thread {}'s stack", t), outcome.after.local[t], after.local[t]);
  for (size_t i = 0; i < after.images.size(); ++i)
    out += byte_difference(fmt::format("image {}", i), outcome.after.images[i], after.images[i]);
  return out;
}

uint64_t Random::next() {
  uint64_t z = (state += 0x9e37'79b9'7f4a'7c15);
  z = (z ^ z >> 30) * 0xbf58'476d'1ce4'e5b9;
  z = (z ^ z >> 27) * 0x94d0'49bb'1331'11eb;
  return z ^ z >> 31;
}

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> out;
  for (size_t dot = 0; dot != name.npos; name.remove_prefix(std::min(name.size(), dot + 1))) {
    dot = name.find('.');
    out.push_back(name.substr(0, dot));
    if (dot == name.npos) break;
  }
  return out;
}

OpLab::OpLab(const isa::OpRow& row, int32_t displacement, const std::string& prelude, uint32_t num_extra)
    : row_(row), displacement_(displacement), num_extra_(num_extra) {
  for (OperandKind kind : row.operands.view())
    (isa::is_destination(kind) ? num_results_ : num_sources_) += words_of(kind);
  inputs_ = memory.allocate("inputs", kThreads * (num_sources_ + num_extra + 1) * 4);
  outputs_ = memory.allocate("outputs", kThreads * (num_results_ + 1) * 4);
  global_ = memory.allocate("global", kGlobalBytes);
  shared_ = memory.allocate("shared", kSharedBytes);
  local_ = memory.allocate("local", kThreads * kLocalBytes);
  isa::Program program = isa::parse(program_text(prelude), std::string(row.name));
  program.local_bytes = kLocalBytes;
  program.shared_bytes = kSharedBytes;
  Diagnostics diagnostics;
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  image_ = exec::link({program});
  world.image = &image_;
  world.memory = &memory;
  world.raygen = 0;
  world.local_bytes = kLocalBytes;
  exec::set_blocks(world, {1, 1, 1}, {uint32_t(kThreads), 1, 1}, kSharedBytes);
}

// Returns whether the op may reach shared memory, as copies do besides the space of their row.
bool OpLab::uses_shared() const {
  return row_.memory.space == isa::Space::Shared || row_.memory.space == isa::Space::Generic ||
         row_.effect == isa::Effect::Copy;
}

// Copies shared memory and the lanes' stacks from global memory, or back.
std::string OpLab::copies(bool to_spaces) const {
  const isa::Space space = row_.memory.space;
  const bool is_image = row_.klass == isa::Class::Tex;
  std::string out;
  const auto copy = [&](std::string_view name, std::string_view from, std::string_view to) {
    out += to_spaces
               ? fmt::format("    ld.global.b32 %r8, [{}];\n    st.{}.b32 [{}], %r8;\n", from, name, to)
               : fmt::format("    ld.{}.b32 %r8, [{}];\n    st.global.b32 [{}], %r8;\n", name, to, from);
  };
  if (is_image) return out;
  if (uses_shared()) {
    if (!to_spaces) out += "    bar.sync 0, 0;\n";
    for (uint32_t at = 0; at < kSharedBytes; at += kThreads * 4)
      copy("shared", fmt::format("%rd6 + {}", at), fmt::format("%r5 + {}", at));
    if (to_spaces) out += "    bar.sync 0, 0;\n";
  }
  if (space == isa::Space::Local || space == isa::Space::Generic)
    for (uint32_t at = 0; at < kLocalBytes; at += 4)
      copy("local", fmt::format("%rd50 + {}", at), fmt::format("{}", at));
  return out;
}

std::string OpLab::program_text(const std::string& prelude) {
  const size_t in_words = num_sources_ + num_extra_ + 1;
  std::string text = fmt::format(
      ".program \"{}\"\n.stage compute\n.registers 128\n\n"
      "    ld.param.b64 %rd2, [0];\n    mad.wide.u32 %rd2, %tid.x, {}, %rd2;\n"
      "    ld.param.b64 %rd54, [8];\n    mad.wide.u32 %rd54, %tid.x, {}, %rd54;\n"
      "    ld.param.b64 %rd6, [16];\n    mad.wide.u32 %rd6, %tid.x, 4, %rd6;\n    mul.lo.u32 %r5, %tid.x, "
      "4;\n"
      "    ld.param.b64 %rd50, [24];\n    mad.wide.u32 %rd50, %tid.x, {}, %rd50;\n",
      row_.name, in_words * 4, (num_results_ + 1) * 4, uint32_t(kLocalBytes));
  std::string operands, loads, before, saves;
  Registers sources(kFirstSource), results(kFirstResult);
  size_t in = 0, out = 0;
  for (OperandKind kind : row_.operands.view()) {
    const bool is_result = isa::is_destination(kind);
    const auto registers = (is_result ? results : sources).take(words_of(kind), is_vector(kind));
    operands += (operands.empty() ? " " : ", ") + operand_text(kind, registers, displacement_);
    for (uint32_t r : registers) {
      if (!is_result) {
        loads += fmt::format("    ld.global.b32 %r{}, [%rd2 + {}];\n", r, 4 * in++);
        if (kind == OperandKind::SrcPred) loads += fmt::format("    setp.ne.u32 %p3, %r{}, 0;\n", r);
        continue;
      }
      before += fmt::format("    mov.b32 %r{}, {:#x};\n", r, uint32_t(kUntouched));
      if (kind == OperandKind::DstPred) {
        before += "    setp.eq.u32 %p2, 0, 1;\n";
        saves += fmt::format("    selp.b32 %r{}, 1, 0, %p2;\n", r);
      }
      saves += fmt::format("    st.global.b32 [%rd54 + {}], %r{};\n", 4 * out++, r);
    }
  }
  for (uint32_t i = 0; i < num_extra_; ++i)
    loads += fmt::format("    ld.global.b32 %r{}, [%rd2 + {}];\n", kFirstExtra + i, 4 * in++);
  loads += fmt::format("    ld.global.b32 %r4, [%rd2 + {}];\n    setp.ne.u32 %p1, %r4, 0;\n", 4 * in);
  return text + copies(true) + loads + before + prelude +
         fmt::format("    @%p1 {}{};\n", row_.name, operands) + copies(false) + saves + "    exit;\n";
}

uint32_t OpLab::add_image(exec::ImageView view) {
  view.name = fmt::format("image {}", world.images.size());
  view.base = memory.allocate(view.name, view.bytes());
  world.images.push_back(std::move(view));
  return uint32_t(world.images.size() - 1);
}

Spaces OpLab::random_spaces(Random& random) const {
  const auto random_bytes = [&](size_t size) {
    Bytes out(size);
    for (uint8_t& byte : out) byte = uint8_t(random.next() >> 40);
    return out;
  };
  Spaces out;
  out.global = random_bytes(kGlobalBytes);
  out.shared = random_bytes(kSharedBytes);
  out.constants = random_bytes(isa::kConstantBankBytes);
  for (Bytes& bytes : out.local) bytes = random_bytes(kLocalBytes);
  for (const exec::ImageView& image : world.images) out.images.push_back(random_bytes(image.bytes()));
  Bytes parameters;
  for (Address address : {inputs_, outputs_, shared_, local_}) append(parameters, address);
  std::copy(parameters.begin(), parameters.end(), out.constants.begin() + isa::kPushConstantOffset);
  return out;
}

void OpLab::read_spaces(Spaces& out) const {
  const auto read = [&](Address from, Bytes& to) {
    std::memcpy(to.data(), memory.find(from, to.size()), to.size());
  };
  read(global_, out.global);
  if (uses_shared()) read(shared_, out.shared);
  for (size_t t = 0; t < kThreads; ++t) read(local_ + t * kLocalBytes, out.local[t]);
  for (size_t i = 0; i < world.images.size(); ++i) read(world.images[i].base, out.images[i]);
}

Outcome OpLab::run_on(bool timing, const std::vector<Column>& sources, uint64_t enabled,
                      const Spaces& before) {
  std::vector<uint32_t> inputs;
  for (size_t t = 0; t < kThreads; ++t) {
    for (const Column& column : sources) inputs.push_back(column[t]);
    inputs.push_back(uint32_t(enabled >> t & 1));
  }
  REQUIRE(inputs.size() == kThreads * (num_sources_ + num_extra_ + 1));
  memory.write(inputs_, inputs.data(), inputs.size() * 4);
  memory.write(global_, before.global.data(), before.global.size());
  memory.write(shared_, before.shared.data(), before.shared.size());
  for (size_t t = 0; t < kThreads; ++t)
    memory.write(local_ + t * kLocalBytes, before.local[t].data(), before.local[t].size());
  for (size_t i = 0; i < world.images.size(); ++i)
    memory.write(world.images[i].base, before.images[i].data(), before.images[i].size());
  const auto constants = std::as_bytes(std::span(before.constants));
  world.constant_bank.assign(constants.begin(), constants.end());
  exec::PrintLog log;
  world.prints = &log;

  Outcome out;
  out.after = before;
  try {
    run_machine(world, timing ? Machine::TwoCores : Machine::Functional, 100'000, *counted_, out.lanes);
  } catch (const Error& error) {
    out.fault = error.what();
  }
  out.printed = log.take();
  world.prints = nullptr;
  read_spaces(out.after);
  const auto words = memory.view<uint32_t>(outputs_, kThreads * (num_results_ + 1));
  out.results.resize(num_results_);
  for (size_t r = 0; r < num_results_; ++r)
    for (size_t t = 0; t < kThreads; ++t) out.results[r][t] = words[t * (num_results_ + 1) + r];
  return out;
}

Outcome OpLab::run(const std::vector<Column>& sources, uint64_t enabled, const Spaces& before) {
  Outcome functional = run_on(false, sources, enabled, before),
          timing = run_on(true, sources, enabled, before);
  if (functional.fault.empty())
    CHECK(difference(timing, functional.results, functional.after) == "");
  else
    CHECK(functional.fault == timing.fault);
  CHECK(functional.lanes == timing.lanes);
  CHECK(functional.printed == timing.printed);
  return functional;
}

}  // namespace glint::test
