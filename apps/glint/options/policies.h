// Lists every registered policy of every interface, as `glint list policies` shows them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::app {

struct PolicyInfo {
  std::string key;     // the configuration key that chooses the policy, or what uses it
  std::string folder;  // folder of the interface's implementation files
  std::string name, doc;
};
std::vector<PolicyInfo> all_policies();

}  // namespace glint::app
