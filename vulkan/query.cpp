// Makes query pools, and answers what was queried: timestamps, which the device's clock gives, properties of
// acceleration structures, and how many compute shaders ran. Nothing is drawn, so statistics of graphics and
// samples that pass are 0.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/query.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <ctime>
#include <fmt/format.h>
#include <iterator>
#include <optional>

#include "vulkan/chain.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

bool is_known(VkQueryType type) {
  switch (int(type)) {
    case VK_QUERY_TYPE_OCCLUSION:
    case VK_QUERY_TYPE_PIPELINE_STATISTICS:
    case VK_QUERY_TYPE_TIMESTAMP:
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR:
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR:
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS_KHR:
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SIZE_KHR:
    case VK_QUERY_TYPE_MICROMAP_SERIALIZATION_SIZE_EXT:
    case VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT:
      return true;
    default:
      return false;
  }
}

// Returns the numbers of a query.
uint32_t numbers_of(const VkQueryPool_T& pool) {
  return pool.type == VK_QUERY_TYPE_PIPELINE_STATISTICS ? uint32_t(std::popcount(pool.statistics)) : 1;
}

VkDeviceSize bytes_of_results(const VkQueryPool_T& pool, uint32_t count, VkDeviceSize stride,
                              VkQueryResultFlags flags) {
  const VkDeviceSize number = flags & VK_QUERY_RESULT_64_BIT ? sizeof(uint64_t) : sizeof(uint32_t);
  const uint32_t numbers = numbers_of(pool) + ((flags & VK_QUERY_RESULT_WITH_AVAILABILITY_BIT) != 0);
  return count ? (count - 1) * stride + numbers * number : 0;
}

template <class Number>
void put(std::byte* to, uint32_t index, uint64_t value) {
  const auto number = Number(value);
  std::memcpy(to + index * sizeof number, &number, sizeof number);
}

// Writes results as vkGetQueryPoolResults says. Returns whether all were available. Of statistics only the
// number of threads of compute shaders is not 0.
template <class Number>
bool write_results(const VkQueryPool_T& pool, uint32_t first, uint32_t count, std::byte* to,
                   VkDeviceSize stride, VkQueryResultFlags flags) {
  const uint32_t numbers = numbers_of(pool);
  const auto threads = uint32_t(
      std::popcount(pool.statistics & (VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT - 1)));
  const bool counts_threads = pool.type != VK_QUERY_TYPE_PIPELINE_STATISTICS ||
                              (pool.statistics & VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT);
  bool all = true;
  for (uint32_t i = 0; i < count; ++i, to += stride) {
    const std::optional<uint64_t>& value = pool.values[first + i];
    all = all && value;
    if (value || (flags & VK_QUERY_RESULT_PARTIAL_BIT))
      for (uint32_t n = 0; n < numbers; ++n)
        put<Number>(to, n, counts_threads && n == threads ? value.value_or(0) : 0);
    if (flags & VK_QUERY_RESULT_WITH_AVAILABILITY_BIT) put<Number>(to, numbers, value.has_value());
  }
  return all;
}

bool write_results(const VkQueryPool_T& pool, uint32_t first, uint32_t count, std::byte* to,
                   VkDeviceSize stride, VkQueryResultFlags flags) {
  return flags & VK_QUERY_RESULT_64_BIT ? write_results<uint64_t>(pool, first, count, to, stride, flags)
                                        : write_results<uint32_t>(pool, first, count, to, stride, flags);
}

void reset(VkQueryPool pool, uint32_t first, uint32_t count) {
  std::fill_n(pool->values.begin() + first, count, std::nullopt);
}

}  // namespace

void check_range(VkQueryPool pool, uint32_t first, uint32_t count) {
  if (first > pool->values.size() || count > pool->values.size() - first)
    throw Refusal(
        fmt::format("queries {} to {} are not in a pool of {}", first, first + count, pool->values.size()));
}

VkResult CreateQueryPool(Device&, const VkQueryPoolCreateInfo* info, VkQueryPool* out) {
  if (!is_known(info->queryType))
    throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT,
                  "only timestamps, properties of acceleration structures, statistics of pipelines and "
                  "occlusion can be queried");
  const bool has_statistics = info->queryType == VK_QUERY_TYPE_PIPELINE_STATISTICS;
  *out = new VkQueryPool_T{info->queryType, has_statistics ? info->pipelineStatistics : 0,
                           std::vector<std::optional<uint64_t>>(info->queryCount),
                           std::vector<uint64_t>(info->queryCount)};
  return VK_SUCCESS;
}
void DestroyQueryPool(Device&, VkQueryPool pool) {
  delete pool;
}

void ResetQueryPool(Device&, VkQueryPool pool, uint32_t first, uint32_t count) {
  check_range(pool, first, count);
  reset(pool, first, count);
}

VkResult GetQueryPoolResults(Device& device, VkQueryPool pool, uint32_t first, uint32_t count, size_t bytes,
                             void* out, VkDeviceSize stride, VkQueryResultFlags flags) {
  check_range(pool, first, count);
  if (bytes_of_results(*pool, count, stride, flags) > bytes)
    throw Refusal(fmt::format("{} results do not fit into {} bytes", count, bytes));
  const auto is_there = [&] {
    return std::all_of(pool->values.begin() + first, pool->values.begin() + first + count,
                       [](const auto& value) { return value.has_value(); });
  };
  device.advance();
  if (flags & VK_QUERY_RESULT_WAIT_BIT)
    device.changed.wait(device.mutex, [&] { return device.is_lost || is_there(); });
  if (device.is_lost) return VK_ERROR_DEVICE_LOST;
  const bool all = write_results(*pool, first, count, static_cast<std::byte*>(out), stride, flags);
  return all ? VK_SUCCESS : VK_NOT_READY;
}

void CmdResetQueryPool(CommandBuffer& commands, VkQueryPool pool, uint32_t first, uint32_t count) {
  check_range(pool, first, count);
  commands.record([=](Queue&) { reset(pool, first, count); });
}

void CmdBeginQuery(CommandBuffer& commands, VkQueryPool pool, uint32_t query, VkQueryControlFlags) {
  check_range(pool, query, 1);
  commands.record([=](Queue& queue) { pool->begun[query] = queue.device.compute_threads; });
}
void CmdEndQuery(CommandBuffer& commands, VkQueryPool pool, uint32_t query) {
  check_range(pool, query, 1);
  commands.record([=](Queue& queue) {
    const bool is_counted = pool->type == VK_QUERY_TYPE_PIPELINE_STATISTICS;
    pool->values[query] = is_counted ? queue.device.compute_threads - pool->begun[query] : 0;
  });
}

void CmdWriteTimestamp(CommandBuffer& commands, VkPipelineStageFlagBits, VkQueryPool pool, uint32_t query) {
  check_range(pool, query, 1);
  commands.record([=](Queue& queue) { pool->values[query] = queue.device.clock.now(); });
}
void CmdWriteTimestamp2(CommandBuffer& commands, VkPipelineStageFlags2, VkQueryPool pool, uint32_t query) {
  CmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, query);
}

VkResult GetPhysicalDeviceCalibrateableTimeDomainsEXT(PhysicalDevice&, uint32_t* count,
                                                      VkTimeDomainEXT* out) {
  constexpr VkTimeDomainEXT kDomains[] = {VK_TIME_DOMAIN_DEVICE_EXT, VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT};
  return enumerate(uint32_t(std::size(kDomains)), count, out,
                   [&](auto& to, uint32_t i) { to = kDomains[i]; });
}

// Simulated time and the host's have nothing to do with each other, so all that is known of the deviation is
// how long reading them took.
VkResult GetCalibratedTimestampsEXT(Device& device, uint32_t count, const VkCalibratedTimestampInfoEXT* infos,
                                    uint64_t* out, uint64_t* deviation) {
  const auto now = [] {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return uint64_t(time.tv_sec) * 1'000'000'000 + uint64_t(time.tv_nsec);
  };
  const uint64_t begin = now();
  for (uint32_t i = 0; i < count; ++i)
    out[i] = infos[i].timeDomain == VK_TIME_DOMAIN_DEVICE_EXT ? device.clock.now() : now();
  *deviation = now() - begin + 1;
  return VK_SUCCESS;
}

void CmdCopyQueryPoolResults(CommandBuffer& commands, VkQueryPool pool, uint32_t first, uint32_t count,
                             VkBuffer buffer, VkDeviceSize offset, VkDeviceSize stride,
                             VkQueryResultFlags flags) {
  check_range(pool, first, count);
  const VkDeviceSize bytes = bytes_of_results(*pool, count, stride, flags);
  bytes_of(commands.device, buffer, offset, bytes);
  commands.record([=](Queue& queue) {
    write_results(*pool, first, count, bytes_of(queue.device, buffer, offset, bytes).data, stride, flags);
  });
}

}  // namespace glint::vulkan
