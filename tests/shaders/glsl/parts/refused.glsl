// Has a function that the frontend does not support.
// SPDX-License-Identifier: Apache-2.0

float fetched(ivec2 at) {
  vec4 texel; const int code = sparseTexelFetchARB(flat_image, at, 0, texel);
  return texel.x + float(code);
}
