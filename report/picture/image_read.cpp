// Reads the pictures that runs leave, and others to compare them with, and encodes them to be seen.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "pictures/decode.h"
#include "pictures/encode.h"
#include "report/picture/image_compare.h"

namespace glint::report {

Picture read_picture(const std::string& path) {
  const pictures::DecodedPicture picture = pictures::decode_picture_file(path);
  if (!picture.error.empty())
    throw UserError({path}, fmt::format("cannot read the picture: {}", picture.error),
                    "expected a PFM, EXR, HDR, PNG or JPEG file");
  Picture out{picture.width, picture.height, std::vector<float>(size_t{picture.width} * picture.height * 3)};
  for (size_t i = 0; i < out.rgb.size(); ++i) {
    const size_t from = i / 3 * 4 + i % 3;
    out.rgb[i] = picture.floats.empty() ? float(picture.bytes[from]) / 255.0f : picture.floats[from];
  }
  return out;
}

std::string png_of(const Picture& picture) {
  std::vector<float> rgba(picture.rgb.size() / 3 * 4, 1.0f);
  for (size_t i = 0; i < picture.rgb.size(); ++i) rgba[i / 3 * 4 + i % 3] = picture.rgb[i];
  return pictures::png_bytes({picture.width, picture.height, rgba});
}

}  // namespace glint::report
