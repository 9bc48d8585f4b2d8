// Tests the contract of Network for every registered network, and the times and limits of each.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/network.h"

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/registry.h"
#include "memsys/messages/network_port.h"
#include "memsys/params.h"
#include "tests/support/catch.h"
#include "tests/support/memory_rig.h"

using namespace glint;
using namespace glint::mem;

namespace {

PolicyChoice<Network> chosen_network(const std::string& name, const std::string& params = {}) {
  PolicyChoice<Network> choice(name.c_str());
  Config config;
  config.add_text("test", params);
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<Network>::instance().entry(name).read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  return choice;
}

NocParams with_credits(uint32_t credits) {
  NocParams params;
  params.credits = credits;
  return params;
}

// Describes a message that a port has taken. Lines number the packets of a core, and a reply has the line of
// its packet.
struct Taken {
  Cycle at = 0;
  uint16_t from = 0, to = 0;
  Address line = 0;
  uint8_t sectors = 0;
  bool operator==(const Taken&) const = default;
};

// Decides in each cycle whether a user of a port is busy with something else.
class Moods {
 public:
  Moods(uint32_t seed, uint32_t of_8) : random_(seed), of_8_(of_8) {}
  bool busy() { return random_() % 8 < of_8_; }
  uint32_t draw(uint32_t below) { return uint32_t(random_() % below); }

 private:
  std::mt19937 random_;
  const uint32_t of_8_;
};

// Holds a network with all its users. Each user has its own state, as a cell has.
class Rig {
 public:
  Rig(const PolicyChoice<Network>& choice, uint16_t cores, uint16_t slices, const NocParams& params)
      : network_(choice.make({params, cores, slices})) {
    for (uint16_t c = 0; c < cores; ++c) cores_.push_back({network_->core_port(c), Moods(c, 2)});
    for (uint16_t s = 0; s < slices; ++s) slices_.push_back({network_->slice_port(s), Moods(1000 + s, 2)});
  }

  // Each core sends `packets` packets, to any slice or to slice `only`.
  uint32_t packets = 300;
  int only = -1;
  bool slices_take = true, cores_take = true;

  void run_until(Cycle end, Cycle window = 1, bool backwards = false) {
    const size_t users = cores_.size() + slices_.size();
    for (; now_ < end; now_ += window) {
      for (ChannelBase* channel : network_->channels()) channel->deliver();
      const Cycle until = std::min(now_ + window, end);
      std::vector<Cell*> cells = network_->cells();
      if (backwards) {
        for (size_t i = cells.size(); i-- > 0;) cells[i]->advance(now_, until);
        for (size_t i = users; i-- > 0;) advance(i, until);
      } else {
        for (size_t i = 0; i < users; ++i) advance(i, until);
        for (Cell* cell : cells) cell->advance(now_, until);
      }
    }
  }
  bool idle() const {
    for (ChannelBase* channel : network_->channels()) {
      channel->deliver();
      if (channel->next_arrival() != kNever) return false;
    }
    for (const Cell* cell : network_->cells())
      if (!cell->finished()) return false;
    return true;
  }

  uint64_t sent() const {
    uint64_t sum = 0;
    for (const Core& core : cores_) sum += core.sent;
    return sum;
  }
  // Returns what all slices, or all cores, have taken, one after another.
  std::vector<Taken> packets_taken() const {
    std::vector<Taken> out;
    for (const Slice& slice : slices_) out.insert(out.end(), slice.taken.begin(), slice.taken.end());
    return out;
  }
  std::vector<Taken> replies_taken() const {
    std::vector<Taken> out;
    for (const Core& core : cores_) out.insert(out.end(), core.taken.begin(), core.taken.end());
    return out;
  }
  const Network& network() const { return *network_; }

 private:
  struct Core {
    CorePort port;
    Moods moods;
    uint32_t sent = 0;
    uint32_t destination = 0;
    std::vector<Taken> taken{};
  };
  struct Slice {
    SlicePort port;
    Moods moods;
    std::vector<Taken> taken{};
  };

  void advance(size_t user, Cycle until) {
    for (Cycle now = now_; now < until; ++now)
      user < cores_.size() ? step(cores_[user], uint16_t(user), now)
                           : step(slices_[user - cores_.size()], uint16_t(user - cores_.size()), now);
  }
  void step(Core& core, uint16_t index, Cycle now) {
    core.port.take_credits(now);
    if (!core.moods.busy() && cores_take && core.port.received() <= now) {
      const Reply& reply = core.port.front();
      core.taken.push_back({now, reply.slice, index, reply.line, reply.sectors});
      REQUIRE(reply.core == index);
      core.port.take(now);
    }
    if (core.moods.busy() || core.sent == packets) return;
    const auto slice = uint16_t(only >= 0 ? uint32_t(only) : core.destination);
    if (core.port.departure(now, slice) > now) return;
    core.port.send(now, {.line = core.sent++,
                         .core = index,
                         .slice = slice,
                         .sectors = uint8_t(1 + core.moods.draw(15)),
                         .write = core.moods.draw(2) == 0});
    core.destination = core.moods.draw(uint32_t(slices_.size()));
  }
  void step(Slice& slice, uint16_t index, Cycle now) {
    if (slice.moods.busy() || !slices_take || slice.port.received() > now) return;
    const Packet packet = slice.port.front();
    REQUIRE(packet.slice == index);
    slice.taken.push_back({now, packet.core, index, packet.line, packet.sectors});
    slice.port.take(now);
    slice.port.send(
        now,
        {.line = packet.line, .slice = index, .core = packet.core, .sectors = packet.sectors, .stamps = {}});
  }

  const std::unique_ptr<Network> network_;
  std::vector<Core> cores_;
  std::vector<Slice> slices_;
  Cycle now_ = 0;
};

// Checks that lines from one source to one destination grow, because they were sent in this order.
void check_order(const std::vector<Taken>& taken) {
  std::map<std::pair<uint16_t, uint16_t>, Address> last;
  for (const Taken& t : taken) {
    const auto [at, is_first] = last.try_emplace({t.from, t.to}, t.line);
    REQUIRE((is_first || t.line > at->second));
    at->second = t.line;
  }
}

struct Shape {
  uint16_t cores, slices;
};
constexpr Shape kShapes[] = {{1, 1}, {3, 2}, {2, 7}, {8, 4}, {13, 12}};

}  // namespace

TEST_CASE("every network brings every packet and every reply to its destination once, in order") {
  REQUIRE(Registry<Network>::names() == std::vector<std::string>{"crossbar", "mesh"});
  for (const std::string& name : Registry<Network>::names())
    for (const Shape shape : kShapes)
      for (const uint32_t credits : {0u, 2u}) {
        CAPTURE(name, shape.cores, shape.slices, credits);
        Rig rig(chosen_network(name), shape.cores, shape.slices, with_credits(credits));
        rig.run_until(60'000);
        REQUIRE(rig.idle());
        const std::vector<Taken> packets = rig.packets_taken(), replies = rig.replies_taken();
        CHECK(rig.sent() == 300u * shape.cores);
        REQUIRE(packets.size() == rig.sent());
        REQUIRE(replies.size() == packets.size());
        std::map<std::pair<uint16_t, Address>, Taken> of_core;  // holds each packet once, by core and line
        for (const Taken& p : packets) REQUIRE(of_core.emplace(std::pair{p.from, p.line}, p).second);
        for (const Taken& r : replies) {
          const auto packet = of_core.extract({r.to, r.line});
          REQUIRE(!packet.empty());
          CHECK(packet.mapped().to == r.from);
          CHECK(packet.mapped().sectors == r.sectors);
          CHECK(r.at >= packet.mapped().at + rig.network().shortest_latency());
        }
        check_order(packets);
        check_order(replies);
      }
}

TEST_CASE("with every network, windows and the order of cells change no cycle of any message") {
  for (const std::string& name : Registry<Network>::names()) {
    CAPTURE(name);
    const auto run = [&](Cycle window, bool backwards) {
      Rig rig(chosen_network(name), 8, 4, with_credits(3));
      rig.run_until(30'000, window ? window : rig.network().shortest_latency(), backwards);
      REQUIRE(rig.idle());
      std::vector<Taken> out = rig.packets_taken();
      const std::vector<Taken> replies = rig.replies_taken();
      out.insert(out.end(), replies.begin(), replies.end());
      return out;
    };
    const std::vector<Taken> plain = run(1, false);
    CHECK(plain.size() == 2 * 8 * 300);
    for (const Cycle window : {0, 3, 7})
      for (const bool backwards : {false, true}) CHECK(run(window, backwards) == plain);
    CHECK(run(1, true) == plain);
  }
}

TEST_CASE("every network refuses packets when a slice takes none, and accepts packets again when it does") {
  for (const std::string& name : Registry<Network>::names()) {
    CAPTURE(name);
    Rig rig(chosen_network(name), 5, 3, with_credits(4));
    rig.packets = 1'000, rig.only = 1, rig.slices_take = false;
    rig.run_until(20'000);
    const uint64_t held = rig.sent();
    CHECK(held >= 5);
    rig.run_until(40'000);
    CHECK(rig.sent() == held);
    rig.slices_take = true;
    rig.run_until(120'000);
    CHECK(rig.packets_taken().size() == 5 * 1'000);
    CHECK(rig.idle());
  }
}

TEST_CASE("with every network, packets come through while no core takes a reply") {
  for (const std::string& name : Registry<Network>::names()) {
    CAPTURE(name);
    Rig rig(chosen_network(name), 6, 4, with_credits(2));
    rig.cores_take = false;
    rig.run_until(60'000);
    CHECK(rig.packets_taken().size() == 6 * 300);
    CHECK(rig.replies_taken().empty());
    rig.cores_take = true;
    rig.run_until(120'000);
    CHECK(rig.replies_taken().size() == 6 * 300);
    CHECK(rig.idle());
  }
}

TEST_CASE("with every network, windows and stepping change no answer of the memory system") {
  for (const std::string& name : Registry<Network>::names()) {
    CAPTURE(name);
    const auto run = [&](Cycle window, bool step) {
      Params params;
      params.l1.size = 8 * 128, params.l2.slice_size = 16 * 128, params.l2.ways = 4, params.l2.slices = 2;
      params.noc.topology = chosen_network(name);
      MemoryRig rig(params, 3);
      if (window) rig.set_window(window);
      rig.set_step_every_cycle(step);
      std::vector<std::mt19937> random{std::mt19937(1), std::mt19937(2), std::mt19937(3)};
      std::vector<uint32_t> left{400, 400, 400};
      rig.run([&](uint32_t core, Cycle now) {
        const bool write = random[core]() % 8 == 0;
        const Address line = random[core]() % (random[core]() % 4 ? 12 : 300) * 128;
        const Request request{line, 15, write, write ? Traffic::ShaderLocal : Traffic::RtNode, left[core]};
        if (rig.l1(core).access(now, Client::Lsu, request)) --left[core];
        return left[core] ? now + 1 : kNever;
      });
      rig.memory().check_drained();
      return rig.answers();
    };
    const std::vector<Answered> plain = run(0, false);
    CHECK(plain.size() > 1000);
    CHECK(plain == run(1, false));
    CHECK(plain == run(0, true));
  }
}

TEST_CASE("the crossbar holds as many packets of a core for a slice as the core has credits") {
  for (const uint32_t credits : {1u, 4u, 19u}) {
    Rig rig(chosen_network("crossbar"), 3, 2, with_credits(credits));
    rig.only = 0, rig.slices_take = false;
    rig.run_until(5'000);
    CHECK(rig.sent() == 3 * credits);
  }
}

TEST_CASE("the mesh holds as many packets as its buffers on the way have entries") {
  Rig rig(chosen_network("mesh", "entry_buffer = 3\nbuffer = 2\nexit_buffer = 4\n"), 1, 1, {});
  rig.slices_take = false;
  rig.run_until(5'000);
  CHECK(rig.sent() == 3 + 2 + 4);
}

TEST_CASE("an unloaded packet crosses the mesh in the time of its hops, its two ports and its links") {
  NocParams params;
  constexpr int kCores[] = {0, 2, 4, 6}, kSlices[] = {1, 3, 5, 7, 8};  // routers in three rows of three
  for (uint16_t core = 0; core < 4; ++core)
    for (uint16_t slice = 0; slice < 5; ++slice) {
      const auto network = chosen_network("mesh", "hop_latency = 5\nport_latency = 9\n").make({params, 4, 5});
      std::vector<CorePort> cores;
      std::vector<SlicePort> slices;
      for (uint16_t c = 0; c < 4; ++c) cores.push_back(network->core_port(c));
      for (uint16_t s = 0; s < 5; ++s) slices.push_back(network->slice_port(s));
      cores[core].send(100, {.core = core, .slice = slice, .sectors = 1, .write = true});  // has 40 bytes
      for (Cycle now = 100; now < 200; ++now) {
        for (ChannelBase* channel : network->channels()) channel->deliver();
        for (Cell* cell : network->cells()) cell->advance(now, now + 1);
      }
      for (ChannelBase* channel : network->channels()) channel->deliver();
      const int a = kCores[core], b = kSlices[slice];
      const int hops = std::abs(a % 3 - b % 3) + std::abs(a / 3 - b / 3);
      CAPTURE(core, slice);
      CHECK(slices[slice].received() == 100 + 1 + 9 + Cycle(hops) * 5 + 1 + 9);
    }
}

TEST_CASE("two cores that share a link of the mesh take turns on it, and it is never idle") {
  NocParams params;
  const auto network =
      chosen_network("mesh").make({params, 2, 1});  // core 1 goes through the router of core 0
  std::vector<CorePort> cores{network->core_port(0), network->core_port(1)};
  SlicePort slice = network->slice_port(0);
  std::vector<uint16_t> order;
  std::vector<Cycle> at;
  std::array<uint32_t, 2> sent{};
  for (Cycle now = 0; now < 400; ++now) {
    for (ChannelBase* channel : network->channels()) channel->deliver();
    for (uint16_t c = 0; c < 2; ++c) {
      cores[c].take_credits(now);
      if (sent[c] == 60 || cores[c].departure(now, 0) > now) continue;
      ++sent[c];
      cores[c].send(now, {.core = c, .slice = 0, .sectors = 1, .write = true});
    }
    if (slice.received() <= now) {
      order.push_back(slice.front().core);
      at.push_back(now);
      slice.take(now);
    }
    for (Cell* cell : network->cells()) cell->advance(now, now + 1);
  }
  REQUIRE(at.size() == 120);
  for (size_t i = 10; i < 110; ++i) {
    CHECK(at[i] == at[i - 1] + 1);
    CHECK(order[i] != order[i - 1]);
  }
}
