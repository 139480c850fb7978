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

std::vector<HalfEdge> border_sides(std::span<const Triangle> faces) {
  const std::vector<HalfEdge> sides = sorted_half_edges(faces);
  std::vector<HalfEdge> border;

  // Sides of one edge stand together; one on the border stands alone.
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    if (end - begin == 1) border.push_back(sides[begin]);
  }
  return border;
}

}  // namespace icloth
