// Implements the DRAM model `simple`: requests are served in order of arrival with one latency and one
// bandwidth, without banks, rows or refresh.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "memsys/dram/dram_timing.h"
#include "memsys/dram_model.h"

namespace glint::mem {
namespace {

// Requests follow each other on the data bus, one every data_clocks / efficiency clocks. The data of a read
// have come when `latency` and its own transfer have passed since its turn began. Model: an entry of the
// queue is free when the transfer begins, as an entry of `banked` is when the column command goes out.
class Simple final : public DramModel {
 public:
  static constexpr const char* kName = "simple";
  static constexpr const char* kDoc =
      "Requests are served in the order of arrival, with a fixed latency and a share of the peak bandwidth. "
      "It suits fast sweeps.";
  struct Params {
    double latency = 29.1;    // tRCD + CL of GDDR6-14000, as for a closed row
    double efficiency = 0.9;  // Choice: about the share that refresh and turnarounds leave to streams
    static ParamList params() {
      return {param(&Params::latency, "latency", "ns",
                    "Time from the beginning of a read's service to its first data.", 0.0, 1e5),
              param(&Params::efficiency, "efficiency", "ratio",
                    "Share of the data bus's peak bandwidth that requests can use.", 0.01, 1.0)};
    }
  };

  Simple(const Params& params, const Context& context)
      : DramModel(context, DramTiming(context.params).data),
        latency_(DramClock(std::ceil(params.latency * context.params.clock_mhz / 1000.0 - 1e-6))),
        // The spacing is in parts of a clock, 2^10 to a clock, so that any efficiency is met in the long run.
        spacing_(
            std::max<DramClock>(data_clocks_ << kFraction,
                                DramClock(std::ceil(double(data_clocks_ << kFraction) / params.efficiency)))),
        waiting_(context.params.queue) {}

  void add(Cycle now, Address line, uint8_t sectors, Address, bool write) override {
    const DramClock arrival = clocks_.clock_at(now) + 1;
    const DramClock start = std::max(arrival << kFraction, free_at_);
    free_at_ = start + spacing_;
    waiting_.push({(start + kRound) >> kFraction, arrival, line, sectors, write});
    next_step_ = waiting_.front().start;
    ++in_flight_;
    ++stats_.requests;
  }
  void advance(Cycle now) override {
    const DramClock last = clocks_.clock_at(now);
    for (; !waiting_.empty() && waiting_.front().start <= last; waiting_.pop()) transfer(waiting_.front());
    next_step_ = waiting_.empty() ? kNever : waiting_.front().start;
  }
  void finish(Cycle end) override {
    advance(end);
    account(clocks_.clock_at(end), false);
  }

 private:
  static constexpr uint32_t kFraction = 10;
  static constexpr DramClock kRound = (1u << kFraction) - 1;
  struct Waiting {
    DramClock start = 0, arrival = 0;
    Address line = 0;
    uint8_t sectors = 0;
    bool write = false;
  };

  void transfer(const Waiting& request) {
    account(request.arrival, false);
    account(request.start, true);
    data_until_ = request.start + data_clocks_;
    stats_.busy_clocks += data_clocks_;
    stats_.queue_clocks += request.start - request.arrival;
    stats_.queue_latency.add(request.start - request.arrival);
    ++stats_.picks;
    --in_flight_;
    if (request.write) {
      ++stats_.writes;
      return;
    }
    ++stats_.reads;
    returns_.push({clocks_.cycle_after(request.start + latency_ + data_clocks_), request.line,
                   request.sectors, clocks_.cycle_after(request.start)});
  }
  // Counts each clock up to `until` under one reason. `waiting` says whether a request waited in the clocks
  // without data.
  void account(DramClock until, bool waiting) {
    if (until <= accounted_) return;
    const DramClock data = std::clamp(data_until_, accounted_, until) - accounted_;
    const DramClock length = until - accounted_;
    stats_.use.add(DramUse::Data, data);
    stats_.use.add(waiting ? DramUse::ColumnWait : DramUse::Idle, length - data);
    stats_.clocks += length;
    stats_.active_clocks += waiting ? length : data;
    accounted_ = until;
  }

  const DramClock latency_, spacing_;
  Ring<Waiting> waiting_;
  DramClock free_at_ = 0;  // earliest start of the next transfer, in parts of a clock
  DramClock accounted_ = 0, data_until_ = 0;
};

const Register<DramModel, Simple> registered;

}  // namespace
}  // namespace glint::mem
