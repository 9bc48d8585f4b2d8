// Joins the op families into one table a SIMD path, and finds the path of this machine.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <map>
#include <vector>

#include "base/check.h"
#include "isa/op_row.h"
#include "isa/ops/row_list.h"
#include "isa/paths.h"

namespace glint::isa {

// isa/ops/families.cpp, compiled once for each path.
namespace baseline {
RowList family_rows(int family);
}
namespace avx2 {
RowList family_rows(int family);
}
namespace avx512 {
RowList family_rows(int family);
}

namespace {

constexpr int kNumFamilies = 10;
constexpr std::array<std::string_view, kNumFamilies> kFamilyNames = {
    "move",      "integer", "compare", "float",   "convert",
    "predicate", "memory",  "texture", "control", "ray tracing"};
constexpr std::array<std::string_view, kNumFamilies> kFamilyDocs = {
    "Copies, selections, and the packing of register pairs.",
    "Integer arithmetic, logic, shifts and bit fields.",
    "Integer comparisons; the result is a predicate.",
    "Single precision, rounded to nearest even, subnormals kept; a NaN result is 0x7fffffff.",
    "Conversions between integers and floats, and rounding to integers.",
    "Operations on predicates.",
    "Loads and stores; an address is a register (pair) and a displacement.",
    "Filtered texture fetches and texel access.",
    "Branches, regions whose lanes meet again, and ends.",
    "Rays, and the calls of the shaders they find."};

std::vector<OpRow> joined(Path path) {
  const auto rows_of = path == Path::Avx512 ? &avx512::family_rows
                       : path == Path::Avx2 ? &avx2::family_rows
                                            : &baseline::family_rows;
  std::vector<OpRow> out;
  for (int f = 0; f < kNumFamilies; ++f) {
    const RowList list = rows_of(f);
    out.insert(out.end(), list.rows, list.rows + list.count);
  }
  return out;
}

std::array<Family, kNumFamilies> make_families() {
  std::array<Family, kNumFamilies> out;
  uint16_t first = 0;
  for (int f = 0; f < kNumFamilies; ++f) {
    const uint16_t count = uint16_t(baseline::family_rows(f).count);
    out[f] = {kFamilyNames[f], kFamilyDocs[f], first, count};
    first = uint16_t(first + count);
  }
  return out;
}

Path widest_path() {
  if (is_supported(Path::Avx512)) return Path::Avx512;
  return is_supported(Path::Avx2) ? Path::Avx2 : Path::Baseline;
}

}  // namespace

bool is_supported(Path path) {
  const bool has_avx2 =
      __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (path == Path::Baseline) return true;
  if (path == Path::Avx2) return has_avx2;
  return has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

std::span<const OpRow> op_table(Path path) {
  static const std::array<std::vector<OpRow>, size_t(Path::Count)> tables = {
      joined(Path::Baseline), joined(Path::Avx2), joined(Path::Avx512)};
  return tables[size_t(path)];
}

std::span<const OpRow> op_table() {
  static const std::span<const OpRow> table = op_table(widest_path());
  return table;
}

std::span<const Family> families() {
  static const std::array<Family, kNumFamilies> all = make_families();
  return all;
}

int find_op(std::string_view name) {
  static const std::map<std::string_view, int> index = [] {
    std::map<std::string_view, int> out;
    for (const OpRow& row : op_table()) {
      const bool is_new = out.emplace(row.name, int(out.size())).second;
      GLINT_CHECK(is_new, "op '{}' stands twice in the table", row.name);
    }
    return out;
  }();
  const auto it = index.find(name);
  return it == index.end() ? -1 : it->second;
}

uint16_t op_index(std::string_view name) {
  const int index = find_op(name);
  GLINT_CHECK(index >= 0, "no op is named '{}'", name);
  return uint16_t(index);
}

}  // namespace glint::isa
