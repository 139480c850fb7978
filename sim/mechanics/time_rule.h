// How a step goes from velocities to positions: backward Euler, or the two-step formula of second
// order (BDF2) with steps that may change. With x' and v' taken from the past,
//
//   x1 = x' + h v1    x' = x0 + w (x0 − x₋₁)
//   v1 = v' + h a1    v' = v0 + w (v0 − v₋₁)
//
// BDF2: with r = dt / (length of the last step), h = dt (1 + r)/(1 + 2r), w = r²/(1 + 2r)
// (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, III.5). Euler: h = dt, w =
// 0.
#pragma once

#include "kernels/parallel/platform.h"
#include "sim/scene/parameters.h"

namespace icloth::ICLOTH_BUILD {

struct TimeRule {
  Real dt;  ///< [s]
  Real h;   ///< from a change of velocity to a change of position [s]
  Real w;   ///< weight of the last step
  Integrator integrator;

  ICLOTH_HD bool remembers() const { return w != 0; }
};

/// `past`: length of the last step [s], 0: there is none to go on from.
inline TimeRule time_rule(Integrator integrator, double dt, double past) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  if (integrator == Integrator::backward_euler || !(past > 0))
    return {real(dt), real(dt), 0, integrator};
  const double r = dt / past;
  return {real(dt), real(dt * (1 + r) / (1 + 2 * r)), real(r * r / (1 + 2 * r)), integrator};
}

}  // namespace icloth::ICLOTH_BUILD
