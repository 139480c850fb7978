#include "render/pick.h"

#include <limits>

namespace icloth {

namespace {

/// The nearest hit of a ray so far.
struct Hit {
  Index face = kNone;
  double distance = std::numeric_limits<double>::infinity();
  double b1 = 0, b2 = 0;  ///< weights of the second and third vertex
};

// Tests one face, after Möller and Trumbore 1997. The edges belong to both faces beside them, so
// that a ray through a shared edge never slips through.
void hit_face(Vec3d origin, Vec3d direction, Vec3d a, Vec3d ab, Vec3d ac, Index face, Hit& best) {
  const Vec3d p = cross(direction, ac);
  const double determinant = dot(ab, p);
  if (determinant == 0) return;

  // Each weight is tested as soon as it is known, with some slack.
  const Vec3d s = origin - a;
  const double inverse = 1 / determinant;
  const double b1 = inverse * dot(s, p);
  constexpr double kSlack = 1e-12;
  if (b1 < -kSlack || b1 > 1 + kSlack) return;

  const Vec3d q = cross(s, ab);
  const double b2 = inverse * dot(direction, q);
  if (b2 < -kSlack || b1 + b2 > 1 + kSlack) return;

  const double distance = inverse * dot(ac, q);
  if (distance > 0 && distance < best.distance) best = {face, distance, b1, b2};
}

/// The nearest face of a range.
Hit nearest(const World& world, std::span<const Vec3f> positions, const Ray& ray, Index first,
            Index last) {
  Hit best;
  for (Index f = first; f < last; ++f) {
    const Triangle& t = world.face[static_cast<std::size_t>(f)];
    const Vec3d a = convert<double>(positions[static_cast<std::size_t>(t[0])]);
    const Vec3d b = convert<double>(positions[static_cast<std::size_t>(t[1])]);
    const Vec3d c = convert<double>(positions[static_cast<std::size_t>(t[2])]);
    hit_face(ray.origin, ray.direction, a, b - a, c - a, f, best);
  }
  return best;
}

}  // namespace

Pick pick(const World& world, std::span<const Vec3f> positions, const Ray& ray) {
  Pick result;

  // Cloth and obstacles are searched apart, since a hand reaches only cloth with nothing solid
  // before it.
  const Hit cloth = nearest(world, positions, ray, 0, world.cloth_faces);
  if (cloth.face != kNone) {
    result.face = cloth.face;
    result.barycentric = {1 - cloth.b1 - cloth.b2, cloth.b1, cloth.b2};
    result.distance = cloth.distance;
    result.point = ray.origin + cloth.distance * ray.direction;
  }

  const Hit obstacle = nearest(world, positions, ray, world.cloth_faces, world.faces);
  if (obstacle.face != kNone) {
    result.obstacle_face = obstacle.face;
    result.obstacle_distance = obstacle.distance;
    result.obstacle_point = ray.origin + obstacle.distance * ray.direction;
  }
  return result;
}

}  // namespace icloth
