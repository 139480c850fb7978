#include "app/window/patch_outline.h"

#include <cmath>

#include "kernels/index.h"

namespace icloth {

std::vector<LineSegment> patch_outline(const World& world, std::span<const Vec3f> positions,
                                       const HeldHandle& handle, double share) {
  std::vector<LineSegment> lines;
  if (handle.face < 0 || handle.face >= world.cloth_faces || !(handle.radius > 0)) return lines;

  // The pull falls off as (1 − (d/r)²)² with the distance d at rest.
  const double reach = handle.radius * std::sqrt(1 - std::sqrt(share));
  const Triangle& held = world.face[at(handle.face)];
  const double weight[] = {handle.barycentric.x, handle.barycentric.y, handle.barycentric.z};
  Vec3d centre{};
  for (std::size_t k = 0; k < 3; ++k) centre += weight[k] * world.rest[at(held[k])];
  const auto beyond = [&](Index v) { return norm(world.rest[at(v)] - centre) - reach; };

  // A face that the line goes through has one corner on one side and two on the other.
  const Index cloth = world.object[at(held[0])];
  for (Index f = 0; f < world.cloth_faces; ++f) {
    const Triangle& t = world.face[at(f)];
    if (world.object[at(t[0])] != cloth) continue;
    const double d[] = {beyond(t[0]), beyond(t[1]), beyond(t[2])};
    Vec3d ends[2];
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if ((d[k] < 0) == (d[next] < 0)) continue;
      const double s = d[k] / (d[k] - d[next]);
      ends[count++] = (1 - s) * convert<double>(positions[at(t[k])]) +
                      s * convert<double>(positions[at(t[next])]);
    }
    if (count == 2) lines.push_back({ends[0], ends[1]});
  }
  return lines;
}

}  // namespace icloth
