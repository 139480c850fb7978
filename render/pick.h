// The element under the pointer.
#pragma once

#include <span>

#include "render/camera.h"
#include "sim/scene/world.h"

namespace icloth {

struct Pick {
  Index face = kNone;   ///< global face of a cloth, kNone: no cloth there
  Vec3d barycentric{};  ///< weights of the face's vertices at the hit
  Vec3d point{};        ///< the hit [m]
  double distance = 0;  ///< along the ray [m]

  Index obstacle_face = kNone;   ///< nearest global face of an obstacle, kNone: none there
  Vec3d obstacle_point{};        ///< [m]
  double obstacle_distance = 0;  ///< along the ray [m]

  bool hit_cloth() const { return face != kNone; }
  bool hit_obstacle() const { return obstacle_face != kNone; }
  /// True when the cloth is there and nothing solid before it, so that a hand can reach it.
  bool reachable() const {
    return hit_cloth() && (!hit_obstacle() || distance <= obstacle_distance);
  }
};

/// The nearest cloth face and the nearest obstacle face along the ray; both sides count.
/// `positions` are those of all vertices of the world; every face is tested. On equal distance the
/// smaller face number wins.
Pick pick(const World& world, std::span<const Vec3f> positions, const Ray& ray);

}  // namespace icloth
