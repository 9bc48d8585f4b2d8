// Says which headers a program or a plugin was compiled against. cmake/plugin_stamp.cmake writes the
// definition.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace glint {

// The stamp begins with this text, so that it can be found in a file that must not be loaded yet.
inline constexpr std::string_view kPluginStampPrefix = "glint-plugin-stamp:";

}  // namespace glint

// Holds the prefix, the version and a hash of all public headers.
extern "C" const char glint_plugin_stamp[];
