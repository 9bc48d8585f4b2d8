// Draws frames that `glint export` wrote, on any Vulkan device that traces rays, and says how long they took.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "device.h"
#include "drawing.h"
#include "frame.h"

namespace rt_frames {
namespace {

constexpr const char* kUsage = R"(usage: rt_frames [OPTIONS] FOLDER...

Draws the frame of each FOLDER, which `glint export` wrote, and prints how long its rays took.

  --device NAME     use the first device whose name holds NAME (default: the first that traces rays)
  --warm-up N       trace each frame at least N times before the timed ones (default: 3)
  --warm-seconds S  go on with that for at least S seconds, so that clocks have risen (default: 0)
  --runs N          trace each frame N times and take the median (default: 11)
  --csv FILE        append a row for each frame; a new file gets a heading
  --picture FILE    write the picture of the last frame as a PFM file
)";
constexpr const char* kHeading =
    "frame,device,driver,width,height,depth,runs,median_ns,least_ns,most_ns,structure_bytes\n";

struct Options {
  std::vector<std::string> folders;
  std::string device, csv, picture;
  uint32_t warm_up = 3, runs = 11;
  double warm_seconds = 0;
};

uint32_t count_of(const std::string& text, const std::string& option) {
  char* end = nullptr;
  const unsigned long value = std::strtoul(text.c_str(), &end, 10);
  if (text.empty() || *end || text[0] == '-' || value > 1'000'000)
    throw std::runtime_error(option + " takes a number from 0 to 1000000, and '" + text + "' is none");
  return uint32_t(value);
}

double seconds_of(const std::string& text, const std::string& option) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end || !(value >= 0 && value <= 3600))
    throw std::runtime_error(option + " takes seconds from 0 to 3600, and '" + text + "' is none");
  return value;
}

Options read_options(const std::vector<std::string>& words) {
  Options out;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.rfind("--", 0) != 0) {
      out.folders.push_back(word);
      continue;
    }
    if (i + 1 == words.size())
      throw std::runtime_error(word + " is no option, or lacks its value; --help lists all");
    const std::string& value = words[++i];
    if (word == "--device")
      out.device = value;
    else if (word == "--csv")
      out.csv = value;
    else if (word == "--picture")
      out.picture = value;
    else if (word == "--warm-up")
      out.warm_up = count_of(value, word);
    else if (word == "--warm-seconds")
      out.warm_seconds = seconds_of(value, word);
    else if (word == "--runs")
      out.runs = std::max(1u, count_of(value, word));
    else
      throw std::runtime_error(word + " is no option; --help lists all");
  }
  if (out.folders.empty()) throw std::runtime_error("no folder is given; --help says more");
  return out;
}

// Returns a field of a CSV file: names of devices may hold commas.
std::string csv_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

void append_row(const Options& options, const std::string& row) {
  if (options.csv.empty()) return;
  const bool is_new = !std::ifstream(options.csv).good();
  std::ofstream out(options.csv, std::ios::app);
  if (!(out << (is_new ? kHeading : "") << row << std::flush))
    throw std::runtime_error("cannot write " + options.csv);
}

void draw(const Options& options, const std::string& folder) {
  const Frame frame = read_frame(folder);
  Device device(options.device);
  Drawing drawing(device, frame);
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  for (uint32_t i = 0; i < options.warm_up || seconds() < options.warm_seconds; ++i) drawing.trace();
  std::vector<double> times;
  for (uint32_t i = 0; i < options.runs; ++i) times.push_back(drawing.trace());
  std::sort(times.begin(), times.end());
  const double median = (times[(times.size() - 1) / 2] + times[times.size() / 2]) / 2;
  const auto [width, height, depth] = frame.launch;
  std::printf("%-12s %5u x %-5u %12.0f ns  (%.0f to %.0f in %u runs)  %s\n", frame.name.c_str(), width,
              height, median, times.front(), times.back(), options.runs, device.name.c_str());
  std::fflush(stdout);
  char numbers[200];
  std::snprintf(numbers, sizeof numbers, "%u,%u,%u,%u,%.0f,%.0f,%.0f,%llu\n", width, height, depth,
                options.runs, median, times.front(), times.back(),
                static_cast<unsigned long long>(drawing.structure_bytes()));
  append_row(options, csv_text(frame.name) + "," + csv_text(device.name) + "," + csv_text(device.driver) +
                          "," + numbers);
  if (options.picture.empty()) return;
  std::ofstream out(options.picture, std::ios::binary);
  if (!(out << drawing.picture() << std::flush)) throw std::runtime_error("cannot write " + options.picture);
}

int main_of(const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), "--help") != words.end()) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  try {
    const Options options = read_options(words);
    for (const std::string& folder : options.folders) draw(options, folder);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}

}  // namespace
}  // namespace rt_frames

int main(int argc, char** argv) {
  return rt_frames::main_of({argv + 1, argv + argc});
}
