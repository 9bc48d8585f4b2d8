// Holds the text of shaders/traversal/traversal.rcall, which the build puts into the library.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace glint::pipeline {

std::string traversal_source();

}  // namespace glint::pipeline
