// Asks an X server for the sizes of windows, over the libraries that the application has loaded.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "vulkan/handles.h"

namespace glint::vulkan {

// Returns the size of a window. Throws Refusal when there is no such window.
VkExtent2D size_of_window(xcb_connection_t* connection, xcb_window_t window);
// Returns whether the library is there with which sizes of windows are asked for.
bool can_ask_for_sizes();
// Returns what stands behind a connection of Xlib, or null where the library for it is not installed.
xcb_connection_t* connection_of(Display* display);

}  // namespace glint::vulkan
