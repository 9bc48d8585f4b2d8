// Finds node formats by their names and by what a structure's header says.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/registry.h"
#include "rtunit/node_format.h"

namespace glint::rt {
namespace {

struct Known {
  FormatId id;
  std::string name;
  std::unique_ptr<NodeFormat> format;
};

std::vector<Known> all_formats() {
  std::vector<Known> out;
  for (const std::string& name : Registry<NodeFormat>::names()) {
    auto format = make_format(name);
    const FormatId id = format->walk().format;
    for (const Known& other : out)
      if (other.id == id)
        throw UserError(
            fmt::format("the node formats '{}' and '{}' have the same number {:#x} in headers of "
                        "structures; give one of them another name",
                        other.name, name, id));
    out.push_back({id, name, std::move(format)});
  }
  return out;
}

}  // namespace

std::unique_ptr<NodeFormat> make_format(std::string_view name) {
  return Registry<NodeFormat>::instance().entry(name).make_default({});
}

const NodeFormat* find_format(FormatId id) {
  static const std::vector<Known> known = all_formats();
  for (const Known& one : known)
    if (one.id == id) return one.format.get();
  return nullptr;
}

}  // namespace glint::rt
