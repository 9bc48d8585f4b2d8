// Looks up what a glTF file names by number, and says which number names nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace glint::scenes {

// Returns element `index` of one of the file's lists. Throws UserError at `path` when the list has no such
// element; `kind` is the element's name in the singular.
template <class T>
const T& named(const std::vector<T>& list, int index, const char* kind, const std::string& path) {
  if (index < 0 || size_t(index) >= list.size())
    throw UserError({path}, fmt::format("it names {} {}, and it has {}", kind, index, list.size()),
                    "numbers count from 0; the file may be damaged, so export it again");
  return list[size_t(index)];
}

// Returns how messages name an element: by its number, and by its name where the file gives one.
inline std::string name_of(const std::string& name, int index) {
  return name.empty() ? fmt::format("{}", index) : fmt::format("{} ('{}')", index, name);
}

}  // namespace glint::scenes
