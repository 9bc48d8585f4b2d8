// Makes the images of a launch file of kernels, which its arguments name as textures and surfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "exec/image_view.h"
#include "memsys/address_space.h"
#include "pipeline/description/description.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Reads the [[image]] tables of a launch file. Throws UserError that lists every mistake with its place.
std::vector<pipeline::KernelImage> read_kernel_images(const std::string& path);

// Makes the texels of the images, puts them into `memory`, and returns the images in the same order. A handle
// is the number of an image there.
std::vector<exec::ImageView> place_images(const std::vector<pipeline::KernelImage>& images,
                                          mem::AddressSpace& memory, uint32_t threads);

// Writes the images that are to be saved into the run directory, and returns lines on them.
std::vector<std::string> keep_images(const std::vector<pipeline::KernelImage>& images,
                                     const std::vector<exec::ImageView>& views,
                                     const mem::AddressSpace& memory, const report::RunDirectory& directory,
                                     uint32_t threads);

}  // namespace glint::app
