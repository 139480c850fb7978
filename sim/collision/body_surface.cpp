#include "sim/collision/body_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "kernels/distance.h"
#include "kernels/index.h"
#include "sim/scene/exact_triangles.h"

namespace icloth {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3d area_vector(const FaceCorners& t) { return cross(t[1] - t[0], t[2] - t[0]); }

/// Unit vector, or zero for a vector that has no direction.
Vec3d direction(Vec3d a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : Vec3d{};
}

struct Range {
  double low, high;
};

Range range(const FaceCorners& t, double Vec3d::*axis) {
  return {std::min({t[0].*axis, t[1].*axis, t[2].*axis}),
          std::max({t[0].*axis, t[1].*axis, t[2].*axis})};
}

/// Squared distance from a point to the box of a triangle, a lower bound of that to the triangle.
double box_distance2(const FaceCorners& t, Vec3d p) {
  double sum = 0;
  for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
    const Range r = range(t, axis);
    const double d = std::max({r.low - p.*axis, p.*axis - r.high, 0.0});
    sum += d * d;
  }
  return sum;
}

bool boxes_apart(const FaceCorners& s, const FaceCorners& t) {
  for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
    const Range a = range(s, axis), b = range(t, axis);
    if (a.low > b.high || b.low > a.high) return true;
  }
  return false;
}

/// The share of a face in the normal at its nearest point. At a corner the angle of the face is its
/// weight, so that the sum separates inside from outside there (Bærentzen and Aanæs 2005).
Vec3d normal_share(const FaceCorners& t, const TrianglePoint<double>& q) {
  double weight = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (q.w[k] < 1 - 1e-9) continue;
    const Vec3d a = t[(k + 1) % 3] - t[k], b = t[(k + 2) % 3] - t[k];
    weight = std::atan2(norm(cross(a, b)), dot(a, b));
  }
  return weight * direction(area_vector(t));
}

/// Barycentric weights of the point at which the segment a b goes through the triangle, if it does.
std::optional<std::array<double, 3>> pierced(const FaceCorners& t, Vec3d a, Vec3d b) {
  const Vec3d n = area_vector(t);
  const double from = dot(a - t[0], n), to = dot(b - t[0], n), nn = dot(n, n);
  if (!(from * to < 0) || !(nn > 0)) return std::nullopt;

  // The point is inside the triangle when none of its weights is negative.
  const Vec3d p = a + (from / (from - to)) * (b - a);
  std::array<double, 3> w{};
  for (std::size_t k = 0; k < 3; ++k) {
    w[k] = dot(cross(t[(k + 2) % 3] - t[(k + 1) % 3], p - t[(k + 1) % 3]), n) / nn;
    if (w[k] < 0) return std::nullopt;
  }
  return w;
}

}  // namespace

BodySurface::BodySurface(const World& world, Index object) : world_(&world) {
  const WorldObject& body = world.objects[at(object)];
  first_face_ = body.first_face;
  last_face_ = body.first_face + body.face_count;
  link_edges();

  // Without a boundary the sign of the volume says where the normals point.
  const bool closed = std::ranges::all_of(edges_, [](const Edge& e) { return e.face[1] >= 0; });
  if (!closed) return;
  const Vec3d origin = world.position[at(body.first_vertex)];
  double volume = 0;
  for (Index f = first_face_; f < last_face_; ++f) {
    const FaceCorners t = corners(world.position, f);
    volume += dot(t[0] - origin, cross(t[1] - origin, t[2] - origin));
  }
  own_side_ = volume >= 0 ? 1 : -1;
}

void BodySurface::link_edges() {
  std::map<std::array<Index, 2>, std::size_t> known;
  for (Index f = first_face_; f < last_face_; ++f) {
    const Triangle& t = world_->face[at(f)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      const std::array<Index, 2> ends{std::min(a, b), std::max(a, b)};
      const auto [place, is_new] = known.try_emplace(ends, edges_.size());

      // An edge with three or more faces keeps the first one and the last one.
      if (is_new)
        edges_.push_back({ends, {f, -1}});
      else
        edges_[place->second].face[1] = f;
    }
  }
}

FaceCorners BodySurface::corners(std::span<const Vec3d> x, Index face) const {
  const Triangle& t = world_->face[at(face)];
  return {x[at(t[0])], x[at(t[1])], x[at(t[2])]};
}

double BodySurface::winding(std::span<const Vec3d> x, Vec3d p) const {
  double sum = 0;
  for (Index f = first_face_; f < last_face_; ++f) {
    // Half the solid angle of each face is summed up, after van Oosterom and Strackee 1983.
    const FaceCorners t = corners(x, f);
    const Vec3d a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum += std::atan2(dot(a, cross(b, c)),
                      la * lb * lc + la * dot(b, c) + lb * dot(c, a) + lc * dot(a, b));
  }
  return sum / (2 * std::numbers::pi);
}

SurfacePoint BodySurface::nearest(std::span<const Vec3d> x, Vec3d p, int side) const {
  SurfacePoint found;
  double best = kInfinity;
  Vec3d sum, place;

  // Faces that share the nearest point add up to its normal.
  for (Index f = first_face_; f < last_face_; ++f) {
    const FaceCorners t = corners(x, f);
    const double tie = best < kInfinity ? 1e-6 * best + 1e-18 : 0;
    if (box_distance2(t, p) > best + tie) continue;
    const TrianglePoint<double> q = closest_point_triangle(p, t[0], t[1], t[2]);
    if (q.distance2 > best + tie) continue;
    if (q.distance2 < best - tie) sum = {};
    sum += normal_share(t, q);
    if (q.distance2 >= best) continue;
    best = q.distance2;
    found.face = f;
    found.w = {q.w[0], q.w[1], q.w[2]};
    place = q.w[0] * t[0] + q.w[1] * t[1] + q.w[2] * t[2];
  }

  // A point in front of its nearest face is outside, one behind it inside.
  found.normal = direction(static_cast<double>(side) * sum);
  const bool behind = dot(p - place, found.normal) < 0;

  // Parts of one body that overlap hide each other's surface: the winding number knows.
  const bool inside = own_side_ != 0 ? std::fabs(winding(x, p)) > 0.5 : behind;
  if (inside != behind) found.normal = {};
  found.distance = inside ? -std::sqrt(best) : std::sqrt(best);
  return found;
}

double BodySurface::distance_ahead(std::span<const Vec3d> x, Vec3d p, Vec3d ahead,
                                   double most) const {
  double best = kInfinity;
  for (Index f = first_face_; f < last_face_; ++f) {
    const FaceCorners t = corners(x, f);
    if (box_distance2(t, p) > best) continue;
    const double facing = own_side_ * dot(direction(area_vector(t)), ahead);
    if (facing > most) continue;
    const TrianglePoint<double> q = closest_point_triangle(p, t[0], t[1], t[2]);
    if (q.distance2 >= best) continue;
    const Vec3d place = q.w[0] * t[0] + q.w[1] * t[1] + q.w[2] * t[2];
    if (dot(place - p, ahead) > 0.3 * std::sqrt(q.distance2)) best = q.distance2;
  }
  return std::sqrt(best);
}

bool BodySurface::touches(std::span<const Vec3d> x, const FaceCorners& triangle) const {
  for (Index f = first_face_; f < last_face_; ++f) {
    const FaceCorners t = corners(x, f);
    if (!boxes_apart(t, triangle) && triangles_meet(t, triangle)) return true;
  }
  return false;
}

std::vector<SurfaceCrossing> BodySurface::crossings(std::span<const Vec3d> x,
                                                    const FaceCorners& triangle, int side) const {
  std::vector<SurfaceCrossing> found;
  const auto normal_of = [&](Index f) {
    return f < 0 ? Vec3d{} : direction(area_vector(corners(x, f)));
  };
  for (const Edge& edge : edges_) {
    const Vec3d a = x[at(edge.end[0])], b = x[at(edge.end[1])];
    if (boxes_apart({a, b, b}, triangle)) continue;
    const auto w = pierced(triangle, a, b);
    if (!w) continue;
    const Vec3d p = (*w)[0] * triangle[0] + (*w)[1] * triangle[1] + (*w)[2] * triangle[2];
    const Vec3d normal =
        direction(static_cast<double>(side) * (normal_of(edge.face[0]) + normal_of(edge.face[1])));
    found.push_back({norm2(p - a) < norm2(p - b) ? edge.end[0] : edge.end[1], *w, normal});
  }
  return found;
}

}  // namespace icloth
