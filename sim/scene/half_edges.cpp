#include "sim/scene/half_edges.h"

#include <algorithm>

#include "kernels/index.h"

namespace icloth {

std::vector<HalfEdge> sorted_half_edges(std::span<const Triangle> faces, Index first_face) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (Index corner = 0; corner < 3; ++corner) {
      const Index a = faces[f][at(corner)], b = faces[f][at((corner + 1) % 3)];
      half_edges.push_back(
          {{std::min(a, b), std::max(a, b)}, first_face + static_cast<Index>(f), corner});
    }

  std::ranges::sort(half_edges, [](const HalfEdge& a, const HalfEdge& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.face < b.face;
  });
  return half_edges;
}

}  // namespace icloth
