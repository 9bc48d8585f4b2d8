// Defines statistics, which are declared once as members and visited by every writer.
//
// A statistic is a member with a name, a unit and a sentence. It registers with its Group, and the tree of
// groups is the tree of instances. Ratios are computed when they are read. No format knows a unit of
// hardware, and no unit knows a format.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::stats {

class Group;
class Visitor;

// Holds what every statistic has: a name, a unit and a description. A member registers itself with its Group,
// so a statistic appears in every output format once it is declared, and no other list names it.
class Stat {
 public:
  Stat(Group* group, std::string_view name, std::string_view unit, std::string_view doc);
  Stat(const Stat&) = delete;
  Stat& operator=(const Stat&) = delete;
  virtual ~Stat() = default;
  virtual void accept(Visitor& visitor) const = 0;
  // Adds what the same statistic has counted in another run. What is computed when it is read adds nothing.
  virtual void take_in(const Stat&) {}

  std::string_view name() const { return name_; }
  std::string_view unit() const { return unit_; }
  std::string_view doc() const { return doc_; }

 private:
  std::string_view name_, unit_, doc_;
};

class Counter final : public Stat {
 public:
  using Stat::Stat;
  Counter& operator++() {
    ++value_;
    return *this;
  }
  Counter& operator+=(uint64_t n) {
    value_ += n;
    return *this;
  }
  uint64_t value() const { return value_; }
  void accept(Visitor& visitor) const override;
  void take_in(const Stat& other) override { value_ += static_cast<const Counter&>(other).value_; }

 private:
  uint64_t value_ = 0;
};

// Declares the quotient of two counters. It is computed when it is read, so it cannot disagree with the
// counters.
class Ratio final : public Stat {
 public:
  Ratio(Group* group, std::string_view name, std::string_view unit, const Counter& num, const Counter& den,
        std::string_view doc)
      : Stat(group, name, unit, doc), num_(num), den_(den) {}
  double value() const { return den_.value() ? double(num_.value()) / double(den_.value()) : 0.0; }
  void accept(Visitor& visitor) const override;

 private:
  const Counter& num_;
  const Counter& den_;
};

// Declares a value that is computed, when it is read, from anything else in the unit, such as a sum over
// instances or a peak.
class Value final : public Stat {
 public:
  // `join`, when given, takes in the value of another run, as a peak has to.
  Value(Group* group, std::string_view name, std::string_view unit, std::function<double()> read,
        std::string_view doc, std::function<void(double)> join = {})
      : Stat(group, name, unit, doc), read_(std::move(read)), join_(std::move(join)) {}
  double value() const { return read_(); }
  void accept(Visitor& visitor) const override;
  void take_in(const Stat& other) override {
    if (join_) join_(static_cast<const Value&>(other).value());
  }

 private:
  std::function<double()> read_;
  std::function<void(double)> join_;
};

// Defines bins of equal width over [low, high). Values below and above count in the first and last bin.
struct Bins {
  uint64_t low, high, step;
};
constexpr Bins linear(uint64_t low, uint64_t high, uint64_t step) {
  return {low, high, step};
}

class Histogram final : public Stat {
 public:
  Histogram(Group* group, std::string_view name, std::string_view unit, Bins bins, std::string_view doc)
      : Stat(group, name, unit, doc), bins_(bins), counts_((bins.high - bins.low) / bins.step) {}
  void add(uint64_t x) { ++counts_[bin_of(x)]; }
  // Takes back an add() of the same value. A unit uses it when something counted goes on and will be counted
  // again at its end.
  void remove(uint64_t x) { --counts_[bin_of(x)]; }
  const Bins& bins() const { return bins_; }
  const std::vector<uint64_t>& counts() const { return counts_; }
  uint64_t total() const {
    uint64_t sum = 0;
    for (uint64_t n : counts_) sum += n;
    return sum;
  }
  void accept(Visitor& visitor) const override;
  void take_in(const Stat& other) override {
    const auto& counts = static_cast<const Histogram&>(other).counts_;
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += counts[i];
  }

 private:
  std::size_t bin_of(uint64_t x) const {
    const uint64_t bin = x < bins_.low ? 0 : (x - bins_.low) / bins_.step;
    return std::size_t(bin < counts_.size() ? bin : counts_.size() - 1);
  }

  Bins bins_;
  std::vector<uint64_t> counts_;
};

// Holds the part of a Breakdown that a visitor sees. It is the same for every enum.
class BreakdownBase : public Stat {
 public:
  using Stat::Stat;
  virtual std::vector<std::pair<std::string_view, uint64_t>> parts() const = 0;
  void accept(Visitor& visitor) const override;
};

// Holds one counter for each value of an enum. Cycle accounting uses it and adds every cycle to exactly one
// reason.
template <class Enum>  // Enum needs a value Enum::Count and a constexpr name_of(Enum) found by ADL
class Breakdown final : public BreakdownBase {
 public:
  using BreakdownBase::BreakdownBase;
  void add(Enum reason, uint64_t n = 1) { counts_[std::size_t(reason)] += n; }
  std::vector<std::pair<std::string_view, uint64_t>> parts() const override {
    std::vector<std::pair<std::string_view, uint64_t>> out;
    for (std::size_t i = 0; i < counts_.size(); ++i) out.emplace_back(name_of(Enum(i)), counts_[i]);
    return out;
  }
  uint64_t count(Enum reason) const { return counts_[std::size_t(reason)]; }
  uint64_t total() const {
    uint64_t sum = 0;
    for (uint64_t n : counts_) sum += n;
    return sum;
  }
  void take_in(const Stat& other) override {
    const auto& counts = static_cast<const Breakdown&>(other).counts_;
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += counts[i];
  }

 private:
  std::array<uint64_t, std::size_t(Enum::Count)> counts_{};
};

class Group {
 public:
  Group(Group* parent, std::string name);
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  void accept(Visitor& visitor) const;
  const std::string& name() const { return name_; }
  // Adds what the same tree has counted in another run. Ratios and values are then those of both runs
  // together. The two runs are of the same machine.
  void take_in(const Group& other);

 private:
  friend class Stat;
  std::string name_;
  std::vector<Stat*> stats_;
  std::vector<Group*> children_;
};

class Visitor {
 public:
  virtual ~Visitor() = default;
  virtual void enter(const Group& group) = 0;
  virtual void leave(const Group& group) = 0;
  virtual void visit(const Counter& stat) = 0;
  virtual void visit(const Ratio& stat) = 0;
  virtual void visit(const Value& stat) = 0;
  virtual void visit(const Histogram& stat) = 0;
  virtual void visit(const BreakdownBase& stat) = 0;
};

}  // namespace glint::stats
