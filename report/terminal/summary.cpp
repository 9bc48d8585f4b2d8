// Lays out the run summary.
// SPDX-License-Identifier: Apache-2.0
#include "report/terminal/summary.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace glint::report {
namespace {

using Rows = std::vector<std::vector<std::string>>;
constexpr int kShareBarWidth = 20;  // columns

std::string paint(const std::string& text, const char* code, const Terminal& terminal) {
  return terminal.colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}
std::string heading(const std::string& text, const Terminal& terminal) {
  return paint(text, "1", terminal);
}
std::string shaded_bar(double fraction, const Terminal& terminal) {
  return paint(bar(fraction, kShareBarWidth, terminal), "36", terminal);
}

void add_fraction(Rows& rows, const std::string& name, std::optional<double> fraction,
                  const std::string& remark, const Terminal& terminal) {
  if (fraction) rows.push_back({name, percent(*fraction), shaded_bar(*fraction, terminal), remark});
}

void add_hit_rate(Rows& rows, const std::string& name, const HitRate& rate, const Terminal& terminal) {
  if (rate.accesses == 0)
    rows.push_back({name, "-", "", "no accesses"});
  else
    add_fraction(rows, name, part(rate.hits, rate.accesses),
                 fmt::format("{} of {} accesses", with_thousands(rate.hits), with_thousands(rate.accesses)),
                 terminal);
}

std::string execution(const Summary& s) {
  Rows rows;
  if (s.timing && s.timing->cycles > 0) {
    const TimingSummary& t = *s.timing;
    rows.push_back({"cycles", with_thousands(t.cycles),
                    t.clock_mhz > 0 ? fmt::format("= {:.3f} ms at {:g} MHz",
                                                  double(t.cycles) / (t.clock_mhz * 1000), t.clock_mhz)
                                    : ""});
    rows.push_back({"IPC", fmt::format("{:.3f}", part(s.warp_instructions, t.cycles)),
                    "warp instructions per cycle of all cores"});
    if (t.warp_slots > 0)
      rows.push_back({"warps per core", fmt::format("{} of {}", t.resident_warps, t.warp_slots),
                      fmt::format("at most, limited by {}", t.residency_limit)});
  }
  rows.push_back({"warp instructions", with_thousands(s.warp_instructions), ""});
  rows.push_back({"SIMT efficiency", percent(s.simt_efficiency), "lanes that do work"});
  return table(rows, "<><", " ");
}

std::string mix(const Summary& s, const Terminal& terminal) {
  uint64_t count = 0, latency = 0;
  for (const MixRow& row : s.mix) count += row.count, latency += row.latency;
  Rows rows{{"class", "instructions", "share", ""}};
  if (latency > 0) rows[0].insert(rows[0].end(), {"latency", ""});
  for (const MixRow& row : s.mix) {
    std::vector<std::string> cells{row.name, with_thousands(row.count), percent(part(row.count, count)),
                                   shaded_bar(part(row.count, count), terminal)};
    if (latency > 0) {
      cells.push_back(percent(part(row.latency, latency)));
      cells.push_back(shaded_bar(part(row.latency, latency), terminal));
    }
    rows.push_back(std::move(cells));
  }
  return table(rows, "<>><>", " ");
}

std::string peaks(const TimingSummary& t) {
  return t.memory_peaks.empty() ? "" : " at best: " + t.memory_peaks + "\n";
}

std::string machine(const TimingSummary& t, const Terminal& terminal) {
  Rows rows;
  add_hit_rate(rows, "L1D hits, RT unit", t.l1_rt, terminal);
  add_hit_rate(rows, "L1D hits, shaders", t.l1_shader, terminal);
  add_hit_rate(rows, "L2 hits", t.l2, terminal);
  add_fraction(rows, "DRAM utilisation", t.dram_utilisation, "of the data bus", terminal);
  add_fraction(rows, "DRAM efficiency", t.dram_efficiency, "of the data bus while requests wait", terminal);
  add_fraction(rows, "RT-unit occupancy", t.rt_occupancy, "of its warp slots", terminal);
  add_fraction(rows, "RT-unit efficiency", t.rt_efficiency, "of resident lanes with a ray in flight",
               terminal);
  return table(rows, "<><<", " ");
}

std::string rays(const Summary& s) {
  Rows rows{{"rays", with_thousands(s.rays), ""}};
  if (s.rays > 0) {
    rows.push_back({"nodes per ray", fmt::format("{:.1f}", s.nodes_per_ray), ""});
    if (s.bvh_depth > 0)
      rows.push_back({"traversal ratio", fmt::format("{:.2f}", s.nodes_per_ray / s.bvh_depth),
                      fmt::format("nodes per ray / BVH depth {}", s.bvh_depth)});
  }
  return table(rows, "<><", " ");
}

std::string speed(const Summary& s) {
  Rows rows{{"wall time", seconds(s.wall_seconds)}};
  if (s.wall_seconds > 0) {
    std::string text = rate(double(s.warp_instructions) / s.wall_seconds) + " warp instructions/s";
    if (s.timing) text += ", " + rate(double(s.timing->cycles) / s.wall_seconds) + " cycles/s";
    rows.push_back({"simulation speed", text});
  }
  return table(rows, "<<", " ");
}

std::string quantity(double value, const std::string& unit) {
  return unit == "fraction" ? percent(value)
         : value < 1000     ? fmt::format("{:.3f}", value)
                            : with_thousands(uint64_t(value + 0.5));
}

std::string estimates(const SampleSummary& s) {
  Rows rows{{"estimate", "value", "95 % interval", ""}};
  for (const SampleSummary::Row& row : s.rows)
    rows.push_back({row.name, quantity(row.value, row.unit),
                    fmt::format("{} to {}", quantity(row.low, row.unit), quantity(row.high, row.unit)),
                    row.unit == "fraction" ? "" : row.unit});
  return " " + s.about + "\n" + table(rows, "<><<", " ");
}

// Returns the sections about what a launch did.
std::string counts(const Summary& s, const Terminal& terminal) {
  std::string out = "\n" + execution(s);
  if (!s.mix.empty()) out += "\n" + heading("Instruction mix", terminal) + "\n" + mix(s, terminal);
  if (s.timing)
    out += "\n" + heading("Memory and RT unit", terminal) + "\n" + peaks(*s.timing) +
           machine(*s.timing, terminal);
  return out + "\n" + heading("Rays", terminal) + "\n" + rays(s);
}

}  // namespace

std::string format_summary(const Summary& s, const Terminal& terminal) {
  std::string out = heading(s.title, terminal) + "\n";
  if (!s.note.empty()) out += " " + s.note + "\n";
  out += s.sample ? "\n" + heading("Estimates of the whole run", terminal) + "\n" + estimates(*s.sample)
                  : counts(s, terminal);
  out += "\n" + heading("Simulation", terminal) + "\n" + speed(s);
  for (const std::string& file : s.files) out += " " + file + "\n";
  return out;
}

}  // namespace glint::report
