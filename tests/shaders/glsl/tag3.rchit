#version 460
#define TAG 3u
#include "parts/tag.glsl"
