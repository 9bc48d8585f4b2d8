// Finds what the shaders of a pipeline declare at the place of a binding, and checks that the script binds
// that.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "amber/compile.h"
#include "amber/script.h"
#include "frontend/spirv/reflection.h"

namespace glint::amber {

// Returns the declaration at the binding's place that has the most elements, or null when no shader declares
// one.
const frontend::Binding* reflected(const Binding& binding, const std::vector<CompiledShader>& shaders);

// Throws UserError when the kind of a binding is not what the shader declares. Aliases of different kinds at
// one place are allowed; one of them has to match.
void check_kind(const Binding& binding, const std::vector<CompiledShader>& shaders);

}  // namespace glint::amber
