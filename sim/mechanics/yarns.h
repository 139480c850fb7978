// Anchors of the friction between yarns (kernels/yarn_friction.h) and its work.
#pragma once

#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// Prepares the anchors at the start of a step as the fabrics and the model of bending need them.
/// Anchors of another kind are reset to the shape x1, where no friction acts; without yarn friction
/// there are none. Changes of the parameters between two steps leave no trace.
void match_yarns(const Topology& mesh, const Parameters& parameters, State& state);

/// Pulls the anchors along where the shape x0 is further from them than the slip. Repeated from the
/// same shape, as when a substep is halved, it changes nothing but rounding.
void update_yarn_anchors(const Topology& mesh, const Parameters& parameters, State& state);

/// Work of the friction on the cloth from x0 to the candidate, with the force that the law has at
/// the candidate [J]. Where the step, linearised, had another force, the difference is an error of
/// the step, and shows in its energy balance. After update_yarn_anchors.
double yarn_work(const Topology& mesh, const Parameters& parameters, const State& state);

}  // namespace icloth::ICLOTH_BUILD
