// The obvious description of a set of shaders, from their own reflection: what `glint init` writes and what a
// shader alone is run with.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "frontend/compile.h"

namespace glint::pipeline {

// A commented TOML text that runs as it is; paths in it start at `folder`. UserError when the shaders make no
// pipeline: no ray generation or compute shader, or several.
std::string default_description(const std::vector<std::string>& shaders, const std::string& folder,
                                const frontend::GlslOptions& glsl = {});

// A ray generation shader with the shaders beside it that have its name and another stage's ending.
std::vector<std::string> with_companions(const std::string& shader);

}  // namespace glint::pipeline
