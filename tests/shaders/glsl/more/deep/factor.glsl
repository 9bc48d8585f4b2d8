// Stands in the middle of an include chain.
// SPDX-License-Identifier: Apache-2.0
#include "../common_factor.glsl"
const uint kFactor = BASE_FACTOR + 1u;
