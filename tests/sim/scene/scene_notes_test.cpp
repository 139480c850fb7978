// Notes of the loader about input that is accepted, but not as a user may expect.
#include <gtest/gtest.h>

#include <cstring>

#include "sim/files/error.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

struct Loaded {
  std::shared_ptr<const Scene> scene;
  std::vector<std::string> notes;
};

/// A small sheet and what `rest` adds: further keys of the scene.
Loaded load(const TemporaryFolder& folder, const std::string& rest,
            const std::vector<std::string>& overrides = {}) {
  const std::string path = folder.write(
      "scene.json", R"({"cloths": [{"name": "c", "mesh": {"grid": {"size": [0.2, 0.2]}},)"
                    R"( "triangles": 50}])" +
                        rest + "}");
  SceneOrigin origin;
  auto scene = load_scene(path, overrides, {}, &origin);
  return {std::move(scene), origin.notes};
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A PC2 file of one frame with four vertices: a square moved along x.
std::string square_cache(float shift) {
  std::string bytes("POINTCACHE2\0", 12);
  const std::int32_t counts[] = {1, 4};
  const float times[] = {0, 1};
  const std::int32_t frames = 1;
  bytes.append(reinterpret_cast<const char*>(counts), sizeof counts);
  bytes.append(reinterpret_cast<const char*>(times), sizeof times);
  bytes.append(reinterpret_cast<const char*>(&frames), sizeof frames);
  const float x[] = {shift, 0, 0, 1 + shift, 0, 0, 1 + shift, 1, 0, shift, 1, 0};
  return bytes.append(reinterpret_cast<const char*>(x), sizeof x);
}

TEST(SceneNotes, SayHowFarAPointCacheIsFromItsMesh) {
  const TemporaryFolder folder;
  folder.write("s.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const std::string body = R"(, "obstacles": [{"name": "b", "mesh": "s.obj", "animation": "s.pc2")";
  folder.write("s.pc2", square_cache(0.25f));
  const Loaded away = load(folder, body + "}]");
  ASSERT_EQ(away.notes.size(), 1u);
  for (const char* part : {"'b'", "s.pc2", "frame 0", "250 mm", "vertex"})
    EXPECT_TRUE(holds(away.notes[0], part)) << part << ": " << away.notes[0];

  // A cache that begins at the mesh needs no note, wherever both are placed.
  folder.write("s.pc2", square_cache(0));
  EXPECT_TRUE(load(folder, body + R"(, "transform": {"scale": 3, "translate": [5, 1, 2]}}])")
                  .notes.empty());
}

TEST(SceneNotes, SayWhatOfAPointCacheIsNotUsed) {
  const TemporaryFolder folder;
  folder.write("s.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const auto notes = [&](const std::string& name, const std::string& bytes) {
    folder.write(name, bytes);
    return load(folder,
                R"(, "obstacles": [{"name": "b", "mesh": "s.obj", "animation": ")" + name + "\"}]")
        .notes;
  };
  const auto with = [](std::string bytes, std::size_t place, float value) {
    std::memcpy(bytes.data() + place, &value, sizeof value);
    return bytes;
  };
  const std::string pc2 = square_cache(0);
  EXPECT_TRUE(notes("a.pc2", pc2).empty());
  EXPECT_TRUE(notes("a.pc2", with(pc2, 20, 1)).empty()) << "Blender counts from 1";
  for (const auto& [bytes, part] : std::vector<std::pair<std::string, std::string>>{
           {with(pc2, 20, 12), "start at frame 12"},
           {with(pc2, 24, 0.5), "sampling of 0.5 frames"},
           {pc2 + "1234567", "7 bytes behind its 1 frames"}}) {
    const std::vector<std::string> found = notes("a.pc2", bytes);
    ASSERT_EQ(found.size(), 1u) << part;
    EXPECT_TRUE(holds(found[0], "obstacle 'b': a.pc2 has ") && holds(found[0], part)) << found[0];
    EXPECT_TRUE(holds(found[0], "not used")) << found[0];
  }

  // Three frames of an MDD file at 0, 1 and 5 s: no one rate fits.
  std::string mdd;
  const auto big_endian = [&](const void* value) {
    const auto* bytes = static_cast<const char*>(value);
    for (int k = 3; k >= 0; --k) mdd += bytes[k];
  };
  for (const std::int32_t count : {3, 4}) big_endian(&count);
  for (const float time : {0.0f, 1.0f, 5.0f}) big_endian(&time);
  for (int f = 0; f < 3; ++f)
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
      big_endian(&x);
  const std::vector<std::string> uneven = notes("a.mdd", mdd);
  ASSERT_EQ(uneven.size(), 1u);
  EXPECT_TRUE(holds(uneven[0], "times of its frames that are not even")) << uneven[0];
}

TEST(SceneNotes, NoDragInStillAirMeansNoAir) {
  const TemporaryFolder folder;
  const auto density = [&](const std::string& rest, const std::vector<std::string>& set = {}) {
    return load(folder, rest, set).scene->parameters.wind.air_density;
  };
  EXPECT_EQ(density(""), 1);
  EXPECT_EQ(density(R"(, "parameters": {"wind.air_drag": 0})"), 0);
  EXPECT_EQ(density(R"(, "parameters": {"wind": {"air_drag": 0}})"), 0);
  EXPECT_EQ(density(R"(, "wind": {"air_drag": 0})"), 0);
  EXPECT_EQ(density("", {"wind.air_drag=0"}), 0);
  EXPECT_EQ(load(folder, R"(, "wind": {"air_drag": 0})").notes.size(), 1u);

  // Whoever sets the density, a wind or another drag keeps the pressure.
  EXPECT_EQ(density(R"(, "wind": {"air_drag": 0, "air_density": 1.2})"), 1.2);
  EXPECT_EQ(density(R"(, "wind": {"air_drag": 0, "velocity": [0, 0, 2]})"), 1);
  EXPECT_EQ(density(R"(, "wind": {"air_drag": 0.1})"), 1);
  EXPECT_EQ(density(R"(, "wind": {"air_drag": 0})", {"wind.air_density=2"}), 2);
}

TEST(SceneNotes, NumbersOfParametersAreSetAsTheyAre) {
  const TemporaryFolder folder;
  const auto scene = load(folder, R"(, "parameters": {"proximity.thickness": 0.00123456789012345,)"
                                  R"( "implicit": {"cg_max_iterations": 7.0}, "ccd.incremental":)"
                                  R"( false})")
                         .scene;
  EXPECT_EQ(scene->parameters.proximity.thickness, 0.00123456789012345);
  EXPECT_EQ(scene->parameters.implicit.cg_max_iterations, 7);
  EXPECT_FALSE(scene->parameters.ccd.incremental);
  for (const char* bad : {R"("proximity.thickness": true)", R"("implicit.integrator": 1)",
                          R"("implicit.cg_max_iterations": 7.5)", R"("proximity.thickness": 9)"})
    EXPECT_THROW(load(folder, ", \"parameters\": {" + std::string(bad) + "}"), InputError) << bad;
}

TEST(SceneNotes, CornersThatFloatsCannotTellApartNameDoublePrecision) {
  const TemporaryFolder folder;
  // Two corners 1 nm apart, 0.5 m from the origin: single precision resolves 30 nm there.
  auto scene = std::make_shared<Scene>(*load(folder, "").scene);
  scene->cloths[0].mesh.positions = {{0.5, 0, 0}, {0.5, 1, 0}, {0.500000001, 0, 0}};
  scene->cloths[0].rest = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  scene->cloths[0].mesh.faces = {{0, 2, 1}};
  scene->cloths[0].mesh.uv.clear();
  try {
    make_simulator(Build::cpu32, scene);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    for (const char* part : {"'c'", "face 0", "vertices 0 and 2", "--precision f64"})
      EXPECT_TRUE(holds(error.what(), part)) << error.what();
  }
  EXPECT_NO_THROW(make_simulator(Build::cpu64, scene));
}

}  // namespace
}  // namespace icloth
