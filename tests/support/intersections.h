// The exact test of a simulator's state, as a count.
#pragma once

#include <cstddef>

#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"
#include "sim/simulator.h"

namespace icloth::testing {

/// Pairs of faces that intersect in the present state.
inline std::size_t count_intersections(const Simulator& simulator) {
  const SceneFaces soup = scene_faces(simulator.scene());
  return find_intersections(simulator.snapshot().x1, soup.faces, soup.group).size();
}

}  // namespace icloth::testing
