// Implements the format `csv` of statistics: comma-separated values for spreadsheets, with the header
// `path,value,unit,doc`.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "report/files/csv_field.h"
#include "report/files/stat_rows.h"
#include "report/files/stat_writer.h"

namespace glint::report {
namespace {

class CsvWriter final : public StatWriter {
 public:
  static constexpr const char* kName = "csv";
  static constexpr const char* kDoc = "Writes a header line and one row per statistic, as RFC 4180 has it.";
  using Params = NoParams;
  CsvWriter(Params, Context) {}

  std::string write(const stats::Group& root) const override {
    std::string out = "path,value,unit,doc\n";
    for (const StatRow& row : stat_rows(root)) {
      for (const std::string_view field :
           {std::string_view(row.path), std::string_view(row.value), row.unit}) {
        append_csv_field(out, field);
        out += ',';
      }
      append_csv_field(out, row.doc);
      out += '\n';
    }
    return out;
  }
};

const Register<StatWriter, CsvWriter> registered;

}  // namespace
}  // namespace glint::report
