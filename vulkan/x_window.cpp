// Asks an X server for the sizes of windows, over the libraries that the application has loaded.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/x_window.h"

#include <cstdint>
#include <cstdlib>
#include <dlfcn.h>
#include <memory>

#include "vulkan/messages.h"

namespace glint::vulkan {
namespace {

// The protocol's answer to GetGeometry, as libxcb hands it out.
struct Geometry {
  uint8_t response_type, depth;
  uint16_t sequence;
  uint32_t length, root;
  int16_t x, y;
  uint16_t width, height, border_width;
  uint8_t unused[2];
};
static_assert(sizeof(Geometry) == 24);
struct Cookie {
  unsigned sequence;
};

// The driver does not depend on X: it takes the libraries that are there when a window is shown to it.
struct XLibraries {
  Cookie (*get_geometry)(xcb_connection_t*, xcb_window_t) = nullptr;
  Geometry* (*get_geometry_reply)(xcb_connection_t*, Cookie, void** error) = nullptr;
  xcb_connection_t* (*connection_of)(Display*) = nullptr;

  XLibraries() {
    find("libxcb.so.1", "xcb_get_geometry", get_geometry);
    find("libxcb.so.1", "xcb_get_geometry_reply", get_geometry_reply);
    find("libX11-xcb.so.1", "XGetXCBConnection", connection_of);
  }
  static const XLibraries& instance() {
    static const XLibraries all;
    return all;
  }

 private:
  template <class Function>
  static void find(const char* library, const char* name, Function& out) {
    if (void* const handle = dlopen(library, RTLD_NOW | RTLD_LOCAL))
      out = reinterpret_cast<Function>(dlsym(handle, name));
  }
};

struct Free {
  void operator()(void* bytes) const { std::free(bytes); }
};

}  // namespace

bool can_ask_for_sizes() {
  return XLibraries::instance().get_geometry && XLibraries::instance().get_geometry_reply;
}

xcb_connection_t* connection_of(Display* display) {
  const XLibraries& x = XLibraries::instance();
  return x.connection_of ? x.connection_of(display) : nullptr;
}

VkExtent2D size_of_window(xcb_connection_t* connection, xcb_window_t window) {
  const XLibraries& x = XLibraries::instance();
  void* error = nullptr;
  const std::unique_ptr<Geometry, Free> reply(
      x.get_geometry_reply(connection, x.get_geometry(connection, window), &error));
  const std::unique_ptr<void, Free> owned_error(error);
  if (!reply) throw Refusal(VK_ERROR_SURFACE_LOST_KHR, "the window of a surface is gone");
  return {reply->width, reply->height};
}

}  // namespace glint::vulkan
