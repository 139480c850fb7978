// One body as a surface with an inside and an outside: how deep a point lies in it, and where cloth
// crosses it. On the host in double precision, by looking at every face: it is asked for the few
// vertices that are let go (sim/collision/pinch.h).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/scene/world.h"

namespace icloth {

/// The point of a surface that is nearest to a given one.
struct SurfacePoint {
  double distance = 0;        ///< [m], negative inside
  Index face = 0;             ///< of the world
  std::array<double, 3> w{};  ///< weights of its corners
  Vec3d normal;               ///< unit, outwards; zero where parts of the body overlap and hide it
};

/// The point at which an edge of the body goes through a cloth face.
struct SurfaceCrossing {
  Index vertex = 0;           ///< end of the edge that is nearer
  std::array<double, 3> w{};  ///< weights of the corners of the cloth face
  Vec3d normal;               ///< unit, outwards, mean of the faces beside the edge
};

class BodySurface {
 public:
  BodySurface(const World& world, Index object);

  /// Returns +1 when the normals of a closed body point outwards and −1 when they point inwards, by
  /// the sign of its volume. Returns 0 for an open surface, whose outside the caller has to choose.
  int own_side() const { return own_side_; }

  /// `x`: positions of all vertices; `side`: +1 when normals point outwards, −1 when inwards.
  SurfacePoint nearest(std::span<const Vec3d> x, Vec3d p, int side) const;
  /// Distance to the nearest point that lies ahead of p in direction `ahead` (unit, within about
  /// 70 degrees), on a face whose outward normal n has n · ahead ≤ most; infinite: there is none.
  double distance_ahead(std::span<const Vec3d> x, Vec3d p, Vec3d ahead, double most) const;
  /// Whether the triangle touches the surface, decided exactly.
  bool touches(std::span<const Vec3d> x, const std::array<Vec3d, 3>& triangle) const;
  std::vector<SurfaceCrossing> crossings(std::span<const Vec3d> x,
                                         const std::array<Vec3d, 3>& triangle, int side) const;

 private:
  struct Edge {
    std::array<Index, 2> end;
    std::array<Index, 2> face;  ///< −1: none
  };

  std::array<Vec3d, 3> corners(std::span<const Vec3d> x, Index face) const;
  void link_edges();
  /// Number of times that the surface winds around p: 0 outside, ±1 inside a closed body.
  double winding(std::span<const Vec3d> x, Vec3d p) const;

  const World* world_;
  Index first_face_, last_face_;
  std::vector<Edge> edges_;
  int own_side_ = 0;
};

}  // namespace icloth
