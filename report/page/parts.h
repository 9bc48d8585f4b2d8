// What every page that Glint writes is put together with: escaping, packed parts, places in a frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace glint::report {

// Text as HTML shows it, also between quotes.
std::string escaped(std::string_view text);

// Text of a description, in which words between backquotes are code.
std::string prose(std::string_view text);

// A number, text or truth value for a table: thin spaces between thousands, whole from 1000 on, four digits
// below; a dash for null.
std::string shown(const nlohmann::ordered_json& value);

// A <script> of that id that no browser runs: `text` as base64 of a zlib stream. The page's own script
// unpacks it (web/src/packed.js).
std::string packed_element(std::string_view id, std::string_view text);

// Puts `text` where the frame says `mark`, the first time. UserError when it does not.
void place(std::string& page, std::string_view mark, const std::string& text);

}  // namespace glint::report
