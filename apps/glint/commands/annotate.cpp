// Declares `glint annotate RUN [FILE]`, which prints programs of a profiled run with what each line cost.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/annotate.h"

#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>

#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "report/files/file_list.h"
#include "report/files/profile_files.h"
#include "report/files/run_facts.h"
#include "report/files/run_record.h"
#include "report/files/source_files.h"

namespace glint::app {
namespace {

struct AnnotateOptions {
  std::string run, file, view = "glsl";
  std::vector<std::string> measures = report::kUsualMeasures;
};

// Returns the files of a run directory, which must be as the run left them. Any folder may hold a profile.
report::ListedFiles files_of_folder(const std::string& folder) {
  if (report::is_run_folder(folder)) return report::ListedFiles::of_run(folder);
  return {folder, "", "", std::nullopt};
}

ProfileTable read_profile(const report::ListedFiles& files, const std::string& name) {
  const std::string path = files.path_of(name);
  const std::optional<std::string> text = files.read(name);
  if (!text)
    throw UserError({}, fmt::format("cannot read '{}'", path),
                    "`glint run ... --profile` writes profile.csv into the run directory");
  return report::parse_profile(*text, path);
}

// Returns source.json beside the profile. Without that file it reads the files as they are now, which is
// enough for GLSL.
report::SourceMap read_source(const report::ListedFiles& files, const ProfileTable& profile,
                              const std::string& view) {
  const std::string path = files.path_of("source.json");
  if (const std::optional<std::string> text = files.read("source.json"))
    return report::parse_source(*text, path);
  if (view != "glsl")
    throw UserError({}, fmt::format("cannot read '{}'", path),
                    "SPIR-V and ISA are in that file: name the run directory, not the profile alone");
  ProgramListing listing;
  for (const report::FileShare& file : report::files_of(profile)) listing.files.push_back(file.file);
  report::SourceMap out = report::source_map({listing}, text_of_file);
  out.programs.clear();
  return out;
}

// Returns whether the user means `file`: its path, or the end of it.
bool means(const std::string& wanted, const std::string& file) {
  return wanted.empty() || file == wanted || file.ends_with("/" + wanted);
}

// Returns the views of files, the costliest first.
std::string files_text(const AnnotateOptions& options, const ProfileTable& profile,
                       const report::SourceMap& map, const report::Annotator& annotator) {
  std::string out, names;
  for (const report::FileShare& share : report::files_of(profile)) {
    names += (names.empty() ? "" : ", ") + share.file;
    if (!means(options.file, share.file)) continue;
    for (size_t i = 0; i < map.files.size(); ++i) {
      const report::SourceFile& file = map.files[i];
      if (file.path != share.file) continue;
      if (!file.is_known)
        fmt::print(stderr, "warning: the text of '{}' is not known, so its lines are shown without it\n",
                   file.path);
      out += options.view == "all" ? annotator.all(i) : annotator.file(file);
    }
  }
  if (!options.file.empty() && out.empty())
    throw UserError({}, fmt::format("no line of '{}' has run", options.file),
                    names.empty() ? "the run knows no source lines" : "files with cycles: " + names);
  return out;
}

// Returns whether a program is the shader FILE or has code of it.
bool has_code_of(const report::SourceMap& map, uint32_t number, const std::string& wanted) {
  const ProgramListing& program = map.programs[number];
  if (means(wanted, program.shader)) return true;
  for (const ListedLine& line : program.isa)
    if (line.line && means(wanted, map.files[line.file].path)) return true;
  return false;
}

std::string programs_text(const AnnotateOptions& options, const ProfileTable& profile,
                          const report::SourceMap& map, const report::Annotator& annotator) {
  std::string out, names;
  for (const uint32_t number : report::programs_of(profile)) {
    if (number >= map.programs.size())
      throw UserError({}, "profile.csv and source.json are of different runs", "run it again with --profile");
    names += (names.empty() ? "" : ", ") + map.programs[number].shader;
    if (has_code_of(map, number, options.file))
      out += options.view == "isa" ? annotator.isa(number) : annotator.spirv(number);
  }
  if (out.empty())
    throw UserError({}, fmt::format("no shader with code of '{}' has run", options.file),
                    "shaders with cycles: " + names);
  return out;
}

Exit annotate(const Session& session, const AnnotateOptions& options) {
  const bool is_directory = std::filesystem::is_directory(options.run);
  if (is_directory) report::check_finished(options.run);
  const std::filesystem::path path = is_directory ? options.run + "/profile.csv" : options.run;
  const report::ListedFiles files =
      files_of_folder(path.has_parent_path() ? path.parent_path().string() : ".");
  const ProfileTable profile = read_profile(files, path.filename().string());
  const report::SourceMap map = read_source(files, profile, options.view);
  if (is_directory) tell_of_files({options.run});
  const report::Annotator annotator(profile, map, options.measures, session.terminal);
  std::string out = options.view == "glsl" || options.view == "all"
                        ? files_text(options, profile, map, annotator)
                        : programs_text(options, profile, map, annotator);
  if (options.file.empty()) out = report::reason_table(profile, session.terminal) + out;
  write_output("", out);
  return Exit::Ok;
}

}  // namespace

void add_annotate(Command app, Session& session) {
  auto options = std::make_shared<AnnotateOptions>();
  Command command = app.add_subcommand(
      "annotate", "Print the GLSL, SPIR-V or ISA of a profiled run with what each line cost");
  command.add_option("RUN", options->run, "Run directory, or its profile.csv").required();
  command.add_option(
      "FILE", options->file,
      "Source file or shader to print, or the end of its path (default: all, the costliest first)");
  command
      .add_option("--view", options->view,
                  "Selects what is printed: source lines (glsl), SPIR-V after optimisation (spirv), ISA "
                  "(isa), or each below what it comes from (all)")
      .one_of({"glsl", "spirv", "isa", "all"})
      .capture_default_str();
  command
      .add_option("--measures", options->measures,
                  "Columns to print, separated by commas: cycles, issues, lanes, accesses, requests, "
                  "sectors, latency, waits, and the name of any reason of docs/profiling.md")
      .delimiter(',')
      .capture_default_str();
  command.callback(
      [&session, options] { session.action = [&session, options] { return annotate(session, *options); }; });
}

}  // namespace glint::app
