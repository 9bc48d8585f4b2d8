// libFuzzer's door to programs that need no text.
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/entry.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  glint::fuzz::program({data, size});
  return 0;
}
