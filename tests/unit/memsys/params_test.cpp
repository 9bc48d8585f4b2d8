// Tests that impossible configurations are reported with what was expected, and that peaks match data sheets.
// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <utility>
#include <vector>

#include "memsys/peak.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::mem;

namespace {

std::vector<std::string> errors(const std::function<void(Params&)>& change) {
  Params params;
  change(params);
  Diagnostics diagnostics;
  check(params, diagnostics);
  return diagnostics.messages();
}

}  // namespace

TEST_CASE("errors name the section that the parameters stand in before every key") {
  Params params;
  params.dram.row_bytes = 1000;
  Diagnostics diagnostics;
  check(params, diagnostics, "memory.");
  REQUIRE(diagnostics.messages().size() == 1);
  CHECK_THAT(diagnostics.messages()[0],
             Catch::Contains("'memory.dram.row_bytes' is 1000, expected a multiple of 'memory.interleave'"));
}

TEST_CASE("the default memory system is possible") {
  CHECK(errors([](Params&) {}).empty());
}

TEST_CASE("each impossible value is reported once with what was expected") {
  const auto one = [](const std::function<void(Params&)>& change, const std::string& expected) {
    const std::vector<std::string> messages = errors(change);
    REQUIRE(messages.size() == 1);
    CHECK_THAT(messages[0], Catch::Contains(expected));
  };
  one([](Params& p) { p.l1.mshr_entries = 0; }, "'l1.mshr_entries' is 0, expected at least 1");
  one([](Params& p) { p.l2.mshr_merges = 0; }, "'l2.mshr_merges' is 0, expected at least 1");
  one([](Params& p) { p.l1.ports = 0; }, "'l1.ports' is 0, expected at least 1");
  one([](Params& p) { p.l1.size = 64; }, "'l1.size' is 64 bytes, expected at least one line of 128 bytes");
  one([](Params& p) { p.l2.slice_size = 1024; },
      "expected at least one set: 16 ways x 128 bytes = 2048 bytes");
  one([](Params& p) { p.l2.slice_size = 3000; }, "expected a multiple of 2048 bytes");
  one([](Params& p) { p.line = 96; }, "'line' is 96 bytes, expected a power of two");
  one(
      [](Params& p) {
        p.interleave = 384;
        p.dram.row_bytes = 768;
      },
      "'interleave' is 384 bytes, expected a power of two");
  one([](Params& p) { p.dram.row_bytes = 1000; },
      "'dram.row_bytes' is 1000, expected a multiple of 'interleave' = 256");
  one([](Params& p) { p.dram.banks = 15; },
      "'dram.banks' is 15, expected a multiple of 'dram.bank_groups' = 4");
  one([](Params& p) { p.dram.bus_bytes = 3; }, "is 48 bytes, expected a power of two");
  one([](Params& p) { p.l2.dram_queue = 4; }, "'l2.dram_queue' is 4, expected at least 8");
  one([](Params& p) { p.dram.channels = 0; }, "'dram.channels' is 0, expected at least 1");
}

TEST_CASE("each further impossible value is reported once with what was expected") {
  const auto one = [](const std::function<void(Params&)>& change, const std::string& expected) {
    const std::vector<std::string> messages = errors(change);
    REQUIRE(messages.size() == 1);
    CHECK_THAT(messages[0], Catch::Contains(expected));
  };
  one(
      [](Params& p) {
        p.l1.allocate = "on_miss";
        p.l1.miss_queue = 1;
      },
      "'l1.miss_queue' is 1, expected at least 2");
  one(
      [](Params& p) {
        p.l1.write_allocate = true;
        p.l1.miss_queue = 1;
      },
      "'l1.miss_queue' is 1, expected at least 2");
  one([](Params& p) { p.noc.sides = 5; }, "'noc.sides' is 5, expected at most the 4 slices");
  one([](Params& p) { p.noc.far_latency = 5; }, "'noc.far_latency' is 5, and 'noc.sides' is 1");
  one([](Params& p) { p.dram.refi = 165.0; }, "'dram.refi' is 165 ns, expected more than the 165.9 ns");
  one(
      [](Params& p) {
        p.dram.refresh = "per_bank";
        p.dram.refi = 100.0;
      },
      "of 'dram.rfc_bank', 'dram.ras' and 'dram.rp'");
  CHECK(errors([](Params& p) {
          p.dram.refresh = "none";
          p.dram.refi = 1.0;
        }).empty());
}

TEST_CASE("a level that delivers more than the next carries is warned of, with both bandwidths") {
  const auto warnings = [](const std::function<void(Params&)>& change) {
    Params params;
    change(params);
    Diagnostics diagnostics;
    warn(params, 8, 1365.0, diagnostics, "memory.");
    CHECK_FALSE(diagnostics.has_errors());
    return diagnostics.messages();
  };
  CHECK(warnings([](Params&) {}).empty());
  // A port of 10 bytes per cycle moves a line and its header in 14 cycles.
  const auto narrow = warnings([](Params& p) { p.noc.partition_reply_bytes = 10; });
  REQUIRE(narrow.size() == 1);
  CHECK_THAT(narrow[0], Catch::Contains("DRAM could deliver 56.0 GB/s and the slices' reply ports carry 49.9 "
                                        "GB/s ('memory.noc.partition_reply_bytes')"));
  CHECK(warnings([](Params& p) { p.noc.partition_reply_bytes = 14; }).empty());
  CHECK(warnings([](Params& p) {
          p.dram.bus_bytes = 4;
          p.dram.burst = 8;
          p.dram.transfers_per_clock = 8;
          p.dram.clock_mhz = 7000;
        }).size() == 3);
}

TEST_CASE("the defaults are the kind gddr6_7000, and each kind is possible and as fast as its name says") {
  const auto listing = [](const DramParams& params) {
    std::string out;
    for (const ParamInfo& info : describe_params(params)) out += info.key + "=" + info.value + "\n";
    return out;
  };
  DramParams named;
  named.rcd = 1.0, named.banks = 8;
  apply_dram_kind(named, "gddr6_7000");
  CHECK(listing(named) == listing(DramParams{}));
  for (const auto& [kind, gigabytes] : {std::pair{"gddr6_7000", 14.0},
                                        {"gddr6_14000", 28.0},
                                        {"gddr6_14000_1v25", 28.0},
                                        {"gddr6x_19000", 38.0},  // 760 GB/s on 20 channels
                                        {"gddr7_28000", 28.0},   // 1792 GB/s on 64 channels
                                        {"lpddr5_6400", 12.8},
                                        {"hbm3_6400", 25.6}}) {
    INFO(kind);
    CHECK(errors([&, name = kind](Params& p) { apply_dram_kind(p.dram, name); }).empty());
    Params params;
    apply_dram_kind(params.dram, kind);
    CHECK(params.dram.atom_bytes() == 32);
    CHECK(peak(params, 8, 1365.0).dram_bandwidth == Approx(4 * gigabytes * 1e9));
    CHECK_FALSE(dram_kind_doc(kind).empty());
  }
  CHECK(dram_kinds().size() == 7);
}

TEST_CASE("a kind of DRAM sets what a file does not name, whatever the order of the keys") {
  const auto read = [](const char* text) {
    Config config;
    config.add_text("test", text);
    Diagnostics diagnostics;
    ConfigTable root = config.root(diagnostics);
    Params params;
    read_params(root, params);
    CHECK(diagnostics.messages().empty());
    return params.dram;
  };
  for (const char* text :
       {"[dram]\nkind = \"hbm3_6400\"\nrcd = 20.5\n", "[dram]\nrcd = 20.5\nkind = \"hbm3_6400\"\n"}) {
    const DramParams d = read(text);
    CHECK(d.kind == "hbm3_6400");
    CHECK(d.rcd == 20.5);
    CHECK(d.cl == 12.5);
    CHECK(d.dual_command_bus);
  }
  CHECK(read("[dram]\nrcd = 20.5\n").cl == 13.7);
}

TEST_CASE("peaks of the mobile part are those of its data sheet") {
  const Peak p = peak(Params{}, 8, 1365.0);
  CHECK(p.dram_bandwidth == Approx(56e9));
  CHECK(p.dram_refreshed == Approx(56e9 * (1 - 120.3 / 1900)));
  CHECK(p.l2_bytes == 512 * 1024);
  CHECK(p.l1_bandwidth == Approx(8 * 128 * 1365e6));
  CHECK(p.network() == Approx(4 * 32 * 1365e6));
}

TEST_CASE("every parameter can be read from a configuration and unknown policies are refused") {
  Config config;
  config.add_text(
      "test",
      "line = 64\n[l1]\nways = 4\n[dram]\nrcd = 14.5\nscheduler = \"fcfs\"\n[dram.frfcfs]\nhit_cap = 3\n");
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  Params params;
  read_params(root, params);
  CHECK(diagnostics.messages().empty());
  CHECK(params.line == 64);
  CHECK(params.l1.ways == 4);
  CHECK(params.dram.rcd == 14.5);
  CHECK(params.dram.scheduler.name == "fcfs");

  Config wrong;
  wrong.add_text("test", "[dram]\nscheduler = \"frfcf\"\n");
  ConfigTable wrong_root = wrong.root(diagnostics);
  read_params(wrong_root, params);
  REQUIRE(diagnostics.messages().size() == 1);
  CHECK_THAT(diagnostics.messages()[0], Catch::Contains("did you mean \"frfcfs\""));
}
