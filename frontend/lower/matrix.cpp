// Computes determinants and inverses of square matrices by cofactors, with sums of products as chains of fma.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/math.h"

namespace glint::frontend::math {
namespace {

// Returns the determinant of the named rows and columns. m is an n x n matrix stored by columns.
Operand minor_of(Arithmetic& a, const Operands& m, size_t n, const std::vector<size_t>& rows,
                 const std::vector<size_t>& columns) {
  if (rows.size() == 1) return m[columns[0] * n + rows[0]];
  Operand sum;
  for (size_t c = 0; c < columns.size(); ++c) {
    std::vector<size_t> rest = columns;
    rest.erase(rest.begin() + long(c));
    const Operand factor = m[columns[c] * n + rows[0]],
                  minor = minor_of(a, m, n, {rows.begin() + 1, rows.end()}, rest);
    sum = c == 0 ? a.mul(factor, minor) : a.fma(c % 2 ? a.negative(factor) : factor, minor, sum);
  }
  return sum;
}

size_t order_of(const Operands& matrix) {
  return matrix.size() == 4 ? 2 : matrix.size() == 9 ? 3 : 4;
}

std::vector<size_t> all_but(size_t n, size_t left_out) {
  std::vector<size_t> result;
  for (size_t i = 0; i < n; ++i)
    if (i != left_out) result.push_back(i);
  return result;
}

}  // namespace

Operands determinant(Arithmetic& a, const std::vector<Operands>& arguments) {
  const size_t n = order_of(arguments[0]);
  return {minor_of(a, arguments[0], n, all_but(n, n), all_but(n, n))};
}

Operands inverse(Arithmetic& a, const std::vector<Operands>& arguments) {
  const Operands& m = arguments[0];
  const size_t n = order_of(m);
  const Operand scale = a.div(a.constant(1), determinant(a, arguments)[0]);
  Operands result;
  for (size_t column = 0; column < n; ++column)
    for (size_t row = 0; row < n; ++row) {  // transposed: the cofactor of row `column` and column `row`
      const Operand cofactor = a.mul(minor_of(a, m, n, all_but(n, column), all_but(n, row)), scale);
      result.push_back((row + column) % 2 ? a.negative(cofactor) : cofactor);
    }
  return result;
}

}  // namespace glint::frontend::math
