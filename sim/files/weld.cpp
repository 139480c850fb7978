#include "sim/files/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "kernels/index.h"

namespace icloth {
namespace {

/// Vertices that may lie in the cells around one: those that are more than a cell apart in the
/// mesh are at most about 60, the rest shape can tell more of them apart.
constexpr std::size_t kMostNear = 400;

using Cell = std::array<double, 3>;  // whole numbers

struct HashCell {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const double c : cell) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Points in cells as large as the distance within which they are looked for.
class NearPoints {
 public:
  explicit NearPoints(double distance) : distance_(distance) {}

  /// Calls `visit` for every point in the cells around a place; false where there are too many.
  template <class Visit>
  bool around(Vec3d place, const Visit& visit) const {
    std::size_t count = 0;
    const Cell centre = cell_of(place);

    // Cells are as large as the distance, so all near points are in this one and those around it.
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells_.find({centre[0] + k % 3 - 1, centre[1] + k / 3 % 3 - 1, centre[2] + k / 9 - 1});
      if (found == cells_.end()) continue;
      count += found->second.size();
      if (count > kMostNear) return false;
      for (const Index i : found->second) visit(i);
    }
    return true;
  }

  void add(Vec3d place, Index number) { cells_[cell_of(place)].push_back(number); }

 private:
  /// Adding 0 makes −0 a 0: both are one cell.
  Cell cell_of(Vec3d p) const {
    return {std::floor(p.x / distance_) + 0.0, std::floor(p.y / distance_) + 0.0,
            std::floor(p.z / distance_) + 0.0};
  }

  double distance_;
  std::unordered_map<Cell, std::vector<Index>, HashCell> cells_;
};

std::vector<bool> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.faces)
    for (const Index v : t) used[at(v)] = true;
  return used;
}

auto coordinates(Vec3d p) { return std::tuple(p.x, p.y, p.z); }

/// The edges with one face, each as its two vertices.
std::vector<std::array<Index, 2>> border_edges(const TriangleMesh& mesh) {
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(3 * mesh.faces.size());
  for (const Triangle& t : mesh.faces)
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = t[c], b = t[(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::ranges::sort(edges);

  // Equal edges stand next to each other now; a border edge stands alone.
  std::vector<std::array<Index, 2>> border;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    if (end - begin == 1) border.push_back(edges[begin]);
  }
  return border;
}

/// Returns for each used vertex the first one of the file that is at the same place, in the rest
/// shape too, and kNone for unused ones. Counts unused and welded vertices, and those that are
/// apart in the rest shape alone.
std::vector<Index> first_at_place(const TriangleMesh& mesh, const std::vector<Vec3d>& rest,
                                  bool weld, WeldReport& report) {
  const std::size_t count = mesh.positions.size();
  const std::vector<bool> used = used_vertices(mesh);
  std::vector<Index> order, first(count, kNone);
  for (std::size_t v = 0; v < count; ++v)
    if (used[v]) order.push_back(static_cast<Index>(v));
  for (const Index v : order) first[at(v)] = v;
  report.unused = count - order.size();
  if (!weld) return first;

  // Vertices at one place stand together after sorting, the first one of the file in front. The
  // lists compare numbers, for which 0 and −0 are equal.
  const auto place = [&](Index v) { return coordinates(mesh.positions[at(v)]); };
  const auto both = [&](Index v) { return std::tuple(place(v), coordinates(rest[at(v)])); };
  std::ranges::sort(order, {}, [&](Index v) { return std::tuple(both(v), v); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Index before = order[i - 1], v = order[i];
    if (both(before) == both(v)) {
      first[at(v)] = first[at(before)];
      ++report.welded;
    } else if (place(before) == place(v)) {
      ++report.apart;
    }
  }
  return first;
}

/// Keeps the vertices that are the first at their place, numbered on in the order of the file.
/// Writes how the file's vertices stand for them.
void keep_first(const std::vector<Index>& first, TriangleMesh& mesh, std::vector<Vec3d>& rest,
                FileLayout& layout) {
  layout.positions = std::move(mesh.positions);
  layout.faces = mesh.faces;
  layout.vertex.assign(first.size(), kNone);
  const std::vector<Vec3d> file_rest = std::move(rest);
  mesh.positions.clear();
  rest.clear();

  // The first vertex at a place has its new number before the others ask for it.
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (first[v] == kNone) continue;
    if (first[v] == static_cast<Index>(v)) {
      layout.vertex[v] = static_cast<Index>(mesh.positions.size());
      mesh.positions.push_back(layout.positions[v]);
      rest.push_back(file_rest[v]);
    } else {
      layout.vertex[v] = layout.vertex[at(first[v])];
    }
  }
  for (Triangle& t : mesh.faces)
    for (Index& v : t) v = layout.vertex[at(v)];
}

}  // namespace

bool snap_vertices(TriangleMesh& mesh, std::vector<Vec3d>& rest, double distance, Vec3d scale) {
  const auto scaled = [&](Vec3d p) { return Vec3d{scale.x * p.x, scale.y * p.y, scale.z * p.z}; };
  const std::vector<bool> used = used_vertices(mesh);
  NearPoints kept(distance);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;

    // The vertex moves to the nearest one that keeps its place, the first one of two as near.
    const Vec3d start = scaled(mesh.positions[v]), flat = scaled(rest[v]);
    Index nearest = kNone;
    double smallest = distance;
    const bool all_seen = kept.around(start, [&](Index other) {
      const double d = std::max(norm(scaled(mesh.positions[at(other)]) - start),
                                norm(scaled(rest[at(other)]) - flat));
      if (d < smallest || (d == smallest && (nearest == kNone || other < nearest))) {
        smallest = d;
        nearest = other;
      }
    });
    if (!all_seen) return false;

    // A vertex that has no such neighbour keeps its own place, so later ones can move onto it.
    if (nearest == kNone) {
      kept.add(start, static_cast<Index>(v));
    } else {
      mesh.positions[v] = mesh.positions[at(nearest)];
      rest[v] = rest[at(nearest)];
    }
  }
  return true;
}

WeldReport merge_vertices(TriangleMesh& mesh, std::vector<Vec3d>& rest, bool weld,
                          FileLayout& layout) {
  WeldReport report;
  const std::vector<Index> first = first_at_place(mesh, rest, weld, report);
  if (report.welded + report.unused > 0) keep_first(first, mesh, rest, layout);
  return report;
}

std::size_t near_border_vertices(const TriangleMesh& mesh, double distance) {
  std::vector<std::array<Index, 2>> border = border_edges(mesh);

  // Vertices have several border edges and count once.
  std::vector<Index> vertices;
  for (const auto& [a, b] : border) vertices.insert(vertices.end(), {a, b});
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

  // A vertex is compared with those before it alone, so one vertex of each pair is counted.
  NearPoints before(distance);
  std::size_t found = 0;
  for (const Index v : vertices) {
    const Vec3d place = mesh.positions[at(v)];
    bool near = false;
    before.around(place, [&](Index other) {
      const std::array<Index, 2> edge{other, v};
      near = near || (norm(mesh.positions[at(other)] - place) <= distance &&
                      !std::ranges::binary_search(border, edge));
    });
    if (near) ++found;
    before.add(place, v);
  }
  return found;
}

std::vector<Index> file_numbers(const FileLayout& layout) {
  std::vector<Index> numbers;
  for (std::size_t v = 0; v < layout.vertex.size(); ++v)
    if (layout.vertex[v] == static_cast<Index>(numbers.size()))
      numbers.push_back(static_cast<Index>(v));
  return numbers;
}

}  // namespace icloth
