// The columns of annotated source: what can be shown of a line's cost.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/terminal/table.h"

namespace glint::report {

// Names of measures: "cycles" (share of those of all instructions), "issues", "lanes" (active, mean of an
// issue), "accesses", "requests", "sectors", "latency" (mean cycles of an access or trace), "waits" (what
// most cycles that issued nothing waited for), and the name of any reason (its cycles).
std::vector<std::string> measure_names(const ProfileTable& profile);
inline const std::vector<std::string> kUsualMeasures = {"cycles", "issues", "lanes", "sectors", "waits"};

// Some measures of rows of one profile, as cells of a table. The profile has to outlive it.
class Measures {
 public:
  // UserError with the names there are when one is unknown.
  Measures(const ProfileTable& profile, std::vector<std::string> names, const Terminal& terminal);

  std::vector<std::string> headings() const;
  // Coloured, where the terminal can, from 1 % and from 10 % of all cycles on. Empty cells for null.
  std::vector<std::string> cells(const ProfileRow* row) const;
  std::string alignment() const;  // for table()

  // Cycles of all instructions, known lines or not.
  uint64_t whole() const { return whole_; }
  // "12.3 %" of them.
  std::string share(uint64_t cycles) const;

 private:
  std::string cell(const std::string& name, const ProfileRow& row) const;

  const ProfileTable& profile_;
  std::vector<std::string> names_;
  Terminal terminal_;
  uint64_t whole_ = 0;
};

}  // namespace glint::report
