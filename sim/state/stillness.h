// Whether the cloth has come to rest (step.sleep).
//
// Cloth is still when for kStillTime no vertex was further than kStillDistance from where it was at
// the beginning of that time. What creeps on as slowly as that goes less than 0.1 mm in a minute.
#pragma once

#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

inline constexpr double kStillTime = 3;         // [s]
inline constexpr double kStillDistance = 5e-6;  // [m]

/// Notes in the memory from when on no vertex has moved away; after an accepted step.
void watch_stillness(const Topology& mesh, State& state);

/// Forgets since when the cloth has been still, because something touches it or has changed.
void disturb(Memory& memory);

/// Whether the cloth has been still for long enough.
bool is_still(const Memory& memory);

/// Whether a body moves between the start and the end of the substep.
bool bodies_move(const Topology& mesh, const State& state);

}  // namespace icloth::ICLOTH_BUILD
