// Elementary CCD, the slow obvious version: advance in time by less than the primitives could have
// moved towards each other, in long double, with distances from a plain case distinction.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/ccd/elementary_ccd.h"

namespace icloth::oracle {

using Number = long double;
using Point3 = Vec3<Number>;

inline Number length(Point3 a) { return std::sqrt(dot(a, a)); }

inline Number point_segment(Point3 p, Point3 a, Point3 b) {
  const Point3 e = b - a;
  const Number ee = dot(e, e);
  const Number s = ee > 0 ? std::clamp(dot(p - a, e) / ee, Number(0), Number(1)) : Number(0);
  return length(p - a - s * e);
}

inline Number point_triangle(Point3 p, Point3 a, Point3 b, Point3 c) {
  Number best = std::min({point_segment(p, a, b), point_segment(p, b, c), point_segment(p, c, a)});
  const Point3 n = cross(b - a, c - a);
  if (dot(n, n) > 0 && dot(cross(b - a, p - a), n) > 0 && dot(cross(c - b, p - b), n) > 0 &&
      dot(cross(a - c, p - c), n) > 0) {
    best = std::min(best, std::fabs(dot(p - a, n)) / length(n));
  }
  return best;
}

inline Number segment_segment(Point3 a0, Point3 a1, Point3 b0, Point3 b1) {
  Number best = std::min({point_segment(a0, b0, b1), point_segment(a1, b0, b1),
                          point_segment(b0, a0, a1), point_segment(b1, a0, a1)});
  const Point3 d = a1 - a0, e = b1 - b0, r = a0 - b0;
  const Number dd = dot(d, d), ee = dot(e, e), de = dot(d, e), determinant = dd * ee - de * de;
  if (!(determinant > 0)) return best;
  const Number s = (de * dot(e, r) - ee * dot(d, r)) / determinant;
  const Number t = (dd * dot(e, r) - de * dot(d, r)) / determinant;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, length(r + s * d - t * e));
  return best;
}

inline Number distance_at(PairKind kind, const CcdQuery<double>& q, Number t) {
  Point3 x[4];
  for (int k = 0; k < 4; ++k) {
    x[k] = (1 - t) * convert<Number>(q.p0[k]) + t * convert<Number>(q.p1[k]);
  }
  return kind == PairKind::vf ? point_triangle(x[0], x[1], x[2], x[3])
                              : segment_segment(x[0], x[1], x[2], x[3]);
}

/// First time found at which the pair is closer than `tolerance`, or 2 when it never is.
inline Number first_approach(PairKind kind, const CcdQuery<double>& q, Number tolerance) {
  const int split = kind == PairKind::vf ? 1 : 2;  // points before it are the first primitive
  Number speed[2] = {0, 0};
  for (int k = 0; k < 4; ++k) {
    // Relative to the motion of the first point, which both primitives share.
    const Vec3d motion = (q.p1[k] - q.p0[k]) - (q.p1[0] - q.p0[0]);
    speed[k < split ? 0 : 1] = std::max(speed[k < split ? 0 : 1], length(convert<Number>(motion)));
  }
  const Number bound = (speed[0] + speed[1]) * Number(1.0001L);
  Number t = 0;
  while (t <= 1) {
    const Number distance = distance_at(kind, q, t);
    if (distance < tolerance) return t;
    if (bound == 0) return 2;
    t += Number(0.999L) * distance / bound;
  }
  return distance_at(kind, q, 1) < tolerance ? 1 : 2;
}

}  // namespace icloth::oracle
