// Counts how long the reads of a run take, by traffic class and latency, and gives percentiles of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/stats.h"
#include "base/types.h"
#include "memsys/request.h"

namespace glint::mem {

// Counts latencies by traffic class, in buckets. Below 16 cycles each cycle has a bucket. From there on each
// octave has eight buckets, so that the width of a bucket is at most an eighth of its lower end. The last
// bucket takes all latencies from 983,040 cycles on.
class Latencies {
 public:
  static constexpr uint32_t kExact = 16, kOctaves = 16, kSteps = 8, kBuckets = kExact + kOctaves * kSteps;
  static constexpr uint32_t bucket_of(Cycle latency) {
    if (latency < kExact) return uint32_t(latency);
    const auto octave = uint32_t(std::bit_width(latency)) - 5;
    return octave < kOctaves ? kExact + octave * kSteps + uint32_t(latency >> (octave + 1) & (kSteps - 1))
                             : kBuckets - 1;
  }
  static constexpr Cycle low_of(uint32_t bucket) {
    if (bucket < kExact) return bucket;
    const uint32_t octave = (bucket - kExact) / kSteps, step = (bucket - kExact) % kSteps;
    return Cycle{kSteps + step} << (octave + 1);
  }

  void add(Traffic traffic, Cycle latency) {
    OfClass& of = classes_[size_t(traffic)];
    ++of.counts[bucket_of(latency)];
    of.cycles += latency;
  }
  void add(const Latencies& other);
  uint64_t count(Traffic traffic, uint32_t bucket) const { return classes_[size_t(traffic)].counts[bucket]; }
  uint64_t cycles(Traffic traffic) const { return classes_[size_t(traffic)].cycles; }

 private:
  struct OfClass {
    std::array<uint64_t, kBuckets> counts{};
    uint64_t cycles = 0;
  };
  std::array<OfClass, size_t(Traffic::Count)> classes_{};
};

// Gives the sum of several Latencies as statistics. All parts are added before any statistic is read.
class LatencyStats : public stats::Group {
 public:
  // `what` says for the documentation which reads are counted and what is measured.
  LatencyStats(stats::Group* parent, std::string name, const char* what);
  void add(const Latencies& part) { parts_.push_back(&part); }

  uint64_t reads(Traffic traffic) const;
  uint64_t total() const;
  // Returns the last cycle of the bucket within which `of_100` of 100 reads were over, or 0 without reads.
  uint64_t percentile(Traffic traffic, uint32_t of_100) const;

 private:
  // Gives one number for each traffic class that has reads.
  class ByTraffic final : public stats::BreakdownBase {
   public:
    ByTraffic(LatencyStats* of, std::string_view name, std::string_view unit, std::string_view doc,
              uint64_t (*read)(const LatencyStats&, Traffic))
        : BreakdownBase(of, name, unit, doc), of_(*of), read_(read) {}
    std::vector<std::pair<std::string_view, uint64_t>> parts() const override;

   private:
    const LatencyStats& of_;
    uint64_t (*read_)(const LatencyStats&, Traffic);
  };
  // Gives the number of reads for each class and bucket that has any. The name of such a number is, for
  // example, "rt_node:64-71".
  class Buckets final : public stats::BreakdownBase {
   public:
    Buckets(LatencyStats* of, std::string_view doc);
    std::vector<std::pair<std::string_view, uint64_t>> parts() const override;
    // Everything else of the group is computed from the buckets and their cycles.
    void take_in(const Stat& other) override;

   private:
    LatencyStats& of_;
    std::vector<std::string> names_;  // by class, then by bucket
  };
  uint64_t count(Traffic traffic, uint32_t bucket) const;

  Latencies other_runs_;
  std::vector<const Latencies*> parts_{&other_runs_};
  ByTraffic reads_, cycles_, p50_, p90_, p99_;
  Buckets buckets_;
};

}  // namespace glint::mem
