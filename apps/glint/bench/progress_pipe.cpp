// Writes progress lines.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/progress_pipe.h"

#include <fmt/format.h>
#include <unistd.h>

namespace glint::app {

void ProgressPipe::update(uint64_t done, uint64_t total) {
  if (descriptor_ < 0 || total == 0) return;
  const uint64_t thousandths = 1000 * done / total;
  if (thousandths == told_) return;
  told_ = thousandths;
  const std::string line = fmt::format("{} {}\n", phase_, thousandths);
  // A line is shorter than PIPE_BUF, so it is written whole or not at all. This run does not care whether
  // anybody reads it.
  if (::write(descriptor_, line.data(), line.size()) < 0) descriptor_ = -1;
}

}  // namespace glint::app
