// Exact triangle–triangle test for small integer coordinates: the slow obvious version.
#pragma once

#include <array>
#include <cstdint>

namespace icloth::oracle {

using Point = std::array<std::int64_t, 3>;
using Corners = std::array<Point, 3>;

inline int sign(std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// Side of d against the plane a b c.
inline int side(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<Point, 3> m;
  for (std::size_t k = 0; k < 3; ++k) m[0][k] = a[k] - d[k];
  for (std::size_t k = 0; k < 3; ++k) m[1][k] = b[k] - d[k];
  for (std::size_t k = 0; k < 3; ++k) m[2][k] = c[k] - d[k];
  return sign(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
              m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
              m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

inline Point normal(const Corners& t) {
  Point u, v;
  for (std::size_t k = 0; k < 3; ++k) u[k] = t[1][k] - t[0][k];
  for (std::size_t k = 0; k < 3; ++k) v[k] = t[2][k] - t[0][k];
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

inline bool degenerate(const Corners& t) { return normal(t) == Point{0, 0, 0}; }

/// Side of c against the line a b, seen along `axis`.
inline int side2(const Point& a, const Point& b, const Point& c, std::size_t axis) {
  const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  return sign((b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]));
}

inline bool between(const Point& a, const Point& b, const Point& p) {
  for (std::size_t k = 0; k < 3; ++k)
    if ((p[k] < a[k] && p[k] < b[k]) || (p[k] > a[k] && p[k] > b[k])) return false;
  return true;
}

inline bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d,
                          std::size_t axis) {
  const int abc = side2(a, b, c, axis), abd = side2(a, b, d, axis);
  const int cda = side2(c, d, a, axis), cdb = side2(c, d, b, axis);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) ||
         (cda == 0 && between(c, d, a)) || (cdb == 0 && between(c, d, b));
}

/// Segment p q against a triangle in the same plane.
inline bool meet_in_plane(const Point& p, const Point& q, const Corners& t) {
  const Point n = normal(t);
  const std::size_t axis = n[0] != 0 ? 0 : n[1] != 0 ? 1 : 2;
  int positive = 0, negative = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (segments_meet(p, q, t[k], t[(k + 1) % 3], axis)) return true;
    const int s = side2(t[k], t[(k + 1) % 3], p, axis);
    positive += s >= 0;
    negative += s <= 0;
  }
  return positive == 3 || negative == 3;
}

inline bool segment_meets(const Point& p, const Point& q, const Corners& t) {
  const int sp = side(t[0], t[1], t[2], p), sq = side(t[0], t[1], t[2], q);
  if (sp * sq > 0) return false;
  if (sp == 0 && sq == 0) return meet_in_plane(p, q, t);
  int positive = 0, negative = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int s = side(p, q, t[k], t[(k + 1) % 3]);
    positive += s >= 0;
    negative += s <= 0;
  }
  return positive == 3 || negative == 3;
}

/// Closed triangles with an area.
inline bool intersect(const Corners& s, const Corners& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (segment_meets(s[k], s[(k + 1) % 3], t) || segment_meets(t[k], t[(k + 1) % 3], s))
      return true;
  return false;
}

}  // namespace icloth::oracle
