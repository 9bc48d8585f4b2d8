// Runs the genetic algorithm: sets of metrics breed, change by one metric, and move between islands.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/metric_search.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <random>
#include <utility>

namespace glint::report {
namespace {

struct Individual {
  std::vector<int> columns;  // sorted
  double fitness = -2;
};

bool is_better(const Individual& a, const Individual& b) {
  return a.fitness != b.fitness ? a.fitness > b.fitness : a.columns < b.columns;
}

// Draws random numbers. Those of std::mt19937_64 are the same everywhere; those of the standard's
// distributions are not.
class Dice {
 public:
  explicit Dice(uint64_t seed) : engine_(seed) {}
  int below(size_t bound) { return int(engine_() % bound); }

 private:
  std::mt19937_64 engine_;
};

class Search {
 public:
  Search(const DistanceFitness& fitness, const SearchSettings& settings)
      : fitness_(fitness),
        settings_(settings),
        total_(int(fitness.metrics())),
        count_(std::clamp(settings.count, 1, total_)),
        dice_(settings.seed) {}

  ChosenMetrics run() {
    for (int i = 0; i < settings_.islands; ++i) islands_.push_back(founders());
    best_ = best_of_all();
    for (int quiet = 0; quiet < settings_.patience && generations_ < settings_.generations; ++quiet) {
      ++generations_;
      for (std::vector<Individual>& island : islands_) island = next_generation(island);
      if (generations_ % settings_.exchange == 0) exchange();
      if (Individual now = best_of_all(); now.fitness > best_.fitness) {
        best_ = std::move(now);
        quiet = 0;
      }
    }
    while (exchange_one()) {
    }
    return result();
  }

 private:
  Individual judged(std::vector<int> columns) {
    std::ranges::sort(columns);
    ++evaluations_;
    const double fitness = fitness_(columns);
    return {std::move(columns), fitness};
  }

  // Returns `columns`, filled up with random others until there are enough.
  std::vector<int> filled(std::vector<int> columns) {
    while (int(columns.size()) < count_)
      if (const int column = dice_.below(size_t(total_)); std::ranges::find(columns, column) == columns.end())
        columns.push_back(column);
    return columns;
  }

  std::vector<Individual> founders() {
    std::vector<Individual> out;
    for (int i = 0; i < settings_.population; ++i) out.push_back(judged(filled({})));
    std::ranges::sort(out, is_better);
    return out;
  }

  // Returns the better of two random members. An island is sorted with the best first.
  const Individual& parent(const std::vector<Individual>& island) {
    return island[size_t(std::min(dice_.below(island.size()), dice_.below(island.size())))];
  }

  // Returns what both parents have, and a random part of what one has.
  Individual child(const Individual& a, const Individual& b) {
    std::vector<int> columns, one;
    std::ranges::set_intersection(a.columns, b.columns, std::back_inserter(columns));
    std::ranges::set_symmetric_difference(a.columns, b.columns, std::back_inserter(one));
    while (int(columns.size()) < count_) {
      const auto pick = one.begin() + dice_.below(one.size());
      columns.push_back(*pick);
      one.erase(pick);
    }
    // Half of the children have one metric exchanged, a quarter have two, and so on.
    while (dice_.below(2) == 0) {
      columns.erase(columns.begin() + dice_.below(columns.size()));
      columns = filled(std::move(columns));
    }
    return judged(std::move(columns));
  }

  std::vector<Individual> next_generation(const std::vector<Individual>& island) {
    // The two best stay.
    std::vector<Individual> out(island.begin(),
                                island.begin() + std::min<std::ptrdiff_t>(2, std::ssize(island)));
    while (out.size() < island.size()) out.push_back(child(parent(island), parent(island)));
    std::ranges::sort(out, is_better);
    // Twins are replaced by newcomers, because otherwise an island soon holds one set many times.
    const auto twins = std::unique(out.begin(), out.end(), [](const Individual& a, const Individual& b) {
      return a.columns == b.columns;
    });
    std::for_each(twins, out.end(), [&](Individual& twin) { twin = judged(filled({})); });
    std::ranges::sort(out, is_better);
    return out;
  }

  void exchange() {
    std::vector<Individual> best;
    for (const std::vector<Individual>& island : islands_) best.push_back(island.front());
    for (size_t i = 0; i < islands_.size(); ++i) {
      islands_[i].back() = best[(i + 1) % islands_.size()];
      std::ranges::sort(islands_[i], is_better);
    }
  }

  Individual best_of_all() const {
    Individual best;
    for (const std::vector<Individual>& island : islands_)
      if (is_better(island.front(), best)) best = island.front();
    return best;
  }

  // Makes the best exchange of one metric of best_ for another. Returns false when no exchange is better.
  bool exchange_one() {
    Individual better = best_;
    for (size_t at = 0; at < best_.columns.size(); ++at) {
      for (int column = 0; column < total_; ++column) {
        if (std::ranges::find(best_.columns, column) != best_.columns.end()) continue;
        std::vector<int> columns = best_.columns;
        columns[at] = column;
        if (Individual other = judged(std::move(columns)); other.fitness > better.fitness)
          better = std::move(other);
      }
    }
    if (better.fitness <= best_.fitness) return false;
    best_ = std::move(better);
    return true;
  }

  ChosenMetrics result() const {
    ChosenMetrics out{
        .metrics = {}, .fitness = best_.fitness, .generations = generations_, .evaluations = evaluations_};
    for (const int column : best_.columns) {
      std::vector<int> others = best_.columns;
      std::erase(others, column);
      out.metrics.push_back({column, others.empty() ? 0 : fitness_(others)});
    }
    std::ranges::stable_sort(out.metrics, {}, &ChosenMetrics::Metric::fitness_without);
    return out;
  }

  const DistanceFitness& fitness_;
  SearchSettings settings_;
  int total_, count_;
  Dice dice_;
  std::vector<std::vector<Individual>> islands_;
  Individual best_;
  int generations_ = 0;
  int64_t evaluations_ = 0;
};

}  // namespace

DistanceFitness::DistanceFitness(const Eigen::MatrixXd& standardised) {
  const Eigen::Index n = standardised.rows();
  squares_.resize(n * (n - 1) / 2, standardised.cols());
  for (Eigen::Index i = 0, at = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j)
      squares_.row(at++) = (standardised.row(i) - standardised.row(j)).array().square();
  full_ = squares_.rowwise().sum().sqrt();
  full_ -= full_.mean();
  if (const double size = full_.matrix().norm(); size > 0) full_ /= size;
}

double DistanceFitness::operator()(const std::vector<int>& chosen) const {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(squares_.rows());
  for (const int column : chosen) sum += squares_.col(column);
  sum = sum.sqrt();
  sum -= sum.mean();
  const double size = sum.matrix().norm();
  return size > 0 ? (sum * full_).sum() / size : 0;
}

ChosenMetrics choose_metrics(const DistanceFitness& fitness, const SearchSettings& settings) {
  return Search(fitness, settings).run();
}

}  // namespace glint::report
