// Declares the columns of annotated source, which show a line's cost.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/terminal/table.h"

namespace glint::report {

// Returns the names of measures: "cycles" (fraction of the cycles of all instructions), "issues", "lanes"
// (mean of active lanes per issue), "accesses", "requests", "sectors", "latency" (mean cycles of an access or
// trace), "waits" (what most cycles that issued nothing waited for), and the name of any reason (its cycles).
std::vector<std::string> measure_names(const ProfileTable& profile);
inline const std::vector<std::string> kUsualMeasures = {"cycles", "issues", "lanes", "sectors", "waits"};

// Shows some measures of rows of one profile as cells of a table. The profile has to outlive it.
class Measures {
 public:
  // Throws UserError with all names when one is unknown.
  Measures(const ProfileTable& profile, std::vector<std::string> names, const Terminal& terminal);

  std::vector<std::string> headings() const;
  // Returns the cells of a row, which are empty for null. Where the terminal can show colours, cells are
  // coloured from 1 % and from 10 % of all cycles on.
  std::vector<std::string> cells(const ProfileRow* row) const;
  std::string alignment() const;  // alignment for table()

  // Returns the cycles of all instructions, whether their lines are known or not.
  uint64_t whole() const { return whole_; }
  // Returns a percentage of whole(), such as "12.3 %".
  std::string share(uint64_t cycles) const;

 private:
  std::string cell(const std::string& name, const ProfileRow& row) const;

  const ProfileTable& profile_;
  std::vector<std::string> names_;
  Terminal terminal_;
  uint64_t whole_ = 0;
};

}  // namespace glint::report
