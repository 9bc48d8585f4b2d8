// Implements the format `csv` of statistics: comma-separated values for spreadsheets, with the header
// `path,value,unit,doc`.
// SPDX-License-Identifier: Apache-2.0
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
    for (const StatRow& row : stat_rows(root))
      out += csv_field(row.path) + "," + csv_field(row.value) + "," + csv_field(row.unit) + "," +
             csv_field(row.doc) + "\n";
    return out;
  }
};

const Register<StatWriter, CsvWriter> registered;

}  // namespace
}  // namespace glint::report
