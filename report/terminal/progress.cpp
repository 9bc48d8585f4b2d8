// Draws the progress line.
// SPDX-License-Identifier: Apache-2.0
#include "report/terminal/progress.h"

#include <fmt/format.h>
#include <utility>

namespace glint::report {
namespace {
constexpr size_t kLineWidth = 80, kLabelWidth = 12;  // columns
constexpr int kBarWidth = 24, kBarWidthWithWork = 8;
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kQuiet{3};  // Choice: a reader wonders by then

// Returns the label's first characters. A character of several bytes is kept or left out as a whole.
std::string shortened(const std::string& label) {
  if (label.size() <= kLabelWidth) return label;
  size_t end = kLabelWidth;
  while (end > 0 && (uint8_t(label[end]) & 0xc0) == 0x80) --end;
  return label.substr(0, end);
}

}  // namespace

std::string progress_line(const std::string& label, uint64_t done, uint64_t total, double elapsed,
                          const Terminal& terminal, const Work& work) {
  const double fraction = total ? double(done) / double(total) : 0.0;
  const bool has_work = work.instructions > 0;
  const std::string name = has_work ? shortened(label) : label;
  std::string left, speed;
  if (done > 0 && done < total) left = "  ETA " + seconds(elapsed * (1 - fraction) / fraction);
  if (work.cycles > 0) speed += fmt::format("  {} cycles", rate(double(work.cycles)));
  if (has_work && elapsed > 0)
    speed += fmt::format("  {} instr/s", rate(double(work.instructions) / elapsed));
  if (!work.at.empty()) speed += "  at " + work.at;
  const auto line = [&](bool with_bar) {
    return fmt::format(
        " {}{} {:3.0f} %  {}", name,
        with_bar ? " [" + bar(fraction, has_work ? kBarWidthWithWork : kBarWidth, terminal) + "]" : "",
        fraction * 100, seconds(elapsed));
  };
  if (display_width(line(true) + left + speed) <= kLineWidth) return line(true) + left + speed;
  const bool fits = display_width(line(true) + speed) <= kLineWidth;
  return line(fits || work.at.empty()) + speed;
}

Progress::Progress(std::FILE* stream, std::string label, Terminal terminal)
    : stream_(stream),
      label_(std::move(label)),
      terminal_(terminal),
      start_(Clock::now()),
      last_(start_),
      moved_(start_) {
}

void Progress::update(uint64_t done, uint64_t total, Work work,
                      const std::function<std::string()>& source_line) {
  if (!stream_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < kRedraw) return;
  last_ = now;
  if (done != done_) done_ = done, moved_ = now;
  if (source_line && now - moved_ > kQuiet) work.at = source_line();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = progress_line(label_, done, total, elapsed, terminal_, work);
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
