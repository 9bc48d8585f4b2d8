// Computes FLIP: how different two pictures look to a person who flips between them, pixel by pixel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "report/picture/image_compare.h"

namespace glint::report {

// These are the pixels per degree for an observer 0.70 m away from a screen 0.70 m wide with 3840 pixels
// (Andersson et al. 2020, sec. 5).
inline constexpr double kPixelsPerDegree = 67;

struct Flip {
  double mean = 0;         // over pixels; not a number when a pixel is beyond measure (image_compare.h)
  std::vector<float> map;  // one per pixel, row 0 on top; 0: looks the same, 1: as different as can be
};

// Computes LDR-FLIP of Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "FLIP: A
// Difference Evaluator for Alternating Images". Values are sRGB, clamped to 0 to 1. Values that are not
// finite count as 0, and the map is 1 where pixels are beyond measure. Beyond its edges a picture continues
// as its edge. Throws UserError unless the pictures have one size and `pixels_per_degree` lies between 1 and
// 1000.
Flip flip(const Picture& a, const Picture& b, double pixels_per_degree = kPixelsPerDegree);

// Returns the map as colours from black over purple and orange to white, with three floats per pixel.
Picture flip_picture(const Picture& a, const Flip& flip);

}  // namespace glint::report
