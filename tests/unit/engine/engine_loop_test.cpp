// Tests windows: who acts when, what is skipped, and when a machine counts as stuck.
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine_loop.h"

#include <algorithm>

#include "base/diagnostics.h"
#include "tests/support/catch.h"

namespace glint {
namespace {

// Works in the cycles that it is given and in those in which a message arrives. It passes each message on.
class RelayCell final : public Cell {
 public:
  RelayCell(std::vector<Cycle> work, Channel<int>* in, Channel<int>* out, Cycle latency = 32)
      : work_(std::move(work)), in_(in), out_(out), latency_(latency) {}
  void advance(Cycle from, Cycle until) override {
    windows.push_back({from, until});
    for (Cycle now = from; now < until; ++now) {
      while (in_ && in_->ready(now)) {
        received.push_back({now, in_->front()});
        in_->pop();
        ++progress_;
      }
      if (next_ < work_.size() && work_[next_] == now) {
        if (out_) out_->send(now + latency_, int(now));
        ++next_, ++progress_;
      }
    }
  }
  Cycle next_event(Cycle from) const override {
    return next_ < work_.size() ? std::max(from, work_[next_]) : kNever;
  }
  bool finished() const override { return next_ == work_.size() && !never_finishes; }
  uint64_t progress() const override { return progress_; }
  std::string describe_stall() const override { return "relay holds one request\n"; }

  std::vector<std::pair<Cycle, Cycle>> windows;
  std::vector<std::pair<Cycle, int>> received;
  bool never_finishes = false;

 private:
  std::vector<Cycle> work_;
  Channel<int>*in_, *out_;
  Cycle latency_;
  size_t next_ = 0;
  uint64_t progress_ = 0;
};

EngineLoop::Next nothing_more(Cycle) {
  return EngineLoop::Next::NothingMore;
}

}  // namespace

TEST_CASE("messages arrive in their cycle whatever the order of the cells and with or without skipping") {
  for (bool no_skip : {false, true})
    for (bool producer_first : {false, true}) {
      Channel<int> channel;
      RelayCell producer({0, 5, 40, 1000}, nullptr, &channel), consumer({}, &channel, nullptr);
      EngineLoop engine({32, no_skip, 100'000});
      engine.add(producer_first ? producer : consumer);
      engine.add(producer_first ? consumer : producer);
      engine.add(channel);
      const Cycle end = engine.run(nothing_more);

      CHECK(consumer.received ==
            std::vector<std::pair<Cycle, int>>{{32, 0}, {37, 5}, {72, 40}, {1032, 1000}});
      CHECK(end == 1056);
    }
}

TEST_CASE("idle windows are skipped, and windows start at multiples of their length") {
  RelayCell cell({3, 1000}, nullptr, nullptr);
  EngineLoop engine({32, false, 100'000});
  engine.add(cell);
  engine.run(nothing_more);

  CHECK(cell.windows == std::vector<std::pair<Cycle, Cycle>>{{0, 32}, {992, 1024}});
}

TEST_CASE("without skipping every window is visited") {
  RelayCell cell({3, 1000}, nullptr, nullptr);
  EngineLoop engine({32, true, 100'000});
  engine.add(cell);
  engine.run(nothing_more);

  CHECK(cell.windows.size() == 32);
}

TEST_CASE("a cycle to look at is looked at in idle time, too, and changes nothing") {
  for (bool no_skip : {false, true}) {
    RelayCell cell({3, 1000}, nullptr, nullptr);
    EngineLoop engine({32, no_skip, 100'000});
    engine.add(cell);
    std::vector<Cycle> looks;
    const auto between = [&](Cycle now) {
      looks.push_back(now);
      return now < 501 ? EngineLoop::Next::NothingMore : EngineLoop::Next::Stop;
    };
    CHECK(engine.run(between, 501) == 512);
    CHECK(looks.back() == 512);

    RelayCell other({3, 1000}, nullptr, nullptr);
    EngineLoop whole({32, no_skip, 100'000});
    whole.add(other);
    CHECK(whole.run(nothing_more, 501) == 1024);
  }
}

TEST_CASE("a machine with work left and nothing to come is stuck at once") {
  RelayCell cell({3}, nullptr, nullptr);
  cell.never_finishes = true;
  EngineLoop engine({32, false, 100'000});
  engine.add(cell);

  try {
    engine.run(nothing_more);
    FAIL("the engine came to an end");
  } catch (const Error& error) {
    CHECK(error.exit() == Exit::Stuck);
    CHECK(std::string(error.what()).find("relay holds one request") != std::string::npos);
  }
}

TEST_CASE("a machine that moves nothing for the watchdog's time is stuck") {
  RelayCell cell({3}, nullptr, nullptr);
  cell.never_finishes = true;
  EngineLoop engine({32, true, 1000});
  engine.add(cell);

  CHECK_THROWS_AS(engine.run(nothing_more), Error);
  CHECK(cell.windows.back().first == 1024);  // the first window that begins 1000 cycles after the one at 0
}

TEST_CASE("a run ends at once when it is told to") {
  RelayCell cell({3, 1000}, nullptr, nullptr);
  EngineLoop engine({32, false, 100'000});
  engine.add(cell);

  const Cycle end =
      engine.run([](Cycle now) { return now >= 32 ? EngineLoop::Next::Stop : EngineLoop::Next::Continue; });

  CHECK(end == 32);
}

}  // namespace glint
