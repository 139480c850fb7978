#include "sim/scene/rest_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "kernels/index.h"
#include "sim/scene/edge_lengths.h"
#include "sim/scene/material_space.h"

namespace icloth {
namespace {

/// A place of a vertex in the pattern.
struct Place {
  Index vertex, panel;
  Vec2d uv;
};

/// The places of all vertices, those of one vertex together in the order of their panels.
class Places {
 public:
  Places(std::span<const Triangle> faces, std::size_t vertices,
         const std::vector<std::array<Vec2d, 3>>& corners, const std::vector<Index>& panel)
      : first_(vertices + 1) {
    std::vector<Place> all;
    std::vector<double> lengths;
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t c = 0; c < 3; ++c) {
        all.push_back({faces[f][c], panel[f], corners[f][c]});
        lengths.push_back(distance(corners[f][c], corners[f][(c + 1) % 3]));
      }

    // Corners of one panel that differ by rounding alone are one place. Sorting brings them
    // together and makes the choice independent of the order of the faces.
    const double rounding = 1e-3 * median(std::move(lengths));
    std::ranges::sort(all, {},
                      [](const Place& p) { return std::tuple(p.vertex, p.panel, p.uv.x, p.uv.y); });
    for (const Place& place : all) {
      const bool known = !places_.empty() && places_.back().vertex == place.vertex &&
                         places_.back().panel == place.panel &&
                         distance(places_.back().uv, place.uv) < rounding;
      if (!known) places_.push_back(place);
    }

    for (const Place& place : places_) ++first_[at(place.vertex) + 1];
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
  }

  std::span<const Place> of(Index v) const {
    return std::span(places_).subspan(first_[at(v)], first_[at(v) + 1] - first_[at(v)]);
  }

  static double distance(Vec2d a, Vec2d b) { return std::hypot(a.x - b.x, a.y - b.y); }

 private:
  std::vector<Place> places_;
  std::vector<std::size_t> first_;
};

/// Vertices that share an edge with each vertex, sorted.
std::vector<std::vector<Index>> adjacent_vertices(std::span<const Triangle> faces,
                                                  std::size_t vertices) {
  std::vector<std::vector<Index>> adjacent(vertices);
  for (const Triangle& t : faces)
    for (std::size_t c = 0; c < 3; ++c) {
      adjacent[at(t[c])].push_back(t[(c + 1) % 3]);
      adjacent[at(t[c])].push_back(t[(c + 2) % 3]);
    }
  for (std::vector<Index>& list : adjacent) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return adjacent;
}

/// Vertices that a search finds at most, the nearest rings first. Usual meshes have about 40; the
/// bound keeps the work linear where thousands of faces meet at one vertex.
constexpr std::size_t kMostAround = 128;

/// Finds the vertices within kListedRings edges of one vertex. The marks are kept between calls, so
/// that a call costs what it finds.
class RingSearch {
 public:
  explicit RingSearch(const std::vector<std::vector<Index>>& adjacent)
      : adjacent_(adjacent), seen_(adjacent.size(), kNone) {}

  const std::vector<Index>& around(Index vertex) {
    found_.assign(1, vertex);
    seen_[at(vertex)] = vertex;
    std::size_t ring = 0;
    for (int k = 0; k < kListedRings; ++k)
      for (const std::size_t end = found_.size(); ring < end; ++ring)
        for (Index next : adjacent_[at(found_[ring])]) {
          if (seen_[at(next)] == vertex) continue;
          if (found_.size() == kMostAround) return found_;
          seen_[at(next)] = vertex;
          found_.push_back(next);
        }
    return found_;
  }

 private:
  const std::vector<std::vector<Index>>& adjacent_;
  std::vector<Index> seen_;  ///< the last vertex whose search came by
  std::vector<Index> found_;
};

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The shortest straight way between two vertices within a panel that both lie in.
double straight_distance(const Places& places, Index a, Index b) {
  const std::span<const Place> of_a = places.of(a), of_b = places.of(b);
  double shortest = kFar;

  // Both lists are sorted by panel, so they are gone through side by side.
  auto p = of_a.begin(), q = of_b.begin();
  while (p != of_a.end() && q != of_b.end()) {
    if (p->panel != q->panel) {
      ++(p->panel < q->panel ? p : q);
      continue;
    }
    for (auto other = q; other != of_b.end() && other->panel == p->panel; ++other)
      shortest = std::min(shortest, Places::distance(p->uv, other->uv));
    ++p;
  }
  return shortest;
}

/// The list of one vertex: those around it that a seam separates from it, or that lie on one.
std::vector<RestDistance> list_of(Index vertex, const Places& places,
                                  const std::vector<Index>& panel, std::vector<Index> around) {
  struct SeamVertex {
    Index vertex;
    double distance;
  };
  std::vector<SeamVertex> seam;
  for (Index v : around)
    if (panel[at(v)] == kNone) seam.push_back({v, straight_distance(places, vertex, v)});
  std::vector<RestDistance> list;
  if (seam.empty()) return list;

  std::ranges::sort(around);
  for (Index v : around) {
    if (v <= vertex) continue;
    const double straight = straight_distance(places, vertex, v);
    double across = kFar;
    for (const SeamVertex& m : seam)
      if (m.distance < across)
        across = std::min(across, m.distance + straight_distance(places, m.vertex, v));

    // Two vertices inside one panel have their coordinates, except where a seam, a dart say, makes
    // the way between them shorter.
    const bool of_one_panel = panel[at(vertex)] != kNone && panel[at(vertex)] == panel[at(v)];
    if (of_one_panel && !(across < straight)) continue;
    const double distance = std::min(straight, across);
    if (distance < kFar) list.push_back({v, distance * distance});
  }
  return list;
}

}  // namespace

RestDistances rest_distances(std::span<const Triangle> faces, std::size_t vertices,
                             const std::vector<std::array<Vec2d, 3>>& corners) {
  const std::vector<Index> face_panel = find_panels({{}, {faces.begin(), faces.end()}, corners});
  const Places places(faces, vertices, corners, face_panel);

  RestDistances result;
  result.panel.resize(vertices, kNone);
  for (std::size_t v = 0; v < vertices; ++v)
    if (const auto of = places.of(static_cast<Index>(v)); of.size() == 1)
      result.panel[v] = of.front().panel;

  const std::vector<std::vector<Index>> adjacent = adjacent_vertices(faces, vertices);
  RingSearch search(adjacent);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto vertex = static_cast<Index>(v);
    result.first.push_back(static_cast<Index>(result.distances.size()));
    const auto list = list_of(vertex, places, result.panel, search.around(vertex));
    result.distances.insert(result.distances.end(), list.begin(), list.end());
  }
  result.first.push_back(static_cast<Index>(result.distances.size()));
  return result;
}

}  // namespace icloth
