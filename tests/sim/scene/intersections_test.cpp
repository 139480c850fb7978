#include "sim/scene/intersections.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "sim/files/mesh_io.h"
#include "tests/oracle/integer_triangles.h"

using namespace icloth;

namespace {

struct Soup {
  std::vector<Vec3d> positions;
  std::vector<Triangle> faces;

  void add(Vec3d a, Vec3d b, Vec3d c) {
    const auto first = static_cast<Index>(positions.size());
    positions.insert(positions.end(), {a, b, c});
    faces.push_back({first, first + 1, first + 2});
  }
  std::vector<IntersectingFaces> find(std::span<const int> group = {}) const {
    return find_intersections(positions, faces, group);
  }
};

oracle::Corners corners_of(const Soup& soup, std::size_t f) {
  oracle::Corners t;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d p = soup.positions[static_cast<std::size_t>(soup.faces[f][k])];
    t[k] = {std::int64_t(p.x), std::int64_t(p.y), std::int64_t(p.z)};
  }
  return t;
}

/// Triangles with corners on a small lattice: many of them touch, or lie in one plane.
Soup lattice_soup(unsigned seed, int faces, int size) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(0, size);
  Soup soup;
  while (soup.faces.size() < static_cast<std::size_t>(faces)) {
    const auto point = [&] {
      const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
      return Vec3d{x, y, z};
    };
    soup.add(point(), point(), point());
    if (oracle::degenerate(corners_of(soup, soup.faces.size() - 1))) soup.faces.pop_back();
  }
  return soup;
}

std::string data_folder() {
  const char* folder = std::getenv("ICLOTH_DATA");
  return folder ? folder : ICLOTH_DATA_DEFAULT;
}

std::size_t count_in_files(const std::vector<std::string>& names) {
  Soup soup;
  for (const std::string& name : names) {
    const MeshFile file = read_mesh(data_folder() + "/" + name);
    const auto first = static_cast<Index>(soup.positions.size());
    soup.positions.insert(soup.positions.end(), file.mesh.positions.begin(),
                          file.mesh.positions.end());
    for (const Triangle& t : file.mesh.faces)
      soup.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return soup.find().size();
}

}  // namespace

TEST(Intersections, AgreesWithIntegerArithmetic) {
  std::size_t found = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Soup soup = lattice_soup(seed, 60, seed % 2 ? 6 : 12);
    std::vector<IntersectingFaces> expected;
    for (std::size_t a = 0; a < soup.faces.size(); ++a)
      for (std::size_t b = a + 1; b < soup.faces.size(); ++b)
        if (oracle::intersect(corners_of(soup, a), corners_of(soup, b)))
          expected.push_back({static_cast<Index>(a), static_cast<Index>(b)});
    const auto actual = soup.find();
    ASSERT_EQ(actual.size(), expected.size()) << "seed " << seed;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      EXPECT_EQ(actual[i].a, expected[i].a);
      EXPECT_EQ(actual[i].b, expected[i].b);
    }
    found += actual.size();
  }
  EXPECT_GT(found, 5000u);
}

TEST(Intersections, OneRoundingApartIsNotTouching) {
  // A tip on the plane, then the smallest double above it.
  for (const double height : {0.0, std::nextafter(0.0, 1.0), 1e-300, 1e-17}) {
    Soup soup;
    soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    soup.add({0.25, 0.25, height}, {0.25, 0.25, 1}, {0.5, 0.25, 1});
    EXPECT_EQ(soup.find().size(), height == 0.0 ? 1u : 0u) << height;
  }
}

TEST(Intersections, NeighboursAndObstaclesAreLeftOut) {
  Soup soup;
  soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  soup.add({0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.3, 0.3, 1});
  EXPECT_EQ(soup.find().size(), 1u);
  const std::vector<int> cloths{0, 0}, mixed{-1, 0}, mixed_other{0, -1}, obstacles{-1, -1};
  EXPECT_EQ(soup.find(cloths).size(), 1u);
  EXPECT_EQ(soup.find(mixed).size(), 1u);
  EXPECT_EQ(soup.find(mixed_other).size(), 1u);
  EXPECT_EQ(soup.find(obstacles).size(), 0u);
  soup.faces[1][0] = 0;  // a corner of the first face
  EXPECT_EQ(soup.find(cloths).size(), 0u);
  EXPECT_TRUE(find_intersections({}, {}, {}).empty());
}

TEST(Intersections, AmongFixedFacesAreThoseOfTheWholeSoup) {
  // The first 60 faces move; the other 60 are obstacles of one soup or a tree of their own.
  for (unsigned seed : {11u, 12u, 13u}) {
    Soup moving = lattice_soup(seed, 60, 6), fixed = lattice_soup(seed + 100, 60, 6);
    Soup whole = moving;
    for (const Triangle& t : fixed.faces)
      whole.add(fixed.positions[static_cast<std::size_t>(t[0])],
                fixed.positions[static_cast<std::size_t>(t[1])],
                fixed.positions[static_cast<std::size_t>(t[2])]);
    std::vector<int> group(60, 0);
    group.resize(120, -1);

    const auto expected = whole.find(group);
    const FaceTree tree(fixed.positions, fixed.faces);
    const auto found = find_intersections(moving.positions, moving.faces, tree);
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 100u);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].a, expected[k].a);
      EXPECT_EQ(found[k].b, expected[k].b);
    }
  }
}

TEST(Intersections, StartStateCountsClothsThenObstacles) {
  Scene scene;
  Cloth cloth;
  cloth.mesh.positions = {{0, 0.1, 0}, {1, 0.1, 0}, {0, 0.1, 1}};
  cloth.mesh.faces = {{0, 1, 2}};
  scene.cloths = {cloth};
  Obstacle obstacle;
  obstacle.mesh.positions = {{5, 5, 5},       {6, 5, 5},     {5, 6, 5},
                             {0.2, 0.0, 0.2}, {0.2, 1, 0.2}, {0.3, 1, 0.2}};
  obstacle.mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  scene.obstacles = {obstacle};
  const auto found = find_start_intersections(scene, true);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].a, 0);
  EXPECT_EQ(found[0].b, 2);
}

TEST(Intersections, SinglePrecisionCanMakeAContact) {
  Scene scene;
  Cloth low, high;
  low.mesh.positions = {{0, 1, 0}, {1, 1, 0}, {0, 1, 1}};
  low.mesh.faces = {{0, 1, 2}};
  high = low;
  for (Vec3d& p : high.mesh.positions) p.y += 1e-9;
  scene.cloths = {low, high};
  EXPECT_TRUE(find_start_intersections(scene, false).empty());
  EXPECT_EQ(find_start_intersections(scene, true).size(), 1u);
}

TEST(Intersections, GarmentsAgreeWithTheIndependentChecker) {
  if (!std::filesystem::exists(data_folder() + "/garments/dress_draped.obj"))
    GTEST_SKIP() << "no reference data in " << data_folder();
  // Counts of a separate program that uses CGAL's box intersection and predicates only.
  EXPECT_EQ(count_in_files({"garments/dress_rest.obj"}), 0u);
  EXPECT_EQ(count_in_files({"garments/dress_draped.obj"}), 426u);
  EXPECT_EQ(count_in_files({"garments/dress_draped.obj", "bodies/rumba.obj"}), 922u);
}
