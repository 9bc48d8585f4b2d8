// Makes keys of geometry, and stores structures as values.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/structure_cache.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/block_hash.h"

namespace glint::pipeline {
namespace {

template <class T, size_t N>
std::string_view bytes_of(std::span<T, N> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

uint64_t primitives_of(const rt::BottomLevel& input) {
  uint64_t count = 0;
  for (const rt::Geometry& g : input.geometries)
    count += !g.aabbs.empty() ? g.aabbs.size()
                              : (g.indices.empty() ? g.positions.size() / g.stride : g.indices.size()) / 3;
  return count;
}

// Returns a key: sizes and flags in words, and contents in two hashes of 64 bits.
std::string key_of(const rt::BottomLevel& input, const rt::BuildOptions& options) {
  std::string key = fmt::format("{} {} {}", options.format.name, options.layout.name, options.pair_triangles);
  for (const auto* params : {&options.format.params, &options.layout.params})
    for (const ParamInfo& p : *params) key += fmt::format(" {}={}", p.key, p.value);
  BlockHash contents;
  for (const rt::Geometry& g : input.geometries) {
    key += fmt::format(" [{} {} {} {} {}{}]", g.positions.size(), g.stride, g.indices.size(), g.aabbs.size(),
                       int(g.opaque), int(g.no_duplicate_any_hit));
    for (const std::string_view part : {bytes_of(g.positions), bytes_of(g.indices), bytes_of(g.aabbs),
                                        bytes_of(std::span<const float>(g.transform))})
      contents.add(part);
    if (!g.micromaps) continue;
    const rt::MicromapFormat& format = g.micromaps->format;
    key += fmt::format(" micromaps {}^{} {}", format.two_states ? 2 : 4, format.level,
                       g.micromaps->states.size());
    for (const std::string_view part :
         {bytes_of(std::span(g.micromaps->index)), bytes_of(std::span(g.micromaps->states))})
      contents.add(part);
  }
  return key + fmt::format(" {:016x}{:016x}", contents.first(), contents.second());
}

static_assert(std::is_trivially_copyable_v<rt::StructureInfo>);

}  // namespace

rt::EncodedStructure StructureCache::encode(const std::string& name, const rt::BottomLevel& input,
                                            const rt::BuildOptions& options, uint32_t threads) {
  if (primitives_of(input) < least_primitives_) {
    count(&Counts::built);
    return rt::encode_bottom(name, input, options, threads);
  }
  const std::string key = key_of(input, options);
  const Turn turn(*this, key);
  rt::EncodedStructure out;
  const std::span<char> info(reinterpret_cast<char*>(&out.info), sizeof out.info);
  static_assert(FileStore::kRestSlack >= 2 * mem::HostBlock::kAlignment);
  if (std::optional<FileStore::Large> found = files_.find_large(key);
      found && found->head.size() == info.size()) {
    std::copy(found->head.begin(), found->head.end(), info.begin());
    out.bytes =
        mem::HostBlock(std::move(found->pages), reinterpret_cast<std::byte*>(found->rest), found->bytes);
    count(&Counts::found);
    return out;
  }
  out = rt::encode_bottom(name, input, options, threads);
  files_.store(key, {info.data(), info.size()},
               {reinterpret_cast<const char*>(out.bytes.data()), out.bytes.size()});
  count(&Counts::built);
  return out;
}

StructureCache::Turn::Turn(StructureCache& cache, const std::string& key) : cache_(cache), key_(key) {
  std::unique_lock lock(cache_.mutex_);
  cache_.turn_ended_.wait(lock, [&] { return !cache_.held_.contains(key_); });
  cache_.held_.insert(key_);
}

StructureCache::Turn::~Turn() {
  const std::lock_guard lock(cache_.mutex_);
  cache_.held_.erase(key_);
  cache_.turn_ended_.notify_all();
}

void StructureCache::count(uint64_t Counts::*which) {
  const std::lock_guard lock(mutex_);
  ++(counts_.*which);
}

}  // namespace glint::pipeline
