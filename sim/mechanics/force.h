// The parts that a force on the cloth consists of. sim/mechanics/forces.h has the list of all
// forces and says how to add one.
#pragma once

#include "sim/mechanics/face_pass.h"
#include "sim/mechanics/pattern_builder.h"

namespace icloth::ICLOTH_BUILD {

/// Holds one share of each force in the order of the list, and visits them in that order. A struct
/// instead of std::tuple, because kernels go through it.
template <class... Shares>
struct Bundle;

template <>
struct Bundle<> {
  template <class Visit>
  ICLOTH_HD void each(const Visit&) const {}
};

template <class First, class... Rest>
struct Bundle<First, Rest...> {
  First first;
  Bundle<Rest...> rest;

  template <class Visit>
  ICLOTH_HD void each(const Visit& visit) const {
    visit(first);
    rest.each(visit);
  }
};

inline Bundle<> bundle_of() { return {}; }

template <class First, class... Rest>
Bundle<First, Rest...> bundle_of(const First& first, const Rest&... rest) {
  return {first, bundle_of(rest...)};
}

/// Share of a force that does not act on faces.
struct NoFaceShare {
  ICLOTH_HD void add(const FaceShape&, FaceTerm&) const {}
};

/// Share of a force that has no elements of its own.
struct NoRowShare {
  ICLOTH_HD bool renews(Index) const { return false; }
  ICLOTH_HD void add(const RowBlock&, Mat3r&, Vec3r&) const {}
};

/// Potential energies of a shape of the cloth, added up over all forces.
struct ForceEnergy {
  double elastic = 0;  ///< of the fabric [J]
  double outer = 0;    ///< of conservative forces from outside, gravity left out [J]
  double strain = 0;   ///< largest principal stretch − 1
};

struct EnergyContext {
  const Topology& mesh;
  const Parameters& parameters;
  View<const Vec3r> x;  ///< shape [m] (≥ cloth_vertices)
};

/// Base of all forces, with a version of each part that does nothing. A force hides the versions of
/// the parts that it has; the compiler settles which one is called.
struct Force {
  /// Pattern: whether the force couples vertices that no face couples. Where that changes, the
  /// pattern is built anew.
  static bool couples(const Topology&) { return false; }
  /// Pattern: names the elements whose vertices the force couples, keeps where they are stored, and
  /// works out what depends on the scene alone.
  void lay_out(const World&, const Topology&, PatternBuilder&) {}

  /// State that the force carries from substep to substep: brings it to the shape x0.
  void begin_substep(const Topology&, const Parameters&, State&) {}

  /// Assembly, first: passes over elements of its own.
  void prepare(const ForceContext&) {}
  /// Assembly: what the force adds to each face, in the pass over all faces.
  NoFaceShare face_share(const ForceContext&) const { return {}; }
  /// Assembly, last: what the force adds to each stored block, in the pass over the rows. In later
  /// iterations a row is left as it is unless the share of a force `renews` it, given its diagonal
  /// block.
  NoRowShare row_share(const ForceContext&) const { return {}; }

  /// Energy of a shape, where the force has a potential.
  void add_energy(const EnergyContext&, ForceEnergy&) const {}
  /// Work on the cloth from x0 to the candidate [J], where the force has no potential: with the
  /// force that the solve applied, `dv` its solution (≥ cloth_vertices).
  double work(const ForceContext&, View<const Vec3r>) const { return 0; }
};

}  // namespace icloth::ICLOTH_BUILD
