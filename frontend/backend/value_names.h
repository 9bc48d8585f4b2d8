// Gives each value of a run of instructions a name of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// A register that a run writes several times, or reads and then writes, holds several values. Each unguarded
// write begins a new one. A name below `registers` is that register's value in front of the run.
class ValueNames {
 public:
  ValueNames(const std::vector<VirtualInst>& run, size_t registers);

  const std::vector<VirtualInst>& code() const { return code_; }  // the run, with names for registers
  size_t size() const { return registers_ + written_.size(); }    // all names are smaller
  VirtualRegister last(VirtualRegister r) const;  // name of the register's value behind the run
  VirtualRegister register_of(VirtualRegister name) const {
    return name < registers_ ? name : written_[name - registers_];
  }

 private:
  using Names = std::vector<std::pair<VirtualRegister, VirtualRegister>>;  // register, name; sorted

  std::vector<VirtualInst> code_;
  const size_t registers_;
  std::vector<VirtualRegister> written_;  // register of each new name
  Names names_;
};

}  // namespace glint::frontend
