// Tests the summary, bars, columns and the progress line as a terminal shows them.
// SPDX-License-Identifier: Apache-2.0
#include "report/terminal/summary.h"

#include "report/terminal/progress.h"
#include "report/terminal/table.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

Summary example() {
  Summary s;
  s.title = "WKND pt";
  s.files = {"picture: out/image.png"};
  s.warp_instructions = 3000;
  s.simt_efficiency = 0.5;
  s.mix = {{"alu", 750, 3000}, {"rt", 250, 9000}};
  s.rays = 100;
  s.nodes_per_ray = 12;
  s.bvh_depth = 8;
  s.wall_seconds = 2;
  TimingSummary timing;
  timing.cycles = 6000, timing.clock_mhz = 1000;
  timing.resident_warps = 24, timing.warp_slots = 32, timing.residency_limit = "registers";
  timing.memory_peaks = "DRAM 42.0 GB/s";
  timing.l1_rt = {75, 100}, timing.l2 = {1, 4};
  timing.dram_utilisation = 0.25, timing.dram_efficiency = 0.5, timing.rt_efficiency = 0.125;
  s.timing = timing;
  return s;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("the summary derives IPC, shares, hit rates and the traversal ratio from its counts") {
  const std::string text = format_summary(example(), {});

  CHECK(has(text, "6 000  = 0.006 ms at 1000 MHz"));
  CHECK(has(text, "IPC                   0.500"));
  CHECK(has(text, "alu             750  75.0 %  ###############.....   25.0 %  #####..............."));
  CHECK(has(text, "L1D hits, RT unit   75.0 %"));
  CHECK(has(text, "75 of 100 accesses"));
  CHECK(has(text, "1.50  nodes per ray / BVH depth 8"));
  CHECK(has(text, "24 of 32"));
  CHECK(has(text, "at most, limited by registers"));
  CHECK(has(text, " at best: DRAM 42.0 GB/s"));
  CHECK(has(text, "1500 warp instructions/s") == false);
  CHECK(has(text, "2 k warp instructions/s, 3 k cycles/s"));
}

TEST_CASE("what was not measured is absent, and a cache without accesses has no rate") {
  const std::string text = format_summary(example(), {});

  CHECK_FALSE(has(text, "RT-unit occupancy"));
  CHECK(has(text, "RT-unit efficiency"));
  CHECK(has(text, "no accesses"));
}

TEST_CASE("a functional run shows no cycles, no latency and no caches") {
  Summary s = example();
  s.timing.reset();
  for (MixRow& row : s.mix) row.latency = 0;
  const std::string text = format_summary(s, {});

  for (const char* word : {"cycles", "latency", "L1D", "DRAM", "IPC"}) CHECK_FALSE(has(text, word));
  CHECK(has(text, "warp instructions   3 000"));
}

TEST_CASE("without a terminal the summary is plain ASCII") {
  for (const char c : format_summary(example(), {})) CHECK((c == '\n' || (c >= ' ' && c <= '~')));
}

TEST_CASE("colour adds escape sequences and changes no visible character") {
  std::string coloured = format_summary(example(), {false, true});
  REQUIRE(has(coloured, "\x1b["));
  for (size_t at; (at = coloured.find('\x1b')) != std::string::npos;)
    coloured.erase(at, coloured.find('m', at) - at + 1);

  CHECK(coloured == format_summary(example(), {}));
}

TEST_CASE("a bar has its width in columns at every fill and eighths on a UTF-8 terminal") {
  for (int i = -1; i <= 17; ++i) CHECK(display_width(bar(i / 16.0, 10, {true, false})) == 10);
  CHECK(bar(0.5, 4, {}) == "##..");
  CHECK(bar(0.5, 1, {true, false}) == "▌");
  CHECK(bar(1.5, 2, {true, false}) == "██");
}

TEST_CASE("columns align on displayed width") {
  CHECK(table({{"a", "1"}, {"▌▌b", "22"}}, "<>", " ") == " a     1\n ▌▌b  22\n");
}

TEST_CASE("numbers read as people write them") {
  CHECK(with_thousands(999) == "999");
  CHECK(with_thousands(1234567) == "1 234 567");
  CHECK(seconds(0.0123) == "12 ms");
  CHECK(seconds(59.94) == "59.9 s");
  CHECK(seconds(59.96) == "1 min 00 s");
  CHECK(seconds(3720) == "1 h 02 min");
  CHECK(rate(3.42e6) == "3.42 M");
}

TEST_CASE("the progress line extrapolates the time left") {
  CHECK(progress_line("render", 1, 4, 2.0, {}) ==
        " render [######..................]  25 %  2.0 s  ETA 6.0 s");
  CHECK(progress_line("render", 4, 4, 2.0, {}) == " render [########################] 100 %  2.0 s");
  // A launch that gets nowhere still shows that it runs, and what it is.
  CHECK(progress_line("endless.comp of mine", 0, 4, 2.0, {},
                      {.cycles = 123'000'000, .instructions = 7'000'000}) ==
        " endless.comp [........]   0 %  2.0 s  123.00 M cycles  3.50 M instr/s");
  CHECK(progress_line("never.comp", 0, 4, 64.0, {},
                      {.cycles = 9'000'000, .instructions = 64'000'000, .at = "never.comp:6"}) ==
        " never.comp   0 %  1 min 04 s  9.00 M cycles  1.00 M instr/s  at never.comp:6");
  CHECK(progress_line("SHIP", 1, 4, 2.0, {}, {.cycles = 0, .instructions = 3000}) ==
        " SHIP [##......]  25 %  2.0 s  ETA 6.0 s  2 k instr/s");
}

}  // namespace
}  // namespace glint::report
