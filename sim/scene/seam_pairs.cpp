#include "sim/scene/seam_pairs.h"

#include <algorithm>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// Vertex of a side of a seam in the world.
Index world_vertex(const Seam& seam, const World& world, Index cloth, Index vertex) {
  if (cloth < 0 || at(cloth) >= world.objects.size() || !world.objects[at(cloth)].cloth)
    throw InputError("seam " + in_quotes(seam.name) + ": cloth " + std::to_string(cloth) +
                     ", expected one of the scene");
  const WorldObject& object = world.objects[at(cloth)];
  if (vertex < 0 || vertex >= object.vertex_count)
    throw InputError("seam " + in_quotes(seam.name) + ": vertex " + std::to_string(vertex) +
                     " of cloth " + in_quotes(object.name) + ", expected 0 to " +
                     std::to_string(object.vertex_count - 1));
  return object.first_vertex + vertex;
}

/// Each vertex of `wanted` (sorted) with those that it shares an edge with, and itself.
std::vector<std::vector<Index>> rings_of(const World& world, const std::vector<Index>& wanted) {
  std::vector<std::vector<Index>> rings(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) rings[i].push_back(wanted[i]);

  const auto add = [&](Index center, Index other) {
    const auto found = std::ranges::lower_bound(wanted, center);
    if (found != wanted.end() && *found == center)
      rings[static_cast<std::size_t>(found - wanted.begin())].push_back(other);
  };
  for (Index e = 0; e < world.cloth_edges; ++e) {
    add(world.edge[at(e)][0], world.edge[at(e)][1]);
    add(world.edge[at(e)][1], world.edge[at(e)][0]);
  }
  return rings;
}

}  // namespace

std::vector<StitchedPair> stitched_pairs(const Scene& scene, const World& world) {
  std::vector<StitchedPair> pairs;
  for (std::size_t s = 0; s < scene.seams.size(); ++s) {
    const Seam& seam = scene.seams[s];
    for (const auto& [a, b] : seam.pairs)
      pairs.push_back({world_vertex(seam, world, seam.from, a),
                       world_vertex(seam, world, seam.to, b), static_cast<Index>(s), seam.pulls});
  }
  return pairs;
}

SeamNeighbours seam_neighbours(const World& world, const std::vector<StitchedPair>& pairs) {
  SeamNeighbours result;
  if (pairs.empty()) return result;

  // The rings around all stitched vertices come from one pass over the edges.
  std::vector<Index> wanted;
  for (const StitchedPair& p : pairs) wanted.insert(wanted.end(), {p.a, p.b});
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const std::vector<std::vector<Index>> rings = rings_of(world, wanted);
  const auto ring = [&](Index v) -> const std::vector<Index>& {
    return rings[static_cast<std::size_t>(std::ranges::lower_bound(wanted, v) - wanted.begin())];
  };

  // Every vertex around one side sees every one around the other.
  std::vector<std::array<Index, 2>> links;
  for (const StitchedPair& p : pairs)
    for (const Index u : ring(p.a))
      for (const Index w : ring(p.b)) {
        links.push_back({u, w});
        links.push_back({w, u});
      }
  std::ranges::sort(links);
  links.erase(std::unique(links.begin(), links.end()), links.end());

  // Sorted links are the lists, one after the other.
  result.first.assign(at(world.cloth_vertices) + 1, 0);
  for (const auto& [from, to] : links) {
    ++result.first[at(from) + 1];
    result.vertex.push_back(to);
  }
  for (std::size_t v = 1; v < result.first.size(); ++v) result.first[v] += result.first[v - 1];
  return result;
}

double weld_tolerance(double median_edge) { return std::max(3 * kSeamOffset, 0.02 * median_edge); }

}  // namespace icloth
