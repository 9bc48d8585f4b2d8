// Puts together what every page needs: escaping, packed parts, places in a frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace glint::report {

// Returns a text as HTML shows it, also between quotes.
std::string escaped(std::string_view text);

// Returns the text that an object has under a key, as HTML shows it.
std::string escaped_text(const nlohmann::ordered_json& object, const char* key);

// Returns the text of a description, in which words between backquotes become code.
std::string prose(std::string_view text);

// Returns a number, text or truth value for a table. Numbers have thin spaces between thousands, no fraction
// from 1000 on, and four digits below; null is a dash.
std::string shown(const nlohmann::ordered_json& value);

// Returns a <script> of that id that no browser runs: `text` as base64 of a zlib stream. The page's own
// script unpacks it (web/src/packed.js).
std::string packed_element(std::string_view id, std::string_view text);

// Puts `text` at the first `mark` of the frame. Throws UserError when the frame has none.
void place(std::string& page, std::string_view mark, const std::string& text);

}  // namespace glint::report
