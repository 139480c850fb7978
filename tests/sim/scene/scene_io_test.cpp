// Scene files, built-in scenes, overrides, plain meshes, moving obstacles.
#include "sim/scene/scene_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/bodies/cached_poses.h"
#include "sim/scene/intersections.h"
#include "sim/scene/material_io.h"
#include "sim/scene/world.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

const std::string kData = std::string(ICLOTH_TEST_FOLDER) + "/data/";

std::shared_ptr<const Scene> load(const std::string& argument,
                                  const std::vector<std::string>& overrides = {}) {
  return load_scene(argument, overrides);
}

TEST(SceneIo, SettingsAreOverlaidOnTheDefaults) {
  const auto scene = load(kData + "drop.json");
  EXPECT_EQ(scene->name, "drop");
  EXPECT_EQ(scene->duration, 0.5);
  const Parameters& p = scene->parameters;
  EXPECT_EQ(p.wind.x, 0.5);
  EXPECT_EQ(p.wind.air_drag, 0.1);
  EXPECT_EQ(p.proximity.thickness, 2e-3);
  EXPECT_EQ(p.proximity.friction_cloth, 0.4);
  EXPECT_EQ(p.proximity.friction_obstacle, Parameters{}.proximity.friction_obstacle);
}

TEST(SceneIo, OverridesComeLast) {
  const auto scene = load(kData + "drop.json", {"proximity.thickness=0.003", "time_step=0.002"});
  EXPECT_EQ(scene->parameters.proximity.thickness, 0.003);
  EXPECT_EQ(scene->parameters.step.time_step, 0.002);
}

TEST(SceneIo, ReadsObjectsGrabsAndCameras) {
  const auto scene = load(kData + "drop.json");
  ASSERT_EQ(scene->cloths.size(), 1u);
  const Cloth& sheet = scene->cloths[0];
  EXPECT_EQ(sheet.material.name, "ivory-rib-knit");
  EXPECT_NEAR(static_cast<double>(sheet.mesh.faces.size()), 200, 10);
  for (Vec3d p : sheet.mesh.positions) EXPECT_NEAR(p.y, 0.16, 1e-15);
  ASSERT_EQ(scene->obstacles.size(), 1u);
  EXPECT_TRUE(scene->obstacles[0].moves());
  ASSERT_EQ(scene->input.size(), 1u);
  const ScriptedGrab& grab = scene->input[0];
  const Vec3d corner = sheet.mesh.positions[static_cast<std::size_t>(grab.vertex)];
  EXPECT_NEAR(norm(corner - Vec3d{-0.2, 0.16, -0.2}), 0, 1e-12);
  EXPECT_EQ(grab.release, 0.4);
  EXPECT_EQ(scene->cameras.at(0).eye, (Vec3d{0, 0.4, 1}));
}

TEST(SceneIo, PinsAreGivenByNameNumberAndBox) {
  const TemporaryFolder folder;
  const std::string start = R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 50,)";
  const auto named = load(folder.write("a.json", start + R"("pins": ["top", 0]}]})"));
  const auto boxed = load(
      folder.write("b.json", start + R"("pins": [{"box": [[-1, 0.49, -1], [1, 1, 1]]}, 0]}]})"));
  EXPECT_GT(named->cloths[0].pins.size(), 4u);
  EXPECT_EQ(named->cloths[0].pins, boxed->cloths[0].pins);
}

TEST(SceneIo, TransformScalesRotatesAndMoves) {
  const TemporaryFolder folder;
  const auto scene = load(folder.write("a.json", R"({"cloths": [{"mesh": {"grid": {"size": [1, 2]}},
      "triangles": 40, "transform": {"scale": 2, "rotate": [0, 90, 0], "translate": [5, 0, 0]}}]})"));
  const Cloth& cloth = scene->cloths[0];
  EXPECT_NEAR(norm(cloth.mesh.positions[0] - Vec3d{5, -2, 1}), 0, 1e-12);
  EXPECT_EQ(cloth.rest.back(), (Vec3d{2, 4, 0}));
  EXPECT_EQ(cloth.mesh.uv.back()[1].y, 4);
}

TEST(SceneIo, RotationsAboutSeveralAxesAreDoneInTurn) {
  const TemporaryFolder folder;
  const auto scene = load(folder.write("a.json", R"({"cloths": [{"mesh": {"grid": {"size": [2, 2]}},
      "triangles": 40, "transform": {"rotate": [90, 90, 0]}}]})"));
  // (−1, −1, 0) about x by 90°: (−1, 0, −1), then about y by 90°: (−1, 0, 1).
  EXPECT_NEAR(norm(scene->cloths[0].mesh.positions[0] - Vec3d{-1, 0, 1}), 0, 1e-12);
}

TEST(SceneIo, MeshFilesUseTheirMaterialCoordinatesAndAreFoundBesideTheScene) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(kData + "groups.obj", folder.path("g.obj"));
  const auto scene = load(folder.write(
      "a.json", R"({"cloths": [{"mesh": "g.obj", "subdivide": 1, "material": {"base": "default",
      "density": 0.5, "law": "orthotropic"}}]})"));
  EXPECT_EQ(scene->cloths[0].mesh.faces.size(), 24u);
  EXPECT_EQ(scene->cloths[0].material.density, 0.5);
  EXPECT_EQ(scene->cloths[0].material.law, Material::Law::orthotropic);
  EXPECT_GT(scene->cloths[0].material.bending[0][0], 2e-5);
}

TEST(SceneIo, ReadsEngineeringConstantsAndFlatRestAngles) {
  const TemporaryFolder folder;
  const auto scene = load(folder.write(
      "a.json", R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "rest_angles": "flat",
      "material": {"density": 0.1, "strain_limit": 0.2, "orthotropic": {"young": [800, 200],
      "poisson": 0.5, "shear": 20, "bending": [4e-6, 1e-6]}}}]})"));
  const Material& m = scene->cloths[0].material;
  EXPECT_TRUE(scene->cloths[0].flat_angles);
  EXPECT_EQ(m.law, Material::Law::orthotropic);
  EXPECT_EQ(m.strain_limit, 0.2);
  const double plane = 1 - 0.25 * 200 / 800;
  EXPECT_NEAR(m.stretching[0][0], 400 / plane, 1e-9);
  EXPECT_NEAR(m.stretching[0][1], 0.5 * 100 / plane, 1e-9);
  EXPECT_EQ(m.stretching[3], m.stretching[0]);
  EXPECT_NEAR(m.bending[2][0], 16e-6, 1e-15);  // hinges along v bend the cloth along u
  EXPECT_NEAR(m.bending[1][4], 9e-6, 1e-15);   // between them, as of a plate
}

TEST(SceneIo, TextureCoordinatesAreNotTakenForMaterialCoordinates) {
  const TemporaryFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 3 0 0\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  const auto scene = load(folder.write("a.json", R"({"cloths": [{"mesh": "t.obj"}]})"));
  EXPECT_TRUE(scene->cloths[0].mesh.uv.empty());
}

TEST(SceneIo, PlainMeshHangsByItsTop) {
  const TemporaryFolder folder;
  const auto scene =
      load(folder.write("a.obj",
                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nv 2 -4 0\nf 1 5 2\n"
                        "v 0 -5 0\nv 1 -5 0\nv 2 -5 0\nf 1 6 5\nf 6 7 5\nf 7 8 5\n"));
  ASSERT_EQ(scene->cloths.size(), 1u);
  EXPECT_EQ(scene->cloths[0].pins, (std::vector<Index>{2, 3}));
  EXPECT_EQ(scene->cloths[0].material.name, "default");
  ASSERT_EQ(scene->cameras.size(), 1u);
  EXPECT_GT(norm(scene->cameras[0].eye - scene->cameras[0].target), 3);
}

TEST(SceneIo, TrianglesOverrideRescalesAllGridsAndTheThickness) {
  const auto scene = load("sphere", {"triangles=3000000"});
  std::size_t faces = 0;
  for (const Cloth& cloth : scene->cloths) faces += cloth.mesh.faces.size();
  EXPECT_NEAR(static_cast<double>(faces), 3e6, 3e4);
  EXPECT_LT(scene->parameters.proximity.thickness, 0.3 * 0.0016);
  EXPECT_LT(scene->parameters.impact_zones.offset, 0.05 * 0.0016);
  const auto own = load("sphere", {"triangles=3000000", "proximity.thickness=0.001"});
  EXPECT_EQ(own->parameters.proximity.thickness, 0.001);
}

TEST(SceneIo, ClipStartMovesTheMomentAndLeavesTheBindPoseOfABlend) {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& keys) {
    return folder.write("dance.json",
                        R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 8}],
      "obstacles": [{"mesh": "bodies/woman.glb", "clip": "dance", )" +
                            keys + "}]}");
  };
  const auto pose = [&](const std::string& keys, double time, bool changed) {
    const auto scene = load(file(keys), changed ? std::vector<std::string>{"clip_start=3"}
                                                : std::vector<std::string>{});
    std::vector<Vec3d> out;
    scene->obstacles[0].pose(time, out);
    return out;
  };

  // The override stands for the key of the scene, whatever that says.
  const std::string blended = R"("blend_in": 0.5)";
  EXPECT_EQ(pose(blended + R"(, "start": 1)", 0.9, true),
            pose(blended + R"(, "start": 3)", 0.9, false));
  EXPECT_NE(pose(blended, 0.9, true), pose(blended, 0.9, false));
  EXPECT_EQ(pose(blended, 0, true), pose(blended, 0, false)) << "the garments hang as they do";
}

TEST(SceneIo, AModeSetsHowCollisionsAreHandled) {
  const Parameters pscc = load("flag", {"mode=pscc"})->parameters;
  EXPECT_EQ(pscc.broad_phase.method, BroadPhaseMethod::hash);
  EXPECT_EQ(pscc.impact_zones.solver, ZoneSolver::linear);
  EXPECT_FALSE(pscc.ccd.incremental);
  const Parameters cama = load("flag", {"mode=cama"})->parameters;
  EXPECT_EQ(cama.broad_phase.method, BroadPhaseMethod::tree);
  EXPECT_EQ(cama.impact_zones.solver, ZoneSolver::linear);
  EXPECT_FALSE(cama.ccd.incremental);
  EXPECT_EQ(dump_parameters(load("flag", {"mode=pscc", "mode=icloth"})->parameters),
            dump_parameters(load("flag")->parameters))
      << "our own way is that of the defaults";
}

TEST(SceneIo, BuiltInScenesStartWithoutIntersections) {
  for (const char* name : {"scarf", "sphere"}) {
    const auto scene = load(name, {"triangles=10000"});
    EXPECT_TRUE(find_start_intersections(*scene, true).empty()) << name;
    EXPECT_EQ(scene->cameras.at(0).name, "default");
    EXPECT_EQ(scene->source, name);
  }
  const auto sphere = load("sphere");
  EXPECT_EQ(sphere->parameters.step.time_step, 1.0 / 200);
  std::size_t faces = 0;
  for (const Cloth& cloth : sphere->cloths) faces += cloth.mesh.faces.size();
  EXPECT_NEAR(static_cast<double>(faces), 200000, 2000);
}

TEST(SceneIo, ScarfHandsMoveSlowlyAndSmoothly) {
  const auto scene = load("scarf");
  ASSERT_EQ(scene->input.size(), 2u);
  for (const ScriptedGrab& grab : scene->input) {
    ASSERT_GT(grab.path.size(), 100u);
    EXPECT_LE(grab.release, scene->duration);
    for (std::size_t i = 1; i < grab.path.size(); ++i) {
      const double dt = grab.path[i].time - grab.path[i - 1].time;
      EXPECT_LT(norm(grab.path[i].target - grab.path[i - 1].target), 1.0 * dt) << i;
    }
  }
}

TEST(SceneIo, AllShippedMaterialsLoad) {
  for (const char* name : {"gray-interlock", "11oz-black-denim", "white-dots-on-blk",
                           "ivory-rib-knit", "pink-ribbon-brown", "camel-ponte-roma"}) {
    const Material material = load_material(name, "");
    EXPECT_EQ(material.name, name);
    EXPECT_GT(material.density, 0.1);
    EXPECT_EQ(material.bending_spacing, 20);
  }
  const Material denim = load_material("11oz-black-denim", "");
  EXPECT_EQ(denim.bending_friction, 1.05e-3);
  EXPECT_EQ(denim.shear_friction, 2.9);
  const Material shirt = load_material("default", "");
  EXPECT_EQ(shirt.bending_friction, 0);
  EXPECT_EQ(shirt.density, 0.187);
  EXPECT_EQ(shirt.stretching[4][3], -174.43853);
  EXPECT_NEAR(shirt.bending[1][4], 8.860165e-6, 1e-15);
}

TEST(SceneIo, AMaterialKeepsWhatItsBaseHasAndItLeavesOut) {
  const TemporaryFolder folder;
  const Material worn = load_material(
      folder.write("worn.json", R"({"base": "11oz-black-denim", "yarn_friction": {"shear": 1.5}})"),
      "");
  const Material soft =
      load_material(folder.write("soft.json", R"({"base": "11oz-black-denim", "bending_unit": 1e-6,
      "bending": [[9, 9, 9, 9, 9], [9, 9, 9, 9, 9], [9, 9, 9, 9, 9]]})"),
                    "");
  EXPECT_EQ(worn.shear_friction, 1.5);
  EXPECT_EQ(worn.bending_friction, 1.05e-3);
  EXPECT_EQ(worn.bending_spacing, 20);
  EXPECT_EQ(soft.bending_spacing, 10) << "its own samples, not those of the base";
  EXPECT_EQ(soft.bending_friction, 1.05e-3);
}

TEST(SceneIo, KeyframesAreInterpolatedAndHeldAtBothEnds) {
  Obstacle obstacle;
  obstacle.mesh.positions = {{1, 0, 0}};
  obstacle.motion = {{1, {0, 0, 0}, {}}, {3, {0, 2, 0}, {0, 0, std::numbers::pi}}};
  std::vector<Vec3d> out;
  obstacle.pose(0, out);
  EXPECT_EQ(out.at(0), (Vec3d{1, 0, 0}));
  obstacle.pose(2, out);
  EXPECT_NEAR(norm(out[0] - Vec3d{0, 2, 0}), 0, 1e-15);  // a quarter turn and one metre up
  obstacle.pose(9, out);
  EXPECT_NEAR(norm(out[0] - Vec3d{-1, 2, 0}), 0, 1e-15);
}

TEST(SceneIo, BodiesFollowMddPointCachesAtTheirRate) {
  const TemporaryFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  // Two frames, three points, 0.25 s apart; the body is at rest, then (1, 0, 0) further.
  std::string bytes("\0\0\0\2\0\0\0\3\0\0\0\0\x3e\x80\0\0", 16);
  for (const char* xyz : {"000", "100", "010", "100", "200", "110"})
    for (const char* digit = xyz; *digit; ++digit)
      bytes += *digit == '0'   ? std::string(4, '\0')
               : *digit == '1' ? std::string("\x3f\x80\0\0", 4)
                               : std::string("\x40\0\0\0", 4);
  folder.write("a.mdd", bytes);
  const std::string start = R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 8}],
      "obstacles": [{"mesh": "a.obj", "animation": "a.mdd", "transform": {"scale": 2})";
  const auto scene = load(folder.write("a.json", start + "}]}"));
  const Obstacle& body = scene->obstacles.at(0);
  EXPECT_TRUE(body.moves());
  EXPECT_EQ(dynamic_cast<const CachedPoses&>(*body.poses).frame_rate(), 4);
  std::vector<Vec3d> out;
  body.pose(0.125, out);
  ASSERT_EQ(out.size(), 3u);
  EXPECT_EQ(out[1], (Vec3d{3, 0, 0}));
  const auto slower = load(folder.write("b.json", start + R"(, "frame_rate": 2}]})"));
  EXPECT_EQ(dynamic_cast<const CachedPoses&>(*slower->obstacles.at(0).poses).frame_rate(), 2);
}

TEST(SceneIo, ObjectsMayHaveTheirOwnFriction) {
  const TemporaryFolder folder;
  const std::string grid = R"({"mesh": {"grid": {"size": [1, 1]}}, "triangles": 8)";
  const std::string ball = R"({"mesh": {"sphere": {"radius": 0.1, "triangles": 80}})";
  const auto scene = load(folder.write("a.json", R"({"cloths": [)" + grid +
                                                     R"(, "friction": 0.2}, )" + grid + R"(}],
      "obstacles": [)" + ball + R"(, "friction": 0}, )" +
                                                     ball + "}]}"));
  EXPECT_EQ(scene->cloths[0].friction, 0.2);
  EXPECT_EQ(scene->cloths[1].friction, std::nullopt);
  EXPECT_EQ(scene->obstacles[0].friction, 0.0);
  EXPECT_EQ(scene->obstacles[1].friction, std::nullopt);
  const World world = make_world(*scene);
  EXPECT_EQ(world.objects[0].friction, 0.2);
  EXPECT_EQ(world.objects[2].friction, 0.0);
  EXPECT_EQ(world.objects[3].friction, std::nullopt);
}

TEST(SceneIo, PointCacheIsInterpolated) {
  Obstacle obstacle;
  obstacle.mesh.positions = {{7, 7, 7}};
  const std::vector<std::vector<Vec3f>> frames = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 2, 0}}};
  obstacle.poses = std::make_shared<CachedPoses>(frames, 10);
  EXPECT_TRUE(obstacle.moves());
  std::vector<Vec3d> out;
  obstacle.pose(0.125, out);
  EXPECT_NEAR(norm(out.at(0) - Vec3d{1, 0.5, 0}), 0, 1e-12);
  obstacle.pose(5, out);
  EXPECT_EQ(out[0], (Vec3d{1, 2, 0}));
}

}  // namespace
}  // namespace icloth
