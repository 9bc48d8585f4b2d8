// Writes files in gzip's format (RFC 1952) piece by piece, reads them line by line, and packs text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace glint::report {

// Packs bytes. The result depends only on what was added, because no name and no time are kept.
class GzipWriter {
 public:
  GzipWriter();
  ~GzipWriter();
  void add(std::string_view text);
  std::string finish();  // returns the whole file; called once

 private:
  struct Stream;
  void deflate_all(bool ends);
  std::unique_ptr<Stream> stream_;
  std::string waiting_, out_;
};

// Calls `each` for every line of the file, without its end, until it answers false. Throws UserError when the
// file cannot be read or is damaged.
void read_gzip_lines(const std::string& path, const std::function<bool(std::string_view line)>& each);

// Returns `text` as a zlib stream (RFC 1950), as small as zlib makes it.
std::string zlib_bytes(std::string_view text);

}  // namespace glint::report
