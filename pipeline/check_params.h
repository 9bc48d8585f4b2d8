// Finds what makes a GPU impossible, whatever it runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/diagnostics.h"
#include "pipeline/params.h"

namespace glint::pipeline {

// Reports every key that is impossible, alone or together with others. A message begins with the quoted key.
void check(const GpuParams& params, Diagnostics& diagnostics);

}  // namespace glint::pipeline
