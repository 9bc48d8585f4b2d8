// Includes a file that includes a mistake.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "parts/nested.glsl"
void main() { }
