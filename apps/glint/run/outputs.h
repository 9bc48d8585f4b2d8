// Encodes what a run keeps of buffers and images: pictures, arrays, tables, raw bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "exec/image_view.h"
#include "memsys/address_space.h"
#include "pipeline/description/description.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Returns the bytes of a buffer's file. The ending selects the format: .npy has one dimension of `type`, .csv
// has one number per line, and any other ending keeps the bytes unchanged.
std::string buffer_file(const std::string& file, const std::string& type, std::span<const std::byte> bytes);

// Returns the bytes of an image's file: .png, .pfm and .exr hold level 0 with layers and slices one below the
// other, .npy holds floats (rows, columns, 4), .csv has one row per texel, and any other ending keeps the raw
// bytes. Up to `threads` threads of the host encode .png and .pfm.
std::string image_file(const std::string& file, const exec::ImageView& view, std::span<const std::byte> bytes,
                       uint32_t threads = 1);

// Reports the files of a buffer or an image that cannot be written so.
void check_saves(const std::vector<pipeline::Save>& saves, bool is_image, Diagnostics& errors);

// Writes level 0 of an image to each of its files in the run directory. Returns lines for the summary.
std::vector<std::string> save_image(const pipeline::ImageDescription& image, const exec::ImageView& view,
                                    const mem::AddressSpace& memory, const report::RunDirectory& directory,
                                    uint32_t threads);

// Returns the first numbers as text: "0.5 1 1.5".
std::string first_numbers(const std::string& type, std::span<const std::byte> bytes, size_t count);

}  // namespace glint::app
