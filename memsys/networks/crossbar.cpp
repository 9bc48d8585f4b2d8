// Implements the network `crossbar`: a switch connects every core to every slice of the L2.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <vector>

#include "base/registry.h"
#include "memsys/messages/network_port.h"
#include "memsys/params.h"

namespace glint::mem {
namespace {

// Model: the switch inside never blocks. Only the ports limit the traffic, and towards the slices the credits
// do, too. A core has credits for each slice, and a slice returns a credit when it has taken a packet.
class Crossbar final : public Network {
 public:
  static constexpr const char* kName = "crossbar";
  static constexpr const char* kDoc =
      "The network is a switch that never blocks. Ports and credits limit the traffic.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };

  Crossbar(const Params&, const Context& context)
      : params_(context.params), num_cores_(context.cores), num_slices_(context.slices) {
    for (uint32_t s = 0; s < num_slices_; ++s)
      requests_.push_back(std::make_unique<FanIn<Packet>>(num_cores_));
    for (uint32_t c = 0; c < num_cores_; ++c) {
      replies_.push_back(std::make_unique<FanIn<Reply>>(num_slices_));
      if (params_.credits > 0) credits_.push_back(std::make_unique<FanIn<Credit>>(num_slices_));
    }
  }

  CorePort core_port(uint16_t core) override {
    PortWiring<Packet, Reply> wiring{.index = core,
                                     .send_bytes = params_.core_request_bytes,
                                     .receive_bytes = params_.core_reply_bytes,
                                     .incoming_bytes = params_.partition_reply_bytes,
                                     .inbox = replies_[core].get()};
    for (uint16_t s = 0; s < num_slices_; ++s)
      wiring.routes.push_back({requests_[s].get(), params_.request_latency + far_latency(core, s), s});
    if (!credits_.empty()) {
      wiring.credits.assign(num_slices_, params_.credits);
      wiring.credit_inbox = credits_[core].get();
    }
    return CorePort(std::move(wiring));
  }

  SlicePort slice_port(uint16_t slice) override {
    PortWiring<Reply, Packet> wiring{.index = slice,
                                     .send_bytes = params_.partition_reply_bytes,
                                     .receive_bytes = params_.partition_request_bytes,
                                     .incoming_bytes = params_.core_request_bytes,
                                     .inbox = requests_[slice].get()};
    for (uint16_t c = 0; c < num_cores_; ++c) {
      const Cycle latency = params_.reply_latency + far_latency(c, slice);
      wiring.routes.push_back({replies_[c].get(), latency});
      if (!credits_.empty()) wiring.returns.push_back({credits_[c].get(), latency, slice});
    }
    return SlicePort(std::move(wiring));
  }

  std::vector<ChannelBase*> channels() override {
    std::vector<ChannelBase*> out;
    for (const auto& channel : requests_) out.push_back(channel.get());
    for (const auto& channel : replies_) out.push_back(channel.get());
    for (const auto& channel : credits_) out.push_back(channel.get());
    return out;
  }
  Inputs inputs() override {
    Inputs out;
    for (const auto& channel : requests_) out.of_slice.push_back({channel.get()});
    for (const auto& channel : replies_) out.of_core.push_back({channel.get()});
    for (size_t c = 0; c < credits_.size(); ++c) out.of_core[c].push_back(credits_[c].get());
    return out;
  }
  // Any message takes at least one cycle of a port before its way through the switch.
  Cycle shortest_latency() const override {
    return 1 + std::min(params_.request_latency, params_.reply_latency);
  }

 private:
  // Returns the cycles, one way, that a core and a slice on different sides of the chip add to the latency of
  // the network.
  Cycle far_latency(uint32_t core, uint32_t slice) const {
    const uint64_t sides = params_.sides;
    return core * sides / num_cores_ == slice * sides / num_slices_ ? 0 : params_.far_latency;
  }

  const NocParams params_;
  const uint32_t num_cores_, num_slices_;
  std::vector<std::unique_ptr<FanIn<Packet>>> requests_;  // by slice
  std::vector<std::unique_ptr<FanIn<Reply>>> replies_;    // by core
  std::vector<std::unique_ptr<FanIn<Credit>>> credits_;   // by core; empty when credits are unlimited
};

const Register<Network, Crossbar> registered;

}  // namespace
}  // namespace glint::mem
