// Draws the progress line.
// SPDX-License-Identifier: Apache-2.0
#include "report/terminal/progress.h"

#include <fmt/format.h>
#include <utility>

namespace glint::report {
namespace {
constexpr int kBarWidth = 24;  // columns, so that label, bar and times stay within 80
constexpr std::chrono::milliseconds kRedraw{100};
}  // namespace

std::string progress_line(const std::string& label, uint64_t done, uint64_t total, double elapsed,
                          const Terminal& terminal) {
  const double fraction = total ? double(done) / double(total) : 0.0;
  std::string line =
      fmt::format(" {} [{}] {:3.0f} %", label, bar(fraction, kBarWidth, terminal), fraction * 100);
  line += "  " + seconds(elapsed);
  if (done > 0 && done < total) line += "  ETA " + seconds(elapsed * (1 - fraction) / fraction);
  return line;
}

Progress::Progress(std::FILE* stream, std::string label, Terminal terminal)
    : stream_(stream), label_(std::move(label)), terminal_(terminal), start_(Clock::now()), last_(start_) {
}

void Progress::update(uint64_t done, uint64_t total) {
  if (!stream_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < kRedraw) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = progress_line(label_, done, total, elapsed, terminal_);
  const size_t width = display_width(line);
  if (width < drawn_) line.append(drawn_ - width, ' ');
  drawn_ = width;
  fmt::print(stream_, "\r{}", line);
  std::fflush(stream_);
}

void Progress::clear() {
  if (!stream_ || drawn_ == 0) return;
  fmt::print(stream_, "\r{}\r", std::string(drawn_, ' '));
  std::fflush(stream_);
  drawn_ = 0;
}

}  // namespace glint::report
