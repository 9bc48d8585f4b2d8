// Holds the lists that registries fill.
// SPDX-License-Identifier: Apache-2.0
#include "base/policy_kinds.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace glint {

std::vector<std::function<std::vector<PolicyInfo>()>>& policy_lists() {
  static std::vector<std::function<std::vector<PolicyInfo>()>> lists;
  return lists;
}

std::vector<std::string>& registered_twice() {
  static std::vector<std::string> names;
  return names;
}

std::vector<PolicyInfo> all_policies() {
  std::vector<PolicyInfo> out;
  for (const auto& list : policy_lists())
    for (PolicyInfo& info : list()) out.push_back(std::move(info));
  std::sort(out.begin(), out.end(), [](const PolicyInfo& a, const PolicyInfo& b) {
    return std::tie(a.kind.folder, a.name) < std::tie(b.kind.folder, b.name);
  });
  return out;
}

}  // namespace glint
