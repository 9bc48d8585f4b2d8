// Adds up latencies, finds their percentiles, and names their buckets.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/latency.h"

#include <fmt/format.h>
#include <string_view>

namespace glint::mem {
namespace {

// Returns the largest latency of a bucket.
Cycle high_of(uint32_t bucket) {
  return Latencies::low_of(bucket + 1) - 1;
}

std::string name_of_bucket(uint32_t bucket) {
  const Cycle low = Latencies::low_of(bucket);
  if (bucket + 1 == Latencies::kBuckets) return fmt::format("{}+", low);
  return high_of(bucket) == low ? fmt::format("{}", low) : fmt::format("{}-{}", low, high_of(bucket));
}

}  // namespace

void Latencies::add(const Latencies& other) {
  for (size_t c = 0; c < classes_.size(); ++c) {
    for (uint32_t bucket = 0; bucket < kBuckets; ++bucket)
      classes_[c].counts[bucket] += other.classes_[c].counts[bucket];
    classes_[c].cycles += other.classes_[c].cycles;
  }
}

LatencyStats::LatencyStats(stats::Group* parent, std::string name, const char* what)
    : Group(parent, std::move(name)),
      reads_(this, "reads", "request", what,
             [](const LatencyStats& of, Traffic traffic) { return of.reads(traffic); }),
      cycles_(this, "cycles", "cycle",
              "Sum of the latencies of all reads that `reads` counts, by traffic class.",
              [](const LatencyStats& of, Traffic traffic) {
                uint64_t sum = 0;
                for (const Latencies* part : of.parts_) sum += part->cycles(traffic);
                return sum;
              }),
      p50_(this, "p50", "cycle",
           "Latency that half of the reads did not exceed, by traffic class. It is the upper end of its "
           "bucket.",
           [](const LatencyStats& of, Traffic traffic) { return of.percentile(traffic, 50); }),
      p90_(this, "p90", "cycle",
           "Latency that 90 % of the reads did not exceed, by traffic class. It is the upper end of its "
           "bucket.",
           [](const LatencyStats& of, Traffic traffic) { return of.percentile(traffic, 90); }),
      p99_(this, "p99", "cycle",
           "Latency that 99 % of the reads did not exceed, by traffic class. It is the upper end of its "
           "bucket.",
           [](const LatencyStats& of, Traffic traffic) { return of.percentile(traffic, 99); }),
      buckets_(
          this,
          "Number of reads by traffic class and latency. From 16 cycles on, each octave has eight buckets.") {
}

uint64_t LatencyStats::count(Traffic traffic, uint32_t bucket) const {
  uint64_t sum = 0;
  for (const Latencies* part : parts_) sum += part->count(traffic, bucket);
  return sum;
}

uint64_t LatencyStats::reads(Traffic traffic) const {
  uint64_t sum = 0;
  for (uint32_t bucket = 0; bucket < Latencies::kBuckets; ++bucket) sum += count(traffic, bucket);
  return sum;
}

uint64_t LatencyStats::total() const {
  uint64_t sum = 0;
  for (size_t traffic = 0; traffic < size_t(Traffic::Count); ++traffic) sum += reads(Traffic(traffic));
  return sum;
}

uint64_t LatencyStats::percentile(Traffic traffic, uint32_t of_100) const {
  const uint64_t all = reads(traffic);
  uint64_t sum = 0;
  for (uint32_t bucket = 0; bucket < Latencies::kBuckets && all > 0; ++bucket) {
    sum += count(traffic, bucket);
    if (sum * 100 >= all * of_100) return high_of(bucket);
  }
  return 0;
}

std::vector<std::pair<std::string_view, uint64_t>> LatencyStats::ByTraffic::parts() const {
  std::vector<std::pair<std::string_view, uint64_t>> out;
  for (size_t i = 0; i < size_t(Traffic::Count); ++i)
    if (of_.reads(Traffic(i)) > 0) out.emplace_back(name_of(Traffic(i)), read_(of_, Traffic(i)));
  return out;
}

LatencyStats::Buckets::Buckets(LatencyStats* of, std::string_view doc)
    : BreakdownBase(of, "buckets", "request", doc), of_(*of) {
  for (size_t i = 0; i < size_t(Traffic::Count); ++i)
    for (uint32_t bucket = 0; bucket < Latencies::kBuckets; ++bucket)
      names_.push_back(fmt::format("{}:{}", name_of(Traffic(i)), name_of_bucket(bucket)));
}

std::vector<std::pair<std::string_view, uint64_t>> LatencyStats::Buckets::parts() const {
  std::vector<std::pair<std::string_view, uint64_t>> out;
  for (size_t i = 0; i < names_.size(); ++i)
    if (const uint64_t n = of_.count(Traffic(i / Latencies::kBuckets), uint32_t(i % Latencies::kBuckets)))
      out.emplace_back(names_[i], n);
  return out;
}

void LatencyStats::Buckets::take_in(const Stat& other) {
  for (const Latencies* part : static_cast<const Buckets&>(other).of_.parts_) of_.other_runs_.add(*part);
}

}  // namespace glint::mem
