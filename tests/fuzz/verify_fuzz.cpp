// Gives libFuzzer's inputs to the verifier, as programs spelt by bytes.
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/entry.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  glint::fuzz::program({data, size});
  return 0;
}
