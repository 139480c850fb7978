// Energies, largest strain and speed, and hash of a state: what a step reports about its end.
#pragma once

#include "sim/mechanics/forces.h"

namespace icloth::ICLOTH_BUILD {

/// Statistics of a state of the cloth.
struct StateStatistics {
  double kinetic = 0, elastic = 0, gravity = 0;  ///< energies [J]
  double outer = 0;   ///< energy of other conservative forces from outside [J]
  double strain = 0;  ///< largest principal stretch − 1
  double speed = 0;   ///< largest [m/s]

  double energy() const { return kinetic + elastic + gravity + outer; }
};

/// Measures the cloth in a shape, with masses [kg] and velocities [m/s] (≥ cloth_vertices).
StateStatistics statistics_of(const Forces& forces, const EnergyContext& shape,
                              View<const Real> mass, View<const Vec3r> v);

/// Writes the statistics of the state (x1, v) to the report; returns its energy [J].
double report_state(const Forces& forces, const Topology& mesh, const State& state,
                    const Parameters& parameters, StateReport& report);

/// Writes the largest strain and speed of the state (x1, v) to the report.
void report_extremes(const Topology& mesh, const State& state, StateReport& report);

/// 64-bit hash of the bits of all positions and velocities; does not depend on the thread count.
std::uint64_t hash_state(const State& state);

/// False when a position of the step's end is not a finite number.
bool all_finite(const State& state);

}  // namespace icloth::ICLOTH_BUILD
