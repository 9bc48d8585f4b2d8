// Finds which functions of a module a kernel needs, and which of them cannot become part of their caller.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "frontend/ptx/syntax.h"

namespace glint::frontend::ptx {

// Holds the functions that a kernel may call. Most of them are inlined. A function is called if it calls
// itself, by itself or through others, or if its address is taken: then its caller is not known.
class CallGraph {
 public:
  CallGraph(const Module& module, const Function& entry);

  // Returns the functions that are called and have code of their own, in the order of the module.
  const std::vector<const Function*>& called() const { return called_; }
  bool is_called(const Function& f) const;
  // Returns the kernel and all functions that it may reach, inlined or called.
  const std::set<const Function*>& reached() const { return reached_; }

  // Returns the number of a function, which is its address for programs: functions of a module are numbered
  // from 1, in the order of the text, so that all kernels of the module agree.
  uint32_t number_of(const std::string& function) const { return number_.at(function); }

 private:
  // Says what the body of a function names.
  struct Uses {
    std::set<const Function*> callees, addresses;
    bool calls_through_register = false;
  };
  void collect(const std::vector<Statement>& statements, Uses& uses) const;
  void find_addresses(const Module& module);
  void reach(const Function& f);
  bool reaches_itself(const Function& f) const;

  std::map<std::string, const Function*> functions_;
  std::map<std::string, uint32_t> number_;
  std::map<const Function*, Uses> uses_;
  std::set<const Function*> addresses_;  // whose addresses the module takes
  std::set<const Function*> reached_;
  std::vector<const Function*> called_;
};

}  // namespace glint::frontend::ptx
