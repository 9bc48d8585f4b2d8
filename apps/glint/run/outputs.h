// What a run keeps of buffers and images: pictures, arrays, tables, raw bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "exec/image_view.h"

namespace glint::app {

// Bytes of the file, by its ending: .npy (one dimension of `type`), .csv (a number a line), anything else as
// they are.
std::string buffer_file(const std::string& file, const std::string& type, std::span<const std::byte> bytes);

// .png and .pfm (level 0, layers and slices one below the other), .npy (float: rows, columns, 4), .csv (a row
// a texel), else raw.
std::string image_file(const std::string& file, const exec::ImageView& view,
                       std::span<const std::byte> bytes);

// "" or what is wrong with the file's name.
std::string wrong_with_output(const std::string& file, bool is_image);

// "0.5 1 1.5": the first numbers.
std::string first_numbers(const std::string& type, std::span<const std::byte> bytes, size_t count);

}  // namespace glint::app
