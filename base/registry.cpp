// Implements what the registries of all interfaces have in common.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>
#include <utility>

#include "base/check.h"

namespace glint {
namespace {

// Static objects fill the list, so it lives in a function.
std::vector<std::pair<PolicyKind, const PolicyRegistry*>>& registries() {
  static std::vector<std::pair<PolicyKind, const PolicyRegistry*>> list;
  return list;
}

}  // namespace

std::vector<std::string>& registered_twice() {
  static std::vector<std::string> names;
  return names;
}

PolicyRegistry::PolicyRegistry(const PolicyKind& kind) : kind_(kind) {
  registries().emplace_back(kind, this);
}

void PolicyRegistry::add(std::string_view name, const PolicyEntry& entry) {
  if (!entries_.emplace(name, &entry).second)
    registered_twice().push_back(fmt::format("{}: {}", kind_.folder, name));
}

const PolicyEntry& PolicyRegistry::at(std::string_view name) const {
  const auto it = entries_.find(name);
  GLINT_CHECK(it != entries_.end(), "no policy named '{}'", name);
  return *it->second;
}

std::vector<std::string> PolicyRegistry::list() const {
  std::vector<std::string> out;
  for (const auto& [name, entry] : entries_) out.emplace_back(name);
  return out;
}

void PolicyRegistry::read(ConfigTable& table, std::string_view key, AnyPolicyChoice& choice) const {
  choice.name = table.take_name(key, choice.name, list());
  choice.others.clear();
  for (const auto& [name, entry] : entries_) {
    ConfigTable params = table.take_table(name);
    if (name == choice.name)
      choice.params = entry->read(params, &choice);
    else
      choice.others.emplace(name, entry->read(params, nullptr));
  }
}

const PolicyRegistry& registry_of(const PolicyKind& kind) {
  const auto it = std::find_if(registries().begin(), registries().end(),
                               [&](const auto& one) { return one.first.folder == kind.folder; });
  GLINT_CHECK(it != registries().end(), "no policy of {} is linked", kind.folder);
  return *it->second;
}

std::vector<PolicyInfo> all_policies() {
  std::vector<PolicyInfo> out;
  for (const auto& [kind, registry] : registries())
    for (const std::string& name : registry->list())
      out.push_back({kind, name, std::string(registry->at(name).doc)});
  std::sort(out.begin(), out.end(), [](const PolicyInfo& a, const PolicyInfo& b) {
    return std::tie(a.kind.folder, a.name) < std::tie(b.kind.folder, b.name);
  });
  return out;
}

std::vector<ParamInfo> describe_choice(const AnyPolicyChoice& choice, const std::string& prefix,
                                       std::string_view key) {
  std::vector<ParamInfo> out;
  const auto add = [&](const std::string& policy, const std::vector<ParamInfo>& params,
                       const std::string& needs) {
    for (ParamInfo info : params) {
      info.key = prefix + policy + "." + info.key;
      info.needs = needs;
      out.push_back(std::move(info));
    }
  };
  add(choice.name, choice.params, "");
  for (const auto& [name, params] : choice.others)
    add(name, params, prefix + std::string(key) + " = " + config_text(name));
  return out;
}

}  // namespace glint
