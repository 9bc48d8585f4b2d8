// Checks hit objects of every origin: what they hold, and which shader they execute.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

#include "rtunit/traversal/ray.h"
#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/ops/ray_pipeline.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// These are the types that a hit object says it has.
enum ObjectType : uint32_t { kEmptyObject, kHitObject, kMissObject };

// Names the ops that make an object.
enum class Maker { Record, Empty, Miss, Hit, HitAtRecord };
struct MakerRow {
  Maker maker;
  std::string_view op;
};
constexpr MakerRow kMakers[] = {{Maker::Record, "ho.record"},
                                {Maker::Empty, "ho.empty"},
                                {Maker::Miss, "ho.miss"},
                                {Maker::Hit, "ho.hit"},
                                {Maker::HitAtRecord, "ho.hit.record"}};

// Holds the inputs of made hits, behind those of the trace.
struct Made {
  uint32_t kind = 0, record = 0;
  double u = 0, v = 0;
};
enum MadeInput : uint32_t {
  kMadeInstance = RayInput::kFree,
  kMadePrimitive,
  kMadeGeometry,
  kMadeKind,
  kMadeRecord,
  kMadeU,
  kMadeV,
};

// The log's words of values and of the first two words of the attributes follow those of the payload.
constexpr uint32_t kValues = RayLog::kPayload + kPayloadWords;

// Names the values in the order of their numbers (SPV_NV_shader_invocation_reorder's getters).
const std::vector<std::string>& value_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out{"type",         "hit.kind",   "hit.primitive", "hit.geometry",
                                 "hit.instance", "hit.custom", "record.index",  "record.low",
                                 "record.high",  "ray.tmin",   "hit.t"};
    for (const char* what : {"ray.origin", "ray.direction", "object.origin", "object.direction"})
      for (const char axis : {'x', 'y', 'z'}) out.push_back(fmt::format("{}.{}", what, axis));
    for (const char* matrix : {"object_to_world", "world_to_object"})
      for (int i = 0; i < 12; ++i) out.push_back(fmt::format("{}.{}", matrix, i));
    out.push_back("time");
    return out;
  }();
  return names;
}

std::string input(uint32_t word) {
  return fmt::format("%r{}", 20 + word);
}
std::string made_ray() {
  std::string out;
  for (uint32_t i = 0; i < 8; ++i) out += ", " + input(RayInput::kOrigin + i);
  return out;
}

// Makes object 3 for the threads of %p1.
std::string maker_text(Maker maker) {
  const std::string ray = made_ray(),
                    time = fmt::format("    @%p1 rt.time.set {};\n", input(RayInput::kTime)),
                    what = fmt::format("{}, {}, {}, {}", input(kMadeInstance), input(kMadePrimitive),
                                       input(kMadeGeometry), input(kMadeKind)),
                    attributes =
                        fmt::format("    st.local.b32 [%r11], {};\n    st.local.b32 [%r11 + 4], {};\n",
                                    input(kMadeU), input(kMadeV));
  switch (maker) {
    case Maker::Record:
      return trace_text("ho.record 3");
    case Maker::Empty:
      return fmt::format("    @%p1 ho.miss 3, 1{};\n    ho.empty 3;\n", ray);
    case Maker::Miss:
      return time + fmt::format("    @%p1 ho.miss 3, {}{};\n", input(RayInput::kMiss), ray);
    case Maker::Hit:
      return attributes + time +
             fmt::format("    @%p1 ho.hit 3, %rd20, {}, {}, {}{}, %r11;\n", what, input(RayInput::kOffset),
                         input(RayInput::kStride), ray);
    case Maker::HitAtRecord:
      return attributes + time +
             fmt::format("    @%p1 ho.hit.record 3, %rd20, {}, {}{}, %r11;\n", what, input(kMadeRecord), ray);
  }
  return "";
}

// Reads the object and executes its shader. Object 4 has other contents.
std::string body_text(Maker maker) {
  std::string out = "    ho.empty 3;\n" + maker_text(maker) + ray_state() +
                    fmt::format("    ho.miss 4, 1, 0, 0, 0, 0, 0, 0, 0, {};\n", input(RayInput::kTmin));
  // Threads may move between reads of the object. The hints differ, so that they do.
  const auto hint = [](std::string_view op) {
    return fmt::format("    {}{}, 3, 90;\n", op, input(kMadePrimitive));
  };
  out += hint("ho.reorder 3, ");
  const uint32_t count = uint32_t(value_names().size());
  for (uint32_t i = 0; i < count; ++i)
    out += fmt::format("    ho.value %r9, 3, {};\n", i) + log_word(kValues + i, "%r9");
  out += fmt::format("    ho.value %r9, 3, 0;\n    setp.eq.u32 %p2, %r9, {};\n", uint32_t(kHitObject));
  out += "    add.u32 %r12, %r11, 64;\n    @%p2 ho.attributes 3, %r12;\n";
  for (uint32_t i = 0; i < 2; ++i)
    out += fmt::format("    ld.local.b32 %r9, [%r12 + {}];\n    @%p2", 4 * i) +
           log_word(kValues + count + i, "%r9");
  return out + hint("ho.reorder.hint ") + "    ho.execute 3, %r10, %r11;\n    call.sbt.hit;\n    rt.end;\n";
}

// Returns what a value op gives for the object.
Value value_of_object(std::string_view name, ObjectType type, const RayAsk& ask, const Found& found,
                      const exec::BindingTable& table) {
  if (name == "type") return integer(type);
  if (type == kEmptyObject) return integer(0);
  const Address data = (type == kHitObject ? table.hit : table.miss).base +
                       Address(found.record) * RayLab::kRecordStride + exec::kHandleBytes;
  if (name == "record.index") return integer(found.record);
  if (name == "record.low") return integer(uint32_t(data));
  if (name == "record.high") return integer(uint32_t(data >> 32));
  if (name == "time") return integer(ask.time);
  const bool is_of_ray = name.starts_with("ray.") || name == "hit.t";
  return type == kHitObject || is_of_ray ? value_seen(name, ask, found) : integer(0);
}

// Returns what the object of an enabled thread holds.
Found found_by(Maker maker, RayAsk& ask, const Made& made, Expected& log) {
  if (maker == Maker::Record) return follow(ask, log);
  // A made object has no flags and no mask.
  ask.flags = 0, ask.mask = 0xff;
  if (maker == Maker::Empty || maker == Maker::Miss)
    return {false, real(ask.aim.tmax), {}, {}, 0, ask.miss & 0xffff};
  const uint32_t record = maker == Maker::HitAtRecord
                              ? made.record
                              : ask.aim.sbt_offset + ask.aim.geometry * (ask.stride & 15) + (ask.offset & 15);
  return {true, real(ask.aim.tmax), real(made.u), real(made.v), made.kind, record};
}

void expect_object(ObjectType type, const RayAsk& ask, const Found& found, const RayLab& lab, Expected& log) {
  uint32_t at = kValues;
  for (const std::string& name : value_names())
    log[at++] = value_of_object(name, type, ask, found, lab.world.table);
  if (type == kHitObject) log[at] = found.u, log[at + 1] = found.v;
  if (type != kEmptyObject) expect_hit_shader(ask, found, log);
}

uint64_t check_maker(const isa::OpRow& row, Maker maker, uint64_t seed) {
  INFO("objects of " << kMakers[size_t(maker)].op);
  RayLab lab(ray_shaders(body_text(maker)));
  const RayScene scene(lab.memory, kLastSbtOffset);
  fill_table(lab);
  Random random{seed};
  ThreadWords inputs;
  std::vector<Expected> expected;
  for (RayAsk& ask : random_asks(scene, seed)) {
    Made made{random.below(128), random.below(uint32_t(lab.world.hit.size())), random.below(99) / 99.0,
              random.below(99) / 99.0};
    if (random.below(2)) made.kind = random.below(2) ? rt::kHitKindFront : rt::kHitKindBack;
    std::vector<uint32_t> words = ask.words();
    words.insert(words.end(), {ask.aim.instance, ask.aim.primitive, ask.aim.geometry, made.kind, made.record,
                               word_of(made.u), word_of(made.v)});
    inputs.push_back(words);
    expected.push_back(fresh_log());
    Found found;
    ObjectType type = kEmptyObject;
    if (ask.enabled) {
      found = found_by(maker, ask, made, expected.back());
      if (maker != Maker::Empty) type = found.hit ? kHitObject : kMissObject;
    }
    expect_object(type, ask, found, lab, expected.back());
  }
  const RayLab::Outcome outcome = lab.run(row, inputs);
  check_log(outcome.log, expected);
  return outcome.lanes;
}

}  // namespace

uint64_t check_hit_object(const isa::OpRow& row) {
  if (row.name.starts_with("rt.")) return check_ray_tracing(row);  // times and corners have the same effect
  uint64_t lanes = 0;
  for (const MakerRow& maker : kMakers) {
    const bool makes = std::any_of(std::begin(kMakers), std::end(kMakers),
                                   [&](const MakerRow& m) { return m.op == row.name; });
    if (makes && maker.op != row.name) continue;  // The other ops read all kinds of objects.
    for (uint64_t seed : {11, 12}) lanes += check_maker(row, maker.maker, seed);
  }
  return lanes;
}

}  // namespace glint::test
