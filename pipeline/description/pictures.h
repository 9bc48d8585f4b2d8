// Makes the texels of a described image, from files or by rules, in its format and with its smaller levels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "exec/image_view.h"
#include "pictures/decode.h"
#include "pipeline/description/description.h"

namespace glint::pipeline {

struct Picture {
  exec::ImageView view;  // the address is not set
  std::vector<std::byte> texels;
};

// Says what the shader declares of an image.
struct DeclaredImage {
  isa::ImageShape shape = isa::ImageShape::D2;
  std::string texel = {};   // "f32", "u32", "s32", or nothing
  std::string format = {};  // by its GLSL name; an image without a format and without files gets it
};

// Makes the texels of images on several threads, which do not show in them.
class PictureMaker {
 public:
  // Reads the files of `images` on up to `threads` threads of the host.
  PictureMaker(std::span<const ImageDescription> images, uint32_t threads);

  // Makes the texels of one of the images. `fallback` is the size of an image without one. Throws UserError
  // at the image's place for unreadable files, sizes that differ, and a format of another kind of number.
  Picture make(const ImageDescription& image, const DeclaredImage& declared,
               std::array<uint32_t, 3> fallback) const;

 private:
  const pictures::DecodedPicture& file_of(const std::string& path, const SourceLocation& where) const;
  const uint32_t threads_;
  std::map<std::string, pictures::DecodedPicture> files_;
};

// Returns the channels of a level-0 image, four words per texel, layer after layer: bits of floats, or
// integers.
std::vector<uint32_t> texels_as_words(const exec::ImageView& view, const std::byte* data);

// Returns a level-0 image as it is saved to pictures: four floats per texel, layer after layer.
std::vector<float> texels_as_floats(const exec::ImageView& view, const std::byte* data);

}  // namespace glint::pipeline
