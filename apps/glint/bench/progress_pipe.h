// Tells another process how far a run is, in lines such as "loading 437" (thousandths) through a file
// descriptor.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>

namespace glint::app {

class ProgressPipe {
 public:
  // A `descriptor` below 0 tells nobody. `phase` is one word.
  ProgressPipe(int descriptor, std::string phase) : descriptor_(descriptor), phase_(std::move(phase)) {}
  // Writes a line when a thousandth is complete, so a phase has at most a thousand short lines.
  void update(uint64_t done, uint64_t total);

 private:
  int descriptor_;
  std::string phase_;
  uint64_t told_ = 0;
};

}  // namespace glint::app
