// Writes random straight code over all exact ops. Every value is stored, so that the first wrong op is named.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::test::torture {

inline constexpr uint32_t kValueWords = 8;  // room of a value in the results: four parts of 64 bits
inline constexpr uint32_t kExpressionInputs = 256;

struct ExpressionProgram {
  std::vector<uint32_t> spirv;
  // Says what each value computes, in the order of the values' words in a lane's results.
  std::vector<std::string> values;
  uint32_t lanes = 64;
};

ExpressionProgram random_expressions(uint64_t seed, uint32_t count);

// Returns words that are interesting as integers and as floats.
std::vector<uint32_t> expression_inputs(uint64_t seed);

}  // namespace glint::test::torture
