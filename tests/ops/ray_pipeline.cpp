// Writes the shaders that log what they see of a ray.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/ray_pipeline.h"

#include <fmt/format.h>
#include <stdexcept>

#include "rtunit/traversal/ray.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// These are the places of the pipeline's shaders.
enum ShaderNumber : uint32_t { kHitA = 1, kHitB, kMissA, kMissB, kAnyHit, kIntersection };

constexpr uint32_t kCorner = 9;

using Names = std::vector<std::string>;

const Names& any_hit_names() {
  static const Names names{"hit.t",        "hit.kind",   "hit.primitive", "hit.geometry",
                           "hit.instance", "hit.custom", "ray.flags",     "ray.tmin"};
  return names;
}
const Names& ray_names() {
  static const Names names{"hit.t",           "ray.flags",      "ray.tmin",     "ray.mask",
                           "ray.origin.x",    "ray.origin.y",   "ray.origin.z", "ray.direction.x",
                           "ray.direction.y", "ray.direction.z"};
  return names;
}
const Names& entered_names() {
  static const Names names{"hit.t",
                           "hit.primitive",
                           "hit.geometry",
                           "hit.instance",
                           "hit.custom",
                           "object.origin.x",
                           "object.origin.y",
                           "object.origin.z",
                           "object.direction.x",
                           "object.direction.y",
                           "object.direction.z",
                           "ray.tmin"};
  return names;
}
const Names& hit_names() {
  static const Names names = [] {
    Names out = ray_names();
    for (const char* name :
         {"hit.kind", "hit.u", "hit.v", "hit.primitive", "hit.geometry", "hit.instance", "hit.custom"})
      out.push_back(name);
    for (const char* what : {"origin", "direction"})
      for (const char axis : {'x', 'y', 'z'}) out.push_back(fmt::format("object.{}.{}", what, axis));
    for (const char* matrix : {"object_to_world", "world_to_object"})
      for (int i = 0; i < 12; ++i) out.push_back(fmt::format("{}.{}", matrix, i));
    return out;
  }();
  return names;
}

std::string keep(uint32_t word, std::string_view value) {
  return fmt::format("    st.local.b32 [%payload + {}], {};\n", 4 * word, value);
}
std::string keep_specials(const Names& names, uint32_t first) {
  std::string out;
  for (const std::string& name : names) out += keep(first++, "%" + name);
  return out;
}
std::string keep_corners(uint32_t first) {
  std::string out;
  for (uint32_t i = 0; i < kCorner; ++i)
    out += fmt::format("    rt.corner %r9, {};\n", i) + keep(first + i, "%r9");
  return out;
}
// Loads the word of the shader's record.
std::string load_record() {
  return "    pack.b64 %rd6, %record, %record_hi;\n    ld.global.b32 %r9, [%rd6];\n";
}
std::string keep_record_and_time(uint32_t record, uint32_t time) {
  return load_record() + keep(record, "%r9") + "    rt.time.get %r9;\n" + keep(time, "%r9");
}
std::string load_input(std::string_view to, uint32_t word) {
  return fmt::format("    ld.global.b32 {}, [%rd2 + {}];\n", to, 4 * word);
}

std::string any_hit() {
  return fmt::format(
             "    ld.local.b32 %r8, [%payload + {0}];\n    add.u32 %r8, %r8, 1;\n"
             "    st.local.b32 [%payload + {0}], %r8;\n",
             4 * uint32_t(RayPayload::kAnyHits)) +
         keep_record_and_time(RayPayload::kAnyHitRecord, RayPayload::kAnyHitTime) +
         keep_corners(RayPayload::kAnyHitCorners) +
         keep_specials(any_hit_names(), RayPayload::kAnyHitSpecials) + load_input("%r8", RayInput::kVerdict) +
         "    setp.eq.u32 %p0, %r8, 1;\n    @%p0 rt.ignore;\n"
         "    setp.eq.u32 %p0, %r8, 2;\n    @%p0 rt.terminate;\n    ret;\n";
}

std::string intersection() {
  std::string out = fmt::format("    ld.global.b32 %r8, [%rd4 + {}];\n    add.u32 %r8, %r8, 1;\n",
                                4 * uint32_t(RayLog::kEntries)) +
                    log_word(RayLog::kEntries, "%r8");
  uint32_t at = RayLog::kEntered;
  for (const std::string& name : entered_names()) out += log_word(at++, "%" + name);
  out += load_record() + log_word(at, "%r9");
  for (uint32_t i = 0; i < 2; ++i) {
    out += load_input("%r8", RayInput::kReports + 2 * i) + load_input("%r9", RayInput::kReports + 2 * i + 1) +
           "    st.local.b32 [%attribute], %r9;\n    st.local.b32 [%attribute + 4], %r8;\n"
           "    rt.report %p0, %r8, %r9;\n" +
           log_predicate(RayLog::kUndecided + i, "%p0") +
           fmt::format(
               "    ssy DECIDED{0};\n    @!%p0 bra DECIDED{0};\n    add.u32 %r0, %r0, {1};\n"
               "    call.sbt.anyhit;\n    sub.u32 %r0, %r0, {1};\nDECIDED{0}:\n    join;\n"
               "    rt.accepted %p1;\n",
               i, RayLab::kFrameBytes) +
           own_words() + log_predicate(RayLog::kAccepted + i, "%p1") + log_word(RayLog::kEnd + i, "%hit.t");
  }
  return out + "    ret;\n";
}

std::string rays(uint32_t first) {  // of a trace: tmin stands between origin and direction
  std::string out;
  for (uint32_t i = 0; i < 8; ++i) out += fmt::format(", %r{}", first + i);
  return out;
}
std::string load_all(uint32_t first) {
  std::string out;
  for (uint32_t i = 0; i < RayLab::kInputWords; ++i) out += load_input(fmt::format("%r{}", first + i), i);
  return out;
}
// Traces a ray that misses everything, with a payload of its own. What the shader sees afterwards is what it
// saw before.
std::string nested_trace() {
  return load_all(20) +
         fmt::format(
             "    mov.b32 %r10, %r0;\n    add.u32 %r11, %r0, {0};\n    add.u32 %r0, %r0, {1};\n"
             "    rt.trace %p0, %rd20, 0, 0, 0, 0, 0{2}, %r10, %r11;\n    call.sbt.hit;\n    rt.end;\n"
             "    sub.u32 %r0, %r0, {1};\n",
             kPayloadWords * 4, RayLab::kFrameBytes, rays(20 + RayInput::kOrigin)) +
         fmt::format("    ld.local.b32 %r9, [%r0 + {}];\n", 4 * uint32_t(RayPayload::kMarker)) +
         keep(RayPayload::kNestedMarker, "%r9") +
         fmt::format("    ld.local.b32 %r9, [%r0 + {}];\n", 4 * uint32_t(RayPayload::kTime)) +
         keep(RayPayload::kNestedTime, "%r9");
}

std::string closest_hit(uint32_t number) {
  return (number == kHitB ? nested_trace() : "") + keep(RayPayload::kMarker, std::to_string(number)) +
         keep_record_and_time(RayPayload::kRecord, RayPayload::kTime) + keep_corners(RayPayload::kCorners) +
         keep_specials(hit_names(), RayPayload::kSpecials) + "    ret;\n";
}
std::string miss(uint32_t number) {
  return keep(RayPayload::kMarker, std::to_string(number)) +
         keep_record_and_time(RayPayload::kRecord, RayPayload::kTime) +
         keep_specials(ray_names(), RayPayload::kSpecials) + "    ret;\n";
}

constexpr uint32_t kNone = exec::kNoShader;
uint32_t closest_hit_of(uint32_t record) {
  return record % 7 == 3 ? kNone : record % 2 ? uint32_t(kHitB) : uint32_t(kHitA);
}
uint32_t any_hit_of(uint32_t record) {
  return record % 5 == 4 ? kNone : uint32_t(kAnyHit);
}
uint32_t intersection_of(uint32_t record) {
  return record % 11 == 7 ? kNone : uint32_t(kIntersection);
}
constexpr uint32_t kMissShader[] = {kMissA, kMissB, kNone, kMissA, kMissB};
constexpr uint32_t kHitRecords = kLastSbtOffset + 15 + 15 + 1;

void expect(const Names& names, uint32_t first, const RayAsk& ask, const Found& found, Expected& log) {
  for (const std::string& name : names) log[first++] = value_seen(name, ask, found);
}
void expect_corners(uint32_t first, const RayAsk& ask, const Found& found, Expected& log) {
  for (uint32_t i = 0; i < kCorner; ++i)
    log[first + i] = found.is_triangle ? value_of_corner(std::to_string(i), ask.aim) : integer(0);
}

// Returns whether the structure holds a candidate for the ray, by Vulkan's rules of flags and masks.
bool meets(const RayAsk& ask, bool opaque) {
  namespace flag = rt::ray_flag;
  const Aim& aim = ask.aim;
  if (!aim.hits || !(ask.mask & aim.mask & 0xff)) return false;
  if (ask.flags & (opaque ? flag::kCullOpaque : flag::kCullNoOpaque)) return false;
  if (ask.flags & (aim.is_box ? flag::kSkipAabbs : flag::kSkipTriangles)) return false;
  return aim.is_box || !(ask.flags & (aim.is_front ? flag::kCullFrontFacing : flag::kCullBackFacing));
}

// Runs the any-hit shader of a candidate. Returns false when it is ignored.
bool judge(const RayAsk& ask, const Found& candidate, Expected& log) {
  if (any_hit_of(candidate.record) == kNone) return true;
  const uint32_t at = RayLog::kPayload;
  log[at + RayPayload::kAnyHits]->number += 1;
  log[at + RayPayload::kAnyHitRecord] = integer(record_word(Region::Hit, candidate.record));
  log[at + RayPayload::kAnyHitTime] = integer(ask.time);
  expect_corners(at + RayPayload::kAnyHitCorners, ask, candidate, log);
  expect(any_hit_names(), at + RayPayload::kAnyHitSpecials, ask, candidate, log);
  return ask.verdict != Verdict::Ignore;
}

// Runs the intersection shader. `found` is the miss at first.
void enter(const RayAsk& ask, bool opaque, uint32_t record, Found& found, Expected& log) {
  log[RayLog::kEntries]->number += 1;
  expect(entered_names(), RayLog::kEntered, ask, found, log);
  log[RayLog::kEntered + entered_names().size()] = integer(record_word(Region::Hit, record));
  bool is_over = false;
  for (uint32_t i = 0; i < 2; ++i) {
    const RayAsk::Report& report = ask.report[i];
    const bool inside = !is_over && report.t >= ask.aim.tmin && report.t <= found.t.number;
    const Found candidate{true, real(report.t), integer(report.kind), real(report.t), report.kind, record};
    const bool undecided = inside && !opaque && any_hit_of(record) != kNone;
    const bool accepted = inside && (!undecided || judge(ask, candidate, log));
    if (accepted) found = candidate;
    is_over = is_over || (accepted && ((undecided && ask.verdict == Verdict::Terminate) ||
                                       (ask.flags & rt::ray_flag::kTerminateOnFirstHit)));
    log[RayLog::kUndecided + i] = integer(undecided);
    log[RayLog::kAccepted + i] = integer(accepted);
    log[RayLog::kEnd + i] = found.t;
  }
}

}  // namespace

std::vector<uint32_t> RayAsk::words() const {
  std::vector<uint32_t> out{
      uint32_t(structure), uint32_t(structure >> 32), flags, mask, offset, stride, miss};
  for (double x : aim.origin) out.push_back(word_of(x));
  out.push_back(word_of(aim.tmin));
  for (double x : aim.direction) out.push_back(word_of(x));
  out.push_back(word_of(aim.tmax));
  out.push_back(uint32_t(verdict));
  for (const Report& r : report) out.insert(out.end(), {word_of(r.t), r.kind});
  out.insert(out.end(), {time, uint32_t(enabled)});
  return out;
}

Value value_seen(std::string_view name, const RayAsk& ask, const Found& found) {
  if (name == "hit.t") return found.t;
  if (name == "hit.u") return found.u;
  if (name == "hit.v") return found.v;
  if (name == "hit.kind") return integer(found.kind);
  if (name == "ray.flags") return integer(ask.flags);
  if (name == "ray.mask") return integer(ask.mask & 0xff);
  auto words = parts_of(name);
  if (words[0] == "hit" || words[0] == "ray") words.erase(words.begin());
  if (const auto value = value_of_ray(words, ask.aim)) return *value;
  if (const auto value = value_of_instance(words, ask.aim)) return *value;
  throw std::logic_error(fmt::format("the oracle does not know the special '%{}'", name));
}

Found follow(const RayAsk& ask, Expected& log) {
  const Aim& aim = ask.aim;
  Found found{false, real(aim.tmax), {}, {}, 0, ask.one_record ? 0 : ask.miss & 0xffff};
  const bool opaque = ask.flags & rt::ray_flag::kOpaque     ? true
                      : ask.flags & rt::ray_flag::kNoOpaque ? false
                                                            : aim.is_opaque;
  if (!meets(ask, opaque)) return found;
  const uint32_t record =
      ask.one_record ? 0 : aim.sbt_offset + aim.geometry * (ask.stride & 15) + (ask.offset & 15);
  if (aim.is_box || !opaque) log[RayLog::kTurns] = integer(1);
  if (aim.is_box) {
    if (intersection_of(record) != kNone) enter(ask, opaque, record, found, log);
    return found;
  }
  const uint32_t kind = aim.is_front ? rt::kHitKindFront : rt::kHitKindBack;
  const Found candidate{true, real(aim.t), real(aim.u), real(aim.v), kind, record, true};
  return opaque || judge(ask, candidate, log) ? candidate : found;
}

void expect_hit_shader(const RayAsk& ask, const Found& found, Expected& log) {
  const uint32_t at = RayLog::kPayload,
                 shader = found.hit ? closest_hit_of(found.record) : kMissShader[found.record];
  if (shader == kNone || (found.hit && (ask.flags & rt::ray_flag::kSkipClosestHit))) return;
  log[at + RayPayload::kMarker] = integer(shader);
  log[at + RayPayload::kRecord] = integer(record_word(found.hit ? Region::Hit : Region::Miss, found.record));
  log[at + RayPayload::kTime] = integer(ask.time);
  expect(found.hit ? hit_names() : ray_names(), at + RayPayload::kSpecials, ask, found, log);
  if (found.hit) expect_corners(at + RayPayload::kCorners, ask, found, log);
  if (shader != kHitB) return;
  log[at + RayPayload::kNestedMarker] = integer(kMissA);
  log[at + RayPayload::kNestedTime] = integer(0);
}

Expected fresh_log() {
  Expected out(RayLab::kLogWords);
  out[RayLog::kTurns] = out[RayLog::kEntries] = out[uint32_t(RayLog::kPayload) + RayPayload::kAnyHits] =
      integer(0);
  return out;
}

void check_log(const ThreadWords& log, const std::vector<Expected>& expected) {
  for (size_t t = 0; t < log.size(); ++t)
    for (size_t i = 0; i < log[t].size(); ++i) {
      INFO("thread " << t << ", word " << i << " of the log is " << log[t][i]);
      if (expected[t][i])
        CHECK(expected[t][i]->is(log[t][i]));
      else
        CHECK(log[t][i] == RayLab::kUnwritten);
    }
}

std::string ray_state() {
  return own_words() + load_all(20) +
         fmt::format("    mov.b32 %r10, 16;\n    mov.b32 %r11, {};\n    setp.ne.u32 %p1, %r{}, 0;\n",
                     16 + kPayloadWords * 4, 20 + uint32_t(RayInput::kEnabled));
}

std::string trace_text(std::string_view end) {
  return fmt::format(
             "    ssy TRACED;\n    @!%p1 bra TRACED;\n    rt.time.set %r{};\n"
             "    rt.trace %p0, %rd20, %r22, %r23, %r24, %r25, %r26{}, %r10, %r11;\n    ssy DONE;\nLOOP:\n"
             "    @!%p0 bra DONE;\n    call.sbt.candidate;\n    rt.resume %p0;\n",
             20 + uint32_t(RayInput::kTime), rays(20 + RayInput::kOrigin)) +
         own_words() +
         fmt::format("    ld.global.b32 %r8, [%rd4 + {}];\n    add.u32 %r8, %r8, 1;\n",
                     4 * uint32_t(RayLog::kTurns)) +
         log_word(RayLog::kTurns, "%r8") +
         fmt::format(
             "    bra LOOP;\nDONE:\n    join;\n    rt.reorder;\n    {};\n    rt.end;\nTRACED:\n    join;\n",
             end);
}

std::vector<LabShader> ray_shaders(const std::string& body) {
  std::string first = log_word(RayLog::kTurns, "0") + log_word(RayLog::kEntries, "0"), last = own_words();
  for (uint32_t i = 0; i < kPayloadWords; ++i) {
    const uint32_t place = 16 + 4 * i, fresh = i == RayPayload::kAnyHits ? 0 : RayLab::kUnwritten;
    first += fmt::format("    st.local.b32 [{}], {};\n", place, fresh);
    last += fmt::format("    ld.local.b32 %r9, [{}];\n", place) + log_word(RayLog::kPayload + i, "%r9");
  }
  first += fmt::format("    add.u32 %r0, %r0, {};\n", RayLab::kFrameBytes);
  static_assert(16 + kPayloadWords * 4 + 2 * 64 <= RayLab::kFrameBytes, "payload and attributes fit");
  return {{"ray_generation", first + ray_state() + body + last + "    exit;\n"},
          {"closest_hit", closest_hit(kHitA)},
          {"closest_hit", closest_hit(kHitB)},
          {"miss", miss(kMissA)},
          {"miss", miss(kMissB)},
          {"any_hit", any_hit()},
          {"intersection", intersection()}};
}

void fill_table(RayLab& lab) {
  lab.world.miss.assign(std::begin(kMissShader), std::end(kMissShader));
  for (uint32_t r = 0; r < kHitRecords; ++r)
    lab.world.hit.push_back({closest_hit_of(r), any_hit_of(r), intersection_of(r)});
  lab.place_table();
}

std::vector<RayAsk> random_asks(const RayScene& scene, uint64_t seed) {
  Random random{seed};
  std::vector<RayAsk> out;
  for (size_t t = 0; t < kThreads; ++t) {
    RayAsk ask;
    ask.aim = scene.aim(random, random.below(4) != 0);
    ask.structure = scene.address();
    // Half of the rays have no flag. Skipped kinds of primitives exclude each other, and so do the others.
    if (random.below(2)) ask.flags = 1u << random.below(10);
    ask.mask = random.below(3) ? 0xff : uint32_t(random.next());
    ask.offset = uint32_t(random.next()), ask.stride = uint32_t(random.next());
    ask.miss = uint32_t(random.next()) << 16 | random.below(std::size(kMissShader));
    ask.time = word_of(random.below(100) * 0.01);
    ask.enabled = random.below(8) != 0;
    ask.verdict = Verdict(random.below(3));
    const double length = ask.aim.tmax - ask.aim.tmin;
    for (RayAsk::Report& report : ask.report) {
      report.t = ask.aim.tmin + length * (random.below(11) - 1.0) / 8;
      report.kind = random.below(128);
    }
    if (ask.report[1].t == ask.report[0].t) ask.report[1].t -= 0.125;
    out.push_back(ask);
  }
  return out;
}

}  // namespace glint::test
