// Describes an experiment of `glint lab`: a baseline, what is changed, and what a paper says of the effect.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"

namespace glint::app {

// Holds the values that count as the same effect, both ends included.
struct Band {
  double low = 0, high = 0;
  bool has(double value) const { return value >= low && value <= high; }
};

// Describes a number that an arm is also judged by. It is computed for each workload; the mean stands for
// all.
struct LabFigure {
  std::string name, formula;  // formula as in report/metrics/formula.h
  bool is_ratio = false;      // The number is divided by that of the arm's baseline.
  std::optional<double> published;
  std::optional<Band> expected;
};

// Describes one machine of the experiment: the configuration with these settings.
struct LabArm {
  std::string name;
  std::string against;  // the arm whose cycles are divided by this one's; "" for a baseline
  std::vector<std::string> settings, workloads;  // no workloads: those of the experiment
  std::vector<std::string> oracles;              // as --oracle names them
  std::optional<double> published;               // speed-up in the source: geometric mean
  std::optional<Band> expected;                  // of the geometric mean of the speed-ups
  std::optional<double> least;                   // no workload may have a smaller speed-up
  bool is_pair = false;                          // pairs.h has made it of two others
  std::optional<uint32_t> ao_reach;              // none: that of the experiment
  std::vector<LabFigure> figures;
};

struct Experiment {
  std::string name, title, source, config;
  SourceLocation config_where;
  std::vector<std::string> settings, workloads;  // settings of all arms
  std::string size = "128x128";
  uint32_t samples = 1, bounces = 16, ao_reach = 0;
  bool pairs = false;  // Arms with the same baseline run in pairs, too (pairs.h).
  std::vector<LabArm> arms;
};

// Reads an experiment. Throws UserError with file and line for whatever is wrong in it.
Experiment read_experiment(const std::string& path);

}  // namespace glint::app
