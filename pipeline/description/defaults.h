// Makes the obvious description of shaders from their reflection, for `glint init` and for a shader alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "frontend/compile.h"

namespace glint::pipeline {

// Returns a commented TOML text that runs as it is; paths in it start at `folder`. Throws UserError when the
// shaders make no pipeline, because they have no ray generation or compute shader, or several.
std::string default_description(const std::vector<std::string>& shaders, const std::string& folder,
                                const frontend::GlslOptions& glsl = {});

// Returns a text as TOML's basic string.
std::string quoted(const std::string& text);
// Returns the path of a file as a description in `folder` names it.
std::string path_from(const std::string& path, const std::string& folder);

// Returns a ray generation shader with the shaders beside it that have its name and another stage's ending.
std::vector<std::string> with_companions(const std::string& shader);

}  // namespace glint::pipeline
