// Compresses bytes as PNG files hold them, on several threads.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace glint::pictures {

// Returns `bytes` as a zlib stream (RFC 1950), made on up to `threads` threads of the host. The stream is the
// same at any number of threads.
std::string zlib_stream(std::span<const uint8_t> bytes, uint32_t threads);

}  // namespace glint::pictures
