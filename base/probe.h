// Defines a probe: a place in the model where something happens. It costs one branch while nobody listens.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <utility>
#include <vector>

namespace glint {

template <class Event>
class Probe {
 public:
  using Listener = std::function<void(const Event&)>;
  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }

  bool has_listeners() const { return !listeners_.empty(); }

  template <class Make>
  // `make` builds the event and runs only when somebody listens.
  void fire(Make&& make) const {
    if (listeners_.empty()) [[likely]]
      return;
    const Event event = make();
    for (const Listener& listener : listeners_) listener(event);
  }

 private:
  std::vector<Listener> listeners_;
};

}  // namespace glint
