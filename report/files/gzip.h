// Files in gzip's format (RFC 1952), written piece by piece and read line by line, and packed text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace glint::report {

// The bytes depend on what was added only: no name and no time are kept.
class GzipWriter {
 public:
  GzipWriter();
  ~GzipWriter();
  void add(std::string_view text);
  std::string finish();  // once: all of the file

 private:
  struct Stream;
  void deflate_all(bool ends);
  std::unique_ptr<Stream> stream_;
  std::string waiting_, out_;
};

// Calls `each` for every line of the file, without its end, until it answers false. UserError where the file
// cannot be read or is damaged.
void read_gzip_lines(const std::string& path, const std::function<bool(std::string_view line)>& each);

// `text` as a zlib stream (RFC 1950), as small as zlib makes it.
std::string zlib_bytes(std::string_view text);

}  // namespace glint::report
