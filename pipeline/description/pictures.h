// Texels of a described image: from files, or made up; converted to its format, with its smaller levels.
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
  exec::ImageView view;  // without address
  std::vector<std::byte> texels;
};

// `shape` and `texel` ("f32", "u32", "s32") are what the shader asks for; `fallback` is the size of an image
// without one. `declared` is the format that the shader declares, as GLSL names it: what an image without a
// format and without files has. UserError at the image's place: unreadable files, sizes that differ, a format
// of another kind of number.
Picture make_picture(const ImageDescription& image, isa::ImageShape shape, const std::string& texel,
                     std::array<uint32_t, 3> fallback, const std::string& declared = {});

// A level-0 image as floats, four a texel, layer after layer: what is saved as a picture.
std::vector<float> texels_as_floats(const exec::ImageView& view, const std::byte* data);

}  // namespace glint::pipeline
