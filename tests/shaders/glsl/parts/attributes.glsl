// Declares payload and attributes of the reporting shaders.
// SPDX-License-Identifier: Apache-2.0
struct Seen { vec3 n; uint count; uint kind; float t; uint any_hits; };
#ifdef PAIR
hitAttributeEXT vec2 pair;
#else
struct Attributes { vec3 n; uint count; };
hitAttributeEXT Attributes attributes;
#endif
