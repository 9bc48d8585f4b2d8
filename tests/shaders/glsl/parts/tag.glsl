// Tags the payload with TAG.
// SPDX-License-Identifier: Apache-2.0
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT uint tag;
void main() { tag = TAG; }
