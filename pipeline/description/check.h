// What the shaders ask for against what the description gives: every difference names both places.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/description/modules.h"

namespace glint::pipeline {

// Kinds, counts, shapes, stages of records. UserError with everything; `warnings` hears of what nobody uses.
void check_pipeline(const PipelineDescription& description, const Modules& modules,
                    std::vector<std::string>& warnings);

// A buffer that is smaller than the block's static layout. Nothing when it is large enough.
void check_bytes(const BindingUse& use, uint64_t bytes, const std::string& name, const SourceLocation& where,
                 Diagnostics& errors);

}  // namespace glint::pipeline
