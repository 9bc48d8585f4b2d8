// Tests a ray against a box, or against four boxes at a time. The slabs are padded, so that rounding never
// loses a box that the exact ray touches.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "rtunit/intersection/four.h"

namespace glint::rt {

// Each slab distance carries an error of at most 1.5 ulp, and the far one must be widened by 2 ulp (Ize 2013,
// "Robust BVH Ray Traversal"). Choice: both ends are widened by 8 ulp. The sheared triangle test rounds its
// distance on its own, and with this margin a box is never entered later than its own triangles are hit. Ties
// at equal t then do not depend on the order of visits.
inline constexpr float kSlabShrink = 1 - 8 * 0x1p-24f, kSlabGrow = 1 + 8 * 0x1p-23f;

// Clips the interval to one slab, given by the planes that the ray meets first and last. A distance that is
// not a number (0 * inf: the ray lies in the plane) leaves the interval as it is.
template <class T>
inline void clip_slab(T near_plane, T far_plane, float origin, float inverse, T& t_near, T& t_far) {
  const T enter = (near_plane - all<T>(origin)) * all<T>(inverse);
  const T leave = (far_plane - all<T>(origin)) * all<T>(inverse);
  t_near = enter > t_near ? enter : t_near;
  t_far = leave < t_far ? leave : t_far;
}

// These two widen the ends of an interval outwards, whatever their signs.
template <class T>
inline T widen_near(T t) {
  return t * (t > T{} ? all<T>(kSlabShrink) : all<T>(kSlabGrow));
}
template <class T>
inline T widen_far(T t) {
  return t * (t > T{} ? all<T>(kSlabGrow) : all<T>(kSlabShrink));
}

// Widens the interval that was clipped to the slabs, and clips it to the ray's own.
template <class T>
inline void clip_to_ray(float t_min, float t_max, T& t_near, T& t_far) {
  const T enter = widen_near(t_near), leave = widen_far(t_far);
  t_near = enter > all<T>(t_min) ? enter : all<T>(t_min);
  t_far = leave < all<T>(t_max) ? leave : all<T>(t_max);
}

}  // namespace glint::rt
