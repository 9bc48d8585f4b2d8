// Tests L2 slices to the cycle: several of a partition, near and far ones, credits, partial writes, fills.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/timing/memsys/requests.h"

using namespace glint;
using namespace glint::mem;

namespace {

Request masked_write(Address line, uint8_t sectors, WordMask words) {
  return {line, sectors, true, Traffic::ShaderGlobal, 0, words};
}

// Returns lines of one slice, the first of a partition.
std::vector<Address> lines_of(const PartitionMap& map, uint32_t slice, uint32_t count) {
  std::vector<Address> out;
  for (Address line = 0; out.size() < count; line += 128)
    if (map.slice(line) == slice) out.push_back(line);
  return out;
}

uint64_t dram_reads(MemoryRig& rig) {
  uint64_t sum = 0;
  for (uint32_t p = 0; p < rig.memory().num_partitions(); ++p)
    sum += rig.memory().partition(p).dram().stats().reads.value();
  return sum;
}
const L2Stats& slice_of(MemoryRig& rig, Address line) {
  const uint32_t slice = rig.memory().map().slice(line), of_one = rig.memory().partition(0).num_slices();
  return rig.memory().partition(slice / of_one).slice(slice % of_one).stats();
}

}  // namespace

TEST_CASE(
    "a slice on the far side is reached later by the far latency, each way, and one on the near side is "
    "not") {
  Params params = bare();
  params.noc.sides = 2, params.noc.far_latency = 78;  // one side has cores and slices 0 and 1
  MemoryRig rig(params, 4);
  for (uint32_t slice = 0; slice < 4; ++slice) {
    const Address line = lines_of(rig.memory().map(), slice, 1)[0];
    rig.read_latency(line, 1, true);
    CHECK(rig.read_latency(line, 1) == kL2Hit + (slice < 2 ? 0 : 2 * 78));
  }
}

TEST_CASE("two slices of a partition answer two packets in the time in which one slice answers one") {
  const auto last = [](uint32_t slices) {
    Params params = bare();
    params.dram.channels = 1, params.l2.slices = slices, params.interleave = 128, params.hash = "none";
    params.noc.core_request_bytes = 400, params.noc.core_reply_bytes = 400;
    params.l1.ports = 8, params.l1.banks = 64;
    params.noc.partition_reply_bytes = 400;
    params.l2.sectors_per_cycle = 1;
    MemoryRig rig(params, 2);
    for (Address i = 0; i < 2; ++i) rig.read_latency(i * 128, 0b1111, true);
    const Cycle start = rig.now();
    rig.run([&](uint32_t core, Cycle now) {
      if (now == start) REQUIRE(rig.l1(core).access(now, Client::Lsu, read(core * 128, core, 0b1111)));
      return kNever;
    });
    return rig.answers().back().at - start;
  };
  CHECK(last(1) == last(2) + 4);  // the second packet waits for four sectors of the first
}

TEST_CASE("slices of a partition share its DRAM channel, and each line lives in one of them") {
  Params params = bare();
  params.dram.channels = 2, params.l2.slices = 3;
  MemoryRig rig(params);
  for (Address i = 0; i < 600; ++i) rig.read_latency(i * 128, 1);
  CHECK(dram_reads(rig) == 600);
  for (uint32_t p = 0; p < 2; ++p) {
    uint64_t reads = 0;
    for (uint32_t s = 0; s < 3; ++s) {
      CHECK(rig.memory().partition(p).slice(s).stats().reads.total() == 100);
      reads += rig.memory().partition(p).slice(s).stats().reads.total();
    }
    CHECK(rig.memory().partition(p).dram().stats().reads.value() == reads);
  }
  rig.memory().check_drained();
}

TEST_CASE(
    "a core with one credit sends its next packet to a slice when the credit is back, not a cycle before") {
  const auto second = [](uint32_t credits) {
    Params params = bare();
    params.noc.credits = credits;
    MemoryRig rig(params);
    const std::vector<Address> lines = lines_of(rig.memory().map(), 0, 2);
    for (const Address line : lines) rig.read_latency(line, 1, true);
    const Cycle start = rig.now();
    REQUIRE(rig.l1().access(start, Client::Lsu, read(lines[0], 1)));
    REQUIRE(rig.l1().access(start + 1, Client::Lsu, read(lines[1], 2)));
    rig.drain();
    rig.memory().check_drained();
    return rig.answers().back().at - start;
  };
  CHECK(second(2) == kL2Hit + 1);
  CHECK(second(0) == kL2Hit + 1);
  // The first packet is served at 20 + 1 + 48, and its credit is back 1 + 48 later. Then the second takes its
  // 1 + 48, the slice and the way back.
  CHECK(second(1) == (20 + 49) + 49 + 49 + 42 + 49);
}

TEST_CASE("a packet without a credit keeps those behind it, and another slice's credit does not let it go") {
  Params params = bare();
  params.noc.credits = 1;
  MemoryRig rig(params);
  const Address first = lines_of(rig.memory().map(), 0, 2)[0], second = lines_of(rig.memory().map(), 0, 2)[1];
  const Address other = lines_of(rig.memory().map(), 1, 1)[0];
  for (const Address line : {first, second, other}) rig.read_latency(line, 1, true);
  const Cycle start = rig.now();
  Token token = 0;
  for (const Address line : {first, second, other}) {
    REQUIRE(rig.l1().access(start + token, Client::Lsu, read(line, token)));
    ++token;
  }
  rig.drain();
  CHECK(rig.answers()[1].at - start == 258);
  CHECK(rig.answers()[2].at - start == 259);
}

TEST_CASE("a sector written in part is fetched when it is read, and only then") {
  Params params = bare();
  params.l2.write_masks = true;
  MemoryRig rig(params);
  // The write covers sector 0 whole, and half of sector 1.
  REQUIRE(rig.l1().access(rig.now(), Client::Lsu, masked_write(kLine, 0b0011, 0x0000'0fff)));
  rig.drain();
  CHECK(dram_reads(rig) == 0);
  CHECK(slice_of(rig, kLine).partial_writes.value() == 1);
  CHECK(rig.read_latency(kLine, 0b0001) == kL2Hit);
  CHECK(dram_reads(rig) == 0);
  CHECK(rig.read_latency(kLine, 0b0010) > kL2Hit + 100);
  CHECK(dram_reads(rig) == 1);
  CHECK(slice_of(rig, kLine).completed_sectors.value() == 1);
}

TEST_CASE("writes that together cover a sector make it whole, and one word less does not") {
  for (const WordMask rest : {WordMask{0xf0}, WordMask{0x70}}) {
    Params params = bare();
    params.l2.write_masks = true;
    MemoryRig rig(params);
    REQUIRE(rig.l1().access(rig.now(), Client::Lsu, masked_write(kLine, 1, 0x0f)));
    REQUIRE(rig.l1().access(rig.now() + 1, Client::Lsu, masked_write(kLine, 1, rest)));
    rig.drain();
    CHECK((rig.read_latency(kLine, 1) == kL2Hit) == (rest == 0xf0));
  }
}

TEST_CASE("a sector written in part takes the slice for its interval, a whole one for a cycle") {
  const auto run = [](uint32_t interval, WordMask words) {
    Params params = bare();
    params.l2.partial_interval = interval;
    MemoryRig rig(params);
    const std::vector<Address> lines = lines_of(rig.memory().map(), 0, 2);
    rig.read_latency(lines[1], 1, true);
    const Cycle start = rig.now();
    const size_t before = rig.answers().size();
    REQUIRE(rig.l1().access(start, Client::Lsu, masked_write(lines[0], 1, words)));
    REQUIRE(rig.l1().access(start + 1, Client::Lsu, read(lines[1], 7)));
    rig.drain();
    return std::pair(rig.answers().at(before).at - start, rig.memory().written_until() - start);
  };
  const auto whole = run(0, 0xff), part = run(9, 0x7f);
  CHECK(run(9, 0xff) == whole);
  CHECK(run(0, 0x7f) == whole);
  CHECK(part.second - whole.second == 9 - 1);  // the write ends later, and so does a launch
  CHECK(part.first - whole.first == 9 - 1);    // the read behind the write ends later
}

TEST_CASE(
    "a write takes the slice for its visit and its sectors, in sixteenths of a cycle that add up over those "
    "that wait") {
  // Returns when the last write has been served. The writes come a cycle apart and wait for each other.
  const auto end = [](uint32_t writes, uint8_t sectors, WordMask words) {
    Params params = bare();
    params.l2.write_visit = 1.25;
    params.l2.partial_interval = 1.3125;
    MemoryRig rig(params);
    const std::vector<Address> lines = lines_of(rig.memory().map(), 0, writes);
    const Cycle start = rig.now();
    for (uint32_t i = 0; i < writes; ++i)
      REQUIRE(rig.l1().access(start + i, Client::Lsu, masked_write(lines[i], sectors, words)));
    rig.drain();
    return rig.memory().written_until() - start;
  };
  const auto cost = [&](uint32_t writes, uint8_t sectors, WordMask words, Cycle one) {
    return end(writes, sectors, words) - end(1, sectors, words) + one;
  };
  // 16 writes of one sector in part take 16 x (1.25 + 1.3125) = 41; 2 take 5.125 and 3 take 7.6875, rounded
  // up once.
  CHECK(cost(16, 1, 0x01, 3) == 41);
  CHECK(cost(2, 1, 0x01, 3) == 6);
  CHECK(cost(3, 1, 0x01, 3) == 8);
  // A whole sector takes 1.25 + 1, a line 5.25, and four sectors in part 1.25 + 4 x 1.3125.
  CHECK(cost(4, 1, 0xff, 3) == 9);
  CHECK(cost(4, 0xf, kAllWords, 6) == 21);
  CHECK(cost(2, 0xf, 0x0101'0101, 7) == 13);
}

TEST_CASE("without masks a write covers its sectors, whatever its words") {
  MemoryRig rig(bare());
  REQUIRE(rig.l1().access(rig.now(), Client::Lsu, masked_write(kLine, 1, 0x01)));
  rig.drain();
  CHECK(rig.read_latency(kLine, 1) == kL2Hit);
  CHECK(dram_reads(rig) == 0);
}

TEST_CASE("a sector written in part is written back on eviction without having been fetched") {
  Params params = bare();
  params.l2.write_masks = true;
  params.dram.channels = 1;
  params.l2.slice_size = 2 * 128, params.l2.ways = 0;
  MemoryRig rig(params);
  REQUIRE(rig.l1().access(rig.now(), Client::Lsu, masked_write(0, 1, 0x01)));
  rig.drain();
  for (Address i = 1; i < 3; ++i) rig.read_latency(i * 128, 1);
  const DramStats& dram = rig.memory().partition(0).dram().stats();
  CHECK(dram.writes.value() == 1);
  CHECK(dram.reads.value() == 2);
  CHECK(rig.read_latency(0, 1) > kL2Hit);  // old words do not count for the line's next stay
  rig.memory().check_drained();
}

TEST_CASE(
    "a sector from DRAM takes the slice a cycle when they share a port: who is served in that cycle waits "
    "for one") {
  // Asks for a miss, and `after` cycles later for a hit in the same slice (0: there is no hit). Returns when
  // the token of each came back.
  const auto tokens = [](bool shared, Cycle after) {
    Params params = bare();
    params.l2.fill_takes_service = shared;
    params.l2.sectors_per_cycle = 1;
    MemoryRig rig(params);
    const std::vector<Address> lines = lines_of(rig.memory().map(), 0, 2);
    rig.read_latency(lines[1], 1, true);
    const Cycle start = rig.now();
    rig.run([&](uint32_t, Cycle now) {
      if (now == start) REQUIRE(rig.l1().access(now, Client::RtUnit, read(lines[0], 0)));
      if (after && now == start + after) REQUIRE(rig.l1().access(now, Client::Lsu, read(lines[1], 1)));
      return after && now < start + after ? start + after : kNever;
    });
    std::array<Cycle, 2> at{};
    for (const Answered& a : rig.answers()) at[a.token] = a.at - start;
    return at;
  };
  const Cycle fill = tokens(true, 0)[0] - 49;  // the fill is 1 + 48 before its token
  const Cycle same = fill - (20 + 49);         // a packet asked for then is served in the cycle of the fill
  for (const bool shared : {false, true}) {
    CHECK(tokens(shared, same - 1)[1] == same - 1 + kL2Hit);
    // The slice answers a cycle later.
    CHECK(tokens(shared, same)[1] == same + kL2Hit + (shared ? 1 : 0));
    CHECK(tokens(shared, same + 1)[1] == same + 1 + kL2Hit);
  }
}

TEST_CASE("without a hash, consecutive chunks go round the slices") {
  const PartitionMap map(3, 2, 256, SliceHash::None);
  for (Address chunk = 0; chunk < 60; ++chunk) {
    CHECK(map.slice(chunk * 256) == chunk % 6);
    CHECK(map.partition(chunk * 256) == chunk % 6 / 2);
    CHECK(map.local(chunk * 256, map.slice(chunk * 256)) == (chunk / 6 * 2 + chunk % 2) * 256);
  }
}
