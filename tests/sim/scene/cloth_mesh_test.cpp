// Mesh files of cloths as people have them: doubled vertices, vertices without a face, other units.
#include "sim/scene/cloth_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/scene_meshes.h"
#include "sim/scene/world.h"
#include "sim/simulator.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

/// A scene together with what its files hold beyond it.
struct Loaded {
  SceneOrigin origin;
  std::shared_ptr<const Scene> scene;

  explicit Loaded(const std::string& path) : scene(load_scene(path, {}, {}, &origin)) {}
  const TriangleMesh& mesh() const { return scene->cloths[0].mesh; }
};

std::string error_of(const std::string& path) {
  try {
    load_scene(path, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr int kColumns = 6, kRows = 4;
constexpr double kEdge = 0.05;

/// Sheet of two halves that have their own vertices on the column between them. Stray vertices
/// stand at the start, in the middle and at the end. `gap`: between the halves.
std::string split_sheet(bool stray, double gap = 0, double size = 1) {
  std::string vertices, faces, textures;
  int count = 0;
  const auto add = [&](double x, double z) {
    vertices += "v " + std::to_string(size * x) + " 0.3 " + std::to_string(size * z) + "\n";
    ++count;
  };
  for (int half = 0; half < 2; ++half) {
    if (stray) add(0.111, 0.222);
    const int first = count + 1;
    for (int j = 0; j <= kRows; ++j)
      for (int i = 0; i <= kColumns / 2; ++i) {
        const double x = kEdge * (i + half * (kColumns / 2)) + half * gap;
        add(x - 0.15, kEdge * j - 0.1);
        textures += "vt " + std::to_string(size * (x + half)) + " " +
                    std::to_string(-size * kEdge * j) + "\n";
      }
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < kColumns / 2; ++i) {
        const int a = first + j * (kColumns / 2 + 1) + i, b = a + 1, d = a + kColumns / 2 + 1;
        faces += "f";
        for (const int v : {a, d, d + 1, b})
          faces.append(" ")
              .append(std::to_string(v))
              .append("/")
              .append(std::to_string(v - (stray ? 1 + half : 0)));
        faces += "\n";
      }
  }
  if (stray) add(0.111, 0.222);
  return vertices + textures + faces;
}

std::string scene_of(const std::string& mesh, const std::string& keys = "") {
  return R"({"time_step": 0.01, "cloths": [{"name": "c", "mesh": ")" + mesh + "\"" + keys +
         R"(}], "obstacles": [{"mesh": {"sphere": {"radius": 0.1, "triangles": 300}},
             "transform": {"translate": [0, 0.15, 0]}}]})";
}

/// Runs a scene and returns the cloth as it is exported.
std::vector<Vec3f> run(const Loaded& loaded, int steps, Build build,
                       std::uint64_t* hash = nullptr) {
  EXPECT_TRUE(find_start_intersections(*loaded.scene, build != Build::cpu64).empty());
  const auto simulator = make_simulator(build, loaded.scene);
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulator->step({});
    EXPECT_TRUE(report.accepted && std::isfinite(report.kinetic_energy + report.elastic_energy +
                                                 report.gravity_energy))
        << i;
  }
  if (hash) *hash = simulator->state_hash();
  std::vector<Vec3f> positions;
  simulator->positions(positions);
  const SceneMeshes meshes = named_meshes(*loaded.scene, positions, loaded.origin.layouts);
  EXPECT_EQ(meshes.meshes[0].name, "cloth:c");
  return {meshes.meshes[0].positions.begin(), meshes.meshes[0].positions.end()};
}

TEST(ClothMesh, ASplitSeamRunsAndItsVerticesMoveTogether) {
  const TemporaryFolder folder;
  folder.write("c.obj", split_sheet(false));
  const Loaded scene(folder.write("s.json", scene_of("c.obj")));
  ASSERT_EQ(scene.origin.notes.size(), 1u);
  EXPECT_TRUE(contains(scene.origin.notes[0], "cloth 'c': 5 of 40 vertices lie at the same place"));
  EXPECT_TRUE(contains(scene.origin.notes[0], "\"weld\": false"));
  EXPECT_EQ(scene.mesh().uv.size(), scene.mesh().faces.size());
  for (const Build build : {Build::cpu32, Build::cpu64}) {
    const std::vector<Vec3f> end = run(scene, 15, build);
    ASSERT_EQ(end.size(), 40u) << "the vertices of the file";
    for (std::size_t j = 0; j <= kRows; ++j)
      EXPECT_EQ(end[4 * j + 3], end[20 + 4 * j]) << "row " << j;
    EXPECT_LT(end[22].y, 0.299f) << "it fell";
  }
}

TEST(ClothMesh, WeldSaysWhatIsJoined) {
  const TemporaryFolder folder;
  folder.write("exact.obj", split_sheet(false));
  folder.write("near.obj", split_sheet(false, 2e-6));
  const auto load = [&](const std::string& mesh, const std::string& weld) {
    return Loaded(folder.write("s.json", scene_of(mesh, weld)));
  };
  const auto vertices = [](const Loaded& loaded) { return loaded.mesh().positions.size(); };
  EXPECT_EQ(vertices(load("exact.obj", R"(, "weld": false)")), 40u);
  EXPECT_EQ(vertices(load("exact.obj", R"(, "weld": 0)")), 35u);
  EXPECT_EQ(vertices(load("exact.obj", R"(, "weld": true)")), 35u);
  const Loaded near = load("near.obj", "");
  EXPECT_EQ(vertices(near), 40u);
  ASSERT_EQ(near.origin.notes.size(), 1u);
  EXPECT_TRUE(contains(near.origin.notes[0], "\"weld\": 5e-05 joins them")) << near.origin.notes[0];
  const Loaded joined = load("near.obj", R"(, "weld": 1e-4)");
  EXPECT_EQ(vertices(joined), 35u);
  run(joined, 5, Build::cpu32);
  // Centimetres: the distance is that of the scene.
  folder.write("cm.obj", split_sheet(false, 2e-4, 100));
  EXPECT_EQ(vertices(load("cm.obj", R"(, "weld": 1e-3, "transform": {"scale": 0.01})")), 35u);
  EXPECT_EQ(vertices(load("cm.obj", R"(, "weld": 1e-5, "transform": {"scale": 0.01})")), 40u);
  EXPECT_TRUE(contains(error_of(folder.write("s.json", scene_of("exact.obj", R"(, "weld": 0.06)"))),
                       "weld: value 0.06 m joins vertices"));
  EXPECT_TRUE(contains(error_of(folder.write("s.json", scene_of("exact.obj", R"(, "weld": -1)"))),
                       "cloths[0].weld"));
  const std::string grid = R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "weld": 0}]})";
  EXPECT_TRUE(contains(error_of(folder.write("g.json", grid)), "no such key: only for mesh files"));
}

TEST(ClothMesh, WeldGoesWithSubdivisionAndARestShape) {
  const TemporaryFolder folder;
  folder.write("c.obj", split_sheet(false));
  folder.write("r.obj", split_sheet(false, 0, 0.98));
  for (const char* keys : {R"(, "subdivide": 1)", R"(, "rest": "r.obj")"}) {
    const Loaded scene(folder.write("s.json", scene_of("c.obj", keys)));
    const std::vector<Vec3f> end = run(scene, 10, Build::cpu32);
    for (std::size_t j = 0; j <= kRows; ++j) EXPECT_EQ(end[4 * j + 3], end[20 + 4 * j]) << keys;
    std::set<std::tuple<float, float, float>> places;
    for (const Vec3f p : end) places.insert({p.x, p.y, p.z});
    EXPECT_EQ(places.size(), scene.mesh().positions.size()) << "all doubles lie together";
    EXPECT_TRUE(contains(scene.origin.notes.at(0), "5 of 40 vertices")) << scene.origin.notes[0];
  }
  // In the pattern the halves lie apart: they are not one there, and the start is refused.
  folder.write("apart.obj", split_sheet(false, 0.2));
  const Loaded apart(folder.write("s.json", scene_of("c.obj", R"(, "rest": "apart.obj")")));
  EXPECT_TRUE(contains(apart.origin.notes.at(0),
                       "5 of 40 vertices lie at the same place as earlier "
                       "ones, but not in the rest shape"));
  EXPECT_FALSE(find_start_intersections(*apart.scene, true).empty());
}

TEST(ClothMesh, VerticesWithoutAFaceStayAndChangeNothing) {
  const TemporaryFolder folder;
  folder.write("plain.obj", split_sheet(false));
  folder.write("stray.obj", split_sheet(true));
  const Loaded plain(folder.write("p.json", scene_of("plain.obj")));
  // Pins may name them; 6 is the last used vertex of the second row of the first half.
  const Loaded stray(folder.write("s.json", scene_of("stray.obj")));
  ASSERT_EQ(stray.origin.notes.size(), 2u);
  EXPECT_EQ(stray.origin.notes[0],
            "cloth 'c': 3 of 43 vertices belong to no face and stay where they are");
  EXPECT_EQ(stray.scene->parameters.proximity.thickness,
            plain.scene->parameters.proximity.thickness);
  std::uint64_t plain_hash = 0, stray_hash = 0;
  std::vector<Vec3f> expected = run(plain, 15, Build::cpu32, &plain_hash);
  const std::vector<Vec3f> end = run(stray, 15, Build::cpu32, &stray_hash);
  EXPECT_EQ(plain_hash, stray_hash);
  const Vec3f still{0.111f, 0.3f, 0.222f};
  expected.insert(expected.begin(), still);
  expected.insert(expected.begin() + 21, still);
  expected.push_back(still);
  EXPECT_EQ(end, expected);
}

TEST(ClothMesh, PinsAndHandsNameVerticesAsTheFileDoes) {
  const TemporaryFolder folder;
  folder.write("c.obj", split_sheet(true));
  const auto pinned = [&](const std::string& pins) {
    return load_scene(folder.write("s.json", scene_of("c.obj", ", \"pins\": " + pins)), {})
        ->cloths[0]
        .pins;
  };
  EXPECT_EQ(pinned("[1, 0, 21]"), (std::vector<Index>{0})) << "those without a face stay anyway";
  EXPECT_EQ(pinned("[4, 22]"), (std::vector<Index>{3})) << "two numbers of one vertex";
  EXPECT_EQ(pinned("[41]"), (std::vector<Index>{34})) << "the last one of the file";
  EXPECT_EQ(pinned(R"([{"box": [[-1, 0, -0.11], [1, 1, -0.09]]}])").size(), 7u);
  EXPECT_TRUE(contains(error_of(folder.write("s.json", scene_of("c.obj", R"(, "pins": [43])"))),
                       "from 0 to 42"));
  std::string scene = scene_of("c.obj");
  scene.insert(1, R"("input": [{"vertex": 22, "path": [[0, 0, 1, 0], [1, 0, 2, 0]]}],)");
  EXPECT_EQ(load_scene(folder.write("s.json", scene), {})->input[0].vertex, 3);
  scene.replace(scene.find("22"), 2, "21");
  EXPECT_TRUE(contains(error_of(folder.write("s.json", scene)),
                       "input[0].vertex: value 21, expected a vertex that a face uses"));
}

TEST(ClothMesh, AMeshFileAloneIsAsForgiving) {
  const TemporaryFolder folder;
  const Loaded scene(folder.write("c.obj", split_sheet(true)));
  EXPECT_EQ(scene.mesh().positions.size(), 35u);
  EXPECT_EQ(scene.origin.notes.size(), 2u);
  EXPECT_FALSE(scene.scene->cloths[0].pins.empty());
  EXPECT_TRUE(run(scene, 3, Build::cpu32).size() == 43u);
}

/// Faces around the y axis that share one edge, at vertices 1 and 2 of the file.
std::string fan_of(int faces) {
  std::string text = "v 5 5 5\nv 0 0 0\nv 0 0.1 0\n";
  for (int i = 0; i < faces; ++i) {
    const double angle = 6.28 * i / faces;
    text += "v " + std::to_string(0.1 * std::cos(angle)) + " 0 " +
            std::to_string(0.1 * std::sin(angle)) + "\n";
  }
  for (int i = 0; i < faces; ++i) text += "f 2 3 " + std::to_string(i + 4) + "\n";
  return text;
}

TEST(ClothMesh, AsManyFacesOnAnEdgeAsAreAllowedRunAndOneMoreIsNamed) {
  const TemporaryFolder folder;
  const int most = static_cast<int>(kMostFacesOnEdge);
  const Loaded scene(folder.write("most.obj", fan_of(most)));
  EXPECT_EQ(make_world(*scene.scene).hinges.size(), kMostFacesOnEdge * (kMostFacesOnEdge - 1) / 2);
  const std::string message = error_of(folder.write("many.obj", fan_of(most + 1)));
  EXPECT_TRUE(contains(message, "edge between vertices 1 and 2: 17 faces, expected at most 16"))
      << message;
  // A scene that no file was read for is held to the same.
  Scene own = *scene.scene;
  own.cloths[0].mesh.positions.push_back({-0.1, 0, 0.001});
  own.cloths[0].rest = own.cloths[0].mesh.positions;
  own.cloths[0].mesh.faces.push_back({0, 1, static_cast<Index>(most) + 2});
  EXPECT_THROW(make_world(own), InputError);
}

TEST(ClothMesh, AsManyFacesAtAVertexAsAreAllowedRunAndOneMoreIsNamed) {
  const TemporaryFolder folder;
  const auto fan = [](std::size_t faces) {
    std::string text = "v 5 5 5\nv 0 0 0\n";
    for (std::size_t i = 0; i < faces; ++i) {
      const double angle = 6.283185 * static_cast<double>(i) / static_cast<double>(faces);
      text +=
          "v " + std::to_string(std::cos(angle)) + " 0 " + std::to_string(std::sin(angle)) + "\n";
    }
    for (std::size_t i = 0; i < faces; ++i)
      text += "f 2 " + std::to_string(3 + (i + 1) % faces) + " " + std::to_string(3 + i) + "\n";
    return text;
  };
  const Loaded scene(folder.write("most.obj", fan(kMostFacesAtVertex)));
  EXPECT_EQ(scene.mesh().faces.size(), kMostFacesAtVertex);
  const std::string message = error_of(folder.write("many.obj", fan(kMostFacesAtVertex + 1)));
  EXPECT_TRUE(contains(message, "vertex 1: 4097 faces, expected at most 4096")) << message;
}

TEST(ClothMesh, RepeatedFacesAreTold) {
  const TemporaryFolder folder;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n";
  const Loaded once(folder.write("once.obj", corners + "f 1 2 3 4\n"));
  EXPECT_TRUE(once.origin.notes.empty());
  const Loaded twice(folder.write("c.obj", corners + "f 1 2 3 4\nf 3 2 1\n"));
  ASSERT_EQ(twice.origin.notes.size(), 1u);
  EXPECT_TRUE(contains(twice.origin.notes[0], "1 of 3 faces have the same vertices"));
  run(twice, 2, Build::cpu32);
}

TEST(ClothMesh, FineBordersAreNoSeams) {
  // A slice of a disc: the edges along its rim are far shorter than those to its tip.
  const TemporaryFolder folder;
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < 4000; ++i)
    text += "v " + std::to_string(std::cos(i / 4000.0)) + " 0 " +
            std::to_string(std::sin(i / 4000.0)) + "\n";
  for (int i = 2; i < 4001; ++i)
    text += "f 1 " + std::to_string(i + 1) + " " + std::to_string(i) + "\n";
  const Loaded disc(folder.write("disc.obj", text));
  EXPECT_TRUE(disc.origin.notes.empty()) << disc.origin.notes[0];
}

TEST(ClothMesh, ABoxOfPinsMayHoldVerticesWithoutAFaceAlone) {
  const TemporaryFolder folder;
  folder.write("c.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 7 7 7\nf 1 2 3\n");
  const Loaded scene(
      folder.write("s.json", scene_of("c.obj", R"(, "pins": [{"box": [[6, 6, 6], [8, 8, 8]]}])")));
  EXPECT_TRUE(scene.scene->cloths[0].pins.empty());
  const std::string nowhere =
      folder.write("n.json", scene_of("c.obj", R"(, "pins": [{"box": [[4, 4, 4], [5, 5, 5]]}])"));
  EXPECT_TRUE(contains(error_of(nowhere), "a box with at least one vertex"));
}

TEST(ClothMesh, OtherUnitsAreToldWithTheirRemedy) {
  const auto note = [](double size, Vec3d scale = {1, 1, 1}, bool is_cloth = true,
                       double depth = 0) {
    return unit_note("cloth 'c'", {{0, 0, 0}, {size, size / 2, depth}}, scale, is_cloth);
  };
  EXPECT_EQ(note(1), "");
  EXPECT_EQ(note(8), "");
  EXPECT_EQ(note(0.03), "");
  EXPECT_EQ(note(80),
            "cloth 'c' is 80 m large: its file is probably in centimetres or inches; "
            "\"transform\": {\"scale\": 0.01} makes it 0.8 m");
  EXPECT_TRUE(
      contains(note(1200), "millimetres; \"transform\": {\"scale\": 0.001} makes it 1.2 m"));
  EXPECT_TRUE(contains(note(15), "inches; \"transform\": {\"scale\": 0.0254} makes it 0.381 m"));
  EXPECT_TRUE(contains(note(0.008), "{\"scale\": 100} makes it 0.8 m"));
  EXPECT_TRUE(contains(note(1e6), "is it in metres?"));
  EXPECT_TRUE(contains(note(80, {2, 2, 2}), "{\"scale\": 0.02}")) << "in place of its present one";
  EXPECT_EQ(note(80, {1, 1, 1}, false), "") << "a floor";
  EXPECT_TRUE(contains(note(170, {1, 1, 1}, false, 30), "centimetres; "));
}

TEST(ClothMesh, TheRemedyForOtherUnitsWorks) {
  const TemporaryFolder folder;
  folder.write("cm.obj", split_sheet(false, 0, 100));
  folder.write("ball.obj",
               "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  std::string text = scene_of("cm.obj", R"(, "weld": 0)");
  text.insert(text.rfind("]}"), R"(, {"name": "ball", "mesh": "ball.obj"})");
  const Loaded large(folder.write("s.json", text));
  ASSERT_EQ(large.origin.notes.size(), 3u);
  EXPECT_TRUE(contains(large.origin.notes[1],
                       "cloth 'c' is 30 m large: its file is probably in "
                       "centimetres or inches; \"transform\": {\"scale\": 0.01}"));
  EXPECT_TRUE(contains(large.origin.notes[2], "obstacle 'ball' is 20 m large"));
  text = scene_of("cm.obj", R"(, "weld": 0, "transform": {"scale": 0.01})");
  EXPECT_EQ(Loaded(folder.write("s.json", text)).origin.notes.size(), 1u);
}

}  // namespace
}  // namespace icloth
