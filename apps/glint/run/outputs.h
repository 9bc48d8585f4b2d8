// Encodes what a run keeps of buffers and images: pictures, arrays, tables, raw bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exec/image_view.h"

namespace glint::app {

// Returns the bytes of a buffer's file. The ending selects the format: .npy has one dimension of `type`, .csv
// has one number per line, and any other ending keeps the bytes unchanged.
std::string buffer_file(const std::string& file, const std::string& type, std::span<const std::byte> bytes);

// Returns the bytes of an image's file: .png, .pfm and .exr hold level 0 with layers and slices one below the
// other, .npy holds floats (rows, columns, 4), .csv has one row per texel, and any other ending keeps the raw
// bytes. Up to `threads` threads of the host encode .png and .pfm.
std::string image_file(const std::string& file, const exec::ImageView& view, std::span<const std::byte> bytes,
                       uint32_t threads = 1);

// Returns what is wrong with the file's name, or "".
std::string wrong_with_output(const std::string& file, bool is_image);

// Returns the first numbers as text: "0.5 1 1.5".
std::string first_numbers(const std::string& type, std::span<const std::byte> bytes, size_t count);

}  // namespace glint::app
