// Makes the texels of a described image, from files or by rules, in its format and with its smaller levels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "exec/image_view.h"
#include "pipeline/description/description.h"

namespace glint::pipeline {

struct Picture {
  exec::ImageView view;  // the address is not set
  std::vector<std::byte> texels;
};

// Makes the texels of an image. `shape` and `texel` ("f32", "u32", "s32") are what the shader asks for.
// `fallback` is the size of an image without one. `declared` is the format that the shader declares, by its
// GLSL name; an image without a format and without files gets it. Throws UserError at the image's place for
// unreadable files, sizes that differ, and a format of another kind of number.
Picture make_picture(const ImageDescription& image, isa::ImageShape shape, const std::string& texel,
                     std::array<uint32_t, 3> fallback, const std::string& declared = {});

// Returns the channels of a level-0 image, four words per texel, layer after layer: bits of floats, or
// integers.
std::vector<uint32_t> texels_as_words(const exec::ImageView& view, const std::byte* data);

// Returns a level-0 image as it is saved to pictures: four floats per texel, layer after layer.
std::vector<float> texels_as_floats(const exec::ImageView& view, const std::byte* data);

}  // namespace glint::pipeline
