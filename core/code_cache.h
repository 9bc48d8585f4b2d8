// Models the cache behind a core's instruction and constant caches (level 1.5). Misses go through the core's
// port to the L2.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/code_params.h"
#include "core/code_stats.h"
#include "memsys/cache/tag_array.h"
#include "memsys/l1_port.h"
#include "memsys/ring.h"

namespace glint::core {

// Looks up one line per cycle, in the order of the requests. A line that is already on its way is requested
// only once, however many clients wait for it.
class CodeCache {
 public:
  static constexpr uint32_t kMaxClients = 16;
  struct Answer {
    uint32_t client = 0;
    Address line = 0;
  };

  // `most` is the number of lines that all clients together may wait for at a time.
  CodeCache(const CodeCacheParams& params, uint32_t most, mem::L1Port& l1, CodeStats& stats);

  void ask(uint32_t client, Address line, mem::Traffic traffic, Cycle now);
  // Advances to `now`. Afterwards answers() holds the lines that come in this cycle, once for each client
  // that waits.
  void tick(Cycle now);
  std::span<const Answer> answers() const { return answers_; }
  Cycle next_event(Cycle now) const;  // The L1's answers are the L1's events.
  bool idle() const { return asked_.empty() && hits_.empty() && fills_.empty() && num_missing_ == 0; }
  uint32_t line_bytes() const { return line_bytes_; }

 private:
  struct Asked {
    Cycle at = 0;
    uint32_t client = 0;
    Address line = 0;
    mem::Traffic traffic = mem::Traffic::Instruction;
  };
  struct Missing {
    Address line = 0;
    Cycle send_at = 0;
    uint32_t clients = 0;  // one bit per client; 0: the entry is free
    bool sent = false;
    mem::Traffic traffic = mem::Traffic::Instruction;
  };
  struct Timed {
    Cycle at = 0;
    uint32_t clients = 0;
    Address line = 0;
  };

  void look_up(Cycle now);
  void miss(const Asked& asked, Cycle now);
  void send(Cycle now);
  void take_fills(Cycle now);
  void answer(mem::Ring<Timed>& from, Cycle now);

  const uint32_t there_, back_, line_bytes_;
  mem::L1Port& l1_;
  CodeStats& stats_;
  mem::TagArray tags_;
  mem::Ring<Asked> asked_;
  mem::Ring<Timed> hits_, fills_;
  std::vector<Missing> missing_;
  uint32_t num_missing_ = 0, num_unsent_ = 0;
  Cycle lookup_free_ = 0;
  std::vector<Answer> answers_;  // reserved once
};

}  // namespace glint::core
