// Declares the payload of a path.
// SPDX-License-Identifier: Apache-2.0
struct Path { uint depth; float sum; uint trail; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT top;
#ifndef DEPTH
#define DEPTH 3u
#endif
