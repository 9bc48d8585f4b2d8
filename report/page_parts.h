// What every page that Glint writes is put together with: escaping, embedded data, places in a frame.
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

// A number, text or truth value for a table: thin spaces between thousands, whole from 1000 on, four digits below; a dash for null.
std::string shown(const nlohmann::ordered_json& value);

// JSON for a <script> element: no "</script>" and no "<!--" can be in it.
std::string script_json(const nlohmann::ordered_json& data);

// Puts `text` where the frame says `mark`, the first time. UserError when it does not.
void place(std::string& page, std::string_view mark, const std::string& text);

}  // namespace glint::report
