// Faces that touch beside their common vertices, and what the solver can start from.
#include "sim/scene/touching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "kernels/distance.h"
#include "kernels/index.h"
#include "sim/scene/intersections.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

std::vector<Touch> touches_of(const std::vector<Vec3d>& x, const std::vector<Triangle>& faces) {
  return find_touching_neighbours(x, faces, {});
}

TEST(Touching, NamesTheSmallestElementThatHoldsAVertex) {
  // Two faces share vertex 0; vertex 3 of the second one is put on the first one.
  const std::vector<Triangle> faces{{0, 1, 2}, {0, 3, 4}};
  std::vector<Vec3d> x{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.5, 0, 0}, {1, 1, 0}};
  ASSERT_EQ(touches_of(x, faces).size(), 1u);
  EXPECT_EQ(touches_of(x, faces)[0].kind, Touch::Kind::vertex_edge);
  EXPECT_EQ(touches_of(x, faces)[0].v[0], 3);

  x[3] = {0.25, 0, 0.25};
  EXPECT_EQ(touches_of(x, faces)[0].kind, Touch::Kind::vertex_face);
  x[3] = x[1];
  EXPECT_EQ(touches_of(x, faces)[0].kind, Touch::Kind::vertex_vertex);

  // One rounding beside the edge is enough.
  x[3] = {0.5, 0, -0x1p-60};
  EXPECT_TRUE(touches_of(x, faces).empty());
}

TEST(Touching, FindsAFlapThatIsFoldedFlat) {
  // Two faces with a common edge 0 1, on the same side of it.
  const std::vector<Triangle> faces{{0, 1, 2}, {1, 0, 3}};
  const std::vector<Vec3d> folded{{0, 0, 0}, {1, 0, 0}, {0.2, 0, 1}, {0.8, 0, 1}};
  ASSERT_EQ(touches_of(folded, faces).size(), 1u);
  EXPECT_EQ(touches_of(folded, faces)[0].kind, Touch::Kind::edge_edge);

  const std::vector<Vec3d> open{{0, 0, 0}, {1, 0, 0}, {0.2, 0, 1}, {0.8, 1e-9, 1}};
  EXPECT_TRUE(touches_of(open, faces).empty());
}

TEST(Touching, FlatAndTiltedSheetsHaveNone) {
  Cloth sheet = testing::make_sheet(testing::lying(0.3, 800), {0, 0.1, 0});
  EXPECT_TRUE(touches_of(sheet.mesh.positions, sheet.mesh.faces).empty());
  for (Vec3d& p : sheet.mesh.positions) p = {0.6 * p.x - 0.8 * p.z, 0.8 * p.x + 0.6 * p.z, p.y};
  EXPECT_TRUE(touches_of(sheet.mesh.positions, sheet.mesh.faces).empty());
}

TEST(Touching, ManyFacesAtAVertexGiveTheSameAsAllPairs) {
  // Fans of 50 faces on a lattice, where elements meet in every way.
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(-6, 6), height(-1, 1);
  std::size_t all = 0;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Vec3d> x{{0, 0, 0}};
    std::vector<Triangle> faces;
    while (faces.size() < 50) {
      const auto corner = [&] {
        x.push_back({0.1 * place(random), trial % 2 * 0.1 * height(random), 0.1 * place(random)});
        return static_cast<Index>(x.size()) - 1;
      };
      const Triangle t{0, random() % 2 ? corner() : static_cast<Index>(x.size()) - 1, corner()};
      if (t[1] == 0 || norm(cross(x[at(t[1])], x[at(t[2])])) < 1e-6) continue;
      faces.push_back(t);
    }

    // Two faces alone are tested without a tree.
    std::set<std::pair<Touch::Kind, std::array<Index, 4>>> expected;
    const auto key = [](const Touch& t) {
      auto result = std::pair(t.kind, t.v);
      std::ranges::sort(result.second);
      return result;
    };
    for (std::size_t b = 0; b < faces.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        for (const Touch& t : touches_of(x, {faces[a], faces[b]})) expected.insert(key(t));
    const std::vector<Touch> found = touches_of(x, faces);
    std::set<std::pair<Touch::Kind, std::array<Index, 4>>> keys;
    for (const Touch& t : found) keys.insert(key(t));
    EXPECT_EQ(keys, expected) << "trial " << trial;
    EXPECT_EQ(keys.size(), found.size()) << "each once";
    all += keys.size();
  }
  EXPECT_GT(all, 1000u);
}

TEST(Touching, AHundredThousandFacesAtAVertexAreNoObstacle) {
  // All pairs would be five billion.
  constexpr Index kFaces = 100'000;
  std::vector<Vec3d> x{{0, 0, 0}};
  std::vector<Triangle> faces;
  for (Index i = 0; i < kFaces; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kFaces;
    x.push_back({std::cos(angle), 0.3 * std::sin(angle), std::sin(angle)});
    faces.push_back({0, 1 + (i + 1) % kFaces, 1 + i});
  }
  EXPECT_TRUE(touches_of(x, faces).empty());
}

/// Faces with corners on a coarse lattice; many share vertices, touch or overlap.
Cloth lattice_cloth(std::mt19937& random) {
  std::uniform_int_distribution<int> coordinate(0, 2), height(0, 1), corner(0, 5);
  Cloth cloth;
  cloth.name = "lattice";
  cloth.material = load_material("default", "");
  for (int v = 0; v < 6; ++v) {
    const double x = coordinate(random), y = height(random), z = coordinate(random);
    cloth.mesh.positions.push_back({0.05 * x, 0.05 * y, 0.05 * z});
  }
  for (int draw = 0; draw < 60 && cloth.mesh.faces.size() < 3; ++draw) {
    const Triangle t{corner(random), corner(random), corner(random)};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    const std::vector<Vec3d>& p = cloth.mesh.positions;
    const auto x = [&](std::size_t k) { return p[static_cast<std::size_t>(t[k])]; };
    if (norm(cross(x(1) - x(0), x(2) - x(0))) > 1e-6) cloth.mesh.faces.push_back(t);
  }
  return cloth;
}

/// Whether two elements without a common vertex are at distance 0; all pairs, with rounding.
bool any_contact(const Cloth& cloth) {
  const auto x = [&](Index v) { return cloth.mesh.positions[static_cast<std::size_t>(v)]; };
  const auto& faces = cloth.mesh.faces;
  for (const Triangle& s : faces)
    for (const Triangle& t : faces)
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = s[i], b = s[(i + 1) % 3];
        if (a != t[0] && a != t[1] && a != t[2] &&
            closest_point_triangle(x(a), x(t[0]), x(t[1]), x(t[2])).distance2 < 1e-20)
          return true;
        for (std::size_t j = 0; j < 3; ++j) {
          const Index c = t[j], d = t[(j + 1) % 3];
          if (a == c || a == d || b == c || b == d) continue;
          if (closest_points_segments(x(a), x(b), x(c), x(d)).distance2 < 1e-20) return true;
        }
      }
  return false;
}

TEST(Touching, LayersThatFloatsDoNotTellApartAreInContactAtRest) {
  const auto scene_of = [](double gap) {
    auto scene = std::make_shared<Scene>();
    scene->cloths.push_back(testing::make_sheet(testing::lying(0.3, 72), {0, 0, 0}));
    scene->cloths.push_back(testing::make_sheet(testing::lying(0.3, 72), {0, gap, 0}));
    scene->cloths[1].name = "upper";
    return scene;
  };
  const auto close = make_simulator(Build::cpu32, scene_of(1e-7));
  EXPECT_FALSE(close->contacts_at_rest().empty());
  for (const Build build : {Build::cpu32, Build::cpu64})
    EXPECT_TRUE(make_simulator(build, scene_of(1e-4))->contacts_at_rest().empty());

  // Asking leaves no trace: the steps are those of a simulator that was not asked.
  const auto asked = make_simulator(Build::cpu32, scene_of(0.001));
  const auto other = make_simulator(Build::cpu32, scene_of(0.001));
  for (int k = 0; k < 12; ++k) {
    EXPECT_TRUE(asked->contacts_at_rest().empty()) << k;
    ASSERT_EQ(asked->step({}).state_hash, other->step({}).state_hash) << k;
  }
}

TEST(Touching, WhatTheStartCheckAcceptsSurvivesTheFirstStep) {
  std::mt19937 random(7);
  int accepted = 0, refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    auto scene = std::make_shared<Scene>();
    scene->cloths.push_back(lattice_cloth(random));
    Cloth& cloth = scene->cloths[0];

    // Vertices without a face are no part of a cloth.
    std::vector<Index> number(cloth.mesh.positions.size(), -1);
    std::vector<Vec3d> used;
    for (Triangle& t : cloth.mesh.faces)
      for (Index& v : t) {
        Index& n = number[static_cast<std::size_t>(v)];
        if (n < 0) {
          n = static_cast<Index>(used.size());
          used.push_back(cloth.mesh.positions[static_cast<std::size_t>(v)]);
        }
        v = n;
      }
    cloth.mesh.positions = used;
    cloth.rest = used;

    // The same face twice is refused elsewhere.
    bool twice = cloth.mesh.faces.size() < 3;
    for (std::size_t f = 0; f < cloth.mesh.faces.size(); ++f)
      for (std::size_t g = 0; g < f; ++g) {
        Triangle s = cloth.mesh.faces[f], t = cloth.mesh.faces[g];
        std::ranges::sort(s);
        std::ranges::sort(t);
        twice = twice || s == t;
      }
    if (twice) continue;

    const bool free = find_start_intersections(*scene, true).empty();
    if (any_contact(cloth)) {
      EXPECT_FALSE(free) << "trial " << trial;
    }
    if (!free) {
      ++refused;
      continue;
    }
    ++accepted;
    const StepReport report = make_simulator(Build::cpu32, scene)->step({});
    EXPECT_TRUE(report.accepted) << "trial " << trial << ", " << report.impacts_left << " impacts";
  }
  EXPECT_GT(accepted, 50);
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace icloth
