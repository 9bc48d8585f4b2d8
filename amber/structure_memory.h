// Builds the acceleration structures of a script in simulated memory, each at its first use.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "amber/script.h"
#include "memsys/address_space.h"

namespace glint::amber {

// No command of the language changes a structure, so one that is built serves all launches of its script.
class StructureMemory {
 public:
  StructureMemory(const Script& script, mem::AddressSpace& memory, const rt::BuildOptions& options)
      : script_(script), memory_(memory), options_(options) {}

  // Returns the top level with this name. Throws as rt::build_top() does.
  const rt::StructureInfo& top_level(const std::string& name);

 private:
  const rt::StructureInfo& bottom_level(const std::string& name);

  const Script& script_;
  mem::AddressSpace& memory_;
  const rt::BuildOptions& options_;
  std::map<std::string, rt::StructureInfo> top_levels_, bottom_levels_;  // by name
};

}  // namespace glint::amber
