// Declares `glint annotate RUN [B] [FILE]`, which prints programs of a profiled run with what each line cost,
// or compares the lines of two runs.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/annotate.h"

#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>

#include "apps/glint/options/output.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "report/files/file_list.h"
#include "report/files/line_changes.h"
#include "report/files/profile_files.h"
#include "report/files/run_facts.h"
#include "report/files/run_record.h"
#include "report/files/source_files.h"
#include "report/metrics/compare.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

struct AnnotateOptions {
  std::string run, other, file, view = "glsl";
  std::vector<std::string> measures = report::kUsualMeasures;
  bool has_measures = false;
  uint32_t top = 0;  // 0: all lines
};

// Holds what is read of a run.
struct Profiled {
  ProfileTable profile;
  report::SourceMap map;
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
  report::SourceMap out = report::source_map({listing}, setup::text_of_file);
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
    throw UserError(
        {}, fmt::format("no line of '{}' has run, and it is not a second run's directory", options.file),
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
    throw UserError({},
                    fmt::format("no shader with code of '{}' has run, and it is not a second run's directory",
                                options.file),
                    "shaders with cycles: " + names);
  return out;
}

Profiled read_profiled(const std::string& run, const std::string& view) {
  const bool is_directory = std::filesystem::is_directory(run);
  if (is_directory) report::check_finished(run);
  const std::filesystem::path path = is_directory ? run + "/profile.csv" : run;
  const report::ListedFiles files =
      files_of_folder(path.has_parent_path() ? path.parent_path().string() : ".");
  Profiled out{read_profile(files, path.filename().string()), {}};
  out.map = read_source(files, out.profile, view);
  if (is_directory) tell_of_files({run});
  return out;
}

// Returns the costliest lines or instructions of everything that FILE names.
std::string top_text(const AnnotateOptions& options, const report::SourceMap& map,
                     const report::Annotator& annotator) {
  if (options.view == "glsl" || options.view == "all")
    return annotator.top_lines(
        options.top, [&](const std::string& path) { return means(options.file, path); },
        options.view == "all");
  return annotator.top_instructions(
      options.top, [&](uint32_t program) { return has_code_of(map, program, options.file); },
      options.view == "spirv");
}

Exit annotate_one(const Session& session, const AnnotateOptions& options) {
  const auto [profile, map] = read_profiled(options.run, options.view);
  const report::Annotator annotator(profile, map, options.measures, session.terminal);
  // This also refuses what is not there, so it comes first for --top, too.
  std::string out = options.view == "glsl" || options.view == "all"
                        ? files_text(options, profile, map, annotator)
                        : programs_text(options, profile, map, annotator);
  if (options.top) out = top_text(options, map, annotator);
  if (options.file.empty()) out = report::reason_table(profile, session.terminal) + out;
  write_output("", out);
  return Exit::Ok;
}

// Prints to stderr why the lines of two runs may not be each other's counterparts.
void warn_of_differences(const AnnotateOptions& options, const report::LineComparison& comparison) {
  if (std::filesystem::is_directory(options.run) && std::filesystem::is_directory(options.other)) {
    report::RunRecord was, is;
    was.add_finished(options.run);
    is.add_finished(options.other);
    if (const std::string different = report::different_work(was, is); !different.empty())
      fmt::print(stderr, "warning: the runs did different work: {}\n", different);
  }
  for (const report::FileDifference& file : comparison.differ)
    if (!file.is_known)
      fmt::print(stderr, "warning: the text of '{}' is not known, so its lines are matched by number\n",
                 file.file);
    else
      fmt::print(stderr,
                 "warning: '{}' is not the same in both runs: {} of its lines are only in A and {} only in "
                 "B; the others are matched by their text\n",
                 file.file, file.only_before, file.only_after);
  for (const std::string& file : comparison.unmatched)
    fmt::print(stderr, "warning: only one of the runs has '{}'\n", file);
}

Exit annotate_two(const AnnotateOptions& options) {
  if (options.view != "glsl")
    throw UserError({}, fmt::format("two runs cannot be compared in the view '{}'", options.view),
                    "their source lines are compared, because instructions have no counterpart");
  if (options.has_measures && options.measures.size() != 1)
    throw UserError({}, "two runs are compared by one measure", "name one, such as --measures issues");
  const std::string measure = options.has_measures ? options.measures[0] : "cycles";
  const Profiled before = read_profiled(options.run, options.view),
                 after = read_profiled(options.other, options.view);
  report::LineComparison comparison =
      report::compare_lines({before.profile, before.map}, {after.profile, after.map}, measure);
  if (comparison.files == 0)
    throw UserError({},
                    fmt::format("'{}' and '{}' have no source file in common", options.run, options.other),
                    "compare runs of the same shaders");
  warn_of_differences(options, comparison);
  std::erase_if(comparison.lines,
                [&](const report::LineChange& line) { return !means(options.file, line.file); });
  if (comparison.lines.empty())
    throw UserError({}, fmt::format("no line of '{}' has run in either run", options.file));
  write_output("", report::line_changes_text(comparison, measure, options.top));
  return Exit::Ok;
}

// Returns whether a word names a run rather than a source file.
bool names_a_run(const std::string& word) {
  return std::filesystem::is_directory(word) || std::filesystem::path(word).extension() == ".csv";
}

Exit annotate(const Session& session, AnnotateOptions options) {
  if (!options.other.empty() && !names_a_run(options.other)) {
    if (!options.file.empty())
      throw UserError({}, fmt::format("'{}' is not a run directory", options.other),
                      "`glint annotate A B FILE` compares the lines of FILE in the runs A and B");
    std::swap(options.file, options.other);
  }
  return options.other.empty() ? annotate_one(session, options) : annotate_two(options);
}

}  // namespace

void add_annotate(Command app, Session& session) {
  auto options = std::make_shared<AnnotateOptions>();
  Command command = app.add_subcommand("annotate",
                                       "Print the GLSL, SPIR-V or ISA of a profiled run with what each line "
                                       "cost, or compare the lines of two");
  command.add_option("RUN", options->run, "Run directory, or its profile.csv").required();
  command.add_option("B", options->other,
                     "Second run, whose source lines are compared with those of the first; without one, FILE "
                     "stands here");
  command.add_option(
      "FILE", options->file,
      "Source file or shader to print, or the end of its path (default: all, the costliest first)");
  command
      .add_option("--top", options->top,
                  "Prints only this many lines, the costliest first; of two runs, those that changed most")
      .in_range(uint32_t{1}, ~uint32_t{0});
  command
      .add_option("--view", options->view,
                  "Selects what is printed: source lines (glsl), SPIR-V after optimisation (spirv), ISA "
                  "(isa), or each below what it comes from (all)")
      .one_of({"glsl", "spirv", "isa", "all"})
      .capture_default_str();
  command
      .add_option("--measures", options->measures,
                  "Columns to print, separated by commas: cycles, issues, lanes, accesses, requests, "
                  "sectors, latency, waits, and the name of any reason of docs/profiling.md; two runs are "
                  "compared by one of them (default: cycles)")
      .delimiter(',')
      .capture_default_str();
  command.callback([&session, options, command] {
    options->has_measures = command.count("--measures") > 0;
    session.action = [&session, options] { return annotate(session, *options); };
  });
}

}  // namespace glint::app
