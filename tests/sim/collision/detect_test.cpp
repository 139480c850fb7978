// Detection over a whole mesh against all pairs, and against published complete lists.
#include "sim/collision/detect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "kernels/ccd/elementary_ccd.h"
#include "kernels/index.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/shapes.h"

namespace icloth {
namespace {

struct Lists {
  std::set<std::array<Index, 2>> vertex_face;
  std::set<std::array<Index, 4>> edge_edge;  ///< both edges and their vertices ascending
};

std::array<Index, 4> ordered(std::array<Index, 4> e) {
  if (std::array{e[2], e[3]} < std::array{e[0], e[1]}) return {e[2], e[3], e[0], e[1]};
  return e;
}

Lists sets_of(const Collisions& found) {
  Lists lists;
  for (const auto& pair : found.vertex_face) lists.vertex_face.insert(pair);
  for (const auto& pair : found.edge_edge) {
    EXPECT_LT(pair[0], pair[1]);
    EXPECT_LT(pair[2], pair[3]);
    lists.edge_edge.insert(ordered(pair));
  }
  EXPECT_EQ(lists.vertex_face.size(), found.vertex_face.size()) << "no pair twice";
  EXPECT_EQ(lists.edge_edge.size(), found.edge_edge.size()) << "no pair twice";
  return lists;
}

/// The slow obvious version: every pair that shares no vertex.
Lists all_pairs(const std::vector<Vec3d>& x0, const std::vector<Vec3d>& x1,
                const std::vector<Triangle>& faces) {
  Lists lists;
  std::set<std::array<Index, 2>> edges;
  for (const Triangle& t : faces)
    for (std::size_t k = 0; k < 3; ++k)
      edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  const auto meets = [&](bool edge_edge, const std::array<Index, 4>& v) {
    if (std::set<Index>(v.begin(), v.end()).size() < 4) return false;
    CcdQuery<double> query;
    for (std::size_t k = 0; k < 4; ++k) query.p0[k] = x0[at(v[k])], query.p1[k] = x1[at(v[k])];
    CcdHit hit;
    return edge_edge ? ccd_ee(query, 0, hit) : ccd_vf(query, 0, hit);
  };
  for (Index v = 0; v < static_cast<Index>(x0.size()); ++v)
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (meets(false, {v, faces[f][0], faces[f][1], faces[f][2]}))
        lists.vertex_face.insert({v, static_cast<Index>(f)});
  for (auto a = edges.begin(); a != edges.end(); ++a)
    for (auto b = std::next(a); b != edges.end(); ++b)
      if (meets(true, {(*a)[0], (*a)[1], (*b)[0], (*b)[1]}))
        lists.edge_edge.insert(ordered({(*a)[0], (*a)[1], (*b)[0], (*b)[1]}));
  return lists;
}

TEST(Detect, FindsWhatAllPairsFind) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const TriangleMesh ball = make_sphere(scale, 160);
    const auto shaken = [&](double amount) {
      std::vector<Vec3d> x = ball.positions;
      for (Vec3d& p : x)
        p += amount * scale * Vec3d{uniform(random), uniform(random), uniform(random)};
      return x;
    };
    const std::vector<Vec3d> x0 = shaken(0.1), x1 = shaken(0.9);
    const Lists expected = all_pairs(x0, x1, ball.faces);
    EXPECT_GT(expected.vertex_face.size(), 50u);
    EXPECT_GT(expected.edge_edge.size(), 50u);
    const Lists found = sets_of(cpu64::detect_collisions(x0, x1, ball.faces));
    EXPECT_TRUE(found.vertex_face == expected.vertex_face) << scale;
    EXPECT_TRUE(found.edge_edge == expected.edge_edge) << scale;
  }
}

TEST(Detect, NothingMovesNothingMeets) {
  const TriangleMesh ball = make_sphere(1, 320);
  const Collisions found = cpu64::detect_collisions(ball.positions, ball.positions, ball.faces);
  EXPECT_TRUE(found.vertex_face.empty());
  EXPECT_TRUE(found.edge_edge.empty());
}

/// Rows of numbers below a header line.
template <std::size_t N>
std::vector<std::array<Index, N>> read_rows(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<std::array<Index, N>> rows;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    std::array<Index, N> row{};
    for (Index& n : row) numbers >> n;
    rows.push_back(row);
  }
  return rows;
}

TEST(Detect, GivesThePublishedListsOfTheClothFunnel) {
  const char* set = std::getenv("ICLOTH_DATA");
  const auto folder = std::filesystem::path(set ? set : ICLOTH_DATA_DEFAULT) / "ccd/cloth-funnel";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no data at " << folder;
  const TriangleMesh start = read_mesh((folder / "227.ply").string()).mesh;
  const TriangleMesh end = read_mesh((folder / "228.ply").string()).mesh;
  Lists expected;
  for (const auto& row : read_rows<5>(folder / "hits_vf.csv"))
    expected.vertex_face.insert({row[0], row[1]});
  for (const auto& row : read_rows<4>(folder / "hits_ee.csv"))
    expected.edge_edge.insert(ordered(row));
  ASSERT_EQ(expected.vertex_face.size(), 27u);
  ASSERT_EQ(expected.edge_edge.size(), 107u);
  const Lists found =
      sets_of(cpu64::detect_collisions(start.positions, end.positions, start.faces));
  EXPECT_TRUE(found.vertex_face == expected.vertex_face);
  EXPECT_TRUE(found.edge_edge == expected.edge_edge);
}

}  // namespace
}  // namespace icloth
