// Keeps compiled shaders for all tests of a program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/cache.h"

namespace glint::test {

// Returns the one store of a program's compiled shaders, which is in memory only. A shader is found there by
// everything that it was made from, so a test gets the same program as if it were the only test.
inline frontend::ShaderCache* kept_shaders() {
  static frontend::ShaderCache shaders({});
  return &shaders;
}

}  // namespace glint::test
