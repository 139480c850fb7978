// What a step reports about the state it ends in.
#pragma once

#include "sim/state.h"

namespace icloth::ICLOTH_BUILD {

/// Writes energies, largest strain and largest speed of the state (x1, v) to the report.
void report_state(const Topology& mesh, const State& state, const Parameters& parameters,
                  StepReport& report);

/// 64-bit hash of the bits of all positions and velocities; does not depend on the thread count.
std::uint64_t hash_state(const State& state);

/// False when a position of the step's end is not a finite number.
bool all_finite(const State& state);

}  // namespace icloth::ICLOTH_BUILD
