// Joins the op families into one table for each SIMD path, and finds the path of this machine.
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <vector>

#include "base/check.h"
#include "isa/op_row.h"
#include "isa/ops/row_list.h"
#include "isa/paths.h"

namespace glint::isa {

// These functions are in isa/ops/families.cpp, which is compiled once for each path.
namespace baseline {
std::span<const FamilyEntry> family_entries();
}
namespace avx2 {
std::span<const FamilyEntry> family_entries();
}
namespace avx512 {
std::span<const FamilyEntry> family_entries();
}

namespace {

std::vector<OpRow> joined(std::span<const FamilyEntry> entries) {
  size_t count = 0;
  for (const FamilyEntry& entry : entries) count += entry.rows().count;
  std::vector<OpRow> out;
  out.reserve(count);  // A row is large, so growing would copy megabytes.
  for (const FamilyEntry& entry : entries) {
    const RowList list = entry.rows();
    out.insert(out.end(), list.rows, list.rows + list.count);
  }
  return out;
}

std::vector<Family> make_families() {
  std::vector<Family> out;
  uint16_t first = 0;
  for (const FamilyEntry& entry : baseline::family_entries()) {
    const uint16_t count = uint16_t(entry.rows().count);
    out.push_back({entry.name, entry.doc, first, count});
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
  // Every processor with AVX2 and FMA also converts f16, because F16C came before both. Some compilers do not
  // know the name of F16C here.
  const bool has_avx2 =
      __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (path == Path::Baseline) return true;
  if (path == Path::Avx2) return has_avx2;
  return has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

// A table is made when it is first wanted, because a run needs one of the three.
std::span<const OpRow> op_table(Path path) {
  if (path == Path::Avx512) {
    static const std::vector<OpRow> table = joined(avx512::family_entries());
    return table;
  }
  if (path == Path::Avx2) {
    static const std::vector<OpRow> table = joined(avx2::family_entries());
    return table;
  }
  static const std::vector<OpRow> table = joined(baseline::family_entries());
  return table;
}

std::span<const OpRow> op_table() {
  static const std::span<const OpRow> table = op_table(widest_path());
  return table;
}

std::span<const Family> families() {
  static const std::vector<Family> all = make_families();
  return all;
}

int find_op(std::string_view name) {
  static const std::map<std::string_view, int> index = [] {
    std::map<std::string_view, int> out;
    for (const OpRow& row : op_table()) {
      const bool is_new = out.emplace(row.name, int(out.size())).second;
      GLINT_CHECK(is_new, "op '{}' is in the table twice", row.name);
    }
    return out;
  }();
  const auto it = index.find(name);
  return it == index.end() ? -1 : it->second;
}

uint16_t op_index(std::string_view name) {
  const int index = find_op(name);
  GLINT_CHECK(index >= 0, "there is no op '{}'", name);
  return uint16_t(index);
}

}  // namespace glint::isa
