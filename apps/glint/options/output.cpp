// Writes to files or to standard output.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/output.h"

#include <cstdio>

#include "report/files/run_directory.h"

namespace glint::app {

void write_output(const std::string& path, const std::string& bytes) {
  if (!path.empty() && path != "-") return report::write_file(path, bytes);
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  if (std::fflush(stdout) != 0 || !is_written) throw OutputError();
}

}  // namespace glint::app
