#include "sim/scene/input.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sim/files/error.h"

using namespace icloth;

namespace {

std::string scratch(const std::string& name) {
  const auto folder = std::filesystem::temp_directory_path() / "icloth_input_test";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

Recording sample_recording() {
  Recording recording;
  recording.scene = "scarf";
  recording.build = "cpu64";
  recording.overrides = {"time_step=0.005", "triangles=2000"};
  InputEvent grab;
  grab.handle = 3;
  grab.face = 17;
  grab.barycentric = {0.1, 1.0 / 3, 1 - 0.1 - 1.0 / 3};
  grab.target = {0.1, -2e-17, 1e3 / 7};
  grab.radius = 0.05;
  InputEvent move = grab, release = grab;
  move.kind = InputEvent::Kind::move;
  release.kind = InputEvent::Kind::release;
  recording.steps.resize(4);
  recording.steps[0].events = {grab};
  recording.steps[1].events = {move, release};
  recording.steps[3].parameters = {{"impact_zones.rho", 0.1 / 3}, {"wind.x", -2.0}};
  recording.final_hash = 0x0123456789abcdefull;
  return recording;
}

std::string error_of(const std::string& text) {
  const std::string path = scratch("bad.json");
  std::ofstream(path) << text;
  try {
    load_recording(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Scene grab_scene() {
  Scene scene;
  Cloth cloth;
  cloth.mesh.positions.resize(5);
  cloth.mesh.faces = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}};
  scene.cloths = {cloth, cloth};
  ScriptedGrab grab;
  grab.cloth = 1;
  grab.vertex = 3;
  grab.radius = 0.07;
  grab.start = 0.1;
  grab.release = 0.3;
  grab.path = {{0.1, {0, 0, 0}}, {0.2, {1, 0, 0}}, {0.25, {1, 2, 0}}};
  scene.input = {grab};
  return scene;
}

/// A recording with one grab.
std::string recording_with(const std::string& face, const std::string& barycentric,
                           const std::string& handle = "0") {
  return R"({"icloth_recording": 1, "scene": "scarf", "build": "cpu32", "overrides": [], "steps": [)"
         R"({}, {"events": [{"kind": "grab", "handle": )" +
         handle + R"(, "face": )" + face + R"(, "barycentric": )" + barycentric +
         R"(, "target": [0, 0, 0]}]}], "final_hash": "0123456789abcdef"})";
}

/// Why a recording is refused, "" where it is accepted.
std::string refusal_of(const std::string& text, const Scene* scene = nullptr) {
  const std::string path = scratch("grab.json");
  std::ofstream(path) << text;
  try {
    const Recording recording = load_recording(path);
    if (scene) check_recording(recording, *scene, path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Recording, AnImpossibleGrabIsNamedByStepAndEvent) {
  EXPECT_EQ(refusal_of(recording_with("3", "[0.2, 0.3, 0.5]")), "");
  for (const char* weights : {"[2, -0.5, -0.5]", "[0.2, 0.2, 0.2]", "[-1, 1, 1]", "[null, 0, 1]",
                              "[1e300, 0, 0]", "[1, 0]"}) {
    const std::string text = refusal_of(recording_with("3", weights));
    EXPECT_TRUE(holds(text, "steps[1].events[0].barycentric")) << weights << ": " << text;
  }
  EXPECT_TRUE(holds(refusal_of(recording_with("-1", "[1, 0, 0]")), "steps[1].events[0].face"));
  EXPECT_TRUE(
      holds(refusal_of(recording_with("1", "[1, 0, 0]", "-7")), "steps[1].events[0].handle"));
}

TEST(Recording, RecordingsOfAnotherSceneAreRefused) {
  Scene scene;
  scene.name = "other";
  scene.cloths.resize(1);
  scene.cloths[0].mesh.faces.resize(3);
  EXPECT_EQ(refusal_of(recording_with("2", "[1, 0, 0]"), &scene), "");
  const std::string text = refusal_of(recording_with("3", "[1, 0, 0]"), &scene);
  EXPECT_TRUE(holds(text, "steps[1].events[0].face: value 3, expected 0 to 2")) << text;
  EXPECT_TRUE(holds(text, "'other'")) << text;
}

}  // namespace

TEST(Recording, ReadsBackExactly) {
  const Recording saved = sample_recording();
  const std::string path = scratch("recording.json");
  save_recording(saved, path);
  const Recording loaded = load_recording(path);
  EXPECT_EQ(loaded.scene, saved.scene);
  EXPECT_EQ(loaded.build, saved.build);
  EXPECT_EQ(loaded.overrides, saved.overrides);
  EXPECT_EQ(loaded.final_hash, saved.final_hash);
  ASSERT_EQ(loaded.steps.size(), saved.steps.size());
  for (std::size_t i = 0; i < saved.steps.size(); ++i) {
    EXPECT_EQ(loaded.steps[i].parameters, saved.steps[i].parameters);
    ASSERT_EQ(loaded.steps[i].events.size(), saved.steps[i].events.size());
    for (std::size_t k = 0; k < saved.steps[i].events.size(); ++k) {
      const InputEvent &a = loaded.steps[i].events[k], &b = saved.steps[i].events[k];
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_EQ(a.handle, b.handle);
      EXPECT_TRUE(b.kind == InputEvent::Kind::release || a.target == b.target);
      if (b.kind != InputEvent::Kind::grab) continue;
      EXPECT_EQ(a.face, b.face);
      EXPECT_TRUE(a.barycentric == b.barycentric);
      EXPECT_EQ(a.radius, b.radius);
      EXPECT_EQ(a.stiffness, 0);
    }
  }
}

TEST(Recording, OneLineAStepAndNothingLeftBeside) {
  const std::string path = scratch("lines.json");
  save_recording(sample_recording(), path);
  std::ifstream file(path);
  std::size_t lines = 0;
  for (std::string line; std::getline(file, line);) ++lines;
  EXPECT_EQ(lines, 6u);
  for (const auto& entry : std::filesystem::directory_iterator(scratch("")))
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
  EXPECT_THROW(save_recording(sample_recording(), scratch("no/such/folder.json")), InputError);
}

TEST(Recording, EmptyRecordingIsValid) {
  Recording recording;
  recording.scene = "sphere";
  save_recording(recording, scratch("empty.json"));
  EXPECT_TRUE(load_recording(scratch("empty.json")).steps.empty());
}

TEST(Recording, RefusesBadFilesWithOneLine) {
  const std::string head =
      R"({"icloth_recording":1,"scene":"scarf","build":"cpu32","overrides":[],)";
  const std::string foot = R"(,"final_hash":"0123456789abcdef"})";
  EXPECT_EQ(error_of(head + R"("steps":[{}])" + foot), "");
  const auto expect = [&](const std::string& text, const std::string& part) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_NE(error.find("bad.json"), std::string::npos) << error;
  };
  expect("", "bad.json");
  expect("{\"icloth_recording\": 1", "bad.json");
  expect(head + R"("steps":7)" + foot, "steps");
  expect(head + R"("steps":[{"event":[]}])" + foot, "'events'");
  expect(head + R"("steps":[{"events":[{"kind":"throw","handle":1}]}])" + foot, "grab, move");
  expect(head + R"("steps":[{"events":[{"kind":"release","handle":-1}]}])" + foot, "handle");
  expect(head + R"("steps":[{"events":[{"kind":"move","handle":1,"target":[0,1]}]}])" + foot,
         "target");
  expect(head + R"("steps":[{"parameters":{"step.time_step":7}}])" + foot, "0.1");
  expect(head + R"("steps":[{"parameters":{"nothing":7}}])" + foot, "parameters");
  expect(head + R"("steps":[],"final_hash":"xyz"})", "16 hex digits");
  expect(R"({"icloth_recording":2})", "icloth_recording");
  EXPECT_THROW(load_recording(scratch("missing.json")), InputError);
}

TEST(ScriptedInput, GrabsMovesAndReleases) {
  const Scene scene = grab_scene();
  ScriptedInput input(scene);
  const double dt = 0.02;
  std::vector<int> kinds;
  for (int step = 0; step < 20; ++step) {
    const auto events = input.events(step * dt, dt);
    ASSERT_LE(events.size(), 1u);
    kinds.push_back(events.empty() ? -1 : static_cast<int>(events[0].kind));
    if (events.empty()) continue;
    EXPECT_EQ(events[0].handle, 1000);
    const double end = (step + 1) * dt;  // target at the end of the step
    if (kinds.back() == 2 || end > 0.2) continue;
    EXPECT_NEAR(events[0].target.x, (end - 0.1) / 0.1, 1e-12);
  }
  EXPECT_EQ(kinds, (std::vector<int>{-1, -1, -1, -1, -1, 0, 1,  1,  1,  1,
                                     1,  1,  1,  1,  1,  2, -1, -1, -1, -1}));
}

TEST(ScriptedInput, HitIsTheLowestFaceOfTheVertex) {
  const Scene scene = grab_scene();
  ScriptedInput input(scene);
  const auto events = input.events(0.1, 0.01);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].face, 3 + 1);  // second cloth, its face 1 = (2, 1, 3)
  EXPECT_TRUE(events[0].barycentric == (Vec3d{0, 0, 1}));
  EXPECT_EQ(events[0].radius, 0.07);
}

TEST(ScriptedInput, PathIsClampedAtItsEnds) {
  const Scene scene = grab_scene();
  ScriptedInput input(scene);
  input.events(0.1, 0.01);
  EXPECT_TRUE(input.events(0.28, 0.01)[0].target == (Vec3d{1, 2, 0}));
  ScriptedInput late(scene);  // starts after the release: never grabs
  EXPECT_TRUE(late.events(0.5, 0.01).empty());
}

TEST(ScriptedInput, RefusesImpossibleGrabs) {
  Scene scene = grab_scene();
  scene.input[0].cloth = 2;
  EXPECT_THROW(ScriptedInput{scene}, InputError);
  scene = grab_scene();
  scene.input[0].vertex = 5;
  EXPECT_THROW(ScriptedInput{scene}, InputError);
  scene = grab_scene();
  scene.input[0].path.clear();
  EXPECT_THROW(ScriptedInput{scene}, InputError);
}
