// Tags the payload with 3.
// SPDX-License-Identifier: Apache-2.0
#version 460
#define TAG 3u
#include "parts/tag.glsl"
