// Maps names to factories of policies. Static objects in the implementation files fill the map.
//
// An implementation file registers itself with `const Register<RayScheduler, OldestFirst> registered;` at its
// end. The class has kName, kDoc, Params (base/params.h) and a constructor (Params, Interface::Context). The
// interface has a type Context, which its constructor's caller fills, and a PolicyKind kKind.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/params.h"
#include "base/policy_kinds.h"

namespace glint {

// Holds a policy chosen by a configuration: its name, and a function that makes it with the parameters that
// were read.
template <class Interface>
struct PolicyChoice {
  using Make = std::function<std::unique_ptr<Interface>(typename Interface::Context)>;
  std::string name;
  Make maker;                     // empty: the policy is made with its default parameters
  std::vector<ParamInfo> params;  // parameters of the policy, as read
  std::map<std::string, std::vector<ParamInfo>> others;  // parameters of the policies not chosen

  // The constructor is implicit, so that a default value is written as a name.
  PolicyChoice(const char* default_name) : name(default_name) {}  // NOLINT
  std::unique_ptr<Interface> make(typename Interface::Context context) const;
  // Returns true when the policy declares `static constexpr bool kInIntervalModel = true`: the interval model
  // (pipeline/interval) computes what this policy does.
  bool is_in_interval_model() const;
};

template <class Interface>
class Registry {
 public:
  struct Entry {
    std::string_view doc;
    // Reads the policy's parameters into `choice`: the maker and the list of parameters.
    void (*read)(ConfigTable&, PolicyChoice<Interface>&);
    std::vector<ParamInfo> (*defaults)();
    std::unique_ptr<Interface> (*make_default)(typename Interface::Context);
    bool is_in_interval_model;
  };
  // The object is local to the function, so it exists before the first static object registers a policy.
  static Registry& instance() {
    static Registry registry;
    return registry;
  }
  // A name that is taken keeps its first policy, and the second goes to registered_twice(): a static object
  // has nobody to throw to.
  void add(std::string_view name, Entry entry) {
    if (!entries_.emplace(name, entry).second)
      registered_twice().push_back(fmt::format("{}: {}", Interface::kKind.folder, name));
  }
  const std::map<std::string_view, Entry>& entries() const { return entries_; }  // sorted by name
  const Entry& entry(std::string_view name) const {
    auto it = entries_.find(name);
    GLINT_CHECK(it != entries_.end(), "no policy named '{}'", name);
    return it->second;
  }
  static std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const auto& [name, entry] : instance().entries_) out.emplace_back(name);
    return out;
  }

 private:
  Registry() {
    policy_lists().push_back([] {
      std::vector<PolicyInfo> out;
      for (const auto& [name, entry] : instance().entries_)
        out.push_back({Interface::kKind, std::string(name), std::string(entry.doc)});
      return out;
    });
  }
  std::map<std::string_view, Entry> entries_;
};

template <class Interface>
std::unique_ptr<Interface> PolicyChoice<Interface>::make(typename Interface::Context context) const {
  return maker ? maker(context) : Registry<Interface>::instance().entry(name).make_default(context);
}

template <class Interface>
bool PolicyChoice<Interface>::is_in_interval_model() const {
  return Registry<Interface>::instance().entry(name).is_in_interval_model;
}

template <class Impl>
concept InIntervalModel = requires {
  requires Impl::kInIntervalModel;
};

template <class Interface, class Impl>
struct Register {
  using Params = typename Impl::Params;
  Register() {
    Registry<Interface>::instance().add(
        Impl::kName,
        {Impl::kDoc,
         [](ConfigTable& table, PolicyChoice<Interface>& choice) {
           Params params;
           read_params(table, params);
           choice.params = describe_params(params);
           choice.maker = [params](typename Interface::Context context) -> std::unique_ptr<Interface> {
             return std::make_unique<Impl>(params, context);
           };
         },
         [] { return describe_params(Params{}); },
         [](typename Interface::Context context) -> std::unique_ptr<Interface> {
           return std::make_unique<Impl>(Params{}, context);
         },
         InIntervalModel<Impl>});
  }
};

// Declares the key of a policy: `name = "gto"` chooses the policy, and the table `[<section>.gto]` holds its
// parameters.
template <class Owner, class Interface>
struct PolicyParam {
  PolicyChoice<Interface> Owner::*field;
  std::string_view name, doc;
};
template <class Owner, class Interface>
constexpr PolicyParam<Owner, Interface> policy(PolicyChoice<Interface> Owner::*field, std::string_view name,
                                               std::string_view doc) {
  return {field, name, doc};
}

template <class Owner, class Interface>
void read_param(ConfigTable& table, Owner& out, const PolicyParam<Owner, Interface>& p) {
  PolicyChoice<Interface>& choice = out.*p.field;
  PolicyChoice<Interface> chosen(table.take_name(p.name, choice.name, Registry<Interface>::names()).c_str());
  for (const auto& [name, entry] : Registry<Interface>::instance().entries()) {
    // The tables of policies that are not chosen are checked too.
    ConfigTable params = table.take_table(name);
    PolicyChoice<Interface> read("");
    entry.read(params, read);
    if (name == chosen.name) {
      chosen.maker = read.maker;
      chosen.params = read.params;
    } else {
      chosen.others.emplace(name, read.params);
    }
  }
  choice = chosen;
}

template <class Owner, class Interface>
void describe_param(std::vector<ParamInfo>& out, const std::string& prefix, const Owner& o,
                    const PolicyParam<Owner, Interface>& p) {
  const PolicyChoice<Interface>& choice = o.*p.field;
  std::string range;
  for (const std::string& name : Registry<Interface>::names()) range += (range.empty() ? "" : ", ") + name;
  out.push_back({prefix + std::string(p.name), "", std::string(p.doc), config_text(choice.name), range});
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
    add(name, params, prefix + std::string(p.name) + " = " + config_text(name));
}

}  // namespace glint
