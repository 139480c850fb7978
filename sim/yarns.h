// Anchors of the friction between yarns (kernels/yarn_friction.h): where they are at the start of a
// substep.
#pragma once

#include "sim/state.h"

namespace icloth::ICLOTH_BUILD {

/// Lets the shape x1 pull the anchors along; nothing without fabrics whose yarns rub. Again from
/// the same shape it changes nothing, as when a substep is halved.
void drag_yarns(const Topology& mesh, const Parameters& parameters, State& state);

/// Anchors at the shape x1, where no friction acts; none for fabrics whose yarns do not rub.
void ease_yarns(const Topology& mesh, const Parameters& parameters, State& state);

/// Work of the friction on the cloth from x0 to the candidate [J].
double yarn_work(const Topology& mesh, const Parameters& parameters, const State& state);

}  // namespace icloth::ICLOTH_BUILD
