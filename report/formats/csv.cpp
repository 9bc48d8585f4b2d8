// Statistics as comma-separated values for spreadsheets: header `path,value,unit,doc`.
// SPDX-License-Identifier: Apache-2.0
#include "report/stat_rows.h"
#include "report/stat_writer.h"

namespace glint::report {
namespace {

// RFC 4180: a field with a comma, quote or newline is quoted, its quotes doubled.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

class CsvWriter final : public StatWriter {
 public:
  static constexpr const char* kName = "csv";
  static constexpr const char* kDoc = "One row a statistic with a header line, RFC 4180.";
  using Params = NoParams;
  CsvWriter(Params, Context) {}

  std::string write(const stats::Group& root) const override {
    std::string out = "path,value,unit,doc\n";
    for (const StatRow& row : stat_rows(root))
      out += field(row.path) + "," + field(row.value) + "," + field(row.unit) + "," + field(row.doc) + "\n";
    return out;
  }
};

const Register<StatWriter, CsvWriter> registered;

}  // namespace
}  // namespace glint::report
