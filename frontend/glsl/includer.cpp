// Searches directories for included files, and counts what a chain of includes has read.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/glsl/includer.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>
#include <utility>

#include "base/regular_file.h"
#include "frontend/cache.h"
#include "frontend/glsl/newer_glsl.h"

namespace glint::frontend {
namespace {

namespace fs = std::filesystem;

// Choice: a file may include itself, as macros can end that. These limits are far above what shaders need,
// and stop the others within a second.
constexpr size_t kMaxDepth = 100, kMaxRepeats = 10'000, kMaxRepeatedBytes = size_t{16} << 20;

// Blanks out the #version lines of an included file, because glslang wants the directive at the start of the
// main file. Choice: a shader whose first line includes the file with the #version compiles, as it does with
// tools that paste includes first. A shader without a #version of its own has version 460 in any case.
void blank_version(std::string& text) {
  for (size_t line = 0; line < text.size();) {
    const size_t end = std::min(text.find('\n', line), text.size());
    size_t at = text.find_first_not_of(" \t", line);
    if (at < end && text[at] == '#') {
      at = text.find_first_not_of(" \t", at + 1);
      if (at < end && text.compare(at, 7, "version") == 0)
        std::fill(text.begin() + long(line), text.begin() + long(end), ' ');
    }
    line = end + 1;
  }
}

}  // namespace

// A result that glslang may not use is followed by includeSystem for the same header, which says why.
Includer::IncludeResult* Includer::includeLocal(const char* header, const char*, size_t depth) {
  // glslang goes on after an error. What follows is left out, so that it ends soon.
  if (has_said_failure_) return new IncludeResult(header, "", 0, nullptr);
  if (!enter(depth)) return nullptr;
  if (std::string text = text_of_extension(header, stage_); !text.empty())
    return give(header, texts_[header] = std::move(text));
  for (size_t i = chain_.size(); i-- > 0 && failure_.empty();)
    if (IncludeResult* found = look_in(fs::path(chain_[i]).parent_path().string(), header)) return found;
  return nullptr;
}

Includer::IncludeResult* Includer::includeSystem(const char* header, const char*, size_t depth) {
  if (has_said_failure_) return new IncludeResult(header, "", 0, nullptr);
  if (!failure_.empty() || !enter(depth)) return say_failure();
  for (const std::string& dir : dirs_) {
    if (IncludeResult* found = look_in(dir, header)) return found;
    if (!failure_.empty()) return say_failure();
  }
  failure_ = searched_.empty()
                 ? fmt::format("cannot find {}; there are no include folders (-I)", header)
                 : fmt::format("cannot find {}; searched in {}", header, fmt::join(searched_, ", "));
  return say_failure();
}

bool Includer::enter(size_t depth) {
  chain_.resize(std::min(depth, chain_.size()));
  if (chain_.size() > kMaxDepth)
    failure_ = fmt::format("files include each other more than {} deep: {}", kMaxDepth, chain_in_words());
  return failure_.empty();
}

Includer::IncludeResult* Includer::look_in(const std::string& directory, const char* header) {
  const std::string name = directory.empty() ? "." : fs::path(directory).lexically_normal().string();
  if (std::find(searched_.begin(), searched_.end(), name) != searched_.end()) return nullptr;
  searched_.push_back(name);
  return load(fs::path(directory) / header);
}

Includer::IncludeResult* Includer::load(const fs::path& path) {
  const std::string name = path.lexically_normal().string();
  if (const auto known = texts_.find(name); known != texts_.end()) {
    repeated_bytes_ += known->second.size();
    if (++repeats_ <= kMaxRepeats && repeated_bytes_ <= kMaxRepeatedBytes) return give(name, known->second);
    failure_ = fmt::format("files include each other again and again, {} times by now: {}", repeats_,
                           chain_in_words());
    return nullptr;
  }
  std::optional<std::string> text = read_regular_file(path.string());
  lookups_.push_back(text ? found_at(path.string(), *text) : Lookup{path.string()});
  if (!text) return nullptr;
  blank_version(*text);
  say_extensions_anew(*text);
  return give(name, texts_[name] = std::move(*text));
}

Includer::IncludeResult* Includer::give(const std::string& name, const std::string& text) {
  const bool is_cycle = std::find(chain_.begin(), chain_.end(), name) != chain_.end();
  chain_.push_back(name);
  if (is_cycle && cycle_.empty()) cycle_ = chain_in_words();
  searched_.clear();
  return new IncludeResult(name, text.data(), text.size(), nullptr);
}

// Returns a result without a name, whose text glslang reports as an error.
Includer::IncludeResult* Includer::say_failure() {
  has_said_failure_ = true;
  return new IncludeResult("", failure_.data(), failure_.size(), nullptr);
}

// Names the files that lead to the present one, up to the first that comes a second time.
std::string Includer::chain_in_words() const {
  constexpr size_t kMaxNames = 12;
  std::string words;
  for (size_t i = 0; i < chain_.size(); ++i) {
    if (i == kMaxNames) return words + ", and so on";
    words += (i == 0 ? "" : i == 1 ? " includes " : ", which includes ") + chain_[i];
    if (std::find(chain_.begin(), chain_.begin() + long(i), chain_[i]) != chain_.begin() + long(i)) break;
  }
  return words;
}

}  // namespace glint::frontend
