// Writes the time line of an application and its tables.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/application.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "report/files/application_index.h"
#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostRows = 200;     // of a table; the index has all launches
constexpr int kWidth = 1000;          // of the time line, in its own units
constexpr int kLane = 26, kBar = 20;  // height of a lane and of a bar in it
constexpr double kLeastBar = 0.7;     // Bars are at least so wide.
constexpr int kAxis = 14;             // height of the numbers of frames

struct Lane {
  const char *name, *colour;
};
constexpr Lane kLanes[] = {{"timed launches", "var(--blue)"},
                           {"functional launches", "var(--orange)"},
                           {"transfers", "var(--green)"},
                           {"builds of acceleration structures", "var(--pink)"}};

bool is_present(const Json& command) {
  return command["kind"] == "present";
}
bool is_build(const Json& command) {
  return command["kind"] == "build";
}
bool is_timed(const Json& command) {
  return is_launch(command) && !command["cycles"].is_null();
}

size_t lane_of(const Json& command) {
  return is_build(command) ? 3 : !is_launch(command) ? 2 : is_timed(command) ? 0 : 1;
}

std::string size_of(const Json& command) {
  return fmt::format("{}", fmt::join(command["size"].get<std::vector<uint64_t>>(), " x "));
}

// Returns what a launch is called: "dispatch 3: blur, shadows".
std::string name_of(const Json& command) {
  if (is_build(command))
    return fmt::format("{} of the {} level '{}' of {} {}, {} bytes",
                       command.value("update", false) ? "update" : "build",
                       command["level"].get<std::string>(), command["structure"].get<std::string>(),
                       command["primitives"].dump(), command["level"] == "top" ? "instances" : "primitives",
                       command["bytes"].dump());
  if (!is_launch(command))
    return fmt::format("{} transfers of {} bytes", command["count"].dump(), command["bytes"].dump());
  std::string out = fmt::format("{} {}: {}", command["kind"].get<std::string>(), command["number"].dump(),
                                command["shader"].get<std::string>());
  if (const std::string label = command["label"]; !label.empty()) out += ", " + label;
  return out;
}

std::string link_of(const Json& one, const Json& command) {
  const std::string folder = command.value("folder", "");
  return one.contains("links") && one["links"].contains(folder) ? escaped_text(one["links"], folder.c_str())
                                                                : "";
}

// Returns a text as a link to the launch's report, if it has one.
std::string linked(const Json& one, const Json& command, const std::string& text) {
  const std::string link = link_of(one, command);
  return link.empty() ? text : fmt::format("<a href=\"{}\">{}</a>", link, text);
}

// Puts bars of one lane that would lie on each other into one.
struct Bar {
  uint64_t begin, end, commands;
  const Json* first;
};

std::vector<Bar> bars_of(const Json& commands, size_t lane, double cycles_per_unit) {
  std::vector<Bar> out;
  for (const Json& command : commands) {
    if (is_present(command) || lane_of(command) != lane) continue;
    const uint64_t begin = command["begin"], end = std::max<uint64_t>(begin, command["end"]);
    const double least = kLeastBar * cycles_per_unit;
    if (!out.empty() && double(end - begin) < least && double(end) - double(out.back().begin) < least) {
      out.back().end = end, ++out.back().commands;
    } else {
      out.push_back({begin, end, 1, &command});
    }
  }
  return out;
}

std::string drawn(const Json& one, const Bar& bar, size_t lane, double cycles_per_unit) {
  const std::string name = bar.commands == 1 ? name_of(*bar.first) : fmt::format("{} commands", bar.commands);
  const std::string rectangle = fmt::format(
      "<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" style=\"fill:{}\"><title>{}: cycles {} to "
      "{}</title></rect>",
      double(bar.begin) / cycles_per_unit, int(lane) * kLane,
      std::max(kLeastBar, double(bar.end - bar.begin) / cycles_per_unit), kBar, kLanes[lane].colour,
      escaped(name), bar.begin, bar.end);
  return bar.commands == 1 ? linked(one, *bar.first, rectangle) : rectangle;
}

// Returns the axis of frames: a line where each one was presented, with its number where there is room.
std::string frame_axis(const Json& commands, double cycles_per_unit) {
  constexpr int kHeight = int(std::size(kLanes)) * kLane;
  constexpr double kLeastGap = 1.5, kNumberWidth = 28;
  std::string out;
  double last_line = -kLeastGap, last_number = -kNumberWidth;
  for (const Json& command : commands) {
    if (!is_present(command)) continue;
    const double x = command["end"].get<double>() / cycles_per_unit;
    if (x - last_line < kLeastGap) continue;
    last_line = x;
    out += fmt::format(
        "<line x1=\"{0:.2f}\" x2=\"{0:.2f}\" y1=\"0\" y2=\"{1}\" stroke=\"currentColor\" "
        "stroke-width=\"0.5\"><title>frame {2} ends at cycle {3}</title></line>\n",
        x, kHeight + 2, command["frame"].dump(), command["end"].dump());
    if (x - last_number < kNumberWidth) continue;
    last_number = x;
    out += fmt::format(
        "<text x=\"{:.2f}\" y=\"{}\" font-size=\"9\" text-anchor=\"end\" fill=\"currentColor\">{}</text>\n",
        x, kHeight + kAxis - 2, command["frame"].dump());
  }
  return out;
}

std::string time_line(const Json& one, uint64_t end) {
  const Json& commands = one["index"]["commands"];
  const double cycles_per_unit = std::max(1.0, double(end)) / kWidth;
  std::string bars, legend;
  for (size_t lane = 0; lane < std::size(kLanes); ++lane) {
    const std::vector<Bar> all = bars_of(commands, lane, cycles_per_unit);
    for (const Bar& bar : all) bars += drawn(one, bar, lane, cycles_per_unit) + "\n";
    if (!all.empty())
      legend += fmt::format("{}<span style=\"color:{}\">&#9632;</span> {}", legend.empty() ? "" : " &#160; ",
                            kLanes[lane].colour, kLanes[lane].name);
  }
  const std::string axis = frame_axis(commands, cycles_per_unit);
  if (!axis.empty()) legend += " &#160; | the end of a frame, with its number";
  return fmt::format(
      "<figure data-figure=\"time-line\"><svg viewBox=\"0 0 {} {}\" width=\"100%\" role=\"img\" "
      "aria-label=\"Time line of commands\">\n{}</svg>\n<figcaption class=\"note\">{} &#160; Core cycles 0 "
      "to "
      "{}.</figcaption></figure>\n",
      kWidth, int(std::size(kLanes)) * kLane + (axis.empty() ? 0 : kAxis), bars + axis, legend, shown(end));
}

std::string cell(const std::string& content, bool is_number = false) {
  return fmt::format("<td{}>{}</td>", is_number ? " class=\"n\"" : "", content);
}

std::string table(const char* name, const std::vector<std::string>& head, const std::string& rows) {
  std::string cells;
  for (const std::string& each : head) cells += fmt::format("<th scope=\"col\">{}</th>", each);
  return fmt::format(
      "<div class=\"scroll\"><table class=\"metrics\" data-table=\"{}\"><thead><tr>{}</tr></thead><tbody>\n{}"
      "</tbody></table></div>\n",
      name, cells, rows);
}

std::vector<const Json*> by_cycles(const Json& index) {
  std::vector<const Json*> out;
  for (const Json& command : index["commands"])
    if (is_timed(command)) out.push_back(&command);
  std::stable_sort(out.begin(), out.end(), [](const Json* a, const Json* b) {
    return (*a)["cycles"].get<uint64_t>() > (*b)["cycles"].get<uint64_t>();
  });
  return out;
}

std::string launch_table(const Json& one, uint64_t all_cycles) {
  const std::vector<const Json*> launches = by_cycles(one["index"]);
  std::string rows;
  for (size_t i = 0; i < std::min(launches.size(), kMostRows); ++i) {
    const Json& each = *launches[i];
    const std::string name = fmt::format("{} {}", escaped_text(each, "kind"), each["number"].dump());
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", linked(one, each, name)) +
            cell(escaped_text(each, "shader")) + cell(escaped_text(each, "label")) +
            cell(shown(each["frame"]), true) + cell(size_of(each), true) + cell(shown(each["cycles"]), true) +
            cell(fmt::format("{:.1f} %",
                             100 * each["cycles"].get<double>() / double(std::max<uint64_t>(1, all_cycles))),
                 true) +
            cell(shown(each["instructions"]), true) + cell(shown(each["faults"]), true) + "</tr>\n";
  }
  const std::string rest =
      launches.size() > kMostRows
          ? fmt::format("<p class=\"note\">{} launches with fewer cycles are in index.json.</p>\n",
                        launches.size() - kMostRows)
          : "";
  return table("launches",
               {"Launch", "Shader", "Label", "Frame", "Size", "Cycles", "Of all timed", "Warp instructions",
                "Faults"},
               rows) +
         rest;
}

std::string shader_table(const Json& index) {
  struct Sum {
    std::string name;
    uint64_t launches = 0, timed = 0, instructions = 0, cycles = 0;
  };
  std::vector<Sum> sums;
  std::map<std::string, size_t> place;
  for (const Json& command : index["commands"]) {
    if (!is_launch(command)) continue;
    const std::string name = command["shader"];
    const auto [at, is_new] = place.emplace(name, sums.size());
    if (is_new) sums.push_back({.name = name});
    Sum& sum = sums[at->second];
    ++sum.launches, sum.instructions += command["instructions"].get<uint64_t>();
    if (is_timed(command)) ++sum.timed, sum.cycles += command["cycles"].get<uint64_t>();
  }
  std::stable_sort(sums.begin(), sums.end(), [](const Sum& a, const Sum& b) {
    return std::pair(a.cycles, a.instructions) > std::pair(b.cycles, b.instructions);
  });
  std::string rows;
  for (size_t i = 0; i < std::min(sums.size(), kMostRows); ++i)
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", escaped(sums[i].name)) +
            cell(shown(sums[i].launches), true) + cell(shown(sums[i].instructions), true) +
            cell(shown(sums[i].timed), true) + cell(shown(sums[i].cycles), true) + "</tr>\n";
  return table("shaders", {"Shader", "Launches", "Warp instructions", "Timed", "Cycles of these"}, rows);
}

// Returns the section of the frames that were presented, or "" when none was.
std::string frames_section(const Json& one) {
  struct Sum {
    uint64_t launches = 0, timed = 0, instructions = 0, cycles = 0;
  };
  std::map<uint64_t, Sum> sums;
  std::vector<const Json*> frames;
  for (const Json& command : one["index"]["commands"]) {
    if (is_present(command)) frames.push_back(&command);
    if (!is_launch(command)) continue;
    Sum& sum = sums[command["frame"].get<uint64_t>()];
    ++sum.launches, sum.instructions += command["instructions"].get<uint64_t>();
    if (is_timed(command)) ++sum.timed, sum.cycles += command["cycles"].get<uint64_t>();
  }
  if (frames.empty()) return "";
  std::string rows;
  for (size_t i = 0; i < std::min(frames.size(), kMostRows); ++i) {
    const Json& frame = *frames[i];
    const Sum& sum = sums[frame["frame"].get<uint64_t>()];
    const std::string file = frame.contains("file") ? escaped_text(frame, "file") : "";
    rows += fmt::format("<tr><th scope=\"row\">{}</th>", frame["frame"].dump()) + cell(size_of(frame), true) +
            cell(shown(sum.launches), true) + cell(shown(sum.instructions), true) +
            cell(shown(sum.timed), true) + cell(shown(sum.cycles), true) +
            cell(shown(frame.value("dropped", uint64_t{0})), true) +
            cell(file.empty() ? "" : fmt::format("<a href=\"{0}\">{0}</a>", file)) + "</tr>\n";
  }
  const std::string rest = frames.size() > kMostRows
                               ? fmt::format("<p class=\"note\">{} later frames are in index.json.</p>\n",
                                             frames.size() - kMostRows)
                               : "";
  return fmt::format(
             "<section id=\"frames\">\n<h2>Frames</h2>\n<p class=\"lead\">{} frames were presented. "
             "A launch belongs to the frame that was presented next.</p>\n",
             shown(frames.size())) +
         table("frames",
               {"Frame", "Pixels", "Launches", "Warp instructions", "Timed", "Cycles of these",
                "Dropped draws", "Picture"},
               rows) +
         rest + "</section>\n";
}

// Returns the section of what did not work, or "" when all did.
std::string trouble(const Json& index) {
  std::string rows;
  const auto add = [&](const std::string& kind, const std::string& what, const std::string& why) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"doc\">{}</td></tr>\n", kind,
                        escaped(what), escaped(why));
  };
  for (const Json& command : index["commands"])
    if (const std::string error = command.value("error", ""); !error.empty())
      add("failed", name_of(command), error);
  for (const Json& each : index["dropped"])
    add("dropped", fmt::format("{}, {} times", each["what"].get<std::string>(), each["count"].dump()),
        each["why"]);
  for (const Json& each : index["refused"])
    add("refused", fmt::format("{}, {} times", each["what"].get<std::string>(), each["count"].dump()),
        each["why"]);
  if (rows.empty()) return "";
  return "<section id=\"trouble\">\n<h2>What did not work</h2>\n<p class=\"lead\">A failed launch ended the "
         "device, a "
         "dropped command did nothing, and a refused call returned an error.</p>\n" +
         table("trouble", {"", "What", "Why"}, rows) + "</section>\n";
}

std::string sections_of(const Json& one) {
  const Json& index = one["index"];
  uint64_t launches = 0, timed = 0, builds = 0, cycles = 0, end = 0;
  for (const Json& command : index["commands"]) {
    end = std::max(end, command["end"].get<uint64_t>());
    builds += is_build(command);
    launches += is_launch(command);
    if (is_timed(command)) ++timed, cycles += command["cycles"].get<uint64_t>();
  }
  const std::vector<std::string> words = index.value("command", std::vector<std::string>());
  std::string out = fmt::format(
      "<section id=\"application\">\n<h2>Application</h2>\n<p class=\"lead\"><code>{}</code> had {} launches "
      "on {}, "
      "of which {} were timed (<code>{}</code>): {} cycles.{}</p>\n{}"
      "<p class=\"note\">Commands run one after another. A launch that was not timed takes the time that its "
      "instructions need at least, and a transfer that of its bytes at the memory’s "
      "peak.{}</p>\n</section>\n",
      escaped(fmt::format("{}", fmt::join(words, " "))), shown(launches), escaped_text(index, "config"),
      shown(timed), escaped_text(index, "timing"), shown(cycles),
      index["state"] == "ended" ? "" : " <strong>The application did not end, or still runs.</strong>",
      time_line(one, end),
      builds ? fmt::format(" The {} builds of acceleration structures take no simulated time: the time line "
                           "shows when they happened.",
                           shown(builds))
             : "");
  if (timed)
    out +=
        "<section id=\"launches\">\n<h2>Launches by cycles</h2>\n<p class=\"lead\">These launches ran on the "
        "timing "
        "machine. A link leads to the launch’s own report.</p>\n" +
        launch_table(one, cycles) + "</section>\n";
  if (launches)
    out +=
        "<section id=\"shaders\">\n<h2>Shaders</h2>\n<p class=\"lead\">All launches, summed by "
        "shader.</p>\n" +
        shader_table(index) + "</section>\n";
  return out + frames_section(one) + trouble(index);
}

}  // namespace

std::vector<std::string> timed_folders(const Json& index) {
  std::vector<std::string> out;
  for (const Json* each : by_cycles(index))
    if (const std::string folder = each->value("folder", "");
        folder.starts_with("launch-") && folder.find('/') == std::string::npos)
      out.push_back(folder);
  return out;
}

std::string application_sections(const Json& data) {
  std::string out;
  for (const Json& one : data.value("applications", Json::array())) out += sections_of(one);
  return out;
}

}  // namespace glint::report
