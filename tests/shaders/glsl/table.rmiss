#version 460
#extension GL_EXT_ray_tracing : enable
layout(location = 0) rayPayloadInEXT uint tag;
void main() { tag = 30u; }
