// Anchors of the friction between yarns (kernels/yarn_friction.h) and its work.
#pragma once

#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// At the start of a step: anchors as its fabrics and its model of bending need them. Those of
/// another kind are made anew at x1, where no friction acts; none where no yarns rub. What happened
/// to the parameters between two steps leaves no trace.
void match_yarns(const Topology& mesh, const Parameters& parameters, State& state);

/// Lets the shape x0 pull the anchors along. Again from the same shape, as when a substep is
/// halved, it changes nothing but rounding.
void drag_yarns(const Topology& mesh, const Parameters& parameters, State& state);

/// Work of the friction on the cloth from x0 to the candidate, with the force that the law has at
/// the candidate [J]. Where the step, linearised, had another force, the difference is an error of
/// the step, and shows in its energy balance. After drag_yarns.
double yarn_work(const Topology& mesh, const Parameters& parameters, const State& state);

}  // namespace icloth::ICLOTH_BUILD
