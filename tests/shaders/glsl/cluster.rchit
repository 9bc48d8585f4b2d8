// Declares by hand a built-in of an extension that is newer than the compiler.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_spirv_intrinsics : require

spirv_decorate(extensions = ["SPV_NV_cluster_acceleration_structure"], capabilities = [5437], 11, 5436) in int cluster;
layout(location = 0) rayPayloadInEXT int payload;

void main() { payload = cluster; }
