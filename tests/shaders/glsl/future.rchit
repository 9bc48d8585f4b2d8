// Declares by hand a built-in of an extension that no compiler knows.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_spirv_intrinsics : require

spirv_decorate(extensions = ["SPV_GLINT_from_the_future"], capabilities = [2147483000], 11, 2147483001) in int future;
layout(location = 0) rayPayloadInEXT int payload;

void main() { payload = future; }
