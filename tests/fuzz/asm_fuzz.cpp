// Gives libFuzzer's inputs to the parser, as text of programs.
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/entry.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  glint::fuzz::assembly(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
