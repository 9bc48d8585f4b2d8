// Includes the file with the mistake.
// SPDX-License-Identifier: Apache-2.0
#include "mistake.glsl"
