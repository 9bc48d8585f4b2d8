// Maps names to factories of policies. Static objects in the implementation files fill the map.
//
// An implementation file registers itself with `const Register<RayScheduler, OldestFirst> registered;` at its
// end. The class has kName, kDoc, Params (base/params.h) and a constructor (Params, Interface::Context). The
// interface has a type Context, which its constructor's caller fills, and a PolicyKind kKind.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"

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

// Returns every registered policy of all interfaces, ordered by folder and name.
std::vector<PolicyInfo> all_policies();

// Holds "folder: name" of every policy whose name was taken; main() and the loader of plugins report it.
// Static objects fill the list, so it lives in a function.
std::vector<std::string>& registered_twice();

// Holds what a configuration says of a policy, whatever the interface.
struct AnyPolicyChoice {
  std::string name;
  std::vector<ParamInfo> params;                         // parameters of the policy, as read
  std::map<std::string, std::vector<ParamInfo>> others;  // parameters of the policies not chosen
};

// Holds a policy chosen by a configuration: its name, and a function that makes it with the parameters that
// were read.
template <class Interface>
struct PolicyChoice : AnyPolicyChoice {
  using Make = std::function<std::unique_ptr<Interface>(typename Interface::Context)>;
  Make maker;  // empty: the policy is made with its default parameters

  // The constructor is implicit, so that a default value is written as a name.
  PolicyChoice(const char* default_name) { name = default_name; }  // NOLINT
  std::unique_ptr<Interface> make(typename Interface::Context context) const;
  // Returns true when the policy declares `static constexpr bool kInIntervalModel = true`: the interval model
  // (pipeline/interval) computes what this policy does.
  bool is_in_interval_model() const;
};

// Holds what every policy has, whatever the interface.
struct PolicyEntry {
  std::string_view doc;
  // Reads the policy's parameters from its table and returns them. A `choice` that is not null gets the
  // maker, too; it is a PolicyChoice of the interface.
  std::vector<ParamInfo> (*read)(ConfigTable&, AnyPolicyChoice* choice);
  bool is_in_interval_model;
};

// Maps the names of one interface's policies to their entries, which their registrations own.
class PolicyRegistry {
 public:
  explicit PolicyRegistry(const PolicyKind& kind);
  PolicyRegistry(const PolicyRegistry&) = delete;
  PolicyRegistry& operator=(const PolicyRegistry&) = delete;

  // A name that is taken keeps its first policy, and the second goes to registered_twice(): a static object
  // has nobody to throw to.
  void add(std::string_view name, const PolicyEntry& entry);
  const PolicyEntry& at(std::string_view name) const;  // an unknown name is a bug in Glint
  std::vector<std::string> list() const;               // the names, sorted

  // Reads the key that chooses a policy, and the tables of all policies: those that are not chosen are
  // checked too.
  void read(ConfigTable& table, std::string_view key, AnyPolicyChoice& choice) const;

 private:
  const PolicyKind kind_;
  std::map<std::string_view, const PolicyEntry*> entries_;
};

// Returns the registry of an interface that has at least one policy.
const PolicyRegistry& registry_of(const PolicyKind& kind);

// Gives PolicyRegistry the types of one interface.
template <class Interface>
class Registry {
 public:
  struct Entry : PolicyEntry {
    std::unique_ptr<Interface> (*make_default)(typename Interface::Context);
  };
  // The object is local to the function, so it exists before the first static object registers a policy.
  static Registry& instance() {
    static Registry registry;
    return registry;
  }
  void add(std::string_view name, const Entry& entry) { policies_.add(name, entry); }
  const Entry& entry(std::string_view name) const { return static_cast<const Entry&>(policies_.at(name)); }
  static std::vector<std::string> names() { return instance().policies_.list(); }

 private:
  PolicyRegistry policies_{Interface::kKind};
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
class Register {
 public:
  Register() { Registry<Interface>::instance().add(Impl::kName, entry_); }
  Register(const Register&) = delete;
  Register& operator=(const Register&) = delete;

 private:
  using Params = typename Impl::Params;
  using Context = typename Interface::Context;

  static std::vector<ParamInfo> read(ConfigTable& table, AnyPolicyChoice* choice) {
    Params params;
    read_params(table, params);
    if (choice)
      static_cast<PolicyChoice<Interface>*>(choice)->maker =
          [params](Context context) -> std::unique_ptr<Interface> {
        return std::make_unique<Impl>(params, context);
      };
    return describe_params(params);
  }
  static std::unique_ptr<Interface> make_default(Context context) {
    return std::make_unique<Impl>(Params{}, context);
  }

  typename Registry<Interface>::Entry entry_{{Impl::kDoc, &read, InIntervalModel<Impl>}, &make_default};
};

// Declares the key of a policy: `name = "gto"` chooses the policy, and the table `[<section>.gto]` holds its
// parameters.
template <class Owner, class Interface>
ParamRow policy(PolicyChoice<Interface> Owner::*field, std::string_view name, std::string_view doc) {
  ParamRow row{name, "", doc, FieldType::Policy, offset_of(field)};
  row.kind = &Interface::kKind;
  row.choice_of = [](void* choice) -> AnyPolicyChoice& {
    return *static_cast<PolicyChoice<Interface>*>(choice);
  };
  return row;
}

// Describes the parameters of the policy that `choice` names under `key`, then those of the others.
std::vector<ParamInfo> describe_choice(const AnyPolicyChoice& choice, const std::string& prefix,
                                       std::string_view key);

}  // namespace glint
