// Cuts the text of an OBJ file into chunks that threads read side by side, and finds its mistakes.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/obj_chunks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <system_error>
#include <tuple>

#include "base/diagnostics.h"
#include "base/parallel_ranges.h"

namespace glint::scenes {
namespace {

constexpr size_t kMostCorners = 255;  // The library keeps the number of a face's corners in a byte.

// The lists that a corner "v/vt/vn" names, in its order.
struct List {
  std::string_view keyword;
  std::string_view element;
  size_t least_numbers;
};
constexpr std::array<List, 3> kLists{
    {{"v", "vertex", 3}, {"vt", "texture coordinate", 1}, {"vn", "normal", 3}}};
static_assert(kLists.size() == std::tuple_size_v<ObjCounts>);

// Takes the text up to `separator` from the front of `rest`, and the separator too.
std::string_view take(std::string_view& rest, char separator) {
  const size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view out = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return out;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

// Takes the next word of a line, or "" at its end. A loop over the characters is quicker than a search,
// because words are short.
std::string_view take_word(std::string_view& rest) {
  size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view out = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return out;
}

// Takes the next number of a corner, without the '/' behind it.
std::string_view take_index(std::string_view& rest) {
  size_t end = 0;
  while (end < rest.size() && rest[end] != '/') ++end;
  const std::string_view out = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
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

// Calls visit(line, keyword, rest) for each line. The line has no end of its own, and `rest` follows the
// keyword.
template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    std::string_view lines = take(text, '\n');
    if (lines.ends_with('\r')) lines.remove_suffix(1);
    do {
      const std::string_view line = take(lines, '\r');
      std::string_view rest = line;
      const std::string_view keyword = take_word(rest);
      visit(line, keyword, rest);
    } while (!lines.empty());
  }
}

// Returns the chunks with their texts alone.
std::vector<ObjChunk> cut(std::string_view text, size_t chunk_bytes) {
  std::vector<ObjChunk> chunks;
  while (!text.empty()) {
    const size_t newline = text.find('\n', std::min(text.size(), std::max<size_t>(chunk_bytes, 1)) - 1);
    const size_t end = newline == std::string_view::npos ? text.size() : newline + 1;
    chunks.emplace_back().text = text.substr(0, end);
    text.remove_prefix(end);
  }
  return chunks;
}

// Counts what is in a chunk, and keeps its lines about materials.
void count_lines(ObjChunk& chunk) {
  each_line(chunk.text, [&](std::string_view line, std::string_view keyword, std::string_view rest) {
    ++chunk.lines;
    for (size_t i = 0; i < kLists.size(); ++i) chunk.count[i] += keyword == kLists[i].keyword;
    if (keyword == "f") chunk.faces += !take_word(rest).empty();
    // The library takes the name of a material even where no blank stands before it.
    if (keyword.starts_with("usemtl") || keyword == "mtllib")
      chunk.material_lines.push_back({line, chunk.faces});
  });
}

// Checks a chunk's elements and faces. A corner may name an element that stands further down, so that the
// elements of the whole text were counted before.
class Checker {
 public:
  // `line` is the number of the line above the chunk, and `all` counts the elements of the whole text.
  Checker(const ObjChunk& chunk, uint64_t line, const ObjCounts& all, const std::string& path)
      : path_(path), line_(line), all_(all), above_(chunk.above) {
    each_line(chunk.text, [this](std::string_view, std::string_view keyword, std::string_view rest) {
      ++line_;
      for (size_t i = 0; i < kLists.size(); ++i)
        if (keyword == kLists[i].keyword) element(kLists[i], rest), ++above_[i];
      if (keyword == "f") face(rest);
    });
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& note) const {
    throw UserError({path_, int(line_)}, what, note);
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
      corner(word);
    if (corners > kMostCorners)
      fail(fmt::format("this face has {} corners, and faces of at most {} are read", corners, kMostCorners),
           "let the exporter cut it into triangles");
  }

  void corner(const std::string_view word) const {
    std::string_view rest = word;
    for (size_t i = 0; i < kLists.size(); ++i) {
      const std::string_view index = take_index(rest);
      if (!index.empty())
        check_index(index, i);
      else if (i == 0)
        fail(fmt::format("the corner '{}' names no vertex", word.substr(0, kLongestQuote)), kCornerForm);
    }
    if (!rest.empty())
      fail(fmt::format("the corner '{}' has more than three numbers", word.substr(0, kLongestQuote)),
           kCornerForm);
  }

  // OBJ counts from 1. A negative index counts back from the element that stands last above the face.
  void check_index(std::string_view index, size_t list) const {
    int64_t number = 0;
    const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), number);
    const auto quoted = [index] { return index.substr(0, kLongestQuote); };
    if (end == index.data() || end != index.data() + index.size())
      fail(fmt::format("'{}' is not the number of a {}", quoted(), kLists[list].element), kCornerForm);
    const bool is_there = error == std::errc() && number != 0 &&
                          (number > 0 ? uint64_t(number) <= all_[list] : uint64_t(-number) <= above_[list]);
    if (!is_there)
      fail(number < 0 ? fmt::format("this face names {} {}, and {} stand above it", kLists[list].element,
                                    quoted(), above_[list])
                      : fmt::format("this face names {} {}, and the file has {}", kLists[list].element,
                                    quoted(), all_[list]),
           "the file may be cut short; export it again");
  }

  static constexpr size_t kLongestQuote = 40;  // characters of the user's text in a message
  static constexpr const char* kCornerForm = "expected a corner such as 3, 3/1, 3//2 or 3/1/2";
  const std::string& path_;
  uint64_t line_;
  const ObjCounts& all_;
  ObjCounts above_;
};

}  // namespace

std::vector<ObjChunk> checked_chunks(std::string_view text, const std::string& path, uint32_t threads,
                                     size_t chunk_bytes) {
  std::vector<ObjChunk> chunks = cut(text, chunk_bytes);
  parallel_ranges(chunks.size(), 1, threads, [&](size_t i, size_t) { count_lines(chunks[i]); });
  std::vector<uint64_t> lines_above;
  uint64_t lines = 0;
  ObjCounts all{};
  for (ObjChunk& chunk : chunks) {
    lines_above.push_back(lines);
    lines += chunk.lines;
    chunk.above = all;
    for (size_t i = 0; i < all.size(); ++i) all[i] += chunk.count[i];
  }
  parallel_ranges(chunks.size(), 1, threads,
                  [&](size_t i, size_t) { const Checker checker(chunks[i], lines_above[i], all, path); });
  return chunks;
}

}  // namespace glint::scenes
