#include "sim/pattern/divide_pattern.h"

#include <algorithm>
#include <map>

#include "kernels/index.h"

namespace icloth {
namespace {

using Edge = std::array<Index, 2>;

Edge edge_between(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Division of one panel. Points are numbered when they are first asked for, old ones and middles
/// alike, so that the outline comes first in the finer panel too.
class PanelDivision {
 public:
  explicit PanelDivision(const PanelMesh& coarse) : coarse_(coarse) {
    for (const std::vector<Index>& edge : coarse.edge_points) add_edge(edge);
    for (std::size_t v = 0; v < coarse.points.size(); ++v) old_point(static_cast<Index>(v));
    for (const Triangle& t : coarse.faces) add_face(t);
  }

  PanelMesh fine;
  std::vector<Edge> parents;

 private:
  Index old_point(Index v) { return number({v, v}); }
  Index middle(Index a, Index b) { return number(edge_between(a, b)); }

  /// The point in the middle of two, which may be the same.
  Index number(Edge between) {
    const auto [entry, is_new] =
        numbers_.try_emplace(between, static_cast<Index>(fine.points.size()));
    if (is_new) {
      const Vec2d a = coarse_.points[at(between[0])], b = coarse_.points[at(between[1])];
      fine.points.push_back({0.5 * (a.x + b.x), 0.5 * (a.y + b.y)});
      parents.push_back(between);
    }
    return entry->second;
  }

  void add_edge(const std::vector<Index>& coarse) {
    std::vector<Index>& edge = fine.edge_points.emplace_back();
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      if (i > 0) edge.push_back(middle(coarse[i - 1], coarse[i]));
      edge.push_back(old_point(coarse[i]));
    }
  }

  void add_face(const Triangle& t) {
    const Index a = old_point(t[0]), b = old_point(t[1]), c = old_point(t[2]);
    const Index ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }

  const PanelMesh& coarse_;
  std::map<Edge, Index> numbers_;  ///< of the points, by what they lie between
};

std::size_t count_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  for (const Triangle& t : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge_between(t[k], t[(k + 1) % 3]));
  std::ranges::sort(edges);
  return static_cast<std::size_t>(std::unique(edges.begin(), edges.end()) - edges.begin());
}

}  // namespace

DividedPattern divide_pattern(const MeshedPattern& coarse) {
  DividedPattern divided;
  divided.meshed.pattern = coarse.pattern;
  divided.meshed.edge_length = 0.5 * coarse.edge_length;
  divided.meshed.notes = coarse.notes;
  for (const PanelMesh& panel : coarse.panels) {
    PanelDivision division(panel);
    divided.meshed.panels.push_back(std::move(division.fine));
    divided.parents.push_back(std::move(division.parents));
  }
  return divided;
}

bool is_sewn_alike(const SewnGarment& coarse, const SewnGarment& fine) {
  return fine.mesh.faces.size() == 4 * coarse.mesh.faces.size() &&
         fine.mesh.positions.size() == coarse.mesh.positions.size() + count_edges(coarse.mesh);
}

}  // namespace icloth
