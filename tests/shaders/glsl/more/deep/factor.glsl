#include "../common_factor.glsl"
const uint kFactor = BASE_FACTOR + 1u;
