// Compares what the shaders ask for with what the description gives. Every difference names both places.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/description/modules.h"

namespace glint::pipeline {

// Checks kinds, counts, shapes and stages of records. Throws UserError with all mistakes. `warnings` gets
// what is given and never used.
void check_pipeline(const PipelineDescription& description, const Modules& modules,
                    std::vector<std::string>& warnings);

// Reports a buffer that is smaller than the block's static layout.
void check_bytes(const BindingUse& use, uint64_t bytes, const std::string& name, const SourceLocation& where,
                 Diagnostics& errors);

}  // namespace glint::pipeline
