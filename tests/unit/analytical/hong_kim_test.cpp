// Tests Hong and Kim's equations on the paper's example and on others done by hand, and the table of models.
// SPDX-License-Identifier: Apache-2.0
#include "report/analytical/hong_kim.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "report/analytical/model_table.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::report;

namespace {

HongKimInputs small() {
  HongKimInputs in;
  in.cores = 1, in.warps = 8, in.repetitions = 2;
  in.instructions = 100, in.memory_instructions = 10, in.accesses = 1;
  in.dram_latency = 400, in.miss_rate = 0.5, in.departure_delay = 4, in.issue_cycles = 1;
  in.bytes = 32, in.bandwidth = 3.2;
  return in;
}

}  // namespace

TEST_CASE("The worked example of Hong and Kim's paper comes out as it stands there, up to its rounding",
          "[analytical]") {
  HongKimInputs in;
  in.cores = 16, in.warps = 20, in.repetitions = 1;
  in.instructions = 27 + 6, in.memory_instructions = 6, in.accesses = 32;
  in.dram_latency = 420, in.miss_rate = 1, in.departure_delay = 10, in.issue_cycles = 4;
  in.bytes = 128, in.bandwidth = 80;  // 80 GB/s at 1 GHz
  const HongKimResult out = hong_kim(in);
  CHECK(out.computation_cycles == 132);
  CHECK(std::abs(out.memory_cycles - 4380) < 1e-9);
  CHECK(std::abs(out.mwp - 2.28) < 0.005);
  CHECK(std::abs(out.mwp_peak_bandwidth - 28.57) < 0.1);
  CHECK(out.cwp == 20);
  CHECK(out.equation == 23);
  CHECK(std::abs(out.cycles / 38450 - 1) < 0.001);
}

TEST_CASE("Enough parallelism on both sides is equation 22", "[analytical]") {
  const HongKimResult out = hong_kim(small());  // latency 200, 20 warps' worth of bandwidth, 50 departures
  CHECK(out.equation == 22);
  CHECK(std::abs(out.cycles - 2 * (2000 + 100 + 10 * 7)) < 1e-9);
}

TEST_CASE("Too little bandwidth is equation 23, and halves the speed when it halves", "[analytical]") {
  HongKimInputs in = small();
  in.bandwidth = 0.32;
  const HongKimResult out = hong_kim(in);
  CHECK(std::abs(out.mwp - 2) < 1e-9);
  CHECK(out.equation == 23);
  CHECK(std::abs(out.cycles - 2 * (2000 * 8 / 2.0 + 10)) < 1e-9);
}

TEST_CASE("Computation that hides memory is equation 24", "[analytical]") {
  HongKimInputs in = small();
  in.instructions = 1000;
  const HongKimResult out = hong_kim(in);
  CHECK(out.cwp == 3);
  CHECK(out.equation == 24);
  CHECK(std::abs(out.cycles - 2 * (200 + 1000 * 8)) < 1e-9);
}

TEST_CASE("A warp that computes longer than it waits is equation 24, also where few warps compute",
          "[analytical]") {
  HongKimInputs in = small();
  in.warps = 1.5, in.instructions = 4000;  // (Comp + Mem) / Comp = 1.5 and MWP = 1.5
  CHECK(hong_kim(in).equation == 22);
  in.warps = 4;
  const HongKimResult out = hong_kim(in);
  CHECK(out.mwp == 4);
  CHECK(out.equation == 24);
  CHECK(std::abs(out.cycles - 2 * (200 + 4000 * 4)) < 1e-9);
}

TEST_CASE("Without memory instructions the warps compute in turns", "[analytical]") {
  HongKimInputs in = small();
  in.memory_instructions = 0, in.accesses = 0, in.bytes = 0, in.launch_latency = 50;
  CHECK(hong_kim(in).cycles == 50 + 2 * 100 * 8);
}

TEST_CASE("A barrier costs the departures of the other memory warps, for each block", "[analytical]") {
  HongKimInputs in = small();
  const double without = hong_kim(in).cycles;
  in.barriers = 3, in.blocks = 4;
  const HongKimResult out = hong_kim(in);  // 4 cycles a departure, MWP 8
  CHECK(std::abs(out.synchronization_cost - 4 * 7 * 3 * 4 * 2) < 1e-9);
  CHECK(std::abs(out.cycles - without - out.synchronization_cost) < 1e-9);
}

TEST_CASE("Accesses that hit wait for the L1", "[analytical]") {
  HongKimInputs in = small();
  in.miss_rate = 0.25, in.hit_latency = 20;
  CHECK(hong_kim(in).memory_cycles == 10 * (100 + 15));
}

TEST_CASE("Several launches take the cycles of one so many times", "[analytical]") {
  HongKimInputs in = small();
  in.launch_latency = 5000;
  const double one = hong_kim(in).cycles;
  in.launches = 3;
  CHECK(hong_kim(in).cycles == 3 * one);
  in.memory_instructions = 0;
  CHECK(hong_kim(in).cycles == 3 * (5000 + 100 * 8 * 2));
}

TEST_CASE("LumiBench's adjustment multiplies the latency by the miss rate", "[analytical]") {
  HongKimInputs in = small();
  in.miss_rate = 0.25;
  CHECK(hong_kim(in).memory_cycles == 1000);
}

TEST_CASE("LumiBench's inputs leave out the hits and load whole rows of a warp, whatever DRAM has seen",
          "[analytical]") {
  HongKimInputs in = small();
  in.miss_rate = 0.25, in.hit_latency = 20, in.bytes = 1;
  const HongKimInputs out = as_lumibench(in);
  CHECK(out.memory_latency() == 100);
  CHECK(out.bytes == 128);
  CHECK(out.warps == in.warps);
}

TEST_CASE("A run without statistics of the timing machine is refused by name", "[analytical]") {
  RunRecord run;
  run.add_stats("path,value,unit,doc\ngpu.rays,1,ray,x\n", "stats.csv");
  CHECK_THROWS_WITH(hong_kim_inputs(run, "out/x"),
                    Catch::Contains("out/x") && Catch::Contains("timing machine"));
}

TEST_CASE("R2 is blind to a factor, the mean error is not", "[analytical]") {
  const ModelTable table{{"twice", "constant"},
                         {{"A", 100, {200, 150}, {{"in", 1.5}}},
                          {"B", 200, {400, 150}, {{"in", 2}}},
                          {"C", 400, {800, 150}, {{"in", 3}}}}};
  const ModelScore twice = table.score(0), constant = table.score(1);
  CHECK(std::abs(twice.r2 - 1) < 1e-12);
  CHECK(std::abs(twice.mean_error - 1) < 1e-12);
  CHECK(std::abs(twice.ratio - 2) < 1e-12);
  CHECK(constant.r2 == 0);
  CHECK(constant.worst == "C");
  CHECK(std::abs(constant.mean_error - (0.5 + 0.25 + 0.625) / 3) < 1e-12);
}

TEST_CASE("A table of models reads back as it was", "[analytical]") {
  const ModelTable table{{"a", "b, c"},
                         {{"A", 100, {200.125, 150}, {{"in", 1.5}, {"more", 7}}},
                          {"B", 200, {400, 1e9 / 3}, {{"in", 2}, {"more", 8}}}}};
  const ModelTable read = parse_models(model_csv(table), "models.csv");
  CHECK(model_csv(read) == model_csv(table));
  CHECK(models_json(read) == models_json(table));
  CHECK_THROWS_WITH(parse_models("workload,ipc\nA,1\n", "x.csv"),
                    Catch::Contains("x.csv:1") && Catch::Contains("not a table of models"));
}

TEST_CASE("A table of models that lost its rows, or has a run without cycles, is refused with the line",
          "[analytical]") {
  const auto refused = [](const std::string& rows, const char* line, const char* why) {
    CHECK_THROWS_WITH(parse_models("workload,cycles,model:a,in\n" + rows, "x.csv"),
                      Catch::Contains(line) && Catch::Contains(why));
  };
  refused("", "x.csv:1", "no workload");
  for (const char* cycles : {"nan", "inf", "-5", "0"}) {
    refused(std::string("A,100,90,0\nB,") + cycles + ",90,0\n", "x.csv:3", "is not a number of cycles");
    refused(std::string("A,100,") + cycles + ",0\n", "x.csv:2", "is not a number of cycles");
  }
  refused("A,12x,90,0\n", "x.csv:2", "is not a number");
  CHECK_THROWS_WITH(parse_models("workload,cycles,mod\n", "x.csv"),
                    Catch::Contains("x.csv:1") && Catch::Contains("model:"));
  CHECK(parse_models("workload,cycles,model:a,in\nA,100,90,0\n", "x.csv").rows.size() == 1);
}
