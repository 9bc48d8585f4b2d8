// Tags the payload of a ray that hit nothing.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : enable
layout(location = 0) rayPayloadInEXT uint tag;
void main() { tag = 30u; }
