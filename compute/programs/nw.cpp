// Aligns two sequences by dynamic programming (Needleman and Wunsch, JMB 1970).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

constexpr uint32_t kLetters = 24;  // as in the usual tables of amino acids

// Returns how alike each letter of one sequence is to each of the other.
std::vector<int32_t> similarity_of(Random& random, int32_t length) {
  int32_t table[kLetters][kLetters];
  for (uint32_t i = 0; i < kLetters; ++i)
    for (uint32_t j = 0; j <= i; ++j)
      table[i][j] = table[j][i] = i == j ? int32_t(4 + random.below(8)) : int32_t(random.below(8)) - 4;
  std::vector<uint32_t> one(length), other(length);
  for (uint32_t& letter : one) letter = random.below(kLetters);
  for (uint32_t& letter : other) letter = random.below(kLetters);
  std::vector<int32_t> out;
  out.reserve(size_t(length) * length);
  for (const uint32_t row : one)
    for (const uint32_t column : other) out.push_back(table[row][column]);
  return out;
}

// Returns scores whose row 0 and column 0 are those of gaps alone.
std::vector<int32_t> empty_scores(int32_t length, int32_t penalty) {
  const int32_t width = length + 1;
  std::vector<int32_t> out(size_t(width) * width);
  for (int32_t i = 0; i < width; ++i) out[i] = out[size_t(i) * width] = -i * penalty;
  return out;
}

void fill(std::vector<int32_t>& scores, const std::vector<int32_t>& similarity, int32_t length,
          int32_t penalty) {
  const size_t width = length + 1;
  for (size_t y = 1; y < width; ++y)
    for (size_t x = 1; x < width; ++x)
      scores[y * width + x] =
          std::max({scores[(y - 1) * width + x - 1] + similarity[(y - 1) * length + x - 1],
                    scores[y * width + x - 1] - penalty, scores[(y - 1) * width + x] - penalty});
}

}  // namespace

void nw(Host& host, Size size) {
  const int32_t length = size == Size::Full ? 2'048 : 128, penalty = 10, blocks = length / 16;
  const std::vector<int32_t> similarity = similarity_of(host.random, length);
  std::vector<int32_t> scores = empty_scores(length, penalty);
  const auto values = host.buffer("scores", scores), alike = host.buffer("similarity", similarity);
  for (int32_t diagonal = 0; diagonal < 2 * blocks - 1; ++diagonal) {
    const int32_t first = std::max(0, diagonal - blocks + 1), last = std::min(diagonal, blocks - 1);
    struct {
      int32_t length, penalty, diagonal, first_column;
    } const constants{length, penalty, diagonal, first};
    host.launch("nw", {uint32_t(last - first + 1), 1, 1}, {values, alike}, constants);
  }
  fill(scores, similarity, length, penalty);
  host.check("scores", values, scores);
}

}  // namespace glint::compute
