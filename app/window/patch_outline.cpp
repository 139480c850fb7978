#include "app/window/patch_outline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/index.h"

namespace icloth {

std::vector<LineSegment> patch_outline(const World& world, std::span<const Vec3f> positions,
                                       const HeldHandle& handle, std::span<const double> shares) {
  std::vector<LineSegment> lines;
  if (handle.face < 0 || handle.face >= world.cloth_faces || !(handle.radius > 0)) return lines;

  const Triangle& held = world.face[at(handle.face)];
  const double weight[] = {handle.barycentric.x, handle.barycentric.y, handle.barycentric.z};
  Vec3d centre{};
  for (std::size_t k = 0; k < 3; ++k) centre += weight[k] * world.rest[at(held[k])];

  // Each vertex has its distance to the hit, at rest.
  const WorldObject& cloth = world.objects[at(world.object[at(held[0])])];
  std::vector<double> distance(at(cloth.vertex_count));
  for (Index v = 0; v < cloth.vertex_count; ++v)
    distance[at(v)] = norm(world.rest[at(cloth.first_vertex + v)] - centre);

  for (Index f = cloth.first_face; f < cloth.first_face + cloth.face_count; ++f) {
    const Triangle& t = world.face[at(f)];
    std::array<double, 3> d{};
    for (std::size_t k = 0; k < 3; ++k) d[k] = distance[at(t[k] - cloth.first_vertex)];
    if (std::ranges::min(d) >= handle.radius) continue;

    // The pull falls off as (1 − (d/r)²)². A face that a line goes through has one corner on one
    // side of it and two on the other.
    for (const double share : shares) {
      const double reach = handle.radius * std::sqrt(1 - std::sqrt(share));
      std::array<Vec3d, 2> ends;
      std::size_t count = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if ((d[k] < reach) == (d[next] < reach)) continue;
        const double s = (d[k] - reach) / (d[k] - d[next]);
        ends[count++] = (1 - s) * convert<double>(positions[at(t[k])]) +
                        s * convert<double>(positions[at(t[next])]);
      }
      if (count == 2) lines.push_back({ends[0], ends[1]});
    }
  }
  return lines;
}

}  // namespace icloth
