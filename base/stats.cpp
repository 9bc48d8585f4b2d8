// Registers statistics with their groups and visits them.
// SPDX-License-Identifier: Apache-2.0
#include "base/stats.h"

#include "base/check.h"

namespace glint::stats {

Stat::Stat(Group* group, std::string_view name, std::string_view unit, std::string_view doc)
    : name_(name), unit_(unit), doc_(doc) {
  group->stats_.push_back(this);
}
void Counter::accept(Visitor& visitor) const {
  visitor.visit(*this);
}
void Ratio::accept(Visitor& visitor) const {
  visitor.visit(*this);
}
void Value::accept(Visitor& visitor) const {
  visitor.visit(*this);
}
void Histogram::accept(Visitor& visitor) const {
  visitor.visit(*this);
}
void BreakdownBase::accept(Visitor& visitor) const {
  visitor.visit(*this);
}

Group::Group(Group* parent, std::string name) : name_(std::move(name)) {
  if (parent) parent->children_.push_back(this);
}
void Group::accept(Visitor& visitor) const {
  visitor.enter(*this);
  for (const Stat* stat : stats_) stat->accept(visitor);
  for (const Group* child : children_) child->accept(visitor);
  visitor.leave(*this);
}

void Group::take_in(const Group& other) {
  GLINT_CHECK(stats_.size() == other.stats_.size() && children_.size() == other.children_.size(),
              "the statistics of '{}' are of another machine", name_);
  for (size_t i = 0; i < stats_.size(); ++i) stats_[i]->take_in(*other.stats_[i]);
  for (size_t i = 0; i < children_.size(); ++i) children_[i]->take_in(*other.children_[i]);
}

}  // namespace glint::stats
