// Computes the colour and the feature pipeline of LDR-FLIP. Section numbers are of Andersson et al. 2020.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

using Color = std::array<double, 3>;
using Matrix = std::array<Color, 3>;
using Plane = std::vector<double>;

struct Size {
  ptrdiff_t width = 0, height = 0;
};

// Converts linear sRGB to XYZ and back. Primaries and white point D65 are those of IEC 61966-2-1, scaled so
// that white has Y = 1.
class Xyz {
 public:
  Xyz() {
    constexpr double kChromaticity[4][2] = {
        {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};  // red, green, blue, white
    std::array<Color, 4> at{};
    for (size_t i = 0; i < 4; ++i)
      at[i] = {kChromaticity[i][0] / kChromaticity[i][1], 1.0,
               (1 - kChromaticity[i][0] - kChromaticity[i][1]) / kChromaticity[i][1]};
    white_ = at[3];
    for (size_t row = 0; row < 3; ++row)
      for (size_t i = 0; i < 3; ++i) to_[row][i] = at[i][row];
    const Color share = times(inverse(to_), white_);
    for (Color& row : to_)
      for (size_t i = 0; i < 3; ++i) row[i] *= share[i];
    from_ = inverse(to_);
  }
  // Returns XYZ relative to white.
  Color of(const Color& rgb) const {
    Color xyz = times(to_, rgb);
    for (size_t i = 0; i < 3; ++i) xyz[i] /= white_[i];
    return xyz;
  }
  Color rgb(Color xyz) const {
    for (size_t i = 0; i < 3; ++i) xyz[i] *= white_[i];
    return times(from_, xyz);
  }

 private:
  static Color times(const Matrix& m, const Color& v) {
    Color out{};
    for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
  }
  // Returns the inverse by cofactors.
  static Matrix inverse(const Matrix& m) {
    Matrix out{};
    double determinant = 0;
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) {
        const size_t r = (j + 1) % 3, s = (j + 2) % 3, p = (i + 1) % 3, q = (i + 2) % 3;
        out[i][j] = m[r][p] * m[s][q] - m[r][q] * m[s][p];
        if (i == 0) determinant += m[j][0] * out[i][j];
      }
    for (Color& row : out)
      for (double& value : row) value /= determinant;
    return out;
  }
  Matrix to_{}, from_{};
  Color white_{};
};

double linear(float value) {
  const double v = std::isfinite(value) ? std::clamp(double(value), 0.0, 1.0) : 0.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
}

// Converts to YyCxCz, which is linear in XYZ (sec. 4.1.1).
Color opponent(const Color& xyz) {
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}
Color xyz_of_opponent(const Color& c) {
  const double y = (c[0] + 16) / 116;
  return {y + c[1] / 500, y, y - c[2] / 200};
}

// Converts by CIE 15, 8.2.1, with a and b fading as colours get darker (Hunt's effect, sec. 4.1.2).
Color hunt_lab(const Color& xyz) {
  constexpr double kDelta = 6.0 / 29;
  const auto f = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double lightness = 116 * f(xyz[1]) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(xyz[0]) - f(xyz[1])),
          0.01 * lightness * 200 * (f(xyz[1]) - f(xyz[2]))};
}

// Returns the distance of Abasi et al. 2020: city block in lightness, Euclidean in colour.
double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// Returns the weights of one direction, around the middle.
Plane weights(ptrdiff_t radius, const auto& weight) {
  Plane out;
  for (ptrdiff_t i = -radius; i <= radius; ++i) out.push_back(weight(double(i)));
  return out;
}
double sum(const Plane& values) {
  double out = 0;
  for (const double v : values) out += v;
  return out;
}

// Filters rows with `across`, then columns with `down`. Edges repeat.
Plane filtered(const Plane& in, Size size, const Plane& across, const Plane& down) {
  Plane rows(in.size()), out(in.size());
  const ptrdiff_t ra = ptrdiff_t(across.size() / 2), rd = ptrdiff_t(down.size() / 2);
  for (ptrdiff_t y = 0; y < size.height; ++y)
    for (ptrdiff_t x = 0; x < size.width; ++x)
      for (ptrdiff_t k = -ra; k <= ra; ++k)
        rows[size_t(y * size.width + x)] +=
            across[size_t(k + ra)] *
            in[size_t(y * size.width + std::clamp<ptrdiff_t>(x + k, 0, size.width - 1))];
  for (ptrdiff_t y = 0; y < size.height; ++y)
    for (ptrdiff_t k = -rd; k <= rd; ++k) {
      const double* from = &rows[size_t(std::clamp<ptrdiff_t>(y + k, 0, size.height - 1) * size.width)];
      for (ptrdiff_t x = 0; x < size.width; ++x)
        out[size_t(y * size.width + x)] += down[size_t(k + rd)] * from[x];
    }
  return out;
}

// Holds the contrast sensitivity of a channel as a sum of Gaussians (sec. 4.1.1, Table 1): a of each, and b
// in square degrees.
struct Sensitivity {
  double a[2], b[2];
};
constexpr Sensitivity kSensitivity[3] = {
    {{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};
constexpr double kWidest = 0.04;

Plane as_seen(const Plane& plane, Size size, const Sensitivity& s, double ppd) {
  using std::numbers::pi;
  const ptrdiff_t radius = ptrdiff_t(std::ceil(3 * std::sqrt(kWidest / (2 * pi * pi)) * ppd));
  Plane out(plane.size());
  double whole = 0;
  for (int i = 0; i < 2; ++i) {
    if (s.a[i] == 0) continue;
    const Plane line =
        weights(radius, [&](double x) { return std::exp(-pi * pi * x * x / (ppd * ppd * s.b[i])); });
    const double height = s.a[i] * std::sqrt(pi / s.b[i]);
    const Plane part = filtered(plane, size, line, line);
    for (size_t p = 0; p < out.size(); ++p) out[p] += height * part[p];
    whole += height * sum(line) * sum(line);
  }
  for (double& value : out) value /= whole;
  return out;
}

// Holds a picture as both pipelines want it.
struct Seen {
  std::vector<Color> lab;  // filtered, with Hunt's effect
  Plane grey;              // luminance, 0..1, not filtered
};

Seen see(const Picture& picture, Size size, const Xyz& xyz, double ppd) {
  const size_t pixels = picture.rgb.size() / 3;
  std::array<Plane, 3> channel;
  Seen out;
  for (size_t p = 0; p < pixels; ++p) {
    const float* rgb = &picture.rgb[3 * p];
    const Color c = opponent(xyz.of({linear(rgb[0]), linear(rgb[1]), linear(rgb[2])}));
    for (size_t i = 0; i < 3; ++i) channel[i].push_back(c[i]);
    out.grey.push_back((c[0] + 16) / 116);
  }
  for (size_t i = 0; i < 3; ++i) channel[i] = as_seen(channel[i], size, kSensitivity[i], ppd);
  for (size_t p = 0; p < pixels; ++p) {
    Color rgb = xyz.rgb(xyz_of_opponent({channel[0][p], channel[1][p], channel[2][p]}));
    for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
    out.lab.push_back(hunt_lab(xyz.of(rgb)));
  }
  return out;
}

constexpr double kColorExponent = 0.7, kKnee = 0.4, kKneeValue = 0.95;  // q_c, p_c, p_t (sec. 4.1.3)

// Returns the distance as 0 to 1. Small distances stay nearly linear, and large ones are squeezed above the
// knee.
double color_error(const Color& a, const Color& b, double largest) {
  const double distance = std::pow(hyab(a, b), kColorExponent), knee = kKnee * largest;
  return distance < knee ? kKneeValue * distance / knee
                         : kKneeValue + (1 - kKneeValue) * (distance - knee) / (largest - knee);
}

// Scales values so that the positive weights add up to 1 and the negative ones to -1.
Plane balanced(Plane values) {
  double above = 0, below = 0;
  for (const double v : values) (v > 0 ? above : below) += std::abs(v);
  for (double& v : values) v /= v > 0 ? above : below > 0 ? below : 1;
  return values;
}

// Holds the strength of edges and of points: first and second derivatives of a Gaussian that is as wide as a
// pixel's detail (sec. 4.2).
struct Features {
  Plane edges, points;
};
constexpr double kFeatureWidth = 0.082;  // degrees

Features features(const Plane& grey, Size size, double ppd) {
  const double sigma = 0.5 * kFeatureWidth * ppd;
  const ptrdiff_t radius = ptrdiff_t(std::ceil(3 * sigma));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  Plane smooth = weights(radius, gauss);
  const double whole = sum(smooth);
  for (double& v : smooth) v /= whole;
  const auto strength = [&](const Plane& slope) {
    Plane x = filtered(grey, size, slope, smooth);
    const Plane y = filtered(grey, size, smooth, slope);
    for (size_t p = 0; p < x.size(); ++p) x[p] = std::hypot(x[p], y[p]);
    return x;
  };
  return {strength(balanced(weights(radius, [&](double x) { return -x * gauss(x); }))),
          strength(
              balanced(weights(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gauss(x); })))};
}

void check(const Picture& a, const Picture& b, double ppd) {
  if (a.width != b.width || a.height != b.height)
    throw UserError({}, fmt::format("pictures of {}x{} and {}x{} pixels cannot be compared", a.width,
                                    a.height, b.width, b.height));
  if (!(ppd >= 1 && ppd <= 1000))
    throw UserError({}, fmt::format("{} pixels per degree are out of range: expected 1 to 1000", ppd),
                    fmt::format("{} is usual", kPixelsPerDegree));
}

}  // namespace

Flip flip(const Picture& a, const Picture& b, double ppd) {
  check(a, b, ppd);
  const Xyz xyz;
  const Size size{ptrdiff_t(a.width), ptrdiff_t(a.height)};
  const Seen x = see(a, size, xyz, ppd), y = see(b, size, xyz, ppd);
  const Features fx = features(x.grey, size, ppd), fy = features(y.grey, size, ppd);
  // These two colours are the furthest apart: green and blue.
  const double largest =
      std::pow(hyab(hunt_lab(xyz.of({0, 1, 0})), hunt_lab(xyz.of({0, 0, 1}))), kColorExponent);
  Flip out;
  double all = 0;
  bool is_measured = true;
  for (size_t p = 0; p < x.lab.size(); ++p) {
    const double apart = std::max(std::abs(fx.edges[p] - fy.edges[p]), std::abs(fx.points[p] - fy.points[p]));
    const double feature_error = std::min(1.0, std::sqrt(apart / std::numbers::sqrt2));
    const bool is_beyond = is_beyond_measure(a, b, p);
    const double error =
        is_beyond ? 1.0 : std::pow(color_error(x.lab[p], y.lab[p], largest), 1 - feature_error);
    is_measured &= !is_beyond;
    out.map.push_back(float(error));
    all += error;
  }
  out.mean = !is_measured      ? std::numeric_limits<double>::quiet_NaN()
             : out.map.empty() ? 0
                               : all / double(out.map.size());
  return out;
}

Picture flip_picture(const Picture& a, const Flip& flip) {
  // The ramp grows evenly lighter. Its six points are of the colour map "magma" of van der Walt and Smith
  // 2015.
  constexpr float kRamp[6][3] = {{0.00f, 0.00f, 0.02f}, {0.23f, 0.06f, 0.44f}, {0.55f, 0.16f, 0.51f},
                                 {0.87f, 0.29f, 0.41f}, {1.00f, 0.62f, 0.43f}, {0.99f, 0.99f, 0.75f}};
  Picture out{a.width, a.height, std::vector<float>(flip.map.size() * 3)};
  for (size_t p = 0; p < flip.map.size(); ++p) {
    const float at = std::clamp(flip.map[p], 0.0f, 1.0f) * 5;
    const int below = std::min(int(at), 4);
    for (int c = 0; c < 3; ++c)
      out.rgb[3 * p + size_t(c)] =
          kRamp[below][c] + (at - float(below)) * (kRamp[below + 1][c] - kRamp[below][c]);
  }
  return out;
}

}  // namespace glint::report
