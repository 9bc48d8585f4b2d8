// Says what a trace is asked to show, and how large it may be.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"

namespace glint::pipeline {

struct TraceRequest {
  bool wanted = false;
  Cycle begin = 0, end = kNever;  // cycles
  uint64_t limit = 1'000'000;     // number of events
};

}  // namespace glint::pipeline
