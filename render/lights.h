// The directions that light comes from, without any OpenGL.
#pragma once

#include <Eigen/Core>
#include <span>

#include "kernels/vec.h"

namespace icloth {

/// A sphere around what is drawn.
struct Bounds {
  Vec3d centre;
  double radius = 1;  ///< [m]
  double lowest = 0;  ///< smallest height of a point in it [m]
};

/// The sphere around the first `cloth` points and those of the others that are near them (a floor
/// may reach far beyond what is worth a shadow). It is never smaller than a millimetre.
Bounds bounds_of(std::span<const Vec3f> points, std::size_t cloth);

/// One sample of the studio, whose key light is a disc and whose sky is a dome. Sample i of n is
/// the same in every picture; over all n they cover disc, dome and pixel evenly.
struct LightSample {
  Vec3d key;                ///< unit vector towards the key light
  Vec3d dome;               ///< unit vector towards a part of the sky
  double pixel_x, pixel_y;  ///< offset in the pixel, −0.5 … 0.5
};
LightSample light_sample(int i, int n);

/// The matrix from the world to the clip space of a light far away in `direction` that sees the
/// bounds.
Eigen::Matrix4d light_matrix(const Bounds& bounds, Vec3d direction);

}  // namespace icloth
