// Meshes of panels: they cover the outline once, are Delaunay, and have even triangles.
#include "sim/pattern/panel_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "sim/pattern/outline.h"
#include "sim/pattern/panel_fill.h"
#include "sim/pattern/sewing.h"
#include "tests/sim/pattern/pattern_support.h"

namespace icloth {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

double distance(Vec2d a, Vec2d b) { return std::hypot(a.x - b.x, a.y - b.y); }

PanelMesh meshed(const std::string& panel, double h) {
  return mesh_pattern(parsed(pattern_file(panel)), h).panels[0];
}

using Edge = std::pair<Index, Index>;

/// How many faces have each edge.
std::map<Edge, int> edges_of(std::span<const Triangle> faces) {
  std::map<Edge, int> edges;
  for (const Triangle& t : faces)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  return edges;
}

/// Number of points on the outline: the first ones.
Index ring_size(const PanelMesh& mesh) {
  std::size_t count = 0;
  for (const auto& edge : mesh.edge_points) count += edge.size() - 1;
  return static_cast<Index>(count);
}

double area_of(const PanelMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.faces) {
    const Vec2d a = mesh.points[at(t[0])], b = mesh.points[at(t[1])] - a,
                c = mesh.points[at(t[2])] - a;
    EXPECT_GT(b.x * c.y - b.y * c.x, 0);
    sum += 0.5 * (b.x * c.y - b.y * c.x);
  }
  return sum;
}

double ring_area(const PanelMesh& mesh) {
  double sum = 0;
  const Index n = ring_size(mesh);
  for (Index i = 0; i < n; ++i) {
    const Vec2d a = mesh.points[at(i)], b = mesh.points[at((i + 1) % n)];
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

/// The smallest angle of all triangles [degrees].
double smallest_angle(const PanelMesh& mesh) {
  double smallest = 180;
  for (const Triangle& t : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2d a = mesh.points[at(t[k])];
      const Vec2d b = mesh.points[at(t[(k + 1) % 3])] - a, c = mesh.points[at(t[(k + 2) % 3])] - a;
      const double angle = std::atan2(b.x * c.y - b.y * c.x, b.x * c.x + b.y * c.y);
      smallest = std::min(smallest, angle * 180 / std::numbers::pi);
    }
  return smallest;
}

/// Standard deviation of the lengths of edges over their mean.
double variation_of_edges(const PanelMesh& mesh) {
  double count = 0, sum = 0, squares = 0;
  for (const auto& [edge, faces] : edges_of(mesh.faces)) {
    const double length = distance(mesh.points[at(edge.first)], mesh.points[at(edge.second)]);
    ++count, sum += length, squares += length * length;
  }
  return std::sqrt(squares / count - sum * sum / (count * count)) / (sum / count);
}

/// A disc with one hole cut into its border: every edge of the outline once, all others twice, one
/// more vertex than edges less faces, and the area of the outline.
void expect_covers(const PanelMesh& mesh) {
  const auto edges = edges_of(mesh.faces);
  const Index ring = ring_size(mesh);
  std::set<Edge> border;
  for (Index i = 0; i < ring; ++i) border.insert(std::minmax(i, (i + 1) % ring));
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, border.contains(edge) ? 1 : 2);
  for (const Edge& edge : border) EXPECT_TRUE(edges.contains(edge));
  EXPECT_EQ(mesh.points.size() + mesh.faces.size(), edges.size() + 1);
  EXPECT_NEAR(area_of(mesh), std::fabs(ring_area(mesh)), 1e-12);
}

/// Whether a point lies inside of the circle through a triangle, by more than rounding.
bool is_in_circle(Vec2d a, Vec2d b, Vec2d c, Vec2d p) {
  const auto row = [&](Vec2d q) {
    const Vec2d d = q - p;
    return std::array<double, 3>{d.x, d.y, d.x * d.x + d.y * d.y};
  };
  const auto u = row(a), v = row(b), w = row(c);
  const double determinant = u[0] * (v[1] * w[2] - v[2] * w[1]) -
                             u[1] * (v[0] * w[2] - v[2] * w[0]) +
                             u[2] * (v[0] * w[1] - v[1] * w[0]);
  return determinant > 1e-14;
}

const std::string kAnnulus =
    R"("ring": {"vertices": [[0, 12], [0, 40], [-40, 0], [-12, 0]], "edges": [{"endpoints": [0, 1]},
    {"endpoints": [1, 2], "curvature": {"type": "circle", "params": [40, 0, 1]}},
    {"endpoints": [2, 3]},
    {"endpoints": [3, 0], "curvature": {"type": "circle", "params": [12, 0, 0]}}]})";

TEST(PanelMesh, CoversTheOutlineOnce) {
  for (const std::string& panel : {rectangle("r", 30, 20), shirt_front(), disc("d", 12), kAnnulus})
    for (const double h : {0.05, 0.02, 0.008}) {
      SCOPED_TRACE(panel + " " + std::to_string(h));
      expect_covers(meshed(panel, h));
    }
}

TEST(PanelMesh, IsDelaunayByTheEmptyCircleOfEveryTriangle) {
  for (const std::string& panel : {rectangle("r", 30, 20), disc("d", 12)}) {
    const PanelMesh mesh = meshed(panel, 0.02);
    for (const Triangle& t : mesh.faces)
      for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        if (std::ranges::find(t, static_cast<Index>(v)) != t.end()) continue;
        EXPECT_FALSE(is_in_circle(mesh.points[at(t[0])], mesh.points[at(t[1])],
                                  mesh.points[at(t[2])], mesh.points[v]))
            << "point " << v;
      }
  }
}

TEST(PanelMesh, DelaunayTrianglesOfScatteredPointsCoverTheirHull) {
  // 4 corners and 60 points inside: Euler gives 2 · 64 − 2 − 4 triangles.
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(1, 999);
  std::vector<GridPoint> points{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}};
  for (int i = 0; i < 60; ++i) points.push_back({place(random), place(random)});
  const std::vector<Triangle> faces = delaunay_triangles(points);
  EXPECT_EQ(faces.size(), 2 * points.size() - 2 - 4);
  std::int64_t area = 0;
  for (const Triangle& t : faces)
    area += turn(points[at(t[0])], points[at(t[1])], points[at(t[2])]);
  EXPECT_EQ(area, 2 * 1000 * 1000);
}

TEST(PanelMesh, TheFrontOfAShirtHasEvenTriangles) {
  const PanelMesh mesh = meshed(shirt_front(), 0.02);
  EXPECT_GE(smallest_angle(mesh), 28);
  EXPECT_LE(variation_of_edges(mesh), 0.10);
  EXPECT_NEAR(static_cast<double>(mesh.faces.size()), 2.31 * 0.282 / (0.02 * 0.02), 150);
}

TEST(PanelMesh, EdgePointsAreEvenlySpaced) {
  const Pattern pattern = parsed(pattern_file(shirt_front()));
  const PanelMesh mesh = mesh_pattern(pattern, 0.02).panels[0];
  for (std::size_t e = 0; e < pattern.panels[0].edges.size(); ++e) {
    const EdgePath path(pattern.panels[0], pattern.panels[0].edges[e]);
    const auto& points = mesh.edge_points[e];
    const auto segments = static_cast<double>(points.size() - 1);
    EXPECT_EQ(segments,
              std::max(std::ceil(path.length() / 0.02 - 1e-6),
                       pattern.panels[0].edges[e].curve == EdgeCurve::straight ? 1.0 : 2.0));
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LT(distance(mesh.points[at(points[i])], path.at(static_cast<double>(i) / segments)),
                kPanelGrid);
  }
}

TEST(PanelMesh, PointsOfTheFillAreInsideAndApartFromTheOutline) {
  // A five-pointed star, so that rows enter and leave several times.
  std::vector<GridPoint> ring;
  for (int i = 0; i < 10; ++i) {
    const double r = i % 2 == 0 ? 1e6 : 0.45e6, a = i * std::numbers::pi / 5 + 0.1;
    ring.push_back({std::llround(r * std::cos(a)), std::llround(r * std::sin(a))});
  }
  constexpr double kSpacing = 4e4;
  const auto is_kept = [&](double x, double y) {
    bool inside = false;
    double nearest = 1e300;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const GridPoint a = ring[i], b = ring[(i + 1) % ring.size()];
      const auto ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
      const auto dx = static_cast<double>(b.x) - ax, dy = static_cast<double>(b.y) - ay;
      if ((ay > y) != (ay + dy > y) && x < ax + (y - ay) * dx / dy) inside = !inside;
      const double t = std::clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(x - ax - t * dx, y - ay - t * dy));
    }
    return inside && nearest > 0.62 * kSpacing;
  };

  const std::vector<GridPoint> points = fill_outline(ring, kSpacing);
  std::set<GridPoint> found(points.begin(), points.end());
  EXPECT_EQ(found.size(), points.size());
  for (const GridPoint& p : points)
    EXPECT_TRUE(is_kept(static_cast<double>(p.x), static_cast<double>(p.y)));

  // Neighbours on the lattice that should be kept are there.
  std::size_t checked = 0;
  for (const GridPoint& p : points) {
    const GridPoint next{p.x + std::llround(kSpacing), p.y};
    if (!is_kept(static_cast<double>(next.x), static_cast<double>(next.y))) continue;
    const auto near = found.lower_bound({next.x - 2, -2'000'000});
    EXPECT_TRUE(std::any_of(near, found.end(), [&](const GridPoint& q) {
      return std::abs(q.x - next.x) <= 2 && q.y == next.y;
    }));
    ++checked;
  }
  EXPECT_GT(checked, 100u);
}

/// Two thin arms with a thinner gap between them. The inner edge of the left arm, number 8, has no
/// corners, and all others have some at several heights: its ends are not neighbours in a Delaunay
/// triangulation.
const std::vector<Vec2d> kFork{{0, 0},   {2.2, 0},   {2.2, 11}, {1.2, 11}, {1.2, 8.5},
                               {1.2, 6}, {1.2, 3.5}, {1.2, 1},  {1, 1},    {1, 11},
                               {0, 11},  {0, 8.5},   {0, 6},    {0, 3.5}};
constexpr int kInnerEdge = 8;

std::string fork() {
  std::string corners, edges;
  for (std::size_t i = 0; i < kFork.size(); ++i) {
    const std::string comma = i == 0 ? "" : ", ";
    corners += comma + "[" + std::to_string(kFork[i].x) + ", " + std::to_string(kFork[i].y) + "]";
    edges += comma + R"({"endpoints": [)" + std::to_string(i) + ", " +
             std::to_string((i + 1) % kFork.size()) + "]}";
  }
  return R"("fork": {"vertices": [)" + corners + R"(], "edges": [)" + edges + "]}";
}

TEST(PanelMesh, AnEdgeThatIsMissingIsReportedAndThenDivided) {
  std::vector<GridPoint> ring;
  for (const Vec2d& p : kFork) ring.push_back(to_grid(0.01 * p));
  const OutlineMesh mesh = mesh_outline(ring, 0.1 / kPanelGrid);
  EXPECT_EQ(mesh.missing, std::vector<Index>{kInnerEdge});
  EXPECT_TRUE(mesh.faces.empty());

  const PanelMesh divided = meshed(fork(), 0.1);
  expect_covers(divided);
  EXPECT_GT(divided.edge_points[kInnerEdge].size(), 2u);
}

TEST(PanelMesh, StitchedEdgesAreDividedTogether) {
  const Pattern pattern = parsed(
      pattern_file(fork() + "," + rectangle("q", 10, 10), stitch("fork", kInnerEdge, "q", 2)));
  const MeshedPattern mesh = mesh_pattern(pattern, 0.1);
  EXPECT_GT(mesh.panels[0].edge_points[kInnerEdge].size(), 3u);
  EXPECT_EQ(mesh.panels[0].edge_points[kInnerEdge].size(), mesh.panels[1].edge_points[2].size());
  for (const PanelMesh& m : mesh.panels) expect_covers(m);
}

TEST(PanelMesh, TwiceGivesTheSameBits) {
  const PanelMesh a = meshed(shirt_front(), 0.013), b = meshed(shirt_front(), 0.013);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].x, b.points[i].x);
    EXPECT_EQ(a.points[i].y, b.points[i].y);
  }
  EXPECT_EQ(a.faces, b.faces);
}

TEST(PanelMesh, TheAreaOfADiscIsApproachedFromInside) {
  const double exact = std::numbers::pi * 0.12 * 0.12;
  const double coarse = area_of(meshed(disc("d", 12), 0.02));
  const double fine = area_of(meshed(disc("d", 12), 0.005));
  EXPECT_LT(coarse, fine);
  EXPECT_LT(fine, exact);
  EXPECT_NEAR(fine, exact, 1e-3 * exact);
}

}  // namespace
}  // namespace icloth
