#version 460
#define TAG 1u
#include "parts/tag.glsl"
