// The shape at which an iteration of the implicit step linearises the forces on the cloth.
#pragma once

#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// The elastic forces are f(x1) ≈ f(at) − K(at) (x1 − at + d v1), with d the time constant of the
/// stiffness damping and x1 = at + predicted + dt Δv. Yarn friction is linearised in the same way
/// without damping. Its K is the secant from the anchor to the predicted shape, at + predicted, in
/// the first iteration, and from the anchor to `at` in later ones.
struct Linearization {
  View<const Vec3r> start;      ///< x0; the coefficients of the fabric are those of this shape [m]
  View<const Vec3r> at;         ///< shape of the linearisation [m]
  View<const Vec3r> predicted;  ///< motion from `at` to x1 with Δv = 0 [m]
  View<const Vec3r> v;          ///< before the step [m/s]
  Real dt;                      ///< [s]
  /// Faces that are linearised at `at`, where 1. The others, and the hinges between two of them,
  /// have hardly moved and stay as the first iteration linearised them, at `start`. Empty: there
  /// are no others (cloth_faces).
  View<const std::uint8_t> renewed{};

  /// Whether this is the second or a later iteration.
  ICLOTH_HD bool moved() const { return at.data() != start.data(); }
  /// Whether a face stays as it was linearised first.
  ICLOTH_HD bool keeps(Index face) const { return renewed.size() > 0 && renewed[face] == 0; }
  /// The shape at which a face is linearised.
  ICLOTH_HD View<const Vec3r> shape_of(Index face) const { return keeps(face) ? start : at; }

  /// Factor of K on the right-hand side, predicted + d v [m].
  ICLOTH_HD Vec3r damped_motion(Index i, Real damping) const {
    return predicted[i] + damping * v[i];
  }
};

/// The data that a force may read when the system is assembled and when its work is added up.
struct ForceContext {
  const Topology& mesh;
  const Parameters& parameters;
  const State& state;
  Linearization point;
  View<const Vec3r> free_motion;  ///< x1 − x0 with Δv = 0, in every iteration [m] (vertices)
};

}  // namespace icloth::ICLOTH_BUILD
