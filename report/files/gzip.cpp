// Uses zlib's streams.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/gzip.h"

#include <utility>
#include <zlib.h>

#include "base/check.h"
#include "base/diagnostics.h"

namespace glint::report {
namespace {

constexpr size_t kChunk = size_t{1} << 16;
constexpr int kGzip = 16 + MAX_WBITS;  // zlib writes a gzip header, without the time

}  // namespace

struct GzipWriter::Stream {
  z_stream z{};
};

GzipWriter::GzipWriter() : stream_(std::make_unique<Stream>()) {
  const int status =
      deflateInit2(&stream_->z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY);
  GLINT_CHECK(status == Z_OK, "zlib cannot start: {}", status);
}

GzipWriter::~GzipWriter() {
  deflateEnd(&stream_->z);
}

void GzipWriter::add(std::string_view text) {
  waiting_ += text;
  if (waiting_.size() >= kChunk) deflate_all(false);
}

std::string GzipWriter::finish() {
  deflate_all(true);
  return std::move(out_);
}

void GzipWriter::deflate_all(bool ends) {
  z_stream& z = stream_->z;
  z.next_in = reinterpret_cast<Bytef*>(waiting_.data());
  z.avail_in = uInt(waiting_.size());
  do {
    const size_t before = out_.size();
    out_.resize(before + kChunk);
    z.next_out = reinterpret_cast<Bytef*>(out_.data() + before);
    z.avail_out = uInt(kChunk);
    deflate(&z, ends ? Z_FINISH : Z_NO_FLUSH);
    out_.resize(out_.size() - z.avail_out);
  } while (z.avail_out == 0);
  waiting_.clear();
}

std::string zlib_bytes(std::string_view text) {
  std::string best;
  for (const int strategy :
       {Z_DEFAULT_STRATEGY, Z_FILTERED}) {  // Z_FILTERED suits numbers, because it takes no short repetitions
    z_stream z{};
    const int status = deflateInit2(&z, Z_BEST_COMPRESSION, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, strategy);
    GLINT_CHECK(status == Z_OK, "zlib cannot start: {}", status);
    std::string out(deflateBound(&z, uLong(text.size())), '\0'), in(text);
    z.next_in = reinterpret_cast<Bytef*>(in.data());
    z.avail_in = uInt(in.size());
    z.next_out = reinterpret_cast<Bytef*>(out.data());
    z.avail_out = uInt(out.size());
    const int end = deflate(&z, Z_FINISH);
    GLINT_CHECK(end == Z_STREAM_END, "zlib has not finished: {}", end);
    out.resize(z.total_out);
    deflateEnd(&z);
    if (best.empty() || out.size() < best.size()) best = std::move(out);
  }
  return best;
}

void read_gzip_lines(const std::string& path, const std::function<bool(std::string_view line)>& each) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw UserError({path}, "cannot read the file");
  std::string held(kChunk, '\0'), line;
  for (;;) {
    const int count = gzread(file.get(), held.data(), unsigned(held.size()));
    if (count < 0) throw UserError({path}, "the file is damaged", "run it again");
    if (count == 0) break;
    for (std::string_view rest(held.data(), size_t(count)); !rest.empty();) {
      const size_t end = rest.find('\n');
      line += rest.substr(0, end);
      if (end == std::string_view::npos) break;
      if (!each(line)) return;
      line.clear();
      rest.remove_prefix(end + 1);
    }
  }
  int error = Z_OK;
  gzerror(file.get(), &error);
  if (error != Z_OK && error != Z_STREAM_END) throw UserError({path}, "the file is damaged", "run it again");
  if (!line.empty()) each(line);
}

}  // namespace glint::report
