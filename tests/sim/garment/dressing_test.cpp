// Garments from patterns: where their panels start, how they are put on, and the cache of drapes.
#include "sim/garment/dressing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/garment/drape_cache.h"
#include "sim/garment/face_strain.h"
#include "sim/garment/open_scene.h"
#include "sim/garment/refine.h"
#include "sim/scene/intersections.h"
#include "sim/scene/material_io.h"
#include "sim/scene/shapes.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

/// Two rectangles of `width` cm, front and back, that are sewn along their sides to a tube.
std::string tube_pattern(double width, double distance) {
  const auto panel = [&](const char* name, double z, double turn) {
    const std::string w = std::to_string(width / 2);
    return "\"" + std::string(name) + R"(": {"vertices": [[-)" + w + ", 0], [" + w + ", 0], [" + w +
           ", 20], [-" + w +
           R"(, 20]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
           {"endpoints": [2, 3], "label": "collar"}, {"endpoints": [3, 0]}],
           "translation": [0, 20, )" +
           std::to_string(z) + R"(], "rotation": [0, )" + std::to_string(turn) + ", 0]}";
  };
  return R"({"pattern": {"panels": {)" + panel("front", distance, 0) + ", " +
         panel("back", -distance, 180) + R"(}, "stitches": [
    [{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}],
    [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1}]]},
    "properties": {"units_in_meter": 100}})";
}

/// A tube of cloth round a post of 10 cm radius.
Scene tube_scene(const TemporaryFolder& folder, double width, double distance,
                 Index triangles = 600) {
  std::vector<std::string> notes;
  Scene scene;
  scene.name = "tube";
  Cloth cloth;
  cloth.name = "tube";
  cloth.material = load_material("default", "");
  Garment garment = read_garment(
      folder.write("tube_specification.json", tube_pattern(width, distance)), triangles, notes);
  sew_garment(garment, cloth);
  scene.cloths.push_back(std::move(cloth));
  scene.garments.push_back(std::move(garment));

  Obstacle post;
  post.name = "post";
  post.mesh = make_capsule(0.1, 0.6, 600);
  for (Vec3d& p : post.mesh.positions) p.y += 0.4;
  scene.obstacles.push_back(std::move(post));
  fit_thickness(scene);
  return scene;
}

std::size_t count_conflicts(const Scene& scene) {
  return face_pairs(find_start_conflicts(scene, true)).size();
}

TEST(Dressing, DrawsTheSeamsOfATubeTogetherRoundAPost) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  std::vector<std::string> notes;
  int watched = 0;
  const auto reports =
      put_garments_on(scene, notes, [&](const Simulator& room, const DressingStatus& status) {
        ++watched;
        // The seams close in stiff cloth, without weight for a tenth of a second and then with a
        // part of it. The cloth settles as it is.
        const bool closing = !status.settling, weightless = closing && status.step <= 20;
        EXPECT_DOUBLE_EQ(room.parameters().gravity.y, weightless ? 0.0
                                                      : closing  ? 0.3 * -9.81
                                                                 : -9.81);
        EXPECT_EQ(room.parameters().material.bend_scale > 1, !status.settling);
        EXPECT_EQ(status.garment, "tube");
        return true;
      });
  ASSERT_EQ(reports.size(), 1u);
  ASSERT_TRUE(reports[0].dressing);
  const DressingReport& worn = *reports[0].dressing;
  EXPECT_EQ(watched, worn.closing_steps + worn.settling_steps);
  EXPECT_EQ(count_conflicts(scene), 0u);

  // 72 cm of cloth go round 63 cm of post, so nothing has to be stretched but by the weight.
  EXPECT_LT(worn.seam_strain_p95, 0.05);
  EXPECT_EQ(worn.gathered_share, 0);
  EXPECT_EQ(reports[0].arrangement.pairs_before, 0u);
}

TEST(Dressing, GivesTheSameBitsTwice) {
  const TemporaryFolder folder;
  Scene first = tube_scene(folder, 36, 15), second = tube_scene(folder, 36, 15);
  std::vector<std::string> notes;
  set_thread_count(1);
  put_garments_on(first, notes);
  set_thread_count(2);
  put_garments_on(second, notes);
  set_thread_count(0);
  EXPECT_EQ(first.cloths[0].mesh.positions, second.cloths[0].mesh.positions);
}

TEST(Dressing, MovesPanelsThatStandInTheBody) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 40, 6);  // 4 cm inside the post
  std::vector<std::string> notes;
  const auto reports = put_garments_on(scene, notes);
  const Arrangement& start = reports.at(0).arrangement;
  EXPECT_GT(start.pairs_before, 0u);
  EXPECT_EQ(start.pairs_left, 0u);
  EXPECT_FALSE(start.moved.empty());
  EXPECT_EQ(count_conflicts(scene), 0u);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("panel 'front'"), std::string::npos) << notes[0];
}

TEST(Dressing, LeavesAGarmentThatFindsNoStartAndNamesItsPanels) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  // A wall that goes through the whole garment, which neither lifting nor bending clears.
  Obstacle wall;
  wall.name = "wall";
  wall.mesh = make_box({2, 2, 0.01}, 0.2);
  for (Vec3d& p : wall.mesh.positions) std::swap(p.x, p.z);
  for (Triangle& t : wall.mesh.faces) std::swap(t[1], t[2]);
  scene.obstacles.push_back(std::move(wall));

  const auto before = scene.cloths[0].mesh.faces;
  std::vector<std::string> notes;
  const auto reports = put_garments_on(scene, notes);
  EXPECT_GT(reports.at(0).arrangement.pairs_left, 0u);
  EXPECT_FALSE(reports.at(0).dressing);
  EXPECT_EQ(scene.cloths[0].mesh.faces, before);
  EXPECT_NE(notes.back().find("and body 'wall'"), std::string::npos) << notes.back();
}

TEST(Dressing, LetsABodyGrowBackInsideTheGarment) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  const DressingReport worn = dress_garment(scene, 0, {}, 0.08);
  EXPECT_GT(worn.closing_steps, 200);  // a second of growing, in steps of 5 ms
  EXPECT_EQ(count_conflicts(scene), 0u);
}

/// A trunk with arms that hang at 45°, and a shirt whose sleeves go straight out.
Scene shirt_scene(const TemporaryFolder& folder) {
  const auto front_or_back = [](const char* name, double z, double turn) {
    return "\"" + std::string(name) +
           R"(": {"vertices": [[-20, 0], [20, 0], [20, 26], [20, 42], [9, 42], [-9, 42], [-20, 42],
           [-20, 26]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
           {"endpoints": [3, 4]}, {"endpoints": [4, 5]}, {"endpoints": [5, 6]},
           {"endpoints": [6, 7]}, {"endpoints": [7, 0]}], "translation": [0, 95, )" +
           std::to_string(z) + "], \"rotation\": [0, " + std::to_string(turn) + ", 0]}";
  };
  const auto sleeve = [](const char* name, double x, double z, double turn) {
    return ", \"" + std::string(name) +
           R"(": {"vertices": [[-9, -8], [9, -8], [9, 8], [-9, 8]], "edges": [{"endpoints": [0, 1]},
           {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}], "translation": [)" +
           std::to_string(x) + ", 129, " + std::to_string(z) + "], \"rotation\": [0, " +
           std::to_string(turn) + ", 0]}";
  };
  const auto stitch = [](const char* a, int edge_a, const char* b, int edge_b) {
    return "[{\"panel\": \"" + std::string(a) + "\", \"edge\": " + std::to_string(edge_a) +
           "}, {\"panel\": \"" + b + "\", \"edge\": " + std::to_string(edge_b) + "}]";
  };
  const std::string pattern =
      "{\"pattern\": {\"panels\": {" + front_or_back("front", 16, 0) + ", " +
      front_or_back("back", -16, 180) + sleeve("left_front", 33, 12, 0) +
      sleeve("left_back", 33, -12, 180) + sleeve("right_front", -33, 12, 0) +
      sleeve("right_back", -33, -12, 180) + "}, \"stitches\": [" + stitch("front", 1, "back", 7) +
      ", " + stitch("front", 7, "back", 1) + ", " + stitch("front", 3, "back", 5) + ", " +
      stitch("front", 5, "back", 3) + ", " + stitch("front", 2, "left_front", 3) + ", " +
      stitch("back", 6, "left_back", 1) + ", " + stitch("front", 6, "right_front", 1) + ", " +
      stitch("back", 2, "right_back", 3) + ", " + stitch("left_front", 0, "left_back", 0) + ", " +
      stitch("left_front", 2, "left_back", 2) + ", " + stitch("right_front", 0, "right_back", 0) +
      ", " + stitch("right_front", 2, "right_back", 2) +
      "]}, \"properties\": {\"units_in_meter\": 100}}";

  std::vector<std::string> notes;
  Scene scene;
  Cloth cloth;
  cloth.name = "shirt";
  cloth.material = load_material("default", "");
  Garment garment = read_garment(folder.write("shirt_specification.json", pattern), 500, notes);
  sew_garment(garment, cloth);
  scene.cloths.push_back(std::move(cloth));
  scene.garments.push_back(std::move(garment));

  // The arms start inside the trunk, as in bodies that are put together from parts.
  const auto add = [&](const char* name, double radius, double length, Vec3d centre, double turn) {
    Obstacle part;
    part.name = name;
    part.mesh = make_capsule(radius, length, 600);
    for (Vec3d& p : part.mesh.positions)
      p = Vec3d{std::cos(turn) * p.x - std::sin(turn) * p.y,
                std::sin(turn) * p.x + std::cos(turn) * p.y, p.z} +
          centre;
    scene.obstacles.push_back(std::move(part));
  };
  constexpr double kDown = 0.785;  // 45°
  add("trunk", 0.12, 0.9, {0, 0.8, 0}, 0);
  add("left arm", 0.04, 0.55, {0.3, 1.08, 0}, kDown);
  add("right arm", 0.04, 0.55, {-0.3, 1.08, 0}, -kDown);
  fit_thickness(scene);
  return scene;
}

TEST(Dressing, TurnsSleevesDownToArmsThatHang) {
  const TemporaryFolder folder;
  Scene scene = shirt_scene(folder);
  std::vector<std::string> notes;
  const auto reports = put_garments_on(scene, notes);
  const Arrangement& start = reports.at(0).arrangement;
  EXPECT_GT(start.pairs_before, 0u);
  ASSERT_EQ(start.pairs_left, 0u) << start.left.at(0);
  EXPECT_EQ(count_conflicts(scene), 0u);
  const auto turned = [](const std::string& clause) {
    return clause.find("tilted by") != std::string::npos;
  };
  EXPECT_EQ(std::ranges::count_if(start.moved, turned), 4);
}

TEST(Dressing, HoldsLabelledEdgesAtTheirHeightUntilTheySettle) {
  // A tube that closes round the upper half of a ball slips upwards.
  const TemporaryFolder folder;
  const auto slip = [&](bool held) {
    Scene scene = tube_scene(folder, 36, 18);
    scene.obstacles[0].mesh = make_sphere(0.14, 600);
    for (Vec3d& p : scene.obstacles[0].mesh.positions) p.y += 0.22;
    if (held) scene.garments[0].plan.hold = {"collar"};

    // The mean height of the collar at the start and when the weight comes on.
    std::vector<Index> collar;
    for (const LabelledEdge& edge : scene.garments[0].sewn.labelled)
      collar.insert(collar.end(), edge.vertices.begin(), edge.vertices.end());
    const auto height = [&](const std::vector<Vec3d>& x) {
      double sum = 0;
      for (Index v : collar) sum += x[at(v)].y;
      return sum / static_cast<double>(collar.size());
    };
    const double start = height(scene.cloths[0].mesh.positions);
    double closed = start;
    dress_garment(scene, 0, {}, 0, [&](const Simulator& room, const DressingStatus& status) {
      if (!status.settling) closed = height(room.snapshot().x1);
      return true;
    });
    return closed - start;
  };
  const double free = slip(false), held = slip(true);
  EXPECT_GT(free, 0.01);
  EXPECT_LT(held, 0.5 * free);
}

TEST(Dressing, PutsInnerLayersOnFirst) {
  // The second garment of the file is the inner one; the outer one starts outside of it.
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 46, 22);
  Scene inner = tube_scene(folder, 36, 15);
  inner.cloths[0].name = "inner";
  scene.cloths.push_back(inner.cloths[0]);
  scene.garments.push_back(inner.garments[0]);
  scene.garments[0].layer = 1;
  scene.garments[1].cloth = 1;

  std::vector<std::string> notes;
  const auto reports = put_garments_on(scene, notes);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].garment, "inner");
  EXPECT_EQ(reports[1].garment, "tube");
  EXPECT_TRUE(reports[1].dressing);
  EXPECT_EQ(count_conflicts(scene), 0u);
}

/// More triangles than a garment is put on with.
constexpr Index kManyTriangles = kMostDressedTriangles + 1000;

TEST(Dressing, RefinesAGarmentOfManyTrianglesWhereItHangs) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15, kManyTriangles);
  const std::size_t faces = scene.cloths[0].mesh.faces.size();
  EXPECT_NEAR(static_cast<double>(faces), kManyTriangles, 0.1 * kManyTriangles);
  ASSERT_EQ(refinements(scene), 1);

  // The seams draw together in a quarter of the triangles; all of them settle.
  std::vector<std::string> notes;
  std::size_t closing = 0, settling = 0;
  const auto reports =
      put_garments_on(scene, notes, [&](const Simulator& room, const DressingStatus& status) {
        (status.settling ? settling : closing) = room.scene().cloths[0].mesh.faces.size();
        return true;
      });
  EXPECT_EQ(closing, faces / 4);
  EXPECT_EQ(settling, faces);
  EXPECT_EQ(scene.cloths[0].mesh.faces.size(), faces);
  EXPECT_EQ(count_conflicts(scene), 0u);

  ASSERT_TRUE(reports.at(0).dressing);
  EXPECT_EQ(reports[0].dressing->refined_steps, 20);
  EXPECT_LT(reports[0].dressing->largest_strain, 0.1);
}

TEST(Refine, CutsTheTrianglesThatHangOnTheBodyIntoFour) {
  // The sewn mesh, bent in some way, is divided as any mesh is.
  const TemporaryFolder folder;
  const Scene scene = tube_scene(folder, 36, 15, kManyTriangles);
  Scene worn = coarsest_scene(scene);
  for (Vec3d& p : worn.cloths[0].mesh.positions) p.z += 0.3 * p.x * p.y;
  TriangleMesh expected = worn.cloths[0].mesh;
  std::vector<Vec3d> no_rest;
  subdivide(expected, no_rest);
  refine_garments(worn, 0);

  // Vertices have other numbers, so corners are compared face by face, with the rest shape.
  const TriangleMesh& mesh = worn.cloths[0].mesh;
  ASSERT_EQ(mesh.faces.size(), expected.faces.size());
  ASSERT_EQ(mesh.positions.size(), expected.positions.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.positions[at(mesh.faces[f][k])], expected.positions[at(expected.faces[f][k])]);
      EXPECT_NEAR(mesh.uv[f][k].x, expected.uv[f][k].x, 1e-12);
      EXPECT_NEAR(mesh.uv[f][k].y, expected.uv[f][k].y, 1e-12);
    }

  // It is the mesh of the loaded scene.
  EXPECT_EQ(mesh.faces, scene.cloths[0].mesh.faces);
  EXPECT_EQ(worn.garments[0].sewn.merged, scene.garments[0].sewn.merged);
}

TEST(Refine, LeavesScenesAloneThatHoldVerticesByTheirNumbers) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15, kManyTriangles);
  scene.cloths[0].pins = {0};
  EXPECT_EQ(refinements(scene), 0);
  EXPECT_EQ(refinements(tube_scene(folder, 36, 15)), 0);
}

TEST(Dressing, RaisesAPatternWhoseOriginIsAtTheWaist) {
  // The tube is drawn 1 m below where it belongs on a post of 1.6 m that stands on the ground.
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  for (Vec3d& p : scene.obstacles[0].mesh.positions) p.y = 2 * p.y;
  scene.garments[0].translation.y = -0.9;
  sew_garment(scene.garments[0], scene.cloths[0]);
  const Arrangement start = arrange_garment(scene, 0, {});
  EXPECT_NEAR(start.raised, 0.69 * 1.6, 1e-9);
  EXPECT_EQ(start.pairs_left, 0u);

  // One that hangs above the feet stays where it is.
  Scene other = tube_scene(folder, 36, 15);
  EXPECT_EQ(arrange_garment(other, 0, {}).raised, 0);
}

TEST(Dressing, RefusesAWearerThatIsNotThere) {
  const TemporaryFolder folder;
  folder.write("tube_specification.json", tube_pattern(36, 15));
  const std::string scene = folder.write(
      "s.json",
      R"({"cloths": [{"name": "t", "pattern": "tube_specification.json", "triangles": 100,
          "on": "womn"}], "obstacles": [{"name": "woman", "mesh": {"sphere": {"radius": 0.1}}}]})");
  try {
    load_scene(scene, {});
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("on: value 'womn'"), std::string::npos)
        << error.what();
  }
}

TEST(FaceStrain, IsTheLargestPrincipalStretch) {
  // At rest as it is sewn, then larger by a fifth in all directions.
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  Cloth& cloth = scene.cloths[0];
  cloth.rest_in_uv = false;
  cloth.mesh.uv.clear();
  const World world = make_world(scene);
  for (double strain : face_strains(world, cloth.mesh.positions)) EXPECT_NEAR(strain, 0, 1e-9);
  std::vector<Vec3d> stretched = cloth.mesh.positions;
  for (Vec3d& p : stretched) p = 1.2 * p;
  for (double strain : face_strains(world, stretched)) EXPECT_NEAR(strain, 0.2, 1e-9);
  EXPECT_EQ(percentile({4, 1, 3, 2, 5}, 0.5), 3);
  EXPECT_EQ(percentile({4, 1, 3, 2, 5}, 1), 5);
}

TEST(Dressing, EndsWhenTheWatchSaysSo) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  std::vector<std::string> notes;
  int steps = 0;
  const auto stop = [&](const Simulator&, const DressingStatus&) { return ++steps < 3; };
  EXPECT_THROW(put_garments_on(scene, notes, stop), DressingCancelled);
  EXPECT_EQ(steps, 3);
}

TEST(DrapeCache, GivesBackWhatWasSavedAndNothingElse) {
  const TemporaryFolder folder;
  Scene scene = tube_scene(folder, 36, 15);
  const std::string key = drape_key(scene);
  Drape drape;
  drape.positions = {scene.cloths[0].mesh.positions};
  for (Vec3d& p : drape.positions[0]) p.x += 1.0 / 3;
  drape.notes = {"a note"};
  const std::string place = folder.path("cache");
  save_drape(place, key, drape);

  const auto back = load_drape(place, key, scene);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->positions, drape.positions);
  EXPECT_EQ(back->notes, drape.notes);

  // Another fabric, wearer, held edge or parameter, or a damaged file is no hit.
  Scene other = scene;
  other.cloths[0].material.density *= 2;
  EXPECT_NE(drape_key(other), key);
  other = scene;
  other.garments[0].body = "post";
  EXPECT_NE(drape_key(other), key);
  other = scene;
  other.garments[0].sewn.labelled.clear();
  EXPECT_NE(drape_key(other), key);
  other = scene;
  other.parameters.proximity.stiffness *= 2;
  EXPECT_NE(drape_key(other), key);
  EXPECT_FALSE(load_drape(place, drape_key(other), scene));

  const std::string file = place + "/" + key + ".drape";
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(-3, std::ios::end);
  bytes.put('x');
  bytes.close();
  EXPECT_FALSE(load_drape(place, key, scene));
  std::filesystem::resize_file(file, 40);
  EXPECT_FALSE(load_drape(place, key, scene));
}

TEST(DrapeCache, KeepsTheDrapesThatWereWrittenLast) {
  const TemporaryFolder folder;
  const std::string place = folder.path("cache");
  const auto name = [](int number) {
    const std::string digits = std::to_string(number);
    return std::string(32 - digits.size(), '0') + digits;
  };
  Drape drape;
  for (int k = 0; k < 203; ++k) {
    save_drape(place, name(k), drape);
    const std::string file = place + "/" + name(k) + ".drape";
    const auto now = std::filesystem::last_write_time(file);
    std::filesystem::last_write_time(file, now - std::chrono::hours(1000 - k));
  }
  // The file that was written last is the newest when the others are counted.
  EXPECT_FALSE(std::filesystem::exists(place + "/" + name(2) + ".drape"));
  EXPECT_TRUE(std::filesystem::exists(place + "/" + name(3) + ".drape"));
  EXPECT_TRUE(std::filesystem::exists(place + "/" + name(202) + ".drape"));
}

TEST(OpenScene, RepairsGarmentsAfterTheyArePutOn) {
  const TemporaryFolder folder;
  folder.write("tube_specification.json", tube_pattern(40, 6));
  folder.write("post.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
  const std::string file = folder.write(
      "s.json",
      R"({"cloths": [{"name": "t", "pattern": "tube_specification.json", "triangles": 300}],
          "obstacles": [{"name": "post", "mesh": {"capsule": {"radius": 0.1, "length": 0.6}},
                         "transform": {"translate": [0, 0.4, 0]}}]})");
  const std::vector<std::string> overrides = {"repair_start=on"};
  setenv("XDG_CACHE_HOME", folder.path("cache").c_str(), 1);
  for (int round = 0; round < 2; ++round) {  // dressed, then from the cache
    const auto scene = open_scene(file, overrides);
    ASSERT_TRUE(scene->repair);
    EXPECT_EQ(scene->repair->pairs_before, 0u);
    EXPECT_EQ(scene->repair->moved, 0u);
    EXPECT_EQ(count_conflicts(*scene), 0u);
  }
}

}  // namespace
}  // namespace icloth
