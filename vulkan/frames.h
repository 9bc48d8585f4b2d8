// Counts the frames that an application presents, and makes pictures of those that the user wants.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "setup/launch_selection.h"
#include "vulkan/handles.h"

namespace glint::vulkan {

// Says which frames are written as pictures.
class PictureChoice {
 public:
  // Reads "all", "last", "none" or "frame 0,7-9"; an empty text is "last". Throws UserError that begins with
  // the variable's name and says what is wrong.
  static PictureChoice parse(const std::string& text, const std::string& variable);

  // Returns whether a frame gets a picture with its number.
  bool takes(uint64_t frame) const { return all_ || frames_.has(frame); }
  // Returns whether there is one picture, which the newest frame replaces.
  bool keeps_last() const { return last_; }

 private:
  bool all_ = false, last_ = false;
  setup::NumberList frames_;
};

// Shows images together, and so ends a frame.
void present(Device& device, const std::vector<VkImage>& images);

}  // namespace glint::vulkan
