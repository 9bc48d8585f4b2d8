// `glint annotate RUN [FILE]`: the source of a profiled run with what each line cost.
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "apps/glint/session.h"
#include "report/annotate.h"
#include "report/profile_files.h"

namespace glint::app {
namespace {

std::optional<std::string> text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

ProfileTable read_profile(const std::string& run) {
  const std::string path = std::filesystem::is_directory(run) ? run + "/profile.csv" : run;
  const std::optional<std::string> text = text_of(path);
  if (!text) throw UserError({}, fmt::format("cannot read '{}'", path), "`glint run ... --profile` writes profile.csv into the run directory");
  return report::parse_profile(*text, path);
}

// Whether the user means `file`: its path, or the end of it.
bool means(const std::string& wanted, const std::string& file) {
  return file == wanted || file.ends_with("/" + wanted);
}

Exit annotate(const Session& session, const std::string& run, const std::string& wanted) {
  const ProfileTable profile = read_profile(run);
  const std::vector<report::FileShare> files = report::files_of(profile);
  std::string out, names;
  for (const report::FileShare& file : files) {
    names += (names.empty() ? "" : ", ") + file.file;
    if (!wanted.empty() && !means(wanted, file.file)) continue;
    const std::optional<std::string> source = text_of(file.file);
    if (!source) fmt::print(stderr, "warning: cannot read '{}': its lines are shown without their text\n", file.file);
    out += report::annotate(profile, file.file, source, session.terminal);
  }
  if (!wanted.empty() && out.empty())
    throw UserError({}, fmt::format("no line of '{}' has run", wanted), names.empty() ? "the run knows no source lines" : "files with cycles: " + names);
  if (wanted.empty()) out = report::reason_table(profile, session.terminal) + out;
  write_output("", out);
  return Exit::Ok;
}

}  // namespace

void add_annotate(CLI::App& app, Session& session) {
  struct Options {
    std::string run, file;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("annotate", "Print shader source with what each line cost in a run with --profile");
  command->add_option("RUN", options->run, "Run directory, or its profile.csv")->required();
  command->add_option("FILE", options->file, "Source file, or the end of its path (default: all, the costliest first)");
  command->callback([&session, options] {
    session.action = [&session, options] { return annotate(session, options->run, options->file); };
  });
}

}  // namespace glint::app
