// Measures how long compiling all shaders of the LumiBench workloads takes: in a fresh process, a second
// time, and from the cache.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <string>
#include <unistd.h>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/cache.h"
#include "frontend/compile.h"

using namespace glint;

namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_shaders() {
  std::vector<std::string> out;
  for (const char* workload : {"path_tracing", "shadow", "ambient_occlusion"})
    for (const auto& file : fs::directory_iterator(fs::path(GLINT_SOURCE_DIR) / "shaders" / workload))
      if (frontend::stage_of_file(file.path().string())) out.push_back(file.path().string());
  std::sort(out.begin(), out.end());
  return out;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Compiles all shaders, prints the time that each step takes, and returns the whole time in milliseconds.
// With a cache, lowering includes simplification.
double compile_all(const std::vector<std::string>& shaders, const std::string& title,
                   frontend::ShaderCache* cache) {
  frontend::GlslOptions glsl;
  glsl.cache = cache;
  Diagnostics warnings;
  double parse = 0, simplify = 0, lower = 0, first = 0;
  const auto start = std::chrono::steady_clock::now();
  for (const std::string& shader : shaders) {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<uint32_t> words = frontend::spirv_of_file(shader, glsl);
    parse += milliseconds_since(begin);
    if (first == 0) first = parse;
    const auto middle = std::chrono::steady_clock::now();
    if (cache) {
      frontend::compile_module(words, shader, "", {}, warnings, cache, frontend::Validity::Known);
      lower += milliseconds_since(middle);
      continue;
    }
    words = frontend::simplify(std::move(words), shader, warnings, frontend::Validity::Known);
    simplify += milliseconds_since(middle);
    const auto end = std::chrono::steady_clock::now();
    frontend::lower(words, shader, {});
    lower += milliseconds_since(end);
  }
  const double all = milliseconds_since(start);
  fmt::print("{:<24}{:7.1f} ms   GLSL {:6.1f} (first {:5.1f})   simplify {:6.1f}   lower {:6.1f}\n", title,
             all, parse, first, simplify, lower);
  return all;
}

}  // namespace

int main() {
  const std::vector<std::string> shaders = all_shaders();
  const fs::path folder = fs::temp_directory_path() / fmt::format("glint_compile_bench_{}", ::getpid());
  fmt::print("{} shaders\n", shaders.size());
  compile_all(shaders, "cold process", nullptr);
  compile_all(shaders, "again", nullptr);
  {
    frontend::ShaderCache cache({folder.string(), "bench"});
    compile_all(shaders, "filling the cache", &cache);
    compile_all(shaders, "from memory", &cache);
  }
  frontend::ShaderCache cache({folder.string(), "bench"});
  compile_all(shaders, "from files", &cache);
  fs::remove_all(folder);
}
