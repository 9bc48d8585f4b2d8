// Keeps what a core writes in a turn apart, then puts it into memory in the machine's one order.
// SPDX-License-Identifier: Apache-2.0
#include "exec/memory_view.h"

#include <algorithm>
#include <cstring>

namespace glint::exec {
namespace {

std::byte* line_start(const std::byte* at) {
  return reinterpret_cast<std::byte*>(reinterpret_cast<uintptr_t>(at) & ~uintptr_t{MemoryView::kLine - 1});
}
uint32_t offset_in_line(const std::byte* at) {
  return uint32_t(reinterpret_cast<uintptr_t>(at) & (MemoryView::kLine - 1));
}
size_t hash_of(const std::byte* line) {
  return size_t((reinterpret_cast<uintptr_t>(line) / MemoryView::kLine) * 0x9e3779b97f4a7c15ull >> 20);
}
uint64_t mask_of(uint32_t offset, uint32_t bytes) {
  return (bytes >= 64 ? ~uint64_t{0} : (uint64_t{1} << bytes) - 1) << offset;
}

// Calls visit(line, offset, done, count) for the parts of [at, at + bytes) that lie in one line each.
template <class Visit>
void for_each_part(const std::byte* at, uint32_t bytes, Visit&& visit) {
  for (uint32_t done = 0; done < bytes;) {
    const uint32_t offset = offset_in_line(at + done),
                   count = std::min(bytes - done, MemoryView::kLine - offset);
    visit(line_start(at + done), offset, done, count);
    done += count;
  }
}

uint32_t widened(const MemoryView::Load& load) {
  uint32_t value = 0;
  std::memcpy(&value, load.at, load.bytes);
  if (!load.sign_extend || load.bytes == 4) return value;
  return load.bytes == 1 ? uint32_t(int32_t(int8_t(value))) : uint32_t(int32_t(int16_t(value)));
}

// Runs an atomic and returns whether the value has changed.
bool run_modify(const MemoryView::Modify& op) {
  uint64_t old = 0;
  std::memcpy(&old, op.at, op.bytes);
  const uint64_t value = op.function(old, op.b, op.c);
  std::memcpy(op.at, &value, op.bytes);
  if (op.to) {
    op.to[0] = uint32_t(old);
    if (op.bytes == 8) op.to[kLanes] = uint32_t(old >> 32);
  }
  return value != old;
}

}  // namespace

void MemoryView::begin(Cycle now) {
  now_ = now;
}

void MemoryView::note(Kind kind, size_t count) {
  if (!batches_.empty() && batches_.back().at == now_ && batches_.back().kind == kind)
    batches_.back().end = uint32_t(count);
  else
    batches_.push_back({now_, kind, uint32_t(count - 1), uint32_t(count)});
}

const MemoryView::Line* MemoryView::find(const std::byte* place) const {
  for (size_t i = hash_of(place);; ++i) {
    const Slot& slot = slots_[i & (slots_.size() - 1)];
    if (slot.turn != turn_) return nullptr;
    if (lines_[slot.line].place == place) return &lines_[slot.line];
  }
}

// Returns the core's copy of a line. Memory does not change within a turn, so a copy that is taken now equals
// one from the turn's beginning.
MemoryView::Line& MemoryView::line_of(std::byte* place) {
  if (!lines_.empty() && lines_.back().place == place) return lines_.back();
  if (const Line* line = find(place)) return lines_[size_t(line - lines_.data())];
  if (2 * lines_.size() >= slots_.size()) grow();
  size_t i = hash_of(place);
  while (slots_[i & (slots_.size() - 1)].turn == turn_) ++i;
  slots_[i & (slots_.size() - 1)] = {turn_, uint32_t(lines_.size())};
  Line& line = lines_.emplace_back();
  line.place = place;
  std::memcpy(line.data.data(), place, kLine);
  return line;
}

void MemoryView::grow() {
  slots_.assign(slots_.size() * 2, {});
  for (size_t n = 0; n < lines_.size(); ++n) {
    size_t i = hash_of(lines_[n].place);
    while (slots_[i & (slots_.size() - 1)].turn == turn_) ++i;
    slots_[i & (slots_.size() - 1)] = {turn_, uint32_t(n)};
  }
}

void MemoryView::store(std::byte* at, const void* from, uint32_t bytes) {
  const auto* const source = static_cast<const std::byte*>(from);
  for_each_part(at, bytes, [&](std::byte* place, uint32_t offset, uint32_t done, uint32_t count) {
    Line& line = line_of(place);
    std::memcpy(line.data.data() + offset, source + done, count);
    line.waits &= ~mask_of(offset, count);  // Whoever reads here from now on reads what was stored.
  });
  for (uint32_t done = 0; done < bytes;) {
    Store& store = stores_.emplace_back();
    store.at = at + done;
    store.bytes = std::min(bytes - done, uint32_t(store.data.size()));
    std::memcpy(store.data.data(), source + done, store.bytes);
    done += store.bytes;
    note(Kind::Store, stores_.size());
  }
}

void MemoryView::modify(const Modify& modify) {
  for_each_part(modify.at, modify.bytes, [&](std::byte* place, uint32_t offset, uint32_t, uint32_t count) {
    line_of(place).waits |= mask_of(offset, count);
  });
  modifies_.push_back(modify);
  note(Kind::Modify, modifies_.size());
}

void MemoryView::load(const Load& load) {
  loads_.push_back(load);
  note(Kind::Load, loads_.size());
}

void MemoryView::load(const LoadTexel& load) {
  texels_.push_back(load);
  note(Kind::LoadTexel, texels_.size());
}

bool MemoryView::waits(const std::byte* at, uint32_t bytes) const {
  bool any = false;
  for_each_part(at, bytes, [&](std::byte* place, uint32_t offset, uint32_t, uint32_t count) {
    const Line* const line = find(place);
    any |= line && (line->waits & mask_of(offset, count));
  });
  return any;
}

const std::byte* MemoryView::read(const std::byte* at, uint32_t bytes,
                                  std::span<std::byte, kWidest> scratch) const {
  bool own = false;
  for_each_part(at, bytes, [&](std::byte* place, uint32_t offset, uint32_t done, uint32_t count) {
    const Line* const line = find(place);
    own |= line != nullptr;
    std::memcpy(scratch.data() + done, line ? line->data.data() + offset : at + done, count);
  });
  return own ? scratch.data() : at;
}

bool MemoryView::run(const Batch& batch) const {
  bool changed = false;
  for (uint32_t i = batch.first; i < batch.end; ++i) switch (batch.kind) {
      case Kind::Store:
        changed = changed || std::memcmp(stores_[i].at, stores_[i].data.data(), stores_[i].bytes) != 0;
        std::memcpy(stores_[i].at, stores_[i].data.data(), stores_[i].bytes);
        break;
      case Kind::Modify:
        changed |= run_modify(modifies_[i]);
        break;
      case Kind::Load:
        *loads_[i].to = widened(loads_[i]);
        break;
      case Kind::LoadTexel: {
        const Words words = load_texel(*texels_[i].row, texels_[i].format, texels_[i].at);
        for (size_t c = 0; c < words.size(); ++c)
          if (texels_[i].to[c]) *texels_[i].to[c] = words[c];
        break;
      }
    }
  return changed;
}

void MemoryView::clear() {
  batches_.clear();
  stores_.clear();
  modifies_.clear();
  loads_.clear();
  texels_.clear();
  lines_.clear();
  next_ = 0;
  if (++turn_ == 0) {  // After 2^32 turns, old stamps could be taken for new ones.
    std::fill(slots_.begin(), slots_.end(), Slot{});
    turn_ = 1;
  }
}

// The views are few and their batches are in order, so the earliest batch of all is at one of their heads.
bool MemoryView::commit(std::span<MemoryView* const> views) {
  bool changed = false;
  for (;;) {
    MemoryView* earliest = nullptr;
    for (MemoryView* view : views) {
      if (view->next_ == view->batches_.size()) continue;
      if (!earliest || view->batches_[view->next_].at < earliest->batches_[earliest->next_].at)
        earliest = view;
    }
    if (!earliest) break;
    changed |= earliest->run(earliest->batches_[earliest->next_++]);
  }
  for (MemoryView* view : views)
    if (!view->batches_.empty()) view->clear();
  return changed;
}

}  // namespace glint::exec
