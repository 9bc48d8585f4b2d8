// Holds what most of the laboratory's shaders share. The included name is relative to this folder.
// SPDX-License-Identifier: Apache-2.0
#ifndef COMMON_GLSL
#define COMMON_GLSL
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#include "parts/results.glsl"
#endif
