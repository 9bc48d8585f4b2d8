// Implements the cache of a core behind its instruction and constant caches.
// SPDX-License-Identifier: Apache-2.0
#include "core/code_cache.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace glint::core {

CodeCache::CodeCache(const CodeCacheParams& params, uint32_t most, mem::L1Port& l1, CodeStats& stats)
    : there_(params.latency / 2),
      back_(params.latency - params.latency / 2),
      line_bytes_(l1.line_bytes()),
      l1_(l1),
      stats_(stats),
      tags_(mem::cache_shape(params.size, params.ways, line_bytes_), params.replacement),
      asked_(most),
      hits_(most),
      fills_(most),
      missing_(most) {
  answers_.reserve(size_t{most} * kMaxClients);
}

void CodeCache::ask(uint32_t client, Address line, mem::Traffic traffic, Cycle now) {
  GLINT_DCHECK(client < kMaxClients && line % line_bytes_ == 0, "client {}, line {:#x}", client, line);
  asked_.push({now, client, line, traffic});
  ++stats_.cache_reads;
}

void CodeCache::tick(Cycle now) {
  answers_.clear();
  take_fills(now);
  answer(hits_, now);
  answer(fills_, now);
  look_up(now);
  send(now);
}

// Looks up one line. The cycle from the request to this look-up is the first of the latency, so an unloaded
// cache adds exactly its latency.
void CodeCache::look_up(Cycle now) {
  if (asked_.empty() || now < lookup_free_ || now <= asked_.front().at) return;
  const Asked asked = asked_.front();
  asked_.pop();
  lookup_free_ = now + 1;
  if (const uint32_t slot = tags_.find(asked.line); slot != mem::TagArray::kNone) {
    tags_.touch(slot);
    hits_.push({now - 1 + there_ + back_, 1u << asked.client, asked.line});
  } else {
    miss(asked, now);
  }
}

void CodeCache::miss(const Asked& asked, Cycle now) {
  ++stats_.cache_misses;
  Missing* free = nullptr;
  uint32_t used = num_missing_;  // Entries are taken from the front, so that few are looked at.
  for (size_t i = 0; i < missing_.size() && (used || !free); ++i) {
    Missing& missing = missing_[i];
    if (missing.clients && missing.line == asked.line) {
      missing.clients |= 1u << asked.client;
      return;
    }
    if (missing.clients)
      --used;
    else if (!free)
      free = &missing;
  }
  GLINT_CHECK(free, "more lines are missing than are waited for");
  *free = {asked.line, now - 1 + there_, 1u << asked.client, false, asked.traffic};
  ++num_missing_;
  ++num_unsent_;
}

void CodeCache::send(Cycle now) {
  const auto sectors = uint8_t((1u << line_bytes_ / mem::kSectorBytes) - 1);
  uint32_t unseen = num_unsent_;
  for (size_t i = 0; unseen; ++i) {
    Missing& missing = missing_[i];
    if (!missing.clients || missing.sent) continue;
    --unseen;
    if (missing.send_at > now) continue;
    if (!l1_.access(now, mem::Client::Code, {missing.line, sectors, false, missing.traffic, mem::Token(i)}))
      return;
    missing.sent = true;
    --num_unsent_;
  }
}

void CodeCache::take_fills(Cycle now) {
  while (const auto token = l1_.pop(now, mem::Client::Code)) {
    Missing& missing = missing_[*token];
    tags_.keep(missing.line);
    fills_.push({now + back_, missing.clients, missing.line});
    missing.clients = 0;
    --num_missing_;
  }
}

void CodeCache::answer(mem::Ring<Timed>& from, Cycle now) {
  for (; !from.empty() && from.front().at <= now; from.pop())
    for (uint32_t rest = from.front().clients; rest; rest &= rest - 1)
      answers_.push_back({uint32_t(std::countr_zero(rest)), from.front().line});
}

Cycle CodeCache::next_event(Cycle now) const {
  Cycle next = kNever;
  if (!asked_.empty()) next = std::max(asked_.front().at + 1, lookup_free_);
  if (!hits_.empty()) next = std::min(next, hits_.front().at);
  if (!fills_.empty()) next = std::min(next, fills_.front().at);
  uint32_t unseen = num_unsent_;
  for (size_t i = 0; unseen; ++i)
    if (const Missing& missing = missing_[i]; missing.clients && !missing.sent) {
      next = std::min(next, missing.send_at);
      --unseen;
    }
  return next == kNever ? kNever : std::max(next, now + 1);
}

}  // namespace glint::core
