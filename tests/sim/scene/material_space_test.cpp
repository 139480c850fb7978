// The rest shape in the texture coordinates: panels, distances across seams, runs and messages.
#include "sim/scene/material_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/world.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

using testing::lying;
using testing::make_sheet;

/// A rectangle of `columns` × `rows` squares of side `edge`, rolled to a tube round the y axis
/// whose last column is sewn to the first: one panel, stitched to itself.
Cloth sewn_tube(Index columns, Index rows, double edge) {
  Cloth cloth;
  cloth.name = "tube";
  const double radius = edge * static_cast<double>(columns) / (2 * std::numbers::pi);
  for (Index j = 0; j <= rows; ++j)
    for (Index i = 0; i < columns; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / columns;
      cloth.mesh.positions.push_back(
          {radius * std::cos(angle), edge * static_cast<double>(j), -radius * std::sin(angle)});
    }

  const auto vertex = [&](Index i, Index j) { return j * columns + i % columns; };
  const auto uv = [&](Index i, Index j) { return Vec2d{edge * i, edge * j}; };
  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < columns; ++i) {
      cloth.mesh.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      cloth.mesh.uv.push_back({uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)});
      cloth.mesh.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      cloth.mesh.uv.push_back({uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)});
    }
  cloth.rest = cloth.mesh.positions;
  cloth.rest_in_uv = true;
  cloth.material = load_material("default", "");
  return cloth;
}

/// Two squares side by side that share an edge, with coordinates of their own.
TriangleMesh two_panels() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  mesh.uv = {{{{0, 0}, {1, 0}, {1, 1}}},
             {{{0, 0}, {1, 1}, {0, 1}}},
             {{{5, 0}, {6, 0}, {6, 1}}},
             {{{5, 0}, {6, 1}, {5, 1}}}};
  return mesh;
}

TEST(MaterialSpace, FindsThePanelsThatSeamsSeparate) {
  EXPECT_EQ(find_panels(two_panels()), (std::vector<Index>{0, 0, 1, 1}));

  // Moved together in the pattern, they are one piece.
  TriangleMesh one = two_panels();
  for (std::size_t f : {2u, 3u})
    for (Vec2d& corner : one.uv[f]) corner.x -= 4;
  EXPECT_EQ(find_panels(one), (std::vector<Index>{0, 0, 0, 0}));
}

TEST(MaterialSpace, TurnsAMirroredPanelAndLeavesTheOthers) {
  TriangleMesh mesh = two_panels();
  const TriangleMesh before = mesh;
  for (std::size_t f : {2u, 3u})
    for (Vec2d& corner : mesh.uv[f]) corner.x = -corner.x;
  turn_mirrored_panels(mesh);
  EXPECT_EQ(rest_shape_problem(mesh), "");
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(mesh.uv[f][c].x, before.uv[f][c].x);
}

TEST(MaterialSpace, NamesTheFaceThatCannotBeUsed) {
  // A face that is turned over against its panel, with the three others of one piece.
  TriangleMesh turned = two_panels();
  for (std::size_t f : {2u, 3u})
    for (Vec2d& corner : turned.uv[f]) corner.x -= 4;
  turned.uv[2][1] = {0.5, 0.5};
  turn_mirrored_panels(turned);
  EXPECT_EQ(rest_shape_problem(turned).find("triangle 2 is turned over"), 0u)
      << rest_shape_problem(turned);

  TriangleMesh flat = two_panels();
  flat.uv[1] = {{{0, 0}, {1, 1}, {0.5, 0.5}}};
  EXPECT_EQ(rest_shape_problem(flat).find("triangle 1 has no area"), 0u);
}

/// Distance at rest on a tube that is unrolled: the shorter way round.
double tube_distance(Index columns, Index a, Index b, double edge) {
  const double round = std::abs(a % columns - b % columns);
  const double along = std::abs(a / columns - b / columns);
  return edge * std::hypot(std::min(round, columns - round), along);
}

TEST(RestDistances, EqualThoseOfTheUnrolledTube) {
  constexpr Index kColumns = 16, kRows = 8;
  constexpr double kEdge = 0.01;
  const Cloth tube = sewn_tube(kColumns, kRows, kEdge);
  const auto vertices = tube.mesh.positions.size();
  const RestDistances found = rest_distances(tube.mesh.faces, vertices, tube.mesh.uv);

  // Column 0 is sewn to the last one; all others lie in the one panel.
  for (std::size_t v = 0; v < vertices; ++v)
    EXPECT_EQ(found.panel[v], v % kColumns == 0 ? kNone : 0) << v;

  // Ways over vertices of the seam are a little longer than the straight ones, and never shorter.
  std::size_t listed = 0;
  for (std::size_t v = 0; v < vertices; ++v)
    for (Index k = found.first[v]; k < found.first[v + 1]; ++k) {
      const RestDistance& d = found.distances[at(k)];
      const double real = tube_distance(kColumns, static_cast<Index>(v), d.vertex, kEdge);
      EXPECT_GE(std::sqrt(d.squared), real * (1 - 1e-12)) << v << ' ' << d.vertex;
      EXPECT_LE(std::sqrt(d.squared), real * 1.13) << v << ' ' << d.vertex;
      ++listed;
    }

  // Every pair across the seam or on it that is at most an edge and a half apart is listed.
  for (Index a = 0; at(a) < vertices; ++a)
    for (Index b = a + 1; at(b) < vertices; ++b) {
      const bool on_seam = a % kColumns == 0 || b % kColumns == 0;
      const bool across = std::abs(a % kColumns - b % kColumns) > kColumns / 2;
      if (!(on_seam || across) || tube_distance(kColumns, a, b, kEdge) > 1.5 * kEdge) continue;
      bool known = false;
      for (Index k = found.first[at(a)]; k < found.first[at(a) + 1]; ++k)
        known = known || found.distances[at(k)].vertex == b;
      EXPECT_TRUE(known) << a << ' ' << b;
    }
  EXPECT_GT(listed, 100u);
}

TEST(RestDistances, KeepTheirListsShortWhereThousandsOfPanelsMeet) {
  // A fan of single faces, each a panel of its own, round one vertex.
  constexpr Index kFaces = 2000;
  Cloth fan;
  fan.mesh.positions = {{0, 0, 0}};
  for (Index i = 0; i < kFaces; ++i) {
    const double angle = 2 * std::numbers::pi * i / kFaces;
    fan.mesh.positions.push_back({std::cos(angle), 0, std::sin(angle)});
    fan.mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % kFaces});
    fan.mesh.uv.push_back({{{3.0 * i, 0}, {3.0 * i + 1, 0}, {3.0 * i, 1}}});
  }
  const RestDistances found =
      rest_distances(fan.mesh.faces, fan.mesh.positions.size(), fan.mesh.uv);
  EXPECT_LE(found.distances.size(), 128u * fan.mesh.positions.size());
}

std::shared_ptr<Scene> scene_of(Cloth cloth) {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->cloths.push_back(std::move(cloth));
  return scene;
}

/// Hash after some steps of free fall against the air.
std::uint64_t hash_after(const std::shared_ptr<const Scene>& scene, int steps) {
  const auto simulator = make_simulator(Build::cpu32, scene);
  StepReport report;
  for (int k = 0; k < steps; ++k) report = simulator->step({});
  EXPECT_TRUE(report.accepted);
  return report.state_hash;
}

TEST(RestInUv, MovesOnePanelToTheSameBitsAsItsFlatRestMesh) {
  // A sheet that starts stretched by a fifth and knows its flat shape in both ways.
  Cloth flat = make_sheet(lying(0.3, 400), {0, 1, 0});
  for (Vec3d& p : flat.mesh.positions) p.x *= 1.2;
  for (std::size_t f = 0; f < flat.mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec2d u = flat.mesh.uv[f][c];
      flat.rest[at(flat.mesh.faces[f][c])] = {u.x, u.y, 0};
    }
  flat.pins = {0, 1, 2};
  Cloth in_uv = flat;
  in_uv.rest_in_uv = true;
  in_uv.rest = in_uv.mesh.positions;
  EXPECT_EQ(make_world(*scene_of(flat)).median_edge, make_world(*scene_of(in_uv)).median_edge);
  EXPECT_EQ(hash_after(scene_of(flat), 20), hash_after(scene_of(in_uv), 20));
}

TEST(RestInUv, LeavesASewnTubeAtRestWithoutContacts) {
  // Its edges are short against the thickness, so that neighbours across the seam are within it.
  auto scene = scene_of(sewn_tube(40, 20, 0.01));
  scene->parameters.proximity.thickness = 0.008;
  scene->parameters.gravity = {};
  scene->parameters.wind.air_density = 0;
  const auto simulator = make_simulator(Build::cpu32, scene);
  const StepReport report = simulator->step({});
  EXPECT_TRUE(report.accepted);
  EXPECT_EQ(report.proximity_pairs, 0);

  // Another cloth whose rest shape is in space does not lose its own neighbours.
  auto both = std::make_shared<Scene>(*scene);
  both->cloths.push_back(make_sheet(lying(0.1, 200), {0, 1, 0}));
  const auto two = make_simulator(Build::cpu32, both);
  EXPECT_EQ(two->step({}).proximity_pairs, 0);
}

/// A scene with one cloth of two panels in centimetres, with further keys.
std::string error_of(const std::string& obj, const std::string& keys,
                     std::vector<std::string>* notes = nullptr) {
  const TemporaryFolder folder;
  folder.write("c.obj", obj);
  const std::string path =
      folder.write("s.json", R"({"cloths": [{"name": "c", "mesh": "c.obj")" + keys + "}]}");
  SceneOrigin origin;
  try {
    load_scene(path, {}, {}, &origin);
  } catch (const InputError& error) {
    return error.what();
  }
  if (notes) *notes = origin.notes;
  return "";
}

constexpr const char* kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 100 0\nvt 100 100\nvt 0 100\n";

TEST(RestInUv, ReadsItsUnitAndRefusesWhatIsNoPattern) {
  const std::string good = std::string(kSquare) + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
  EXPECT_EQ(error_of(good, R"(, "rest": "uv", "uv_unit": "cm")"), "");
  EXPECT_EQ(error_of(good, R"(, "rest": "uv", "uv_scale": 0.01)"), "");

  struct Case {
    std::string obj, keys;
    const char* part;
  };
  const std::string mixed = std::string(kSquare) + "f 1/1 2/2 3/3\nf 1/1 3/3 4/2\n";
  const std::string flat = std::string(kSquare) + "f 1/1 2/2 3/3\nf 1/1 3/3 4/1\n";
  const std::string none = std::string(kSquare) + "f 1/1 2/2 3/3\nf 1 3 4\n";
  for (const Case& c : {Case{mixed, R"(, "rest": "uv")", "triangle 1 is turned over"},
                        Case{flat, R"(, "rest": "uv")", "triangle 1 has no area"},
                        Case{none, R"(, "rest": "uv")", "at every corner"},
                        Case{good, R"(, "uv_unit": "cm")", "only with \"rest\": \"uv\""},
                        Case{good, R"(, "rest": "uv", "uv_unit": "inch")", "\"mm\""},
                        Case{good, R"(, "rest": "uv", "uv_unit": "m", "uv_scale": 2)", "either"},
                        Case{good, R"(, "rest": "uv", "rest_angles": "mesh")", "no folds"}}) {
    const std::string error = error_of(c.obj, c.keys);
    EXPECT_NE(error.find(c.part), std::string::npos) << c.part << ": " << error;
  }
}

TEST(RestInUv, SaysWhenTheUnitIsProbablyAnotherOne) {
  const std::string good = std::string(kSquare) + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
  std::vector<std::string> notes;
  EXPECT_EQ(error_of(good, R"(, "rest": "uv")", &notes), "");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("1e+04 times"), std::string::npos) << notes[0];

  // Coordinates that are not used at all are a note as well, with the reason.
  EXPECT_EQ(error_of(good, "", &notes), "");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("not used as material coordinates"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace icloth
