// Declares the interface of the parts that send requests through the RT unit's port to the L1.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/types.h"

namespace glint::rt {

// RtUnit lists its sources by priority and asks the first that has a request.
class RequestSource {
 public:
  virtual ~RequestSource() = default;
  virtual bool has_request(Cycle now) const = 0;
  // Sends one request. Returns false when the L1 refuses it; nothing has changed then.
  virtual bool send(Cycle now) = 0;
  // Returns whether a read waits here that needs an entry for its answer. It must wait while all entries are
  // in use.
  virtual bool has_reads_waiting() const { return false; }
  // Returns the earliest cycle after `now` in which the source has something to do without new input.
  virtual Cycle next_event(Cycle now) const { return has_request(now) ? now + 1 : kNever; }
};

}  // namespace glint::rt
