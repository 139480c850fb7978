// The force of a gas inside closed cloth whose pressure does not depend on the volume, as in a
// balloon: p · area · normal on every face of a closed surface. It is the gradient of p V, with V
// the volume inside, so its sum over a closed surface is zero and so is that of its torques.
//
// The force is that of the shape of the linearisation; its derivative, which is not definite, is
// left out of the matrix. Newton's method makes up for it.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "kernels/index.h"
#include "kernels/parallel/parallel.h"
#include "sim/mechanics/force.h"

namespace icloth::ICLOTH_BUILD {

/// Sets of faces that are connected over edges; each face is a set of its own at first.
class Surfaces {
 public:
  explicit Surfaces(Index faces) : parent_(static_cast<std::size_t>(faces)) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  /// A face that stands for the surface of face f.
  Index of(Index f) {
    while (parent(f) != f) {
      parent(f) = parent(parent(f));
      f = parent(f);
    }
    return f;
  }
  void unite(Index f, Index g) { parent(of(f)) = of(g); }

 private:
  Index& parent(Index f) { return parent_[static_cast<std::size_t>(f)]; }

  std::vector<Index> parent_;
};

/// Unites the cloth faces that meet at edges. Returns one face of every edge at which a surface is
/// not closed.
inline std::vector<Index> unite_over_edges(const World& world, Surfaces& surfaces) {
  struct Side {
    Index low, high, face;
    bool forward;
  };

  // Sorting the sides of all faces brings those along the same edge together.
  std::vector<Side> sides;
  for (Index f = 0; f < world.cloth_faces; ++f)
    for (std::size_t a = 0; a < 3; ++a) {
      const Triangle& t = world.face[static_cast<std::size_t>(f)];
      const Index from = t[a], to = t[(a + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), f, from < to});
    }
  const auto edge = [](const Side& s) { return std::pair(s.low, s.high); };
  std::ranges::sort(sides, {}, edge);

  // Two faces that run along their edge in opposite directions close it.
  std::vector<Index> open;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    for (; end < sides.size() && edge(sides[end]) == edge(sides[i]); ++end)
      surfaces.unite(sides[end].face, sides[i].face);
    if (end - i != 2 || sides[i].forward == sides[i + 1].forward) open.push_back(sides[i].face);
    i = end;
  }
  return open;
}

/// Returns 1 for the cloth faces of a closed surface with outward normals, −1 for those of one with
/// inward normals, and 0 for faces of open surfaces. A surface, connected over edges, is closed
/// when two faces meet at each edge and run along it in opposite directions.
inline std::vector<Real> outward_sides(const World& world) {
  Surfaces surfaces(world.cloth_faces);
  std::vector<bool> is_open(at(world.cloth_faces));
  for (const Index f : unite_over_edges(world, surfaces)) is_open[at(surfaces.of(f))] = true;

  // The sign of the volume says which way the normals of a closed surface point.
  std::vector<double> volume(at(world.cloth_faces));
  for (Index f = 0; f < world.cloth_faces; ++f) {
    const Triangle& t = world.face[at(f)];
    const Vec3d a = world.position[at(t[0])], b = world.position[at(t[1])];
    volume[at(surfaces.of(f))] += dot(a, cross(b, world.position[at(t[2])]));
  }

  std::vector<Real> outward;
  for (Index f = 0; f < world.cloth_faces; ++f) {
    const std::size_t surface = at(surfaces.of(f));
    outward.push_back(is_open[surface] ? Real(0) : Real(volume[surface] < 0 ? -1 : 1));
  }
  return outward;
}

struct PressureShare {
  View<const Real> outward;  ///< see outward_sides (cloth_faces)
  Real pressure;             ///< [Pa]
  Real dt;                   ///< [s]

  ICLOTH_HD void add(const FaceShape& f, FaceTerm& t) const {
    if (pressure == 0 || outward[f.index] == 0) return;
    const Vec3r twice_area = outward[f.index] * cross(f.at[1] - f.at[0], f.at[2] - f.at[0]);
    const Vec3r impulse = (dt * pressure / 6) * twice_area;
    for (int a = 0; a < 3; ++a) t.impulse[a] += impulse;
  }
};

/// Share of one face in the volume inside [m³].
struct EnclosedVolume {
  View<const Int3> face;
  View<const Real> outward;
  View<const Vec3r> x;

  ICLOTH_HD double operator()(Index i) const {
    const Int3 f = face[i];
    const Vec3d a = convert<double>(x[f.v[0]]), b = convert<double>(x[f.v[1]]);
    return static_cast<double>(outward[i]) * dot(a, cross(b, convert<double>(x[f.v[2]]))) / 6;
  }
};

class Pressure : public Force {
 public:
  void lay_out(const World& world, const Topology&, PatternBuilder&) {
    outward_.upload(outward_sides(world));
  }
  PressureShare face_share(const ForceContext& c) const {
    return {outward_.view(), static_cast<Real>(c.parameters.material.pressure), c.point.dt};
  }
  /// −p V.
  void add_energy(const EnergyContext& c, ForceEnergy& energy) const {
    const double pressure = c.parameters.material.pressure;
    if (pressure == 0) return;
    energy.outer -=
        pressure * reduce("statistics.volume", c.mesh.cloth_faces, 0.0,
                          EnclosedVolume{c.mesh.face.view(), outward_.view(), c.x}, Sum{});
  }

 private:
  Array<Real> outward_;  ///< (cloth_faces), lay_out
};

}  // namespace icloth::ICLOTH_BUILD
