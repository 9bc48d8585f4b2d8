// Tests the small structures of the memory system: line table, tags, MSHRs, fan-in, address maps.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "base/registry.h"
#include "memsys/address_map.h"
#include "memsys/cache/mshr.h"
#include "memsys/cache/tag_array.h"
#include "memsys/dram/dram_timing.h"
#include "memsys/messages/fan_in.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::mem;

TEST_CASE("a line table agrees with std::map over random insertions and erasures") {
  LineTable table(8);
  std::map<Address, uint32_t> reference;
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    const Address line = random() % 300 * 128;
    const auto found = reference.find(line);
    REQUIRE(table.find(line) == (found == reference.end() ? LineTable::kNone : found->second));
    if (found == reference.end()) {
      table.insert(line, uint32_t(i));
      reference[line] = uint32_t(i);
    } else {
      table.erase(line);
      reference.erase(found);
    }
    REQUIRE(table.size() == reference.size());
  }
}

TEST_CASE("the least recently used line of a set is the victim") {
  TagArray tags({1, 3, 128}, "lru");
  for (const Address line : {0, 128, 256}) tags.insert(line).valid = 1;
  tags.touch(tags.find(0));
  CHECK(tags.victim(384).address() == 128);
  tags.insert(384).valid = 1;
  CHECK(tags.find(128) == TagArray::kNone);
  CHECK(tags.find(0) != TagArray::kNone);
  CHECK(tags.victim(512).address() == 256);
}

TEST_CASE("bringing a line's set near changes nothing that is found or replaced") {
  for (const uint32_t ways : {1u, 3u, 16u, 64u}) {
    CAPTURE(ways);
    TagArray tags({2, ways, 128}, "lru");
    for (Address line = 0; line < 300 * 128; line += 128) {
      tags.prefetch(line);
      const uint32_t victim = tags.slot_of(tags.victim(line));
      CHECK(tags.find(line) == TagArray::kNone);
      CHECK(tags.slot_of(tags.insert(line)) == victim);
      tags.line(victim).valid = 1;
      CHECK(tags.find(line) == victim);
      CHECK(tags.line(victim).address() == line);
    }
  }
}

TEST_CASE("a set-associative array replaces only inside a line's set") {
  TagArray tags({4, 2, 128}, "lru");
  std::set<Address> present;
  for (Address line = 0; line < 64 * 128; line += 128) {
    const TagArray::Line& victim = tags.victim(line);
    if (victim.valid) present.erase(victim.address());
    tags.insert(line).valid = 1;
    present.insert(line);
    CHECK(present.size() <= 8);
  }
  for (const Address line : present) CHECK(tags.find(line) != TagArray::kNone);
  CHECK(present.size() == 8);
}

TEST_CASE("an MSHR serves its waiters oldest first and is free when its last sector arrived") {
  struct Waiter {
    int name = 0;
    uint8_t missing = 0;
  };
  Mshr<Waiter> mshr(1, 2);
  const uint32_t entry = mshr.allocate(640);
  CHECK(mshr.full());
  mshr.expect(entry, 0b0011);
  mshr.add(entry, {1, 0b0011});
  CHECK_FALSE(mshr.merge_limit(entry));
  mshr.add(entry, {2, 0b0001});
  CHECK(mshr.merge_limit(entry));
  std::vector<int> served;
  const auto arrive = [&](uint8_t sectors) {
    mshr.arrive(mshr.find(640), sectors, [&](Waiter& w) {
      w.missing &= uint8_t(~sectors);
      if (w.missing == 0) served.push_back(w.name);
      return w.missing == 0;
    });
  };
  arrive(0b0001);
  CHECK(served == std::vector<int>{2});
  CHECK(mshr.full());
  CHECK_FALSE(mshr.merge_limit(entry));
  arrive(0b0010);
  CHECK(served == std::vector<int>{2, 1});
  CHECK_FALSE(mshr.full());
  CHECK(mshr.find(640) == LineTable::kNone);
}

TEST_CASE("a fan-in orders messages by arrival and then by producer, whenever they are delivered") {
  const auto drain = [](bool deliver_between) {
    FanIn<int> in(3);
    in.send(2, 10, 210);
    in.send(1, 12, 112);
    if (deliver_between) in.deliver();
    in.send(0, 12, 12);
    in.send(2, 12, 212);
    in.send(0, 12, 13);
    in.deliver();
    std::vector<int> out;
    for (; in.arrival() != kNever; in.pop()) out.push_back(in.front());
    return out;
  };
  CHECK(drain(false) == std::vector<int>{210, 12, 13, 112, 212});
  CHECK(drain(true) == drain(false));
}

TEST_CASE("a fan-in shows nothing before delivery but counts it as the next arrival") {
  FanIn<int> in(1);
  in.send(0, 5, 1);
  CHECK(in.arrival() == kNever);
  CHECK(in.next_arrival() == 5);
  CHECK(in.waiting() == 1);
  in.deliver();
  CHECK_FALSE(in.ready(4));
  CHECK(in.ready(5));
}

TEST_CASE("a fan-in that follows windows delivers the messages of the window before and no later ones") {
  FanIn<int> in(2);
  uint64_t window = 1;
  REQUIRE(in.follow(&window));
  in.send(0, 20, 1);
  in.deliver();
  CHECK(in.arrival() == kNever);
  CHECK(in.next_arrival() == 20);
  ++window;
  in.send(1, 30, 2);  // A producer may come before the consumer.
  in.deliver();
  CHECK(in.front() == 1);
  CHECK(in.waiting() == 2);
  in.send(0, 35, 3);
  in.pop();
  CHECK(in.arrival() == kNever);
  CHECK(in.next_arrival() == 30);
  ++window;
  in.deliver();
  CHECK(in.front() == 2);
  in.pop();
  CHECK(in.front() == 3);
  ++window;
  in.deliver();
  CHECK(in.waiting() == 1);
}

TEST_CASE("a fan-in tells of the messages that come next, and of no more than asked") {
  FanIn<int> in(2);
  in.send(1, 7, 2);
  in.send(0, 5, 1);
  in.send(0, 9, 3);
  const auto coming = [&](size_t most) {
    std::vector<int> out;
    in.each_delivered(most, [&](int message) { out.push_back(message); });
    return out;
  };
  CHECK(coming(9).empty());
  in.deliver();
  CHECK(coming(2) == std::vector<int>{1, 2});
  in.pop();
  CHECK(coming(9) == std::vector<int>{2, 3});
  CHECK(in.front() == 2);
}

TEST_CASE("any number of partitions and slices is filled equally and addresses stay unique inside each") {
  const uint32_t n = GENERATE(1u, 3u, 4u, 12u, 24u, 80u), slices = GENERATE(1u, 2u, 3u);
  const SliceHash hash = GENERATE(SliceHash::Mixed, SliceHash::None);
  PartitionMap map(n, slices, 256, hash);
  std::vector<std::set<Address>> local(n);
  std::vector<int> of_slice(n * slices);
  bool one_chunk = true;
  for (uint32_t chunk = 0; chunk < n * slices * 100; ++chunk) {
    const Address address = Address{chunk} * 256;
    one_chunk = one_chunk && map.slice(address) == map.slice(address + 255);
    ++of_slice[map.slice(address)];
    local[map.partition(address)].insert(map.local(address, map.slice(address)));
  }
  CHECK(one_chunk);
  for (const int chunks : of_slice) CHECK(chunks == 100);
  for (const std::set<Address>& one : local) {
    CHECK(one.size() == 100 * slices);
    CHECK(*one.rbegin() == (100 * slices - 1) * 256);  // the addresses are dense
  }
}

TEST_CASE("classes of slices fill all slices equally in the long run, and ranges as unevenly as measured") {
  struct Range {
    uint32_t slices, kilobytes;
    double fullest;  // largest share of a slice, in shares of the mean; bench/probes/slices.cu, mean of all
                     // ranges
  };
  // H100 and H200. With 64 slices no class is left out.
  const auto range =
      GENERATE(Range{80, 64, 1.25}, Range{80, 128, 1.25}, Range{80, 256, 1.25}, Range{80, 512, 1.10},
               Range{80, 1024, 1.02}, Range{96, 64, 1.52}, Range{96, 128, 1.52}, Range{96, 256, 1.15},
               Range{96, 512, 1.15}, Range{64, 32, 1.0});
  PartitionMap map(range.slices, 1, 256, SliceHash::Classes);
  const uint32_t chunks = range.kilobytes * 4, ranges = 24;
  std::vector<std::set<Address>> local(range.slices);
  double fullest = 0;
  for (uint32_t r = 0; r < ranges; ++r) {
    std::vector<uint32_t> count(range.slices);
    for (uint32_t i = 0; i < chunks; ++i) {
      const Address address = (Address{r} * chunks + i) * 256;
      const uint32_t slice = map.slice(address);
      ++count[slice];
      local[slice].insert(map.local(address, slice));
    }
    fullest += double(*std::max_element(count.begin(), count.end())) * range.slices / chunks / ranges;
  }
  CHECK(std::abs(fullest - range.fullest) < 0.035);
  size_t sum = 0;
  for (const std::set<Address>& one : local) {
    sum += one.size();
    CHECK(*one.rbegin() < (one.size() + 16) * 256);  // nearly dense: the last period is not complete
  }
  CHECK(sum == size_t{chunks} * ranges);  // no two chunks of a slice have one local address
}

TEST_CASE("strides of the number of partitions still reach every partition") {
  PartitionMap map(12, 1, 256);
  std::vector<int> count(12);
  for (uint32_t i = 0; i < 1200; ++i) ++count[map.partition(Address{i} * 12 * 256)];
  for (const int n : count) CHECK(n > 60);  // the average is 100
}

TEST_CASE("a line that is held is not a victim, and a set of such lines has none") {
  TagArray tags({1, 2, 128}, "lru");
  tags.insert(0).held = true;
  tags.insert(128).valid = 1;
  tags.touch(tags.find(128));
  CHECK(tags.victim(256).address() == 128);  // 0 is older, but it is held
  tags.insert(256).held = true;
  CHECK_FALSE(tags.has_victim(384));
  CHECK(tags.find(0) != TagArray::kNone);
  tags.line(tags.find(0)).held = false;
  tags.line(tags.find(0)).valid = 1;
  CHECK(tags.victim(384).address() == 0);
}

TEST_CASE("a row's chunks share bank group turns and a full row has row_bytes bytes") {
  DramMap map(16, 4, 2048, 256);
  CHECK(map.locate(0).group != map.locate(256).group);
  std::map<std::pair<uint32_t, uint32_t>, int> chunks;
  for (Address local = 0; local < 16 * 2048 * 4; local += 256) {
    const DramLocation at = map.locate(local);
    CHECK(at.bank % 4 == at.group);
    ++chunks[{at.bank, at.row}];
  }
  CHECK(chunks.size() == 64);
  for (const auto& [place, n] : chunks) CHECK(n == 8);
}

TEST_CASE("clock domains convert without drift") {
  const ClockDomains clocks(1365.0, 1750.0);
  CHECK(clocks.clock_at(1365'000'000) == 1750'000'000);
  CHECK(clocks.cycle_after(1750'000'000) == 1365'000'000);
  CHECK(clocks.cycle_after(1) == 1);
  CHECK(clocks.clock_at(1) == 1);
  CHECK(clocks.clock_at(4) == 5);
  for (Cycle cycle = 0; cycle < 3000; ++cycle) CHECK(clocks.cycle_after(clocks.clock_at(cycle)) <= cycle);
}

TEST_CASE("times in nanoseconds round up to whole clocks") {
  DramParams p;
  p.clock_mhz = 1000.0;
  p.rcd = 15.0, p.rp = 15.01;
  const DramTiming t(p);
  CHECK(t.rcd == 15);
  CHECK(t.rp == 16);
  CHECK(t.data == 4);   // there are 16 transfers at 4 per clock
  CHECK(t.ccd_s == 4);  // tCCD is never shorter than the data
}
