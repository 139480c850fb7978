#include "sim/scene/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "sim/scene/intersections.h"

namespace icloth {
namespace {

constexpr int kMostSweeps = 100;
constexpr int kPatience = 15;        ///< sweeps without fewer pairs
constexpr double kRelaxation = 0.6;  ///< neighbours push too, so a whole correction overshoots

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Cloths and obstacles as one list.
struct Soup {
  std::vector<Vec3d> positions, start;
  std::vector<Triangle> faces;
  std::vector<int> group;          ///< of faces; −1: obstacle
  std::vector<std::uint8_t> free;  ///< of vertices

  explicit Soup(const Scene& scene) {
    for (const Cloth& cloth : scene.cloths) {
      const std::size_t first = positions.size();
      add(cloth.mesh.positions, cloth.mesh.faces, 0);
      for (const Index pin : cloth.pins) free[first + at(pin)] = 0;
    }
    std::vector<Vec3d> pose;
    for (const Obstacle& obstacle : scene.obstacles) {
      obstacle.pose(0.0, pose);
      add(pose, obstacle.mesh.faces, -1);
    }
    start = positions;
  }

  void add(const std::vector<Vec3d>& x, const std::vector<Triangle>& triangles, int number) {
    const auto first = static_cast<Index>(positions.size());
    positions.insert(positions.end(), x.begin(), x.end());
    free.resize(positions.size(), number < 0 ? 0 : 1);
    for (const Triangle& t : triangles) faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    group.resize(faces.size(), number);
  }
};

/// Where an edge goes through a face.
struct Piercing {
  double s;                       ///< place on the edge, 0 … 1
  std::array<double, 3> weights;  ///< barycentric, of the face
  Vec3d normal;                   ///< unit
  double first, second;           ///< signed heights of the edge's ends over the face [m]
};

std::optional<Piercing> pierce(const Vec3d& a, const Vec3d& b, const std::array<Vec3d, 3>& face) {
  const Vec3d n = cross(face[1] - face[0], face[2] - face[0]);
  const double area2 = norm(n);
  if (!(area2 > 0)) return {};
  Piercing p{};
  p.normal = (1 / area2) * n;
  p.first = dot(p.normal, a - face[0]);
  p.second = dot(p.normal, b - face[0]);
  if ((p.first > 0) == (p.second > 0)) return {};
  p.s = p.first / (p.first - p.second);
  const Vec3d point = a + p.s * (b - a);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d side = cross(face[(k + 2) % 3] - face[(k + 1) % 3], point - face[(k + 1) % 3]);
    p.weights[k] = dot(p.normal, side) / area2;
    if (p.weights[k] < 0) return {};
  }
  return p;
}

/// Collects what the pairs ask for; a vertex goes by the mean of it.
class Sweep {
 public:
  Sweep(Soup& soup, double offset)
      : soup_(soup), offset_(offset), sum_(soup.positions.size()), count_(soup.positions.size()) {}

  void separate(Index f, Index g) {
    push_edges(f, g);
    push_edges(g, f);
  }

  void apply(double limit) {
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      if (count_[i] == 0) continue;
      Vec3d to = soup_.positions[i] + (kRelaxation / count_[i]) * sum_[i];
      const Vec3d way = to - soup_.start[i];
      if (norm(way) > limit) to = soup_.start[i] + (limit / norm(way)) * way;
      soup_.positions[i] = to;
    }
  }

 private:
  /// The edges of face f against face g.
  void push_edges(Index f, Index g) {
    const Triangle& edges = soup_.faces[at(f)];
    const Triangle& face = soup_.faces[at(g)];
    const std::array<Vec3d, 3> corners{x(face[0]), x(face[1]), x(face[2])};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = edges[k], b = edges[(k + 1) % 3];
      const auto p = pierce(x(a), x(b), corners);
      if (!p) continue;
      // Out of a body is where its normals point; between cloths the shallower end goes back.
      const bool back_first =
          soup_.group[at(g)] < 0 ? p->first < 0 : std::fabs(p->first) <= std::fabs(p->second);
      const Index moved = back_first ? a : b;
      const double height = back_first ? p->first : p->second;
      const double side = height > 0 ? -1 : 1;
      push(moved, face, p->weights, side * p->normal, std::fabs(height) + 1.5 * offset_);
    }
  }

  /// Vertex and face apart by `depth` along n, shared by how they can move.
  void push(Index v, const Triangle& face, const std::array<double, 3>& w, Vec3d n, double depth) {
    double mobility = soup_.free[at(v)];
    for (std::size_t k = 0; k < 3; ++k) mobility += w[k] * w[k] * soup_.free[at(face[k])];
    if (!(mobility > 0)) return;
    add(v, (depth / mobility) * n);
    for (std::size_t k = 0; k < 3; ++k) add(face[k], (-w[k] * depth / mobility) * n);
  }

  void add(Index v, Vec3d move) {
    if (soup_.free[at(v)] == 0) return;
    sum_[at(v)] += move;
    ++count_[at(v)];
  }
  const Vec3d& x(Index v) const { return soup_.positions[at(v)]; }

  Soup& soup_;
  double offset_;
  std::vector<Vec3d> sum_;
  std::vector<int> count_;
};

/// Single precision is what most builds compute in.
std::vector<IntersectingFaces> intersections(const Soup& soup) {
  std::vector<Vec3d> rounded;
  rounded.reserve(soup.positions.size());
  for (const Vec3d& p : soup.positions) rounded.push_back(convert<double>(convert<float>(p)));
  return find_intersections(rounded, soup.faces, soup.group);
}

}  // namespace

StartRepair repair_start(Scene& scene, double limit) {
  Soup soup(scene);
  StartRepair result;
  std::vector<IntersectingFaces> pairs = intersections(soup);
  result.pairs_before = pairs.size();
  std::size_t fewest = pairs.size();
  int waited = 0;
  for (int sweep = 0; sweep < kMostSweeps && !pairs.empty() && waited < kPatience; ++sweep) {
    Sweep moves(soup, scene.parameters.impact_zones.offset);
    for (const IntersectingFaces& pair : pairs) moves.separate(pair.a, pair.b);
    moves.apply(limit);
    pairs = intersections(soup);
    waited = pairs.size() < fewest ? 0 : waited + 1;
    fewest = std::min(fewest, pairs.size());
  }
  result.pairs_left = pairs.size();
  std::size_t first = 0;
  for (Cloth& cloth : scene.cloths) {
    for (Vec3d& p : cloth.mesh.positions) {
      const double move = norm(soup.positions[first] - p);
      result.moved += move > 0 ? 1 : 0;
      result.largest_move = std::max(result.largest_move, move);
      p = soup.positions[first++];
    }
  }
  scene.repair = result;
  return result;
}

}  // namespace icloth
