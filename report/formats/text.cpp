// Implements the format `txt` of statistics: aligned text for reading and grep, `path   value  unit  # doc`.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "report/files/stat_rows.h"
#include "report/files/stat_writer.h"

namespace glint::report {
namespace {

class TextWriter final : public StatWriter {
 public:
  static constexpr const char* kName = "txt";
  static constexpr const char* kDoc =
      "Writes one aligned line per statistic: path, value, unit, description.";
  using Params = NoParams;
  TextWriter(Params, Context) {}

  std::string write(const stats::Group& root) const override {
    const std::vector<StatRow> rows = stat_rows(root);
    size_t path = 0, value = 0, unit = 0;
    for (const StatRow& row : rows) {
      path = std::max(path, row.path.size());
      value = std::max(value, row.value.size());
      unit = std::max(unit, row.unit.size());
    }
    std::string out;
    for (const StatRow& row : rows) {
      out.append(row.path).append(path - row.path.size() + 2, ' ');
      out.append(value - row.value.size(), ' ').append(row.value).append(2, ' ');
      out.append(row.unit).append(unit - row.unit.size(), ' ').append("  # ").append(row.doc) += '\n';
    }
    return out;
  }
};

const Register<StatWriter, TextWriter> registered;

}  // namespace
}  // namespace glint::report
