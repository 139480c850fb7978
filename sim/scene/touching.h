// Neighbouring faces that touch where they are not joined: a vertex on an edge, a flap folded flat.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// Two elements without a common vertex, at distance 0, of two faces that share a vertex.
struct Touch {
  enum class Kind { vertex_vertex, vertex_edge, vertex_face, edge_edge };
  Kind kind{};
  std::array<Index, 4> v{};  ///< the one element's vertices, then the other's; unused ones are −1
  Index a = 0, b = 0;        ///< the faces, a < b
};

/// Every such pair, each once, sorted by faces; exact for the given doubles. A collision test
/// cannot keep apart what is in touch already, so a simulation cannot start from it. Faces without
/// a common vertex are find_intersections' task (sim/scene/intersections.h). Faces with group[f] <
/// 0 (obstacles) are left out; `group` may be empty.
std::vector<Touch> find_touching_neighbours(std::span<const Vec3d> positions,
                                            std::span<const Triangle> faces,
                                            std::span<const int> group);

}  // namespace icloth
