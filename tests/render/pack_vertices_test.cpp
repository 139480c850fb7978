// Normals are gathered around each vertex; the plain way is to scatter each face to its corners.
#include "render/pack_vertices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "sim/scene/shapes.h"

namespace icloth {
namespace {

std::vector<Vec3f> scattered_normals(const std::vector<Vec3f>& p,
                                     const std::vector<Triangle>& faces) {
  std::vector<Vec3f> normals(p.size());
  const auto at = [&](Index v) { return p[static_cast<std::size_t>(v)]; };
  for (const Triangle& t : faces) {
    const Vec3f normal = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    for (const Index v : t) normals[static_cast<std::size_t>(v)] += normal;
  }
  for (Vec3f& n : normals) {
    n = normalized(n);
    if (norm2(n) == 0) n = {0, 1, 0};
  }
  return normals;
}

struct Packed {
  std::vector<Vec3f> positions, normals;
};

Packed pack(const std::vector<Vec3f>& p, const std::vector<Triangle>& faces) {
  Packed out{std::vector<Vec3f>(p.size()), std::vector<Vec3f>(p.size())};
  pack_vertices(vertex_faces(static_cast<Index>(p.size()), faces), p, out.positions.data(),
                out.normals.data());
  return out;
}

::testing::AssertionResult same_bits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  if (a.size() != b.size()) return ::testing::AssertionFailure() << "lengths differ";
  for (std::size_t v = 0; v < a.size(); ++v) {
    if (std::memcmp(&a[v], &b[v], sizeof(Vec3f)) != 0)
      return ::testing::AssertionFailure() << "vertex " << v << " differs";
  }
  return ::testing::AssertionSuccess();
}

TEST(PackVertices, ListsTheFacesOfEachVertexInOrder) {
  const std::vector<Triangle> faces{{2, 1, 0}, {1, 2, 3}, {2, 2, 5}};
  const VertexFaces list = vertex_faces(6, faces);
  EXPECT_EQ(list.corners, (std::vector<Index>{2, 1, 0, 1, 2, 3, 2, 2, 5}));
  EXPECT_EQ(list.first, (std::vector<Index>{0, 1, 3, 7, 8, 8, 9}));
  EXPECT_EQ(list.around, (std::vector<Index>{0, 0, 1, 0, 1, 2, 2, 1, 2}));
  EXPECT_EQ(list.vertices(), 6);
}

TEST(PackVertices, GathersTheBitsThatScatteringGives) {
  const TriangleMesh sphere = make_sphere(0.7, 3000);
  std::vector<Vec3f> p;
  for (const Vec3d x : sphere.positions) p.push_back(convert<float>(x));
  const Packed packed = pack(p, sphere.faces);
  EXPECT_TRUE(same_bits(packed.positions, p));
  EXPECT_TRUE(same_bits(packed.normals, scattered_normals(p, sphere.faces)));
  for (std::size_t v = 0; v < p.size(); ++v) {
    EXPECT_NEAR(norm(packed.normals[v]), 1, 1e-6f);
    EXPECT_GT(dot(packed.normals[v], normalized(p[v])), 0.99f);
  }
}

TEST(PackVertices, GathersTheBitsOnAHeapOfTriangles) {
  std::mt19937 random(7);
  std::normal_distribution<float> number;
  std::uniform_int_distribution<Index> vertex(0, 99);
  std::vector<Vec3f> p(120);  // the last twenty have no face
  for (Vec3f& x : p) x = {number(random), number(random), number(random)};
  std::vector<Triangle> faces;
  for (int k = 0; k < 2000; ++k)  // some of them have no area, some vertices dozens of faces
    faces.push_back({vertex(random), vertex(random), vertex(random)});
  const Packed packed = pack(p, faces);
  EXPECT_TRUE(same_bits(packed.normals, scattered_normals(p, faces)));
  EXPECT_EQ(packed.normals[110], (Vec3f{0, 1, 0}));
}

TEST(PackVertices, NormalsPointUpWhereFacesCancelOutOrANumberIsNotFinite) {
  const std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {NAN, 0, 0}};
  const Packed packed = pack(p, {{0, 1, 2}, {0, 2, 1}, {1, 2, 3}});
  EXPECT_EQ(packed.normals[0], (Vec3f{0, 1, 0}));
  EXPECT_EQ(packed.normals[3], (Vec3f{0, 1, 0}));
}

}  // namespace
}  // namespace icloth
