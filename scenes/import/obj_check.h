// Finds what the OBJ library would read as something else: bad numbers and corners that name nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace glint::scenes {

// Throws UserError with the line of the first mistake in the text of an OBJ file. The library reads a
// coordinate that is no number as 0, counts at most 255 corners of a face, and does not look whether a corner
// names a vertex. `path` is for the message.
void check_obj(std::string_view text, const std::string& path);

}  // namespace glint::scenes
