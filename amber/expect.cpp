// Compares buffers with values, with colours and with each other.
// SPDX-License-Identifier: Apache-2.0
#include "amber/expect.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <utility>

namespace glint::amber {
namespace {

// Two floats are equal when they differ by at most this many percent, as in Amber's verifier. For a 32-bit
// float this is about one and a half units in the last place.
constexpr double kEqualPercent = 0.000009;

bool is_near(double found, double expected, double tolerance, bool is_percent) {
  if (found == expected || (std::isnan(found) && std::isnan(expected))) return true;
  return std::abs(found - expected) <= (is_percent ? tolerance / 100 * std::abs(expected) : tolerance);
}

const char* sign_of(Comparator comparator) {
  constexpr const char* kSigns[] = {"==", "!=", "<", "<=", ">", ">="};
  static_assert(std::size(kSigns) == size_t(Comparator::Rgb));
  return kSigns[size_t(comparator)];
}

bool holds(Comparator comparator, bool is_equal, bool is_less) {
  switch (comparator) {
    case Comparator::Eq:
      return is_equal;
    case Comparator::Ne:
      return !is_equal;
    case Comparator::Lt:
      return is_less;
    case Comparator::Le:
      return is_less || is_equal;
    case Comparator::Gt:
      return !is_less && !is_equal;
    default:
      return !is_less || is_equal;
  }
}

class Check {
 public:
  Check(const Script& script, const Command& command)
      : expect_(command.expect),
        where_(command.where),
        buffer_(script.buffers.at(expect_.buffer)),
        other_(expect_.other.empty() ? nullptr : &script.buffers.at(expect_.other)) {}

  std::string run() const {
    switch (expect_.comparator) {
      case Comparator::Rgb:
      case Comparator::Rgba:
        return colours();
      case Comparator::Buffer:
        return same();
      case Comparator::Rmse:
        return root_mean_square();
      case Comparator::Histogram:
        return histograms();
      default:
        return values();
    }
  }

 private:
  [[noreturn]] void wrong(const std::string& what) const { throw UserError(where_, what); }

  // Returns the index of the slot that begins at byte `offset` of an element, or 0 when none begins there.
  size_t slot_at(uint64_t offset) const {
    const auto& slots = buffer_.layout.slots;
    for (size_t i = 0; i < slots.size(); ++i)
      if (slots[i].offset == offset) return i;
    return 0;
  }

  std::string values() const {
    const Layout& layout = expect_.as ? *expect_.as : buffer_.layout;
    uint64_t element = expect_.as ? expect_.x : expect_.x / layout.stride * layout.stride;
    size_t slot = expect_.as ? 0 : slot_at(expect_.x - element);
    // The distance from the slot is not 0 for values that lie across slots or elements.
    const uint64_t shift = expect_.x - element - layout.slots[slot].offset;
    for (size_t i = 0; i < expect_.values.size(); ++i) {
      const Slot& at = layout.slots[slot];
      const uint64_t offset = element + shift + at.offset;
      if (offset + bytes_of(at.scalar) > buffer_.bytes.size())
        wrong(fmt::format("byte {} is past the end of buffer '{}' ({} bytes)", offset, buffer_.name,
                          buffer_.bytes.size()));
      if (!is_as_expected(at.scalar, buffer_.bytes.data() + offset, expect_.values[i], slot % 4))
        return fmt::format("buffer '{}' at byte {} (value {}): expected {} {}{}, found {}", buffer_.name,
                           offset, i, sign_of(expect_.comparator), expect_.values[i],
                           expect_.tolerances.empty() ? "" : " within the tolerance",
                           show(at.scalar, buffer_.bytes.data() + offset));
      if (++slot == layout.slots.size()) slot = 0, element += layout.stride;
    }
    return {};
  }

  bool is_as_expected(Scalar scalar, const std::byte* at, const std::string& text, size_t component) const {
    double real = 0;
    parse_real(text, real);
    const double found = get_real(scalar, at);
    if (!expect_.tolerances.empty()) {
      const auto [tolerance, is_percent] = tolerance_of(component);
      return holds(expect_.comparator, is_near(found, real, tolerance, is_percent), found < real);
    }
    if (is_float(scalar)) {
      std::byte rounded[8]{};
      put_real(scalar, real, rounded);
      const bool is_equal = is_near(found, real, kEqualPercent, true) || found == get_real(scalar, rounded);
      if (std::isnan(found) != std::isnan(real)) return expect_.comparator == Comparator::Ne;
      return holds(expect_.comparator, is_equal, found < real);
    }
    std::byte bytes[8]{};
    if (!put(scalar, text, bytes)) wrong(fmt::format("'{}' is not an integer", text));
    const uint64_t a = get_bits(scalar, at), b = get_bits(scalar, bytes);
    const bool is_unsigned = scalar == Scalar::U64;
    return holds(expect_.comparator, a == b, is_unsigned ? a < b : int64_t(a) < int64_t(b));
  }

  // Returns the tolerance of a component and whether it is in percent. A script gives one tolerance for all
  // components or one for each; a component without a tolerance must be equal.
  std::pair<double, bool> tolerance_of(size_t component) const {
    const auto& all = expect_.tolerances;
    if (all.size() == 1) return all[0];
    return component < all.size() ? all[component] : std::pair(kEqualPercent, true);
  }

  // Returns the colour in units of 1/255, as the script gives it. Integer texels are returned unchanged.
  std::array<double, 4> colour_at(uint32_t x, uint32_t y) const {
    const exec::FormatInfo& info = exec::info_of(*buffer_.type.format);
    const std::byte* at = buffer_.bytes.data() + (uint64_t{y} * buffer_.size[0] + x) * buffer_.layout.stride;
    std::array<double, 4> out{};
    // Choice: an sRGB colour is compared as stored, because a screenshot also holds the stored bytes.
    if (info.numeric == exec::Numeric::Srgb) {
      const bool is_swapped = info.name[0] == 'b';
      for (size_t c = 0; c < 4; ++c) out[is_swapped && c < 3 ? 2 - c : c] = double(at[c]);
      return out;
    }
    const exec::Words words = exec::decode(*buffer_.type.format, at);
    for (size_t c = 0; c < 4; ++c)
      out[c] = info.numeric == exec::Numeric::Uint   ? double(words[c])
               : info.numeric == exec::Numeric::Sint ? double(int32_t(words[c]))
                                                     : double(std::bit_cast<float>(words[c]) * 255.0f);
    return out;
  }

  std::string colours() const {
    if (!buffer_.type.format) wrong(fmt::format("'{}' has no texels", buffer_.name));
    if (!buffer_.size[0]) wrong(fmt::format("'{}' has no width", buffer_.name));
    if (uint64_t{expect_.x} + expect_.width > buffer_.size[0] ||
        uint64_t{expect_.y} + expect_.height > std::max(1u, buffer_.size[1]))
      wrong(fmt::format("the rectangle is not inside of '{}' ({} x {})", buffer_.name, buffer_.size[0],
                        buffer_.size[1]));
    for (uint32_t y = expect_.y; y < expect_.y + expect_.height; ++y)
      for (uint32_t x = expect_.x; x < expect_.x + expect_.width; ++x) {
        const std::array<double, 4> found = colour_at(x, y);
        for (size_t c = 0; c < expect_.values.size(); ++c) {
          double expected = 0;
          parse_real(expect_.values[c], expected);
          const auto [tolerance, is_percent] =
              expect_.tolerances.empty() ? std::pair(0.5, false) : tolerance_of(c);
          if (!is_near(found[c], expected, tolerance, is_percent))
            return fmt::format("'{}' at {}, {}: expected {}, found {:g} {:g} {:g} {:g}", buffer_.name, x, y,
                               fmt::join(expect_.values, " "), found[0], found[1], found[2], found[3]);
        }
      }
    return {};
  }

  void check_alike() const {
    if (buffer_.bytes.size() != other_->bytes.size() ||
        buffer_.layout.slots.size() != other_->layout.slots.size() ||
        buffer_.layout.stride != other_->layout.stride)
      wrong(fmt::format("buffers '{}' and '{}' are not alike: {} and {} bytes", buffer_.name, other_->name,
                        buffer_.bytes.size(), other_->bytes.size()));
  }

  // Calls `call` with each scalar, its bytes in both buffers, its offset, and its number within the element.
  template <class F>
  void each_value(const F& call) const {
    check_alike();
    for (uint64_t element = 0; element + buffer_.layout.stride <= buffer_.bytes.size();
         element += buffer_.layout.stride)
      for (size_t i = 0; i < buffer_.layout.slots.size(); ++i) {
        const uint64_t offset = element + buffer_.layout.slots[i].offset;
        call(buffer_.layout.slots[i].scalar, buffer_.bytes.data() + offset, other_->bytes.data() + offset,
             offset, i);
      }
  }

  std::string same() const {
    std::string out;
    uint64_t wrong_values = 0;
    each_value([&](Scalar scalar, const std::byte* a, const std::byte* b, uint64_t offset, size_t) {
      if (std::memcmp(a, b, bytes_of(scalar)) == 0) return;
      if (wrong_values++ == 0)
        out = fmt::format("buffers '{}' and '{}' differ at byte {}: {} and {}", buffer_.name, other_->name,
                          offset, show(scalar, a), show(scalar, b));
    });
    return wrong_values > 1 ? fmt::format("{}; {} values differ", out, wrong_values) : out;
  }

  double only_tolerance() const {
    if (expect_.tolerances.size() != 1) wrong("one TOLERANCE is expected");
    return expect_.tolerances[0].first;
  }

  std::string root_mean_square() const {
    double sum = 0;
    uint64_t count = 0;
    each_value([&](Scalar scalar, const std::byte* a, const std::byte* b, uint64_t, size_t) {
      const double difference = get_real(scalar, a) - get_real(scalar, b);
      sum += difference * difference, ++count;
    });
    const double found = std::sqrt(sum / double(count));
    if (found <= only_tolerance()) return {};
    return fmt::format("buffers '{}' and '{}': expected a root mean square error of at most {}, found {}",
                       buffer_.name, other_->name, only_tolerance(), found);
  }

  // Compares histograms by the earth mover's distance: the work of moving one histogram into the other, as a
  // fraction of all texels and of the range. Each channel of bytes has a histogram, and the largest distance
  // counts.
  std::string histograms() const {
    std::array<std::array<int64_t, 256>, 4> bins{};
    each_value([&](Scalar scalar, const std::byte* a, const std::byte* b, uint64_t, size_t i) {
      if (scalar != Scalar::U8 || i >= 4) wrong("histograms need texels of one to four bytes");
      ++bins[i][size_t(*a)], --bins[i][size_t(*b)];
    });
    double found = 0;
    for (const auto& channel : bins) {
      int64_t moved = 0, work = 0;
      for (int64_t each : channel) moved += each, work += std::abs(moved);
      found = std::max(found, double(work) / double(buffer_.elements) / 256);
    }
    if (found <= only_tolerance()) return {};
    return fmt::format("buffers '{}' and '{}': expected a distance of histograms of at most {}, found {}",
                       buffer_.name, other_->name, only_tolerance(), found);
  }

  const Expectation& expect_;
  const SourceLocation where_;
  const Buffer& buffer_;
  const Buffer* other_;
};

}  // namespace

std::string check(const Script& script, const Command& command) {
  return Check(script, command).run();
}

}  // namespace glint::amber
