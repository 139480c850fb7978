// Seams that are proposed for panels which lie side by side: what becomes a pair and what does not.
#include "sim/scene/seam_proposal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/scene/material_io.h"
#include "sim/scene/seam_weld.h"
#include "sim/scene/world.h"

namespace icloth {
namespace {

constexpr double kEdge = 0.01;
constexpr double kPi = std::numbers::pi;

/// Appends a panel of `columns` × `rows` squares; `place` says where (u, v) [m] of it lies.
template <class Place>
void add_panel(TriangleMesh& mesh, Index columns, Index rows, double edge, const Place& place) {
  const auto first = static_cast<Index>(mesh.positions.size());
  for (Index j = 0; j <= rows; ++j)
    for (Index i = 0; i <= columns; ++i) mesh.positions.push_back(place(edge * i, edge * j));
  const auto vertex = [&](Index i, Index j) { return first + j * (columns + 1) + i; };
  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < columns; ++i) {
      mesh.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
}

/// Two panels in one plane, 2 mm apart, of 10 × 20 squares each.
TriangleMesh side_by_side() {
  TriangleMesh mesh;
  add_panel(mesh, 10, 20, kEdge, [](double u, double v) { return Vec3d{u, v, 0}; });
  add_panel(mesh, 10, 20, kEdge, [](double u, double v) { return Vec3d{0.102 + u, v, 0}; });
  return mesh;
}

/// All pairs of a proposal, smaller vertex first, sorted.
std::vector<std::array<Index, 2>> all_pairs(const SeamProposal& proposal) {
  std::vector<std::array<Index, 2>> pairs;
  for (const ProposedSeam& seam : proposal.seams)
    for (const auto& [a, b] : seam.pairs) pairs.push_back({std::min(a, b), std::max(a, b)});
  std::ranges::sort(pairs);
  return pairs;
}

TEST(SeamProposal, PairsTheBordersOfTwoPanelsFromEndToEnd) {
  const SeamProposal proposal = propose_seams(side_by_side(), 0.004);
  ASSERT_EQ(proposal.seams.size(), 1u);
  const ProposedSeam& seam = proposal.seams[0];
  EXPECT_EQ(proposal.panels, 2u);
  EXPECT_EQ(seam.panel, (std::array<Index, 2>{0, 1}));
  EXPECT_NEAR(seam.mean_gap, 0.002, 1e-12);
  EXPECT_NEAR(seam.largest_gap, 0.002, 1e-12);
  EXPECT_GT(seam.angle, 0.9 * kPi);
  EXPECT_EQ(seam.unpaired, 0u);
  EXPECT_EQ(proposal.border_vertices, 120u);
  EXPECT_EQ(proposal.sewn_vertices, 42u);

  // Column 10 of the first panel meets column 0 of the second.
  std::vector<std::array<Index, 2>> expected;
  for (Index j = 0; j <= 20; ++j) expected.push_back({11 * j + 10, 231 + 11 * j});
  EXPECT_EQ(all_pairs(proposal), expected);
}

TEST(SeamProposal, NothingIsSewnBeyondTheDistance) {
  EXPECT_TRUE(propose_seams(side_by_side(), 0.0019).seams.empty());
}

TEST(SeamProposal, MatchesTheSearchOverAllPairs) {
  // Panels whose places are shaken by less than a third of an edge.
  TriangleMesh mesh = side_by_side();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shake(-0.0015, 0.0015);
  for (Vec3d& p : mesh.positions) p = p + Vec3d{shake(random), shake(random), shake(random)};
  const double within = 0.006;

  // The oracle knows the two borders and compares every vertex of one with every one of the other.
  std::vector<Index> left, right;
  for (Index v = 0; v < 231; ++v)
    if (v % 11 == 0 || v % 11 == 10 || v < 11 || v >= 220)
      left.push_back(v), right.push_back(231 + v);
  const auto distance = [&](Index v, Index w) {
    return norm(mesh.positions[at(v)] - mesh.positions[at(w)]);
  };
  const auto nearest = [&](Index v, const std::vector<Index>& others) {
    return *std::ranges::min_element(others, {}, [&](Index w) { return distance(v, w); });
  };
  std::vector<std::array<Index, 2>> expected;
  for (const Index v : left) {
    const Index w = nearest(v, right);
    if (distance(v, w) <= within && nearest(w, left) == v) expected.push_back({v, w});
  }
  ASSERT_GT(expected.size(), 15u);
  EXPECT_EQ(all_pairs(propose_seams(mesh, within)), expected);
}

TEST(SeamProposal, APanelIsSewnToItselfWhereItClosesToATube) {
  // A sheet that goes round but for a gap of 3 mm.
  TriangleMesh mesh;
  const double radius = 0.203 / (2 * kPi);
  add_panel(mesh, 20, 10, kEdge, [&](double u, double v) {
    return Vec3d{radius * std::cos(u / radius), v, radius * std::sin(u / radius)};
  });
  const SeamProposal proposal = propose_seams(mesh, 0.004);
  ASSERT_EQ(proposal.seams.size(), 1u);
  EXPECT_EQ(proposal.seams[0].pairs.size(), 11u);
  EXPECT_EQ(proposal.seams[0].panel, (std::array<Index, 2>{0, 0}));
}

TEST(SeamProposal, BordersThatCrossAreNotSewn) {
  // The upper and lower borders of the second panel cross the right one of the first, 2 mm above.
  TriangleMesh mesh;
  add_panel(mesh, 10, 30, kEdge, [](double u, double v) { return Vec3d{u, v, 0}; });
  add_panel(mesh, 10, 10, kEdge, [](double u, double v) {
    return Vec3d{0.05 + u, 0.1 + v, 0.002};
  });
  const SeamProposal proposal = propose_seams(mesh, 0.004);
  EXPECT_TRUE(proposal.seams.empty());
  EXPECT_EQ(proposal.scattered, 2u);  // one at each crossing
}

TEST(SeamProposal, TellsASeamFromHemsThatLieUponEachOther) {
  TriangleMesh mesh;
  add_panel(mesh, 10, 10, kEdge, [](double u, double v) { return Vec3d{u, v, 0}; });
  add_panel(mesh, 10, 10, kEdge, [](double u, double v) { return Vec3d{u, v, 0.002}; });
  const SeamProposal proposal = propose_seams(mesh, 0.004);
  ASSERT_FALSE(proposal.seams.empty());
  for (const ProposedSeam& seam : proposal.seams) EXPECT_LT(seam.angle, 0.1 * kPi);
}

TEST(SeamProposal, CountsTheVerticesOfAFinerBorderThatStayUnpaired) {
  TriangleMesh mesh;
  add_panel(mesh, 10, 20, kEdge, [](double u, double v) { return Vec3d{u, v, 0}; });
  add_panel(mesh, 20, 40, kEdge / 2, [](double u, double v) { return Vec3d{0.102 + u, v, 0}; });
  const SeamProposal proposal = propose_seams(mesh, 0.004);
  ASSERT_EQ(proposal.seams.size(), 1u);
  EXPECT_EQ(proposal.seams[0].pairs.size(), 21u);
  EXPECT_EQ(proposal.seams[0].unpaired, 20u);
}

TEST(SeamProposal, NoFaceLosesACornerWherePairsMeet) {
  // A third panel is so fine that several of its vertices reach one of the others.
  TriangleMesh mesh = side_by_side();
  add_panel(mesh, 100, 5, kEdge / 5, [](double u, double v) { return Vec3d{u, 0.202 + v, 0}; });
  const SeamProposal proposal = propose_seams(mesh, 0.02);
  Scene scene;
  Cloth cloth;
  cloth.name = "panels";
  cloth.mesh = mesh;
  cloth.rest = mesh.positions;
  cloth.material = load_material("default", "");
  scene.cloths.push_back(std::move(cloth));
  scene.seams = {joint_seam(proposal)};
  ASSERT_GT(scene.seams[0].pairs.size(), 20u);

  const auto welded = weld_seam(scene, make_world(scene), 0);
  ASSERT_TRUE(welded);
  for (const Triangle& t : welded->scene.cloths[0].mesh.faces)
    EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
}

TEST(SeamProposal, EveryFaceKeepsItsRestShapeWhenThePairsAreWelded) {
  Scene scene;
  Cloth cloth;
  cloth.name = "panels";
  cloth.mesh = side_by_side();
  cloth.rest = cloth.mesh.positions;
  cloth.material = load_material("default", "");
  scene.cloths.push_back(std::move(cloth));
  scene.seams = {joint_seam(propose_seams(scene.cloths[0].mesh, 0.004))};
  const World before = make_world(scene);
  const auto welded = weld_seam(scene, before, 0);
  ASSERT_TRUE(welded);
  const World after = make_world(welded->scene);
  EXPECT_EQ(after.cloth_vertices, before.cloth_vertices - 21);
  ASSERT_EQ(after.face_area.size(), before.face_area.size());
  for (std::size_t f = 0; f < before.face_area.size(); ++f)
    EXPECT_NEAR(after.face_area[f], before.face_area[f], 1e-12 * before.face_area[f]);
}

TEST(SeamProposal, AReachOverTooManyVerticesIsRefused) {
  TriangleMesh mesh;
  add_panel(mesh, 4000, 1, 1e-4, [](double u, double v) { return Vec3d{u, v, 0}; });
  try {
    propose_seams(mesh, 1);
    FAIL() << "expected a refusal";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected a smaller distance"), std::string::npos);
  }
}

}  // namespace
}  // namespace icloth
