// Holds a pipeline with shaders of every ray tracing stage that log what they see, and knows what they should
// log for rays that were aimed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/ops/ray_lab.h"
#include "tests/ops/ray_scene.h"

namespace glint::test {

// Says what a thread's any-hit shader does to each candidate.
enum class Verdict : uint32_t { Accept, Ignore, Terminate };

// Holds the operands of a thread's trace, and what its shaders will do.
struct RayAsk {
  Aim aim;
  Address structure = 0;
  uint32_t flags = 0, mask = 0, offset = 0, stride = 0, miss = 0, time = 0;
  bool enabled = false;     // A thread that is not traces nothing.
  bool one_record = false;  // The regions of the table have stride 0.
  Verdict verdict = Verdict::Accept;
  // The intersection shader reports twice. The attributes of a report are its kind and its distance.
  struct Report {
    double t = 0;
    uint32_t kind = 0;
  };
  std::array<Report, 2> report{};

  std::vector<uint32_t> words() const;  // the inputs of the thread, in the order of RayInput
};

// Names the words of the inputs.
struct RayInput {
  enum Word : uint32_t {
    kStructure,
    kFlags = 2,
    kMask,
    kOffset,
    kStride,
    kMiss,
    kOrigin,
    kTmin = kOrigin + 3,
    kDirection,
    kTmax = kDirection + 3,
    kVerdict,
    kReports,
    kTime = kReports + 4,
    kEnabled,
    kFree  // for what a test wants of its own
  };
};

// Names the words of the log. The payload's words follow kPayload.
struct RayLog {
  enum Word : uint32_t {
    kTurns,      // of the loop that runs candidates
    kEntries,    // runs of the intersection shader
    kUndecided,  // of both reports, and then whether they were accepted, and where the ray ends afterwards
    kAccepted = kUndecided + 2,
    kEnd = kAccepted + 2,
    kEntered = kEnd + 2,  // what the intersection shader sees, and its record
    kPayload = 32
  };
};
inline constexpr uint32_t kPayloadWords = 88;

// Names the words of the payload. The first of the specials is %hit.t.
struct RayPayload {
  enum Word : uint32_t {
    kAnyHits,  // runs of the any-hit shader
    kAnyHitRecord,
    kAnyHitTime,
    kAnyHitCorners,
    kAnyHitSpecials = kAnyHitCorners + 9,
    kMarker = 24,  // the number of the closest-hit or miss shader
    kRecord,
    kTime,
    kNestedMarker,
    kNestedTime,
    kCorners,
    kSpecials = kCorners + 9
  };
};

// Holds what the log should be, or nothing where no shader writes.
using Expected = std::vector<std::optional<Value>>;

// Says what a trace finds, as the shaders should see it.
struct Found {
  bool hit = false;
  Value t, u, v;
  uint32_t kind = 0, record = 0;  // the record is that of the hit, or of the miss
  bool is_triangle = false;       // The structure has corners for it.
};

// Returns what a special shows of a hit or a miss. The name lacks its '%'.
Value value_seen(std::string_view name, const RayAsk& ask, const Found& found);
// Follows the candidate of a ray, fills in what the shaders should log of it, and returns what the ray finds.
Found follow(const RayAsk& ask, Expected& log);
// Fills in what the closest-hit or miss shader should log of what was found.
void expect_hit_shader(const RayAsk& ask, const Found& found, Expected& log);

// Returns what every log holds before the trace.
Expected fresh_log();
// Compares the logs of all threads.
void check_log(const ThreadWords& log, const std::vector<Expected>& expected);

// Returns the shaders of the pipeline around the ray generation shader's own part. That part has the inputs
// from %r20 on, the addresses of payload and attributes in %r10 and %r11, and all of them again after
// ray_state(), which it needs behind calls.
std::vector<LabShader> ray_shaders(const std::string& body);
std::string ray_state();
// Returns a guarded trace whose shaders run. `end` stands where call.sbt.hit does.
std::string trace_text(std::string_view end);
// Fills in the records of the pipeline and places them.
void fill_table(RayLab& lab);
// Returns rays to many primitives with all flags, masks, records and verdicts.
std::vector<RayAsk> random_asks(const RayScene& scene, uint64_t seed);

inline constexpr uint32_t kLastSbtOffset = 40;  // of the scene's last instance

}  // namespace glint::test
