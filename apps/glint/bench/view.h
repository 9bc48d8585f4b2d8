// Shows `glint bench`: a line for each workload that has ended and, on a terminal, those that run below.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/bench/plan.h"
#include "report/files/run_record.h"
#include "report/terminal/table.h"

namespace glint::app {

class BenchView {
 public:
  // `is_live` says that stdout is a terminal whose cursor can be moved; otherwise only finished lines are
  // printed.
  BenchView(const report::Terminal& terminal, bool is_live, size_t total)
      : terminal_(terminal), is_live_(is_live), total_(total) {}
  ~BenchView() { clear(); }
  BenchView(const BenchView&) = delete;
  BenchView& operator=(const BenchView&) = delete;

  // Shows a workload that has ended. `figures` are its figures when it ended well, and say how it ended
  // otherwise.
  void ended(const BenchTask& task, const Process& process, const std::string& figures);
  void draw(const ProcessPool& pool, const std::vector<std::string>& names);
  void clear();  // removes the lines of the running workloads

 private:
  report::Terminal terminal_;
  bool is_live_;
  size_t total_, ended_ = 0, failed_ = 0;
  int drawn_ = 0;  // lines drawn below the finished ones
};

// Returns the figures of a finished run, such as "376 565 cycles  thread IPC 132.9  43.3 nodes/ray". A
// functional run has fewer.
std::string figures_of(const report::RunRecord& run);

// Holds a row of the table at the end, which has one for each workload with results. Those of a launch that
// --max-cycles has ended are marked as partial.
struct BenchRow {
  const BenchTask* task;
  const Process* process;
  report::RunRecord run;
};
std::string summary_table(const std::vector<BenchRow>& rows);

// Returns the estimates of all sampled runs as a table, a row for each, with the ends of their 95 %
// intervals; "" when no run is sampled.
inline constexpr const char* kEstimates = "estimates.csv";
std::string estimates_table(const std::vector<BenchRow>& rows);

std::string gigabytes(uint64_t bytes);  // "1.24 GB", "0.08 GB"

}  // namespace glint::app
