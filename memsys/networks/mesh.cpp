// Implements the network `mesh`: a grid of routers with buffers. Messages go along their row, then their
// column.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/registry.h"
#include "memsys/messages/network_port.h"
#include "memsys/params.h"
#include "memsys/ring.h"

namespace glint::mem {
namespace {

// Dimension-ordered routing and separate grids for packets and replies keep the network free of deadlock
// (Dally and Towles, Principles and Practices of Interconnection Networks, 2004, chapter 14).
struct MeshParams {
  uint32_t hop_latency = 4;    // guess: a router of three stages, and a cycle of wire
  uint32_t link_bytes = 40;    // guess: as wide as a core's port
  uint32_t buffer = 10;        // guess: a credit's round trip between two routers
  uint32_t port_latency = 16;  // guess: with 4 hops, a way takes the 48 cycles of the crossbar of `mobile`
  uint32_t entry_buffer = 34;  // guess: a credit's round trip between a port and its router
  uint32_t exit_buffer = 34;   // guess: a credit's round trip between a router and its port

  static ParamList params() {
    return {
        param(&MeshParams::hop_latency, "hop_latency", "cycle",
              "Cycles from the departure of a message at a router to its possible departure at the next.", 1,
              1000),
        param(&MeshParams::link_bytes, "link_bytes", "byte/cycle",
              "Width of the links between routers, and between a router and its port.", 1, 4096),
        param(&MeshParams::buffer, "buffer", "message",
              "Number of messages that an input of a router can hold. A router has one input for each "
              "neighbour.",
              1, 1 << 12),
        param(&MeshParams::port_latency, "port_latency", "cycle",
              "Cycles from a core's or slice's port to its router, and from the router to the port.", 1,
              10000),
        param(&MeshParams::entry_buffer, "entry_buffer", "packet",
              "Number of packets of a core that its router can hold before they enter the grid.", 1, 1 << 12),
        param(&MeshParams::exit_buffer, "exit_buffer", "message",
              "Number of messages that can wait for a core or slice after they have left the grid.", 1,
              1 << 12)};
  }
};

// The routers stand in rows of `width`, and each serves at most one port.
struct Grid {
  uint32_t width = 1, routers = 1;
  std::vector<uint32_t> cores, slices;  // number of the router that serves each

  // Choice: the slices stand evenly among the cores.
  Grid(uint32_t num_cores, uint32_t num_slices) {
    const uint32_t ports = num_cores + num_slices;
    while (width * width < ports) ++width;
    routers = (ports + width - 1) / width * width;
    for (uint32_t i = 0; i < ports; ++i) {
      const bool is_slice = uint64_t{i + 1} * num_slices / ports > uint64_t{i} * num_slices / ports;
      (is_slice ? slices : cores).push_back(i);
    }
  }
};

// A plane has the routers for packets, or those for replies, and the channels to and from the ports. A
// message moves when its link is free and the next buffer has an entry for it (virtual cut-through). Of
// several inputs with a message for one output, the next in turn sends. An entry is free again for the router
// before when the message's tail has left and `hop_latency` has passed.
template <class Message>
class Plane final : public Cell {
 public:
  // `from` and `to` name the routers of the sources and of the destinations. `is_bounded` says that sources
  // need credits.
  Plane(const MeshParams& params, const Grid& grid, const std::vector<uint32_t>& from,
        const std::vector<uint32_t>& to, bool is_bounded)
      : params_(params),
        width_(grid.width),
        from_(from),
        to_(to),
        entries_(from.size()),
        exit_credits_(to.size()) {
    for (uint32_t r = 0; r < grid.routers; ++r) routers_.emplace_back(params);
    for (size_t i = 0; i < to.size(); ++i) exits_.push_back(std::make_unique<FanIn<Message>>(1));
    for (size_t i = 0; i < from.size() && is_bounded; ++i)
      entry_credits_.push_back(std::make_unique<FanIn<Credit>>(1));
  }

  FanIn<Message>& entries() { return entries_; }
  FanIn<Message>& exit(size_t destination) { return *exits_[destination]; }
  FanIn<Credit>& exit_credits() { return exit_credits_; }
  FanIn<Credit>& entry_credits(size_t source) { return *entry_credits_[source]; }
  void add_channels(std::vector<ChannelBase*>& out) {
    out.push_back(&entries_);
    out.push_back(&exit_credits_);
    for (const auto& channel : exits_) out.push_back(channel.get());
    for (const auto& channel : entry_credits_) out.push_back(channel.get());
  }

  void advance(Cycle from, Cycle until) override {
    for (Cycle now = next_event(from); now < until; now = next_event(now + 1)) {
      take_entries(now);
      for (uint32_t r = 0; r < routers_.size(); ++r)
        if (routers_[r].held > 0) route(r, now);
    }
  }
  Cycle next_event(Cycle from) const override {
    if (held_ > 0) return from;
    const Cycle next = std::min(entries_.arrival(), exit_credits_.arrival());
    return next == kNever ? kNever : std::max(next, from);
  }
  bool finished() const override { return held_ == 0; }
  uint64_t progress() const override { return moves_; }
  std::string describe_stall() const override {
    return fmt::format("mesh: {} messages in its routers\n", held_);
  }

 private:
  enum Side : uint8_t { West, East, North, South, Own, NumSides };  // Own: the router's own core or slice
  static constexpr Side kOpposite[] = {East, West, South, North};

  struct Held {
    Cycle ready = 0;
    Message message;
  };
  struct Input {
    explicit Input(uint32_t entries) : queue(entries), freed(entries) {}
    Ring<Held> queue;
    Cycle free_at = 0;   // cycle in which the last message has left
    uint32_t taken = 0;  // entries in use, as far as the router before knows
    Ring<Cycle> freed;   // cycles in which it will know of entries that are free again
  };
  struct Output {
    Cycle free_at = 0;
    uint32_t turn = 0;  // number of the input that goes first
    uint32_t room = 0;  // credits of the destination; only Own has some
  };
  struct Router {
    explicit Router(const MeshParams& params) : inputs(NumSides, Input(params.buffer)) {
      outputs[Own].room = params.exit_buffer;
    }
    std::vector<Input> inputs;
    std::array<Output, NumSides> outputs{};
    uint32_t held = 0;  // messages in all inputs
  };

  void take_entries(Cycle now) {
    for (; exit_credits_.ready(now); exit_credits_.pop())
      ++routers_[to_[exit_credits_.front().allowance]].outputs[Own].room;
    for (; entries_.ready(now); entries_.pop()) {
      Router& router = routers_[from_[source_of(entries_.front())]];
      router.inputs[Own].queue.push({entries_.arrival(), entries_.front()});
      ++router.held;
      ++held_;
    }
  }

  // Sends what can leave the router. No other router's part in the same cycle changes what it sends: a
  // message that arrives is ready later, and the news of a free entry comes later.
  void route(uint32_t index, Cycle now) {
    Router& router = routers_[index];
    std::array<uint32_t, NumSides> wanted{};  // by output: bits of the inputs that want it
    for (uint32_t i = 0; i < NumSides; ++i) {
      const Input& input = router.inputs[i];
      if (input.queue.empty() || input.queue.front().ready > now || input.free_at > now) continue;
      wanted[side_towards(index, to_[destination_of(input.queue.front().message)])] |= 1u << i;
    }
    for (uint32_t side = 0; side < NumSides; ++side) {
      Output& output = router.outputs[side];
      if (!wanted[side] || output.free_at > now || !has_room(index, Side(side), now)) continue;
      const uint32_t later = wanted[side] >> output.turn << output.turn;
      const auto input = uint32_t(std::countr_zero(later ? later : wanted[side]));
      output.turn = input + 1;
      move(index, input, Side(side), now);
    }
  }

  Side side_towards(uint32_t router, uint32_t goal) const {
    const uint32_t x = router % width_, goal_x = goal % width_;
    if (x != goal_x) return x < goal_x ? East : West;
    return router == goal ? Own : router < goal ? South : North;
  }
  uint32_t neighbour(uint32_t router, Side side) const {
    switch (side) {
      case West:
        return router - 1;
      case East:
        return router + 1;
      case North:
        return router - width_;
      default:
        return router + width_;
    }
  }

  bool has_room(uint32_t index, Side side, Cycle now) {
    if (side == Own) return routers_[index].outputs[Own].room > 0;
    Input& next = routers_[neighbour(index, side)].inputs[kOpposite[side]];
    for (; !next.freed.empty() && next.freed.front() <= now; next.freed.pop()) --next.taken;
    return next.taken < params_.buffer;
  }

  void move(uint32_t index, uint32_t from, Side side, Cycle now) {
    Router& router = routers_[index];
    Input& input = router.inputs[from];
    const Message message = input.queue.front().message;
    const Cycle left = now + Link(params_.link_bytes).cycles(bytes_of(message));
    input.queue.pop();
    input.free_at = router.outputs[side].free_at = left;
    if (from != Own)
      input.freed.push(left + params_.hop_latency);
    else if (!entry_credits_.empty())
      entry_credits_[source_of(message)]->send(0, left + params_.port_latency, Credit{});
    --router.held;
    ++moves_;
    if (side == Own) {
      --router.outputs[Own].room;
      --held_;
      exits_[destination_of(message)]->send(0, left + params_.port_latency, message);
      return;
    }
    Router& next = routers_[neighbour(index, side)];
    next.inputs[kOpposite[side]].queue.push({now + params_.hop_latency, message});
    ++next.inputs[kOpposite[side]].taken;
    ++next.held;
  }

  const MeshParams params_;
  const uint32_t width_;
  const std::vector<uint32_t> from_, to_;
  std::vector<Router> routers_;
  FanIn<Message> entries_;                              // messages of all sources
  std::vector<std::unique_ptr<FanIn<Message>>> exits_;  // by destination
  FanIn<Credit> exit_credits_;                          // credits of all destinations
  std::vector<std::unique_ptr<FanIn<Credit>>>
      entry_credits_;  // by source; empty when sources need no credits
  uint64_t held_ = 0, moves_ = 0;
};

// Model: replies wait in front of the grid without limit, because the packets that a slice takes bound them.
// Model: an entry of a buffer holds one message of any size.
class Mesh final : public Network {
 public:
  static constexpr const char* kName = "mesh";
  static constexpr const char* kDoc =
      "The network is a grid of routers with bounded buffers. The latency of a way depends on its hops and "
      "the load.";
  using Params = MeshParams;

  Mesh(const MeshParams& params, const Context& context)
      : params_(params),
        noc_(context.params),
        grid_(context.cores, context.slices),
        requests_(params, grid_, grid_.cores, grid_.slices, true),
        replies_(params, grid_, grid_.slices, grid_.cores, false) {}

  CorePort core_port(uint16_t core) override {
    PortWiring<Packet, Reply> wiring{.index = core,
                                     .send_bytes = noc_.core_request_bytes,
                                     .receive_bytes = noc_.core_reply_bytes,
                                     .incoming_bytes = params_.link_bytes,
                                     .inbox = &replies_.exit(core),
                                     .credits = {params_.entry_buffer},
                                     .credit_inbox = &requests_.entry_credits(core)};
    connect(wiring, grid_.slices.size(), requests_, replies_);
    return CorePort(std::move(wiring));
  }
  SlicePort slice_port(uint16_t slice) override {
    PortWiring<Reply, Packet> wiring{.index = slice,
                                     .send_bytes = noc_.partition_reply_bytes,
                                     .receive_bytes = noc_.partition_request_bytes,
                                     .incoming_bytes = params_.link_bytes,
                                     .inbox = &requests_.exit(slice)};
    connect(wiring, grid_.cores.size(), replies_, requests_);
    return SlicePort(std::move(wiring));
  }

  std::vector<Cell*> cells() override { return {&requests_, &replies_}; }
  std::vector<ChannelBase*> channels() override {
    std::vector<ChannelBase*> out;
    requests_.add_channels(out);
    replies_.add_channels(out);
    return out;
  }
  // A message takes a cycle of its port and the way to its router. Choice: a window is one cycle shorter,
  // because an L1 sends the write-back of a victim in the cycle after the one in which it is ready to leave.
  Cycle shortest_latency() const override { return params_.port_latency; }

 private:
  // All that a port sends goes to its router, whatever its destination; so do the credits for what it takes.
  template <class Sent, class Received>
  void connect(PortWiring<Sent, Received>& wiring, size_t others, Plane<Sent>& sends,
               Plane<Received>& receives) {
    wiring.routes.assign(others, {&sends.entries(), params_.port_latency, 0});
    wiring.returns.assign(others, {&receives.exit_credits(), params_.port_latency, wiring.index});
  }

  const MeshParams params_;
  const NocParams noc_;
  const Grid grid_;
  Plane<Packet> requests_;
  Plane<Reply> replies_;
};

const Register<Network, Mesh> registered;

}  // namespace
}  // namespace glint::mem
