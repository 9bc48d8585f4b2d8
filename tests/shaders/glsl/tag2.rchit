// Tags the payload with 2.
// SPDX-License-Identifier: Apache-2.0
#version 460
#define TAG 2u
#include "parts/tag.glsl"
