// Says where the registers of a wmma fragment lie in its matrix, on the lanes of a warp.
// SPDX-License-Identifier: Apache-2.0
//
// PTX leaves open which lane holds which element. Here the elements lie as on an H200, whose wmma.load was
// asked for each of them, and as mma wants them, so that programs which index fragments see the same.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::frontend::ptx {

// Describes the fragments of one instruction. Lane 4g + t holds the elements with g along the outer dimension
// and, along the inner one, those from t * step on: inner is the depth of A and B, and the direction in which
// C has pairs. The inner direction of A is a row.
struct Fragment {
  char matrix = 'a';  // a, b or c
  uint32_t m = 0, n = 0, k = 0;
  std::string type;       // f16, bf16, tf32, f32, f64, s8, u8, s4, u4, b1, s32
  uint32_t bits = 0;      // of an element
  uint32_t per = 1;       // elements of a register
  uint32_t step = 1;      // elements from one t to the next
  uint32_t distinct = 0;  // registers that differ; more repeat them
  uint32_t registers = 0;

  bool is_sum() const { return matrix == 'c'; }
  bool is_wide() const { return bits == 64; }
  // Returns whether B has the part of A in mma and A that of B: of the shape m8n32k16 the transposed product
  // is computed.
  bool is_swapped() const { return n == 32; }
  // Returns whether neighbours along the inner dimension are neighbours in memory.
  bool is_contiguous(bool row_major) const {
    const bool inner_is_row = matrix == 'a' || (is_sum() && !is_swapped());
    return inner_is_row == row_major;
  }
  // Returns whether registers come by outer blocks of 8 first: the matrix that has the part of A in mma.
  bool is_outer_first() const { return !is_sum() && (matrix == 'b') == is_swapped(); }
  // Returns where the elements of a register begin.
  struct Origin {
    uint32_t outer, inner;
  };
  Origin origin(uint32_t r) const;
};

// Returns the fragment of a shape such as m16n16k16, or nothing when there is none.
std::optional<Fragment> fragment_of(char matrix, const std::string& shape, const std::string& type);

// Says how a wmma.mma is made of mma: in how many steps, each of which has a part of the sums, and in how
// many along the depth.
struct FragmentProduct {
  Fragment a, b, c, d;
  std::string op;  // name of the row
  uint32_t steps = 1, depths = 1;
};
// Returns the product that the words of an opcode name, or nothing when there is none. The row may be
// missing.
std::optional<FragmentProduct> fragment_product(const std::vector<std::string>& words);

}  // namespace glint::frontend::ptx
