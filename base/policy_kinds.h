// Lists the registered policies of all interfaces. Each Registry (base/registry.h) adds itself.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Says what an interface of policies is to users. Each interface declares one: `static constexpr PolicyKind
// kKind`.
struct PolicyKind {
  std::string_view key;     // the configuration key that chooses a policy, or what uses the policies
  std::string_view folder;  // the folder of the implementation files
};

struct PolicyInfo {
  PolicyKind kind;
  std::string name, doc;
};

// Returns every registered policy, ordered by folder and name.
std::vector<PolicyInfo> all_policies();

// Both lists are filled by static objects, so each lives in a function. The second holds "folder: name" of
// every policy whose name was taken; main() and the loader of plugins report it.
std::vector<std::function<std::vector<PolicyInfo>()>>& policy_lists();
std::vector<std::string>& registered_twice();

}  // namespace glint
