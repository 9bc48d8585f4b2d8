#version 460
#define TAG 2u
#include "parts/tag.glsl"
