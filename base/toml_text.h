// Parses TOML, and says at which place of a file a mistake is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

namespace glint {

// Parses a text. `name` stands for its file in messages. Throws UserError with line and column.
toml::table toml_of_text(const std::string& text, const std::string& name);

// Parses a file. Throws UserError as above, and when the file cannot be read.
toml::table toml_of_file(const std::string& path);

}  // namespace glint
