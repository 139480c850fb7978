// Vertices of files that become one, and those that no face uses.
#include "sim/files/weld.h"

#include <gtest/gtest.h>

#include <random>

#include "kernels/index.h"

namespace icloth {
namespace {

/// Squares in a row whose neighbours have their own vertices on the common side, and vertices
/// without a face in between.
TriangleMesh separate_squares(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double x = i;
    const auto first = static_cast<Index>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(),
                          {{x, 0, 0}, {x + 1, 0, 0}, {9, 9, 9}, {x + 1, 1, 0}, {x, 1, -0.0}});
    mesh.faces.push_back({first, first + 1, first + 3});
    mesh.faces.push_back({first, first + 3, first + 4});
  }
  return mesh;
}

TEST(Weld, ExactDoublesBecomeOneAndUnusedVerticesAreLeftOut) {
  const TriangleMesh file = separate_squares(4);
  TriangleMesh mesh = file;
  std::vector<Vec3d> rest = mesh.positions;
  FileLayout layout;
  const WeldReport report = merge_vertices(mesh, rest, true, layout);
  EXPECT_EQ(report.welded, 6u);
  EXPECT_EQ(report.unused, 4u);
  EXPECT_EQ(report.apart, 0u);
  ASSERT_EQ(mesh.positions.size(), 10u);
  ASSERT_EQ(rest.size(), 10u);

  // Every vertex of the file is found again at its place, through the layout.
  ASSERT_EQ(layout.vertex.size(), 20u);
  EXPECT_EQ(layout.faces, file.faces);
  for (std::size_t v = 0; v < 20; ++v) {
    EXPECT_EQ(layout.vertex[v] == kNone, v % 5 == 2) << v;
    if (layout.vertex[v] == kNone) continue;
    EXPECT_EQ(mesh.positions[at(layout.vertex[v])], file.positions[v]);
  }
  for (std::size_t f = 0; f < file.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(mesh.faces[f][c], layout.vertex[at(file.faces[f][c])]);

  // The first of the doubles gives the number, in the order of the file.
  EXPECT_EQ(file_numbers(layout), (std::vector<Index>{0, 1, 3, 4, 6, 8, 11, 13, 16, 18}));
}

TEST(Weld, AMeshThatNeedsNothingKeepsItsVertices) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}};
  std::vector<Vec3d> rest = mesh.positions;
  FileLayout layout;
  merge_vertices(mesh, rest, true, layout);
  EXPECT_TRUE(layout.is_identity());
  EXPECT_EQ(mesh.positions.size(), 3u);
}

TEST(Weld, DoublesStayApartWhereNobodyWantsThemOrTheirRestPlacesDiffer) {
  TriangleMesh mesh = separate_squares(2);
  std::vector<Vec3d> rest = mesh.positions;
  FileLayout layout;
  EXPECT_EQ(merge_vertices(mesh, rest, false, layout).welded, 0u);
  EXPECT_EQ(mesh.positions.size(), 8u);

  mesh = separate_squares(2);
  rest = mesh.positions;
  rest[5].z += 0.1;  // a dart: closed in the start state, open in the pattern
  layout = {};
  const WeldReport report = merge_vertices(mesh, rest, true, layout);
  EXPECT_EQ(report.welded, 1u);
  EXPECT_EQ(report.apart, 1u);
  EXPECT_EQ(mesh.positions.size(), 7u);
}

/// The slow obvious version: every vertex looks at all earlier ones that kept their place.
std::vector<Vec3d> snap_by_all_pairs(std::vector<Vec3d> x, double distance) {
  const std::vector<Vec3d> given = x;
  std::vector<std::size_t> kept;
  for (std::size_t v = 0; v < x.size(); ++v) {
    std::size_t nearest = x.size();
    for (const std::size_t k : kept) {
      if (norm(given[k] - given[v]) > distance) continue;
      if (nearest == x.size() || norm(given[k] - given[v]) < norm(given[nearest] - given[v]))
        nearest = k;
    }
    if (nearest == x.size())
      kept.push_back(v);
    else
      x[v] = given[nearest];
  }
  return x;
}

TEST(Weld, NearVerticesMoveOntoTheNearestEarlierOne) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1, 1);
  for (const double distance : {1e-3, 0.05, 0.2}) {
    TriangleMesh mesh;
    for (Index i = 0; i < 300; ++i) {
      mesh.positions.push_back({place(random), place(random), 0.1 * place(random)});
      if (i % 3 == 2) mesh.faces.push_back({i - 2, i - 1, i});
    }
    const std::vector<Vec3d> expected = snap_by_all_pairs(mesh.positions, distance);
    std::vector<Vec3d> rest = mesh.positions;
    ASSERT_TRUE(snap_vertices(mesh, rest, distance, {1, 1, 1}));
    EXPECT_EQ(mesh.positions, expected) << distance;
    EXPECT_EQ(rest, expected) << distance;
  }
}

TEST(Weld, TheDistanceIsMeasuredAfterTheScale) {
  for (const double scale : {1.0, 0.01}) {
    TriangleMesh mesh = separate_squares(2);
    mesh.positions[5].x += 0.05;
    std::vector<Vec3d> rest = mesh.positions;
    ASSERT_TRUE(snap_vertices(mesh, rest, 0.001, {scale, scale, scale}));
    EXPECT_EQ(mesh.positions[5] == mesh.positions[1], scale == 0.01);
  }
}

TEST(Weld, TooManyWithinReachAreRefusedInsteadOfCompared) {
  TriangleMesh mesh;
  std::vector<Vec3d> rest;
  for (Index i = 0; i < 3000; ++i) {
    mesh.positions.push_back({0.5 * (i % 2), 0.5 * (i % 3), 0});
    rest.push_back({1.0 * i, 0, 0});  // all of them stay apart by their rest places
    if (i % 3 == 2) mesh.faces.push_back({i - 2, i - 1, i});
  }
  EXPECT_FALSE(snap_vertices(mesh, rest, 0.4, {1, 1, 1}));
}

TEST(Weld, FindsVerticesThatAGapOfASeamLeaves) {
  TriangleMesh mesh = separate_squares(3);
  EXPECT_EQ(near_border_vertices(mesh, 1e-6), 4u);
  for (std::size_t v = 5; v < 10; ++v) mesh.positions[v].x += 2e-6;
  EXPECT_EQ(near_border_vertices(mesh, 1e-6), 0u);
  EXPECT_EQ(near_border_vertices(mesh, 1e-5), 4u);
}

}  // namespace
}  // namespace icloth
