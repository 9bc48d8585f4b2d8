// Every registered policy of every interface, as `glint list policies` shows them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::app {

struct PolicyInfo {
  std::string key;     // the configuration key that chooses it, or what uses it
  std::string folder;  // of its implementation files
  std::string name, doc;
};
std::vector<PolicyInfo> all_policies();

}  // namespace glint::app
