// Includes Embree under either of its two interfaces: 3.13 (Debian 12) or 4 (Ubuntu 24.04).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace glint::test {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline void start(EmbreeContext& context) {
  rtcInitRayQueryContext(&context);
}
inline void intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
inline void start(EmbreeContext& context) {
  rtcInitIntersectContext(&context);
}
inline void intersect(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
  rtcIntersect1(scene, &context, &ray);
}
#endif

}  // namespace glint::test
