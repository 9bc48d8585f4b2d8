// Checks that the shader cache returns what was stored and nothing else: other sources, options and builds
// miss, and so do damaged files.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/cache.h"

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>
#include <unistd.h>

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using frontend::ShaderCache;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("glint_cache_" + std::to_string(::getpid()));
  Folder() { fs::remove_all(path), fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
  ShaderCache cache(uint64_t max_bytes = 1 << 20, const std::string& build = "build 1") const {
    return ShaderCache({(path / "cache").string(), build, max_bytes});
  }
  uint64_t bytes() const {
    uint64_t out = 0;
    for (const auto& file : fs::directory_iterator(path / "cache")) out += file.file_size();
    return out;
  }
};

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_CASE("values come back from memory and from the folder, for their key and build alone") {
  const Folder folder;
  const std::string key("a\0b", 3), value(1000, '\7');
  {
    ShaderCache cache = folder.cache();
    CHECK(!cache.find(key));
    cache.store(key, value);
    CHECK(cache.find(key) == value);
  }
  ShaderCache later = folder.cache(), other_build = folder.cache(1 << 20, "build 2");
  CHECK(later.find(key) == value);
  CHECK(!later.find("a"));
  CHECK(!other_build.find(key));
  CHECK(later.counts().found == 1);
  CHECK(later.counts().missing == 1);
}

TEST_CASE("a file that was changed in any byte, cut off or made longer is a miss, and is written again") {
  const Folder folder;
  const std::string key = "the key", value = "the value of some length";
  folder.cache().store(key, value);
  const std::string file = folder.cache().file_of(key), whole = read(file);
  std::vector<std::string> damaged{"", whole.substr(0, 10), whole.substr(0, whole.size() - 1), whole + "x"};
  for (size_t i = 0; i < whole.size(); ++i) {
    damaged.push_back(whole);
    damaged.back()[i] = char(damaged.back()[i] ^ 0x10);
  }
  for (const std::string& bytes : damaged) {
    std::ofstream(file, std::ios::binary) << bytes;
    ShaderCache cache = folder.cache();
    CHECK(!cache.find(key));
    CHECK(cache.counts().damaged == 1);
  }
  folder.cache().store(key, value);
  CHECK(folder.cache().find(key) == value);
}

TEST_CASE("the folder does not outgrow its limit by more than an eighth, and the entry read last stays") {
  const Folder folder;
  ShaderCache cache = folder.cache(100'000);
  cache.store("kept", std::string(1000, 'k'));
  for (int i = 0; i < 300; ++i) {
    cache.store("key " + std::to_string(i), std::string(1000, 'x'));
    std::error_code failed;
    fs::last_write_time(cache.file_of("kept"), fs::file_time_type::clock::now() + std::chrono::hours(1),
                        failed);
    CHECK(folder.bytes() < 114'000);
  }
  CHECK(folder.cache().find("kept"));
  CHECK(folder.cache().find("key 299"));
  CHECK(!folder.cache().find("key 0"));
}

TEST_CASE("threads and caches of one folder read whole values while they are written") {
  const Folder folder;
  std::vector<std::thread> hosts;
  std::atomic<int> wrong{0};
  for (uint32_t host = 0; host < 4; ++host)
    hosts.emplace_back([&, host] {
      std::mt19937 random(host);
      for (int i = 0; i < 100; ++i) {
        ShaderCache cache = folder.cache();
        const uint32_t number = random() % 8;
        const std::string key = std::to_string(number), value(10'000 + number, char('a' + number));
        if (const auto found = cache.find(key); found && *found != value) ++wrong;
        if (cache.counts().damaged) ++wrong;
        cache.store(key, value);
      }
    });
  for (std::thread& host : hosts) host.join();
  CHECK(wrong == 0);
}

TEST_CASE("a folder that cannot be written is not an error") {
  ShaderCache cache({"/proc/no/such/folder", "build", 1 << 20});
  cache.store("key", "value");
  CHECK(cache.find("key") == "value");  // from memory
}

constexpr const char* kShader =
    "#version 460\n#include \"part.glsl\"\nlayout(local_size_x = 32) in;\nlayout(set = 0, binding = 0) "
    "buffer W { uint w[]; };\n"
    "void main() { w[gl_LocalInvocationID.x] = VALUE + part(); }\n";

TEST_CASE(
    "a compiled program comes back the same with lines and header, and changes when its sources change") {
  const Folder folder;
  const std::string shader = folder.write("a.comp", kShader),
                    part = folder.write("part.glsl", "uint part() { return 1; }\n");
  const auto compile = [&](const char* value, bool contract, uint64_t* missing) {
    ShaderCache cache = folder.cache();
    frontend::GlslOptions glsl;
    glsl.cache = &cache;
    glsl.defines = {{"VALUE", value}};
    Diagnostics warnings;
    frontend::BackendOptions backend;
    backend.contract = contract;
    const isa::Program program = frontend::compile_file(shader, glsl, backend, warnings);
    *missing = cache.counts().missing;
    return program;
  };
  uint64_t missing = 0;
  const isa::Program cold = compile("3", false, &missing);
  CHECK(missing == 2);  // the misses are GLSL to SPIR-V and SPIR-V to program
  const isa::Program warm = compile("3", false, &missing);
  CHECK(missing == 0);
  CHECK(warm == cold);
  CHECK(warm.labels == cold.labels);
  CHECK(warm.local_size == std::array<uint32_t, 3>{32, 1, 1});
  CHECK(warm.lines.size() == warm.code.size());
  CHECK(!(compile("4", false, &missing) == cold));
  CHECK(missing == 2);
  compile("3", true, &missing);
  CHECK(missing == 1);
  folder.write("part.glsl", "uint part() { return 2; }\n");
  CHECK(!(compile("3", false, &missing) == cold));
  folder.write("part.glsl", "uint part() { return 1; }\n");
  CHECK(compile("3", false, &missing) == cold);
  folder.write("a.comp", std::string(kShader) + "// changed\n");
  compile("3", false, &missing);
  CHECK(missing == 2);  // the SPIR-V contains the source text
}

TEST_CASE(
    "a module is compiled once, whatever its name is, and each program has the name that was asked for") {
  const Folder folder;
  const std::string shader = folder.write("a.comp", kShader);
  folder.write("part.glsl", "uint part() { return 1; }\n");
  frontend::GlslOptions glsl;
  glsl.defines = {{"VALUE", "3"}};
  const std::vector<uint32_t> spirv = frontend::glsl_to_spirv(shader, glsl);
  ShaderCache cache = folder.cache();
  Diagnostics warnings;
  const auto compile = [&](const char* name) {
    return frontend::compile_module(spirv, name, "main", {}, warnings, &cache, frontend::Validity::Known)
        .program;
  };
  const isa::Program first = compile("shader 1"), second = compile("shader 2");
  CHECK(cache.counts().missing == 1);
  CHECK(cache.counts().found == 1);
  CHECK(first.name == "shader 1");
  CHECK(second.name == "shader 2");
  CHECK(second.files == first.files);
  CHECK(second.code.size() == first.code.size());
}

TEST_CASE("an include file that appears in a folder that is searched earlier is seen") {
  const Folder folder;
  fs::create_directories(folder.path / "later");
  const std::string shader = folder.write("a.comp", kShader);
  fs::create_directories(folder.path / "first");
  fs::create_directories(folder.path / "second");
  folder.write("second/part.glsl", "uint part() { return 1; }\n");
  ShaderCache cache = folder.cache();
  frontend::GlslOptions glsl;
  glsl.include_dirs = {(folder.path / "first").string(), (folder.path / "second").string()};
  glsl.defines = {{"VALUE", "3"}};
  const std::vector<uint32_t> before = frontend::glsl_to_spirv(shader, glsl);
  glsl.cache = &cache;
  CHECK(frontend::glsl_to_spirv(shader, glsl) == before);
  CHECK(frontend::glsl_to_spirv(shader, glsl) == before);
  CHECK(cache.counts().found == 1);
  folder.write("first/part.glsl", "uint part() { return 7; }\n");
  CHECK(frontend::glsl_to_spirv(shader, glsl) != before);
}

TEST_CASE("shaders with errors are not kept") {
  const Folder folder;
  const std::string shader = folder.write("bad.comp", "#version 460\nvoid main() { x = 1; }\n");
  ShaderCache cache = folder.cache();
  frontend::GlslOptions glsl;
  glsl.cache = &cache;
  for (int i = 0; i < 2; ++i) CHECK_THROWS_AS(frontend::glsl_to_spirv(shader, glsl), UserError);
  CHECK(cache.counts().found == 0);
}

}  // namespace
}  // namespace glint::test
