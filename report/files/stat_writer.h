// Declares a format of statistics. Each is one file in report/formats, registered by name.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "base/registry.h"
#include "base/stats.h"

namespace glint::report {

// Turns a tree of statistics into bytes. The same tree gives the same bytes on every machine.
class StatWriter {
 public:
  static constexpr PolicyKind kKind{"(statistics file)", "report/formats"};
  struct Context {};
  // Formats take no parameters.
  struct NoParams {
    static ParamList params() { return {}; }
  };
  virtual ~StatWriter() = default;
  virtual std::string write(const stats::Group& root) const = 0;
};

}  // namespace glint::report
