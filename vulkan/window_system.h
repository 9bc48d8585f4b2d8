// Declares what the commands of X windows name, so that the driver needs no headers of X.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vulkan/vk_icd.h>

// These are the names and types of xcb and Xlib, in the same words as their own headers have them.
struct xcb_connection_t;
using xcb_window_t = uint32_t;
using xcb_visualid_t = uint32_t;
struct _XDisplay;
using Display = _XDisplay;
using Window = unsigned long;
using VisualID = unsigned long;

#include <vulkan/vulkan_xcb.h>
#include <vulkan/vulkan_xlib.h>
