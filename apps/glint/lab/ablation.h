// Plans an ablation: two configurations, the groups of keys in which they differ, and the machines between.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "setup/resources.h"

namespace glint::app {

// Holds keys that change together, with the values that they have in the second configuration.
struct AblationGroup {
  std::string name;  // a key, or the table of its keys, such as "memory.l1"
  std::vector<std::string> settings;
};

// Says how a machine came about: one of the two configurations, the first one with one group changed, the
// second one with one group as in the first, or the first one with a group and all groups before it changed.
enum class AblationKind { From, To, Alone, Back, Step };

struct AblationArm {
  AblationKind kind = AblationKind::From;
  size_t group = 0;                   // of Alone, Back and Step
  std::string folder;                 // Arms with the same machine share it.
  std::vector<std::string> settings;  // on top of the first configuration
  std::string refused;                // why no such machine can be; then nothing runs
};

struct AblationOptions {
  std::string from, to;            // presets or files
  bool by_key = false;             // Every key is a group of its own.
  std::vector<std::string> only;   // Only keys that begin so change; none: all.
  std::vector<std::string> order;  // groups that come first
  bool alone = true, back = true, steps = true;
};

struct Ablation {
  AblationOptions options;
  std::vector<AblationGroup> groups;  // in the order of the steps
  std::vector<AblationArm> arms;
  // Returns the arm, or null when it was not asked for.
  const AblationArm* find(AblationKind kind, size_t group = 0) const;
};

// Plans the machines. Keys of the tables `core`, `memory`, `rt` and the like are groups of their own, and
// deeper tables are one group each. Throws UserError when the configurations do not differ, or for a group
// that there is not.
Ablation plan_ablation(const setup::Resources& resources, const AblationOptions& options);

// Holds the means over the workloads of each metric, by folder of an arm; cycles have a geometric mean.
using AblationMeans = std::map<std::string, std::map<std::string, double>>;
// Reads the runs in the folders of the arms below `folder`.
AblationMeans read_means(const Ablation& ablation, const std::string& folder);

// Returns what a group does to a metric: alone, back or as a step; nothing where an arm is absent.
std::optional<double> effect_of(const Ablation& ablation, const AblationMeans& means,
                                const std::string& metric, AblationKind kind, size_t group);

// Returns the table of effects of each metric for a terminal, the same as CSV, and a page with a waterfall of
// the steps for each metric.
std::string ablation_table(const Ablation& ablation, const AblationMeans& means,
                           const std::vector<std::string>& metrics);
std::string ablation_csv(const Ablation& ablation, const AblationMeans& means);
std::string ablation_page(const Ablation& ablation, const AblationMeans& means,
                          const std::vector<std::string>& metrics);

}  // namespace glint::app
