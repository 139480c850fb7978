// Work that forces from outside did on the cloth in an implicit step. Part of the energy balance
// that a step reports; it changes nothing.
#pragma once

#include "sim/elastic_terms.h"
#include "sim/state.h"

namespace icloth::ICLOTH_BUILD {

Wind wind_of(const Parameters& parameters);

/// Work of the air on the motion x0 → candidate, with the force that the solve applied: linearised
/// at `point`, dv its solution (≥ cloth_vertices) [J]. 0 without air.
double air_work(const StepContext& step, const Linearization& point, View<const Vec3r> dv);

/// Likewise of the springs of the hands, their damping included [J]. 0 without hands.
double hand_work(const StepContext& step, const Linearization& point, View<const Vec3r> dv);

}  // namespace icloth::ICLOTH_BUILD
