// Checks ray queries by rays that were aimed at known points of a small structure.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/ops/ray_scene.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

constexpr uint32_t kFlags = 0, kQuery = 3, kExtra = 13;
constexpr const char* kInitialize =
    "    rq.initialize 3, %rd100, %r102, %r103, %r104, %r105, %r106, %r107, %r108, %r109, %r110, %r111;\n";
constexpr const char* kProceed = "    rq.proceed %p4, 3;\n";
// A box takes what is generated, and a triangle is confirmed. Each leaves the other alone.
constexpr const char* kCommit = "    rq.confirm 3;\n    rq.generate 3, %r112;\n";

// Returns what the op should give, or nothing where Vulkan gives it no meaning.
std::optional<Value> value_of_op(std::string_view name, const Aim& aim, double generated) {
  const auto parts = parts_of(name);
  const std::span<const std::string_view> words = std::span(parts).subspan(1);
  const bool committed = parts.back() == "committed";
  if (parts[1] == "flags") return integer(kFlags);
  if (const auto value = value_of_ray(words, aim)) return value;
  if (parts[1] == "type" && committed) return integer(!aim.hits ? 0 : aim.is_box ? 2 : 1);
  if (parts[1] == "t" && committed) return real(!aim.hits ? aim.tmax : aim.is_box ? generated : aim.t);
  if (!aim.hits) return std::nullopt;
  if (parts[1] == "type") return integer(aim.is_box);
  if (parts[1] == "aabb_opaque") return aim.is_box ? std::optional(integer(aim.is_opaque)) : std::nullopt;
  if (const auto value = value_of_instance(words, aim)) return value;
  if (aim.is_box) return std::nullopt;
  if (parts[1] == "t") return real(aim.t);
  if (parts[1] == "u") return real(aim.u);
  if (parts[1] == "v") return real(aim.v);
  if (parts[1] == "front_face") return integer(aim.is_front);
  if (parts[1] == "corner") return value_of_corner(parts[2], aim);
  throw std::logic_error(fmt::format("the oracle does not know the value '{}'", name));
}

// Holds a run of an op behind a prelude that walks a ray of each thread.
struct Walk {
  std::vector<Aim> aims;
  std::vector<double> generated;
  Outcome outcome;
};
// Says which threads run the op, and at what distance boxes generate hits, by the threads' rays.
struct Walker {
  const isa::OpRow& observed;
  const isa::OpRow& counted;
  std::string prelude;
};

template <class Enabled, class Generated>
Walk walk(const Walker& walker, Enabled enabled, Generated generated, uint64_t seed) {
  OpLab lab(walker.observed, 0, walker.prelude, kExtra);
  lab.count(walker.counted);
  const RayScene scene(lab.memory);
  Random random{seed};
  Walk out;
  REQUIRE(lab.num_sources() == 1);
  std::vector<Column> sources(1 + kExtra);
  uint64_t mask = 0;
  for (size_t t = 0; t < kThreads; ++t) {
    out.aims.push_back(scene.aim(random, false));
    const Aim& aim = out.aims.back();
    out.generated.push_back(generated(aim));
    mask |= uint64_t{enabled(aim, out.generated.back())} << t;
    const std::vector<uint32_t> words = {kQuery,
                                         uint32_t(scene.address()),
                                         uint32_t(scene.address() >> 32),
                                         kFlags,
                                         0xff,
                                         word_of(aim.origin[0]),
                                         word_of(aim.origin[1]),
                                         word_of(aim.origin[2]),
                                         word_of(aim.tmin),
                                         word_of(aim.direction[0]),
                                         word_of(aim.direction[1]),
                                         word_of(aim.direction[2]),
                                         word_of(aim.tmax),
                                         word_of(out.generated.back())};
    for (size_t i = 0; i < words.size(); ++i) sources[i][t] = words[i];
  }
  const Spaces before = lab.random_spaces(random);
  out.outcome = lab.run(sources, mask, before);
  CHECK(difference(out.outcome, {}, before) == "");
  return out;
}

const auto kEverywhere = [](const Aim&, double) { return true; };
const auto kMiddle = [](const Aim& aim) { return (aim.tmin + aim.tmax) / 2; };

// Checks that the op gives each thread its value.
template <class Expected>
void check_values(const Walk& walk, Expected expected) {
  for (size_t t = 0; t < kThreads; ++t) {
    const std::optional<Value> value = expected(walk.aims[t], walk.generated[t]);
    const uint32_t is = walk.outcome.results[0][t];
    INFO("thread " << t << ", instance " << walk.aims[t].instance << ", geometry " << walk.aims[t].geometry);
    if (!value)
      CHECK(is == OpLab::kUntouched);
    else
      CHECK(value->is(is));
  }
}

uint64_t check_value(const isa::OpRow& row) {
  const bool committed = row.name.ends_with("committed");
  const std::string prelude =
      std::string(kInitialize) + kProceed + (committed ? std::string(kCommit) + kProceed : "");
  const auto expected = [&](const Aim& aim, double generated) {
    return value_of_op(row.name, aim, generated);
  };
  uint64_t lanes = 0;
  for (uint64_t seed : {1, 2}) {
    const Walk run = walk(
        {row, row, prelude}, [&](const Aim& aim, double t) { return expected(aim, t).has_value(); }, kMiddle,
        seed);
    check_values(run, expected);
    lanes += run.outcome.lanes;
  }
  return lanes;
}

const isa::OpRow& row_of(std::string_view name) {
  return isa::op_table()[isa::op_index(name)];
}

// Walks with the steps and observes the query by another op.
template <class Expected, class Generated>
uint64_t check_step(const isa::OpRow& row, std::string_view observed, const std::string& steps,
                    Generated generated, Expected expected) {
  const Walk run = walk({row_of(observed), row, kInitialize + steps}, kEverywhere, generated, 5);
  check_values(run, [&](const Aim& aim, double t) { return std::optional(expected(aim, t)); });
  return run.outcome.lanes;
}

// A decoy query walks beside the one under test. It must not disturb it.
constexpr const char* kDecoy =
    "    rq.initialize 5, %rd100, 255, %r103, %r107, %r106, %r105, %r107, %r110, %r108, %r109, %r111;\n";

uint64_t check_initialize(const isa::OpRow& row) {
  uint64_t lanes = 0;
  const std::string steps = std::string(kDecoy) + kProceed + kCommit + kProceed;
  for (const std::string_view observed : {"rq.t.committed", "rq.type.committed", "rq.flags", "rq.origin.z"})
    lanes += check_step(row, observed, steps, kMiddle,
                        [&](const Aim& aim, double t) { return *value_of_op(observed, aim, t); });
  return lanes;
}

uint64_t check_proceed(const isa::OpRow& row) {
  // There is a candidate at first, and none when it has been passed over, taken, or missed.
  const auto none = [](const Aim&, double) { return integer(0); };
  return check_step(row, row.name, "", kMiddle, [](const Aim& aim, double) { return integer(aim.hits); }) +
         check_step(row, row.name, kProceed, kMiddle, none) +
         check_step(row, row.name, std::string(kProceed) + kCommit, kMiddle, none);
}

uint64_t check_confirm(const isa::OpRow& row) {
  const auto triangle = [](const Aim& aim, double) { return integer(aim.hits && !aim.is_box); };
  const std::string confirm = "    rq.confirm 3;\n";
  return check_step(row, "rq.type.committed", kProceed + confirm + kProceed, kMiddle, triangle) +
         // Without a candidate, there is nothing to confirm.
         check_step(row, "rq.type.committed", confirm + kProceed + kProceed, kMiddle,
                    [](const Aim&, double) { return integer(0); });
}

uint64_t check_generate(const isa::OpRow& row) {
  const std::string steps = std::string(kProceed) + "    rq.generate 3, %r112;\n" + kProceed;
  uint64_t lanes = 0;
  // Hits are generated inside of the interval, before it, and behind it.
  for (const double place : {0.5, -0.25, 1.25}) {
    const auto at = [&](const Aim& aim) { return aim.tmin + place * (aim.tmax - aim.tmin); };
    const auto takes = [&](const Aim& aim) { return aim.hits && aim.is_box && place == 0.5; };
    lanes += check_step(row, "rq.t.committed", steps, at,
                        [&](const Aim& aim, double t) { return real(takes(aim) ? t : aim.tmax); });
    lanes += check_step(row, "rq.type.committed", steps, at,
                        [&](const Aim& aim, double) { return integer(takes(aim) ? 2 : 0); });
  }
  return lanes;
}

uint64_t check_terminate(const isa::OpRow& row) {
  const std::string terminate = "    rq.terminate 3;\n";
  return check_step(row, "rq.proceed", terminate, kMiddle, [](const Aim&, double) { return integer(0); }) +
         check_step(row, "rq.t.committed", std::string(kProceed) + kCommit + terminate, kMiddle,
                    [](const Aim& aim, double t) { return *value_of_op("rq.t.committed", aim, t); });
}

}  // namespace

uint64_t check_ray_query(const isa::OpRow& row) {
  if (row.name == "rq.initialize") return check_initialize(row);
  if (row.name == "rq.proceed") return check_proceed(row);
  if (row.name == "rq.confirm") return check_confirm(row);
  if (row.name == "rq.generate") return check_generate(row);
  if (row.name == "rq.terminate") return check_terminate(row);
  return check_value(row);
}

}  // namespace glint::test
