// Numbers the messages that a program prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Returns the number of a message among `messages` (VirtualProgram::messages), to which it is added if it is
// not there.
inline uint64_t number_of_message(std::vector<std::string>& messages, const std::string& text) {
  const auto at = std::find(messages.begin(), messages.end(), text);
  const auto number = uint64_t(at - messages.begin());
  if (at == messages.end()) messages.push_back(text);
  return number;
}

}  // namespace glint::frontend
