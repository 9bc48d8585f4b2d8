// Tests shaders of every stage with rays: payloads, built-ins, recursion, reports, any-hit decisions, the
// binding table.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>

#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

bool misses(uint32_t x) {
  return x < 2 || x >= RayLab::kWidth;
}
bool is_box(uint32_t x) {
  return x >= 6;
}
uint32_t custom_index(uint32_t x) {
  return x < 4 ? 100 : x < 6 ? 200 : 300;
}
uint32_t primitive(uint32_t x, uint32_t y) {
  return is_box(x) ? y : y < 3 ? 0 : 1;
}

// Returns only exact numbers. Weights of a triangle's corners are checked with a tolerance below.
Row info(uint32_t x, uint32_t y) {
  Row row(29, 0);
  row[28] = bits(float(y * 8 + x) * 0.5f);
  if (misses(x)) {
    for (int i = 1; i < 5; ++i) row[size_t(i)] = 7;
    row[6] = 1;
    row[7] = row[8] = bits(-1);
    row[25] = bits(99);
    row[27] = 5;
    row.resize(9);
    return row;
  }
  const bool second = x == 4 || x == 5;
  row[0] = 1;
  row[1] = x < 4 ? 0 : x < 6 ? 1 : 2;
  row[2] = custom_index(x);
  row[3] = x & 1;
  row[4] = primitive(x, y);
  row[5] = is_box(x) ? 17 : 0xfe;  // clockwise from above in a left-handed system: Vulkan's front
  row[6] = is_box(x) ? 0 : 1;
  if (is_box(x)) row[7] = bits(float(x - 6) + 0.5f), row[8] = bits(float(y) + 1.5f);
  row[9] = row[13] = bits(1);
  row[17] = bits(second ? 3 : 1);
  row[18] = bits(float(x / 2 * 2));
  row[20] = bits(second ? 2 : 0);
  row[21] = bits(second ? 1.0f / 3.0f : 1);
  row[22] = bits(float(x & 1) + 0.5f);
  row[25] = bits(is_box(x) ? 9 : second ? 8 : 10);
  row[26] = bits(0.125f);
  if (second) {
    row.resize(23);
  } else {
    row[23] = bits(10);
    row[24] = bits(-1);
  }
  return row;
}

TEST_CASE(
    "a closest-hit shader sees the hit through its built-ins and hands back a payload of nested types") {
  RayLab lab({"info.rgen",
              {"info.rmiss"},
              {{"info.rchit", "", ""},
               {"info.rchit", "", ""},
               {},
               {},
               {"info.rchit", "", "pair.rint"},
               {"info.rchit", "", "pair.rint"}},
              {}});
  lab.words_per_lane = 40;
  for (const LabOptions& options : all_lab_options()) {
    INFO(to_string(options));
    const std::vector<uint32_t> got = lab.run(options);
    for (uint32_t lane = 0; lane < RayLab::kLanesUsed; ++lane) {
      const uint32_t x = lane % 8, y = lane / 8;
      const Row row = info(x, y);
      const uint32_t* words = &got[lane * 40];
      for (size_t i = 0; i < row.size(); ++i) {
        if ((i == 7 || i == 8) && !misses(x) && !is_box(x)) continue;
        INFO("x " << x << " y " << y << " word " << i << " as float " << std::bit_cast<float>(words[i]));
        CHECK(words[i] == row[i]);
      }
      CHECK(words[28] == bits(float(lane) * 0.5f));
      if (misses(x) || is_box(x)) continue;
      const double px = 0.5, v = (y + 0.5) / 6;
      const double b = y < 3 ? px - v : px, c = y < 3 ? v : v - px;
      CHECK(double(std::bit_cast<float>(words[7])) == Approx(b).margin(1e-6));
      CHECK(double(std::bit_cast<float>(words[8])) == Approx(c).margin(1e-6));
    }
  }
}

TEST_CASE("shadow rays with their own payload leave the first payload alone and skip closest-hit shaders") {
  RayLab lab({"shadow.rgen",
              {"primary.rmiss", "lit.rmiss", "counts.rmiss"},
              {{"shadow.rchit", "", ""}, {}, {}, {}, {"shadow.rchit", "", "pair.rint"}},
              {}});
  const auto blocked = [](uint32_t x, uint32_t y, int side, bool without_second) {
    // The ray starts at z -8 and goes along (side, 0, 1). Quads are at z 0 and 2. Boxes are between z -1 and
    // 1, and their shader always reports 9.
    (void)y;
    const auto column = [&](float dz) { return float(x) + 0.5f + float(side) * dz; };
    const float first = column(8), second = column(10);
    if (first > 2 && first < 4) return true;
    if (!without_second && second > 4 && second < 6) return true;
    const float low = std::min(column(7), column(9)), high = std::max(column(7), column(9));
    return high >= 6 && low <= 8;
  };
  check_pixels(lab, [&](uint32_t x, uint32_t y) {
    const float t = misses(x) ? -1 : is_box(x) ? 9 : x < 4 ? 10 : 8;
    uint32_t seen = 0;
    for (int i = 0; i < 4; ++i) {
      if (i == 2 && t < 0) continue;
      if (!blocked(x, y, i - 1, i == 3)) seen |= 1u << i;
      if (t > 9 && i == 1) break;
    }
    const bool counted = misses(x) || is_box(x);
    const uint32_t low = y % 2 == 0 ? 3 : 0, high = y % 2 == 1 ? 3 : 0;
    const uint32_t counts = counted ? low | high << 8 | 1 << 16 : 0;
    // The last trace culls front-facing triangles, but not boxes.
    return Row{seen, bits(t), bits(t < 0 ? -2 : 10 - t), counts, (counted ? 1u : 0u) + (is_box(x) ? 0 : 1)};
  });
}

struct Path {
  float sum = 0;
  uint32_t trail = 0, depth = 0;
};
float distance(uint32_t x) {
  return is_box(x) ? 9 : x < 4 ? 10 : 8;
}

Path nested(uint32_t x, uint32_t y, uint32_t depth, uint32_t trail) {
  if (misses(x)) return {0.5f, trail * 16 + 14, depth};
  if (depth == 3) return {1, 15, depth};
  const Path next = nested(x + 1, y, depth + 1, 0);
  return {next.sum * 2 + distance(x) + float(primitive(x, y)) * 100 + distance(x) * 2,
          next.trail * 16 + custom_index(x) / 100, depth};
}

TEST_CASE("a closest-hit shader that traces sees its own hit again afterwards, at each depth") {
  RayLab lab({"recursion.rgen",
              {"recursion.rmiss"},
              {{"recursion.rchit", "", ""},
               {"recursion.rchit", "", ""},
               {},
               {},
               {"recursion.rchit", "", "pair.rint"},
               {"recursion.rchit", "", "pair.rint"}},
              {}});
  lab.max_trace_depth = 4;
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    const Path path = nested(x, y, 0, 3);
    return Row{bits(path.sum), path.trail, path.depth};
  });
}

TEST_CASE("a trace deeper than the pipeline allows is a fault that names the shader") {
  RayLab lab({"recursion.rgen",
              {"recursion.rmiss"},
              {{"recursion.rchit", "", ""},
               {"recursion.rchit", "", ""},
               {},
               {},
               {"recursion.rchit", "", "pair.rint"},
               {"recursion.rchit", "", "pair.rint"}},
              {}});
  lab.max_trace_depth = 3;
  CHECK_THROWS_WITH(lab.run(), Catch::Contains("recursion.rchit:14"));
}

TEST_CASE("hit and miss shaders that pass on their own payload share it with all depths") {
  const bool miss_traces = GENERATE(false, true);
  frontend::GlslOptions glsl;
  if (miss_traces) glsl.defines.push_back({"MISS_TRACES", "1"});
  // Boxes are used only where the attribute is exact. Quads have null shaders, which end the path.
  RayLab lab({"recursion.rgen",
              {"recursion.rmiss"},
              {{}, {}, {}, {}, {"own.rchit", "", "pair.rint"}, {"own.rchit", "", "pair.rint"}},
              glsl});
  lab.max_trace_depth = 4;
  check_pixels(lab, [&](uint32_t x, uint32_t y) {
    Path path{0, 3, 0};
    const std::function<void(uint32_t)> follow = [&](uint32_t column) {
      if (!misses(column) && !is_box(column)) return;
      if (misses(column)) {
        path.sum += 0.5f;
        path.trail = path.trail * 16 + 14;
        if (!miss_traces) return;
        if (path.depth++ < 3) follow(column + 1);
        path.sum += float(column) + 0.5f;
        return;
      }
      path.trail = path.trail * 16 + 3;
      const uint32_t depth = path.depth++;
      if (depth < 3) follow(column + 1);
      path.sum = path.sum * 2 + 9 + (float(column & 1) + 0.5f) + float(depth) * 64;
    };
    follow(x);
    (void)y;
    return Row{bits(path.sum), path.trail, path.depth};
  });
}

TEST_CASE("each report in a loop carries the attributes of its moment, and rejected ones leave no trace") {
  const bool pair = GENERATE(false, true);
  frontend::GlslOptions glsl;
  if (pair) glsl.defines.push_back({"PAIR", "1"});
  RayLab lab({"reports.rgen",
              {"none.rmiss"},
              {{},
               {},
               {},
               {},
               {"reports.rchit", "reports.rahit", "reports.rint"},
               {"reports.rchit", "reports.rahit", "reports.rint"}},
              glsl});
  lab.words_per_lane = 12;
  check_pixels(lab, [&](uint32_t x, uint32_t y) {
    if (!is_box(x)) return Row{0, 0, 0, 100, 0, 0, 0, 0, 0};
    const bool opaque = x == 6;
    const float n[3] = {float(x - 6) + 0.5f, float(y) + 0.5f, 10};
    const uint32_t last = opaque ? 3 : 2;
    const float t = opaque ? 9.25f : 9.75f;
    return Row{
        bits(pair ? n[1] : n[0]), bits(n[1]), bits(pair ? n[1] : n[2]), last, last, bits(t), opaque ? 0u : 4u,
        opaque ? 3u : 18u,        bits(t)};
  });
}

TEST_CASE("any-hit shaders ignore, accept and end rays from nested branches, and their payload writes stay") {
  RayLab lab({"anyhit.rgen", {"anyhit.rmiss"}, {{}, {"anyhit.rchit", "anyhit.rahit", ""}}, {}});
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    if (misses(x) || is_box(x)) return Row{0, 0, 7, 0};
    const uint32_t geometry = x & 1, hit = 50 + geometry;
    if (y % 2 == 0 && geometry == 0) return Row{0, 0, hit, 0};  // opaque
    switch (y) {
      case 0:
        return Row{1, 0, hit, 0};
      case 1:
        return Row{1, 13, 7, 1};
      case 2:
        return Row{1, 1014, hit, 6};
      case 3:
        return Row{1, 0, hit, 8};
      default:
        return geometry == 1 ? Row{1, 0, 7, 0} : Row{1, 0, hit, 0};  // primitive 1
    }
  });
}

TEST_CASE("offset, stride and miss index pick the record of the binding table, lane by lane") {
  std::vector<LabShaders::Group> hit(8);
  hit[0] = {"tag1.rchit", "", ""};
  hit[1] = {"tag2.rchit", "", ""};
  hit[3] = {"tag3.rchit", "", ""};
  hit[4] = {"tag3.rchit", "", "pair.rint"};
  hit[5] = {"tag1.rchit", "", "pair.rint"};
  hit[6] = {"", "", "pair.rint"};
  RayLab lab({"table.rgen", {"table.rmiss", ""}, hit, {}});
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    const uint32_t lane = y * 8 + x, tags[8] = {1, 2, 0, 3, 3, 1, 0, 0};
    if (misses(x)) return Row{lane % 2 ? 0u : 30u};
    const uint32_t record = (is_box(x) ? 4 : 0) + (x & 1) * (1 + (lane >> 1 & 1)) + (lane & 1);
    // A box without intersection shader is never hit.
    return Row{record == 7 ? 30 * (1 - lane % 2) : tags[record]};
  });
}

struct Caller {
  uint32_t traces = 0;
  uint32_t shoot(uint32_t x) {
    static constexpr uint32_t kTags[8] = {30, 30, 1, 2, 1, 2, 3, 1};
    ++traces;
    return kTags[x % 8];
  }
  uint32_t walk(uint32_t x) {
    for (uint32_t i = 0; i < 4; ++i) {
      const uint32_t t = shoot(x + i);
      if (t == 3) return 100 + i;
      if (t == 30) continue;
      if (shoot(x + i + 3) == 30) break;
    }
    return x > 3 ? shoot(x) : 50;
  }
  uint32_t main(uint32_t x) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < 3; ++i) {
      if ((shoot(x + i) == 30 && walk(x) > 99) || shoot(x) == 2) sum += 7;
      const uint32_t label = shoot(x + 2 * i);
      if (label == 1) sum += walk(x + i);
      if (label == 1 || label == 2) {
        sum += 1000;
      } else {
        if (i == 1) continue;
        sum += 20000;
      }
      sum += sum > 21000 ? shoot(x + 1) : walk(x + 5);
    }
    return sum;
  }
};

TEST_CASE("rays traced deep in functions and conditions come back to the lane that asked") {
  std::vector<LabShaders::Group> hit(6);
  hit[0] = {"tag1.rchit", "", ""};
  hit[1] = {"tag2.rchit", "", ""};
  hit[4] = {"tag3.rchit", "", "pair.rint"};
  hit[5] = {"tag1.rchit", "", "pair.rint"};
  RayLab lab({"calls.rgen", {"table.rmiss"}, hit, {}});
  check_pixels(lab, [](uint32_t x, uint32_t) {
    Caller caller;
    const uint32_t sum = caller.main(x);
    return Row{sum, caller.traces};
  });
}

}  // namespace
}  // namespace glint::test
