// Finds what the OBJ library would read as something else: bad numbers and corners that name nothing.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/obj_check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <system_error>

#include "base/diagnostics.h"

namespace glint::scenes {
namespace {

constexpr size_t kMostCorners = 255;  // The library keeps the number of a face's corners in a byte.

// The three lists that a corner "v/vt/vn" names, in its order.
struct List {
  std::string_view keyword;
  std::string_view element;
  size_t least_numbers;
};
constexpr std::array<List, 3> kLists{
    {{"v", "vertex", 3}, {"vt", "texture coordinate", 1}, {"vn", "normal", 3}}};
using Counts = std::array<uint64_t, kLists.size()>;

// Takes the text up to `separator` from the front of `rest`, and the separator too.
std::string_view take(std::string_view& rest, char separator) {
  const size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view out = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return out;
}

// Takes the next word of a line, or "" at its end.
std::string_view take_word(std::string_view& rest) {
  constexpr std::string_view kBlank = " \t\r";
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlank), rest.size()));
  const size_t end = std::min(rest.find_first_of(kBlank), rest.size());
  const std::string_view out = rest.substr(0, end);
  rest.remove_prefix(end);
  return out;
}

// Says whether all of `word` is a number that a float can hold.
bool is_float(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
  return error != std::errc::invalid_argument && end == word.data() + word.size() &&
         std::abs(value) <= double(std::numeric_limits<float>::max());
}

class Checker {
 public:
  Checker(std::string_view text, const std::string& path) : path_(path) {
    // A corner may name an element that stands further down, so the elements are counted first.
    each_line(text, [this](std::string_view keyword, std::string_view) {
      for (size_t i = 0; i < kLists.size(); ++i) all_[i] += keyword == kLists[i].keyword;
    });
    each_line(text, [this](std::string_view keyword, std::string_view rest) {
      for (size_t i = 0; i < kLists.size(); ++i)
        if (keyword == kLists[i].keyword) element(kLists[i], rest), ++above_[i];
      if (keyword == "f") face(rest);
    });
  }

 private:
  template <class Visit>
  void each_line(std::string_view text, const Visit& visit) {
    for (line_ = 1; !text.empty(); ++line_) {
      std::string_view rest = take(text, '\n');
      const std::string_view keyword = take_word(rest);
      visit(keyword, rest);
    }
  }

  [[noreturn]] void fail(const std::string& what, const std::string& note) const {
    throw UserError({path_, line_}, what, note);
  }

  void element(const List& list, std::string_view rest) const {
    for (size_t i = 0; i < list.least_numbers; ++i) {
      const std::string_view word = take_word(rest);
      if (word.empty())
        fail(
            fmt::format("this {} has {} of {} numbers", list.element, i, list.least_numbers),
            fmt::format("expected a line such as \"{}\"", list.keyword == "vt" ? "vt 0.5 0.5" : "v 1 0 0.5"));
      if (!is_float(word))
        fail(fmt::format("'{}' is not a finite number", word.substr(0, kLongestQuote)),
             "the exporter may have divided by zero; correct the number or remove what uses it");
    }
  }

  void face(std::string_view rest) const {
    size_t corners = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++corners)
      for (size_t i = 0; i < kLists.size() && !word.empty(); ++i)
        if (const std::string_view index = take(word, '/'); !index.empty()) check_index(index, i);
    if (corners > kMostCorners)
      fail(fmt::format("this face has {} corners, and faces of at most {} are read", corners, kMostCorners),
           "let the exporter cut it into triangles");
  }

  // OBJ counts from 1. A negative index counts back from the element that stands last above the face.
  void check_index(std::string_view index, size_t list) const {
    int64_t number = 0;
    const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), number);
    const std::string quoted(index.substr(0, kLongestQuote));
    if (end == index.data() || end != index.data() + index.size())
      fail(fmt::format("'{}' is not the number of a {}", quoted, kLists[list].element),
           "expected a corner such as 3, 3/1, 3//2 or 3/1/2");
    const bool is_there = error == std::errc() && number != 0 &&
                          (number > 0 ? uint64_t(number) <= all_[list] : uint64_t(-number) <= above_[list]);
    if (!is_there)
      fail(number < 0 ? fmt::format("this face names {} {}, and {} stand above it", kLists[list].element,
                                    quoted, above_[list])
                      : fmt::format("this face names {} {}, and the file has {}", kLists[list].element,
                                    quoted, all_[list]),
           "the file may be cut short; export it again");
  }

  static constexpr size_t kLongestQuote = 40;  // characters of the user's text in a message
  const std::string& path_;
  int line_ = 0;
  Counts all_{}, above_{};
};

}  // namespace

void check_obj(std::string_view text, const std::string& path) {
  const Checker checker(text, path);
}

}  // namespace glint::scenes
