// Look-up of workloads by name.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/workloads.h"

#include <vector>

#include "base/diagnostics.h"

namespace glint::app {

const WorkloadInfo& find_workload(const std::string& name) {
  std::vector<std::string> names;
  for (const WorkloadInfo& info : kWorkloads) {
    if (info.name == name) return info;
    names.emplace_back(info.name);
  }
  const std::string guess = nearest(name, names);
  throw UserError({}, "no shader set '" + name + "', expected pt, sh or ao",
                  guess.empty() ? "" : "did you mean '" + guess + "'?");
}

}  // namespace glint::app
