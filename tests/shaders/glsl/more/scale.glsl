// Starts an include chain.
// SPDX-License-Identifier: Apache-2.0
#include "deep/factor.glsl"
uint scaled(uint x) { return x * kFactor; }
