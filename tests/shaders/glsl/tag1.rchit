// Tags the payload with 1.
// SPDX-License-Identifier: Apache-2.0
#version 460
#define TAG 1u
#include "parts/tag.glsl"
