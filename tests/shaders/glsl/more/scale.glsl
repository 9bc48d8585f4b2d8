#include "deep/factor.glsl"
uint scaled(uint x) { return x * kFactor; }
