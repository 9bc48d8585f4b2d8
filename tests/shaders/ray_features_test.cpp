// Tests callables, data of records, nested any-hit decisions, ends of rays, the vendor's forms, and hit
// objects.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test::ray_features_test {
namespace {

bool misses(uint32_t x) {
  return x < 2 || x >= RayLab::kWidth;
}
bool is_box(uint32_t x) {
  return x >= 6;
}

struct Job {
  uint32_t depth = 0;
  bool odd = false;
  std::array<uint32_t, 3> trail{};
  float sum[2]{};
};

// Computes what callables.rgen and its shaders do.
struct Callables {
  static constexpr uint32_t kAdd = 11, kMix = 13;
  uint32_t x = 0;

  void add(Job& job) {
    job.trail[0] = job.trail[0] * 7 + kAdd;
    const float kept[2] = {job.sum[0] + 0.5f, job.sum[1] + 0.25f};
    if (job.depth > 0) {
      Job other = job;
      --other.depth;
      other.sum[0] = 1, other.sum[1] = 2;
      mix(other);
      job.trail = other.trail;
      job.odd = !other.odd;
      for (int i = 0; i < 2; ++i) job.sum[i] = kept[i] + other.sum[i] * 2.0f;
    } else {
      job.sum[0] = kept[0], job.sum[1] = kept[1];
    }
    job.trail[2] += x + kAdd;
  }
  void mix(Job& job) {
    job.trail[1] = job.trail[1] * 5 + kMix;
    if (job.depth == 0) return;
    --job.depth;
    const uint32_t mark = job.trail[1];
    add(job);
    job.trail[1] += mark * 100 + kMix;
  }
};

RayLab callables_lab() {
  RayLab lab({"rt/callables.rgen", {}, {}, {}, {"rt/add.rcall", "rt/mix.rcall", "", "rt/twice.rcall"}});
  lab.raygen_data = {77, 0, 0, 0};
  lab.callable_data = {{Callables::kAdd, bits(0.5f), bits(0.25f), bits(2)}, {Callables::kMix, 0, 0, 0}};
  return lab;
}

TEST_CASE(
    "callables call each other with data of their own or handed on, lane by lane, and each sees its own "
    "record") {
  RayLab lab = callables_lab();
  check_lanes(lab, [](uint32_t lane) {
    Job job{lane % 5, (lane & 1) != 0, {1, 2, 3}, {float(lane), 0.5f}};
    Callables callables{lane % 8};
    if (lane % 3 == 0) callables.add(job);
    if (lane % 3 == 1) callables.mix(job);
    const uint32_t single = lane & 2 ? lane * 2 + 1 : lane;
    return Row{job.trail[0],     job.trail[1], job.trail[2], bits(job.sum[0]),
               bits(job.sum[1]), single,       77077,        job.odd ? 1u : 0u};
  });
}

TEST_CASE("callables nested deeper than the pipeline allows are a fault that names shader and depth") {
  RayLab lab = callables_lab();
  lab.max_callable_depth = 3;
  CHECK_THROWS_WITH(lab.run(),
                    Catch::Contains("calls a callable shader at depth 4, and the pipeline allows 3") &&
                        Catch::Contains(".rcall:"));
}

TEST_CASE(
    "each shader reads the data of its own record, before and after rays and callables with other records") {
  RayLab lab({"rt/records.rgen",
              {"rt/records.rmiss", "rt/records.rmiss"},
              {{"rt/records.rchit", "rt/records.rahit", ""},
               {"rt/records.rchit", "rt/records.rahit", ""},
               {},
               {},
               {"rt/box.rchit", "", "rt/records.rint"},
               {"rt/box.rchit", "", "rt/records.rint"}},
              {},
              {"", "", "", "rt/twice.rcall"}});
  lab.max_trace_depth = 2;
  lab.raygen_data = {3, 4};
  lab.miss_data = {{5, 6}, {7, 8}};
  lab.hit_data = {{21, bits(1000000)}, {32, bits(2000000)}, {}, {}, {41, 0}, {52, 0}};
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    static constexpr uint32_t kMiss[2][2] = {{5, 6}, {7, 8}};
    const uint32_t outer_miss = kMiss[y & 1][y & 1], inner_miss = kMiss[1][y & 1];
    if (misses(x)) return Row{0, 0, 0, outer_miss, 0, 0xfd, 43};
    if (is_box(x)) {
      const uint32_t tag = x == 6 ? 41 : 52;
      return Row{tag, 0, tag + 1100000, 0, 1000950, 925 + tag * 10000, 43};
    }
    const uint32_t tag = x & 1 ? 32 : 21;
    uint32_t any = 0;
    if (x & 1) any = y == 0 ? 6 * tag : y < 4 ? 6 * tag + 1000 : y == 4 ? 4 * tag + 1000 : 5 * tag;
    if ((x & 1) && y == 5) return Row{0, any, 0, outer_miss, 0, 0xfd, 43};  // ignored
    return Row{tag * 101, any, 0, 0, tag * 2 + 1 + inner_miss * 1000 + (x & 1 ? 2000000u : 1000000u),
               0xfd,      43};
  });
}

TEST_CASE(
    "the vendor's extension traces by the payload's location, and its any-hit ends are not terminators") {
  RayLab lab({"rt/vendor.rgen",
              {"rt/vendor.rmiss"},
              {{"rt/vendor.rchit", "rt/vendor.rahit", ""},
               {"rt/vendor.rchit", "rt/vendor.rahit", ""},
               {},
               {},
               {"rt/vendor.rchit", "", "rt/vendor.rint"},
               {"rt/vendor.rchit", "", "rt/vendor.rint"}},
              {},
              {"rt/vendor.rcall"}});
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    const uint32_t number = (y * 8 + x) * 3 + 2;
    if (misses(x)) return Row{0, 0, 100, 0, number, 8};
    if (is_box(x)) return Row{9 + 30000 + 300000, 0, 0, 0, number, 8};
    const uint32_t hit = (x < 4 ? 10 + 10000 : 8 + 20000) + 100000 * 0xfe;
    if ((x & 1) == 0) return Row{hit, 0, 0, 0, number, 8};  // opaque
    if (y == 1) return Row{0, 1, 100, 0, number, 8};
    return Row{hit, y == 2 ? 11u : 1011u, 0, 0, number, 8};
  });
}

TEST_CASE("lanes choose a structure of an array, and a null structure is a miss") {
  RayLab lab({"rt/arrays.rgen",
              {"table.rmiss"},
              {{"tag1.rchit", "", ""}, {}, {}, {}, {"tag2.rchit", "", "pair.rint"}},
              {}});
  check_pixels(lab, [](uint32_t x, uint32_t) {
    const uint32_t tag = misses(x) ? 30 : is_box(x) ? 2 : 1;
    return Row{x & 1 ? tag : 30, tag};
  });
}

TEST_CASE("a ray's time reaches its shaders, and rays without one have time 0") {
  RayLab lab({"rt/motion.rgen",
              {"rt/motion.rmiss"},
              {{"rt/motion.rchit", "", ""},
               {"rt/motion.rchit", "", ""},
               {},
               {},
               {"rt/motion.rchit", "", "pair.rint"},
               {"rt/motion.rchit", "", "pair.rint"}},
              {}});
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    const float t = misses(x) ? 100.0f : is_box(x) ? 9.0f : x < 4 ? 10.0f : 8.0f;
    return Row{bits(float(y * 8 + x) * 0.25f), bits(t), 0};
  });
}

TEST_CASE("hit objects keep traced and made-up hits until their shaders are executed") {
  RayLab lab({"rt/object.rgen",
              {"rt/object.rmiss", "rt/object.rmiss"},
              {{"rt/object.rchit", "", ""},
               {"rt/object.rchit", "", ""},
               {},
               {},
               {"rt/object.rchit", "", "pair.rint"},
               {"rt/object.rchit", "", "pair.rint"}},
              {}});
  lab.words_per_lane = 24;
  lab.miss_data = {{1}, {2}};
  lab.hit_data = {{1}, {2}, {}, {}, {4}, {5}};
  const auto custom = [](uint32_t x) { return x < 4 ? 100u : x < 6 ? 200u : 300u; };
  for (const LabOptions& options : all_lab_options()) {
    INFO(to_string(options));
    const std::vector<uint32_t> got = lab.run(options);
    for (uint32_t lane = 0; lane < RayLab::kLanesUsed; ++lane) {
      const uint32_t x = lane % 8, y = lane / 8, *words = &got[lane * 24];
      INFO("x " << x << " y " << y);
      const bool miss = misses(x);
      const float t = miss ? 100.0f : is_box(x) ? 9.0f : x < 4 ? 10.0f : 8.0f;
      CHECK(words[0] == 1);
      CHECK(words[1] == 0);
      CHECK(words[2] == (miss ? 2 : 1));
      CHECK(words[3] == bits(t));
      CHECK(words[4] == bits(0.125f));
      const uint32_t primitive = is_box(x) ? y : y < 3 ? 0 : 1, record = (is_box(x) ? 4 : 0) + (x & 1);
      if (miss) {
        CHECK(words[13] == 1100);
      } else {
        CHECK(words[5] == custom(x));
        CHECK(words[6] == primitive);
        CHECK(words[7] == (x & 1));
        CHECK(words[8] == (is_box(x) ? 17u : 0xfeu));
        CHECK(words[9] == record);
        CHECK(words[10] == bits(float(x / 2 * 2)));
        CHECK(words[11] == bits(float(x & 1) + 0.5f));
        const float weight = std::bit_cast<float>(words[12]);
        const double v = (y + 0.5) / 6, expected = is_box(x) ? (x & 1) + 0.5 : y < 3 ? 0.5 - v : 0.5;
        CHECK(double(weight) == Approx(expected).margin(1e-6));
        CHECK(words[13] ==
              custom(x) * 1000 + primitive * 10 + (x & 1) + (record + 1 - (is_box(x) ? 1 : 0)) * 1000000);
        CHECK(words[14] == uint32_t(weight * 64) + 1000 * uint32_t(t));
      }
      CHECK(words[15] == 0);
      CHECK(words[16] == 2007);
      CHECK(words[17] == 200 * 1000 + 5 * 10 + 1 + 2 * 1000000);
      CHECK(words[18] == 16 + 3000);
      CHECK(words[19] == 200);
    }
  }
}

}  // namespace
}  // namespace glint::test::ray_features_test
