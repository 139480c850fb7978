// The memory of a simulation (sim/state/memory.h) where one build computes.
#pragma once

#include "kernels/box.h"
#include "kernels/stencil.h"
#include "kernels/yarn_friction.h"
#include "sim/state/memory.h"

namespace icloth::ICLOTH_BUILD {

using HeldForce = HeldForceOf<Real>;

struct OnDevice {
  template <class T>
  using List = Array<T>;
  using Real = ICLOTH_BUILD::Real;
  using YarnAnchor = ICLOTH_BUILD::YarnAnchor;
  using Box = ICLOTH_BUILD::Box;
};

using Memory = MemoryOf<OnDevice>;

Snapshot download(const Memory& memory);

/// `snapshot`: checked already (check_memory).
void upload(const Snapshot& snapshot, Memory& memory);

}  // namespace icloth::ICLOTH_BUILD
