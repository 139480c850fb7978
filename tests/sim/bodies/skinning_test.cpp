// Bodies that bones move: against formulas, against assimp, against Blender, and in a simulation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>

#include "sim/bodies/cached_poses.h"
#include "sim/bodies/offset.h"
#include "sim/bodies/skinned_poses.h"
#include "sim/files/body_io.h"
#include "sim/files/body_transport.h"
#include "sim/files/error.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/scene_meshes.h"
#include "sim/simulator.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

constexpr double kPi = std::numbers::pi;

std::string data_file(const std::string& name) {
  const char* folder = std::getenv("ICLOTH_DATA");
  return std::string(folder ? folder : ICLOTH_DATA_DEFAULT) + "/bodies/" + name;
}

RotationKey turn(double time, Vec3d axis, double angle) {
  const Vec3d n = std::sin(angle / 2) * normalized(axis);
  return {time, std::cos(angle / 2), n.x, n.y, n.z};
}

RotationKey product(const RotationKey& a, const RotationKey& b) {
  const Vec3d u{a.x, a.y, a.z}, v{b.x, b.y, b.z};
  const Vec3d w = a.w * v + b.w * u + cross(u, v);
  return {0, a.w * b.w - dot(u, v), w.x, w.y, w.z};
}

/// An arm along x with an elbow at x = 1 that bends about z by a right angle within a second. The
/// vertices follow the upper arm, half of each, and the forearm.
Rig arm() {
  Rig rig;
  const auto moved = [](double x) { return Affine{{1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}}; };
  rig.names = {"upper_arm", "forearm"};
  rig.parent = {kNone, 0};
  rig.local = {moved(0), moved(1)};
  rig.bone_node = {0, 1};
  rig.inverse_bind = {moved(0), moved(-1)};
  rig.rest = {{0.5, 0, 0}, {1.5, 0, 0}, {2, 0, 0.25}};
  rig.weight_first = {0, 1, 3, 4};
  rig.weight_bone = {0, 0, 1, 1};
  rig.weight = {1, 0.5, 0.5, 1};
  Clip bend;
  bend.name = "bend";
  bend.duration = 1;
  bend.channels.resize(1);
  bend.channels[0].node = 1;
  bend.channels[0].rotation = {turn(0, {0, 0, 1}, 0), turn(1, {0, 0, 1}, kPi / 2)};
  rig.clips = {bend};
  return rig;
}

Body arm_body() {
  Body body{.mesh = {}, .rig = arm(), .bones = 2};
  body.mesh.positions = body.rig.rest;
  body.mesh.faces = {{0, 1, 2}};
  return body;
}

std::vector<Vec3d> pose_of(const PoseSource& source, double time) {
  std::vector<Vec3d> positions;
  source.pose(time, positions);
  return positions;
}

TEST(Playback, ReadsStartSpeedAndLoop) {
  const Playback plain;
  EXPECT_EQ(plain.at(0.7, 2).time, 0.7);
  EXPECT_EQ(plain.at(5, 2).time, 2);
  EXPECT_EQ(plain.at(-1, 2).time, 0);
  EXPECT_EQ(plain.at(1, 0).time, 0);
  const Playback loop{.start = 1.5, .speed = 2, .loop = true};
  EXPECT_NEAR(loop.at(0, 2).time, 1.5, 1e-15);
  EXPECT_NEAR(loop.at(0.5, 2).time, 0.5, 1e-15);
  EXPECT_NEAR(loop.at(3.25, 2).time, 0, 1e-15);
  const Playback backwards{.start = 0.5, .speed = -1, .loop = true};
  EXPECT_NEAR(backwards.at(1, 2).time, 1.5, 1e-15);
  EXPECT_EQ((Playback{.start = 0.5, .speed = -1}.at(1, 2).time), 0);
  EXPECT_FALSE((Playback{.speed = 0}.moves(2)));
  EXPECT_FALSE(Playback{}.moves(0));
  EXPECT_TRUE((Playback{.blend_in = 1}.moves(0)));
}

TEST(Playback, BlendsInBeforeTheClipStarts) {
  const Playback blended{.start = 0.25, .blend_in = 2};
  EXPECT_EQ(blended.at(-3, 4).blend, 0);
  EXPECT_EQ(blended.at(0, 4).blend, 0);
  EXPECT_NEAR(blended.at(1, 4).blend, 0.5, 1e-15);
  EXPECT_EQ(blended.at(1, 4).time, 0.25);
  EXPECT_EQ(blended.at(2, 4).blend, 1);
  EXPECT_NEAR(blended.at(3, 4).time, 1.25, 1e-15);
}

TEST(Skinning, SlerpTurnsEvenlyAboutOneAxis) {
  for (const double angle : {1e-9, 0.3, 1.7, kPi - 1e-3})
    for (const double s : {0.0, 0.2, 0.5, 1.0}) {
      const RotationKey a = turn(0, {1, 2, -1}, 0.8);
      const RotationKey b = product(a, turn(0, {-2, 1, 3}, angle));
      const RotationKey expected = product(a, turn(0, {-2, 1, 3}, s * angle));
      // A quaternion and its negative are the same rotation: the shorter arc is taken.
      for (const double sign : {1.0, -1.0}) {
        const RotationKey q = slerp(a, {0, sign * b.w, sign * b.x, sign * b.y, sign * b.z}, s);
        const double cosine =
            q.w * expected.w + q.x * expected.x + q.y * expected.y + q.z * expected.z;
        EXPECT_NEAR(std::fabs(cosine), 1, 1e-12) << angle << " " << s << " " << sign;
        EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12);
      }
    }
}

TEST(Skinning, AnArmBendsAsItsFormulaSays) {
  const SkinnedPoses poses(std::make_shared<Rig>(arm()), 0, {}, {});
  for (const double t : {0.0, 0.3, 0.5, 1.0, 7.0}) {
    const double angle = std::min(t, 1.0) * kPi / 2, c = std::cos(angle), s = std::sin(angle);
    const std::vector<Vec3d> x = pose_of(poses, t);
    EXPECT_LE(norm(x[0] - Vec3d{0.5, 0, 0}), 1e-14);
    EXPECT_LE(norm(x[1] - (0.5 * Vec3d{1.5, 0, 0} + 0.5 * Vec3d{1 + 0.5 * c, 0.5 * s, 0})), 1e-14);
    EXPECT_LE(norm(x[2] - Vec3d{1 + c, s, 0.25}), 1e-14);
  }
}

TEST(Skinning, BlendingInKeepsTheLengthOfALimb) {
  const Playback playback{.start = 1, .speed = 0, .blend_in = 2};
  const SkinnedPoses poses(std::make_shared<Rig>(arm()), 0, playback, {});
  EXPECT_EQ(pose_of(poses, 0)[2], (Vec3d{2, 0, 0.25}));
  for (double t = 0; t <= 2.5; t += 0.1)
    EXPECT_NEAR(norm(pose_of(poses, t)[2] - Vec3d{1, 0, 0.25}), 1, 1e-12) << t;
  EXPECT_LE(norm(pose_of(poses, 1)[2] - Vec3d{1 + std::sqrt(0.5), std::sqrt(0.5), 0.25}), 1e-12);
  EXPECT_LE(norm(pose_of(poses, 2)[2] - Vec3d{1, 1, 0.25}), 1e-12);
}

TEST(Skinning, MorphTargetsAddUpBeforeTheBones) {
  Rig rig = arm();
  rig.morph_first = {0, 0, 0, 2};
  rig.morph_target = {0, 1};
  rig.morph_delta = {{1, 0, 0}, {0, 0, 2}};
  rig.morph_rest = {0.5, 0};
  rig.clips[0].morphs = {{1, {{0, 0}, {1, 1}}}};
  const SkinnedPoses poses(std::make_shared<Rig>(rig), 0, {}, {});
  EXPECT_LE(norm(pose_of(poses, 0)[2] - Vec3d{2.5, 0, 0.25}), 1e-14);
  EXPECT_LE(norm(pose_of(poses, 1)[2] - Vec3d{1, 1.5, 2.25}), 1e-14);
}

TEST(Skinning, ACacheIsBlendedInFromItsMesh) {
  const CachedPoses poses({{{0, 0, 0}}, {{1, 0, 0}}}, 1, {.loop = true, .blend_in = 1},
                          {{0, 4, 0}});
  EXPECT_EQ(pose_of(poses, 0)[0], (Vec3d{0, 4, 0}));
  EXPECT_LE(norm(pose_of(poses, 0.5)[0] - Vec3d{0, 2, 0}), 1e-14);
  EXPECT_LE(norm(pose_of(poses, 1.5)[0] - Vec3d{0.5, 0, 0}), 1e-14);
  EXPECT_LE(norm(pose_of(poses, 2.25)[0] - Vec3d{0.25, 0, 0}), 1e-14);
}

TEST(Skinning, AnOffsetSkinTurnsWithItsBones) {
  Rig rig = arm();
  const Affine doubled{{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0}};
  const std::vector<std::array<Index, 3>> faces = {{0, 1, 2}};  // in the plane y = 0
  std::vector<Vec3d> before, after;
  skin_vertices(rig, bind_pose(rig, doubled), before);
  offset_rig(rig, doubled, faces, 0.01);
  skin_vertices(rig, bind_pose(rig, doubled), after);
  for (std::size_t v = 0; v < 3; ++v)
    EXPECT_LE(norm(after[v] - before[v] - Vec3d{0, -0.01, 0}), 1e-12);
  const SkinnedPoses poses(std::make_shared<Rig>(rig), 0, {}, doubled);
  EXPECT_LE(norm(pose_of(poses, 1)[2] - Vec3d{2.01, 2, 0.5}), 1e-12);
}

TEST(BodyTransport, BringsARigAsItWas) {
  const Body body = arm_body(), read = decode_body(encode_body(body), "a.glb");
  EXPECT_EQ(read.rig.rest, body.rig.rest);
  EXPECT_EQ(read.rig.names, body.rig.names);
  EXPECT_EQ(read.rig.weight, body.rig.weight);
  EXPECT_EQ(read.rig.clips.at(0).name, "bend");
  EXPECT_EQ(read.rig.clips[0].duration, 1);
  EXPECT_EQ(read.rig.clips[0].channels.at(0).rotation.at(1).z, std::sin(kPi / 4));
}

TEST(BodyTransport, RefusesAnswersThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Body&)>> faults = {
      [&](Body& b) { b.rig.weight[0] = nan; },
      [](Body& b) { b.rig.weight[1] = 0.75; },
      [](Body& b) { b.rig.weight[1] = -0.5, b.rig.weight[2] = 1.5; },
      [](Body& b) { b.rig.weight_bone[3] = 2; },
      [](Body& b) { b.rig.weight_first[1] = 4, b.rig.weight_first[2] = 3; },
      [](Body& b) { b.rig.weight_first.pop_back(); },
      [](Body& b) {
        b.rig.parent = {1, 0};
      },
      [](Body& b) { b.rig.parent[1] = 1; },
      [](Body& b) { b.rig.bone_node[0] = -1; },
      [&](Body& b) { b.rig.inverse_bind[1].m[3] = nan; },
      [](Body& b) { b.rig.rest.pop_back(); },
      [](Body& b) { b.rig.names.pop_back(); },
      [](Body& b) { b.rig.names.emplace_back("hand"); },
      [](Body& b) { b.rig.names[0] = std::string(5000, 'a'); },
      [](Body& b) { b.rig.morph_target = {0}; },
      [](Body& b) { b.rig.clips[0].channels[0].node = 2; },
      [&](Body& b) { b.rig.clips[0].channels[0].rotation[1].time = nan; },
      [](Body& b) { b.rig.clips[0].channels[0].rotation[1].time = 0; },
      [](Body& b) { b.rig.clips[0].channels[0].rotation[1].w = 3; },
      [](Body& b) {
        b.rig.clips[0].channels[0].translation = {{0, {1e300, 0, 0}}};
      },
      [](Body& b) {
        b.rig.clips[0].morphs = {{0, {}}};
      },
      [](Body& b) { b.rig.parent.clear(), b.rig.local.clear(); }};
  for (std::size_t f = 0; f < faults.size(); ++f) {
    Body body = arm_body();
    faults[f](body);
    EXPECT_THROW(decode_body(encode_body(body), "a.glb"), InputError) << "fault " << f;
  }

  // Counts beyond what was sent, and answers that were cut off anywhere.
  const std::string good = encode_body(arm_body());
  for (std::size_t n = 0; n < good.size(); n += 3)
    EXPECT_THROW(decode_body(good.substr(0, n), "a.glb"), InputError) << n;
  std::string huge = good;
  const std::size_t keys = huge.size() - 16 - 2 * sizeof(RotationKey);  // counts its rotations
  for (std::size_t k = 0; k < 5; ++k) huge[keys + k] = '\x7f';
  EXPECT_THROW(decode_body(huge, "a.glb"), InputError);
}

TEST(BodyTransport, AClipOfNoLengthIsAPose) {
  Body body = arm_body();
  body.rig.clips[0].channels[0].rotation.erase(body.rig.clips[0].channels[0].rotation.begin());
  body.rig.clips[0].channels[0].rotation[0].time = 0;
  auto rig = std::make_shared<Rig>(decode_body(encode_body(body), "a.glb").rig);
  const SkinnedPoses poses(rig, 0, {.loop = true}, {});
  EXPECT_FALSE(poses.moves());
  EXPECT_LE(norm(pose_of(poses, 3)[2] - Vec3d{1, 1, 0.25}), 1e-12);
}

TEST(BodyFiles, RefuseSkinsAndAnimationsOfWhatIsNotThere) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& rest) {
    const std::string json =
        R"({"asset":{"version":"2.0"},"nodes":[{},{}],"buffers":[{"byteLength":8,)"
        R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAA="}],"bufferViews":)"
        R"([{"buffer":0,"byteLength":8}],"accessors":[{"bufferView":0,"componentType":5126,)"
        R"("type":"SCALAR","count":2},{"bufferView":0,"componentType":5126,"type":"SCALAR",)"
        R"("count":1}],)" +
        rest + "}";
    try {
      read_body(folder.write("a.gltf", json));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto expect = [&](const std::string& rest, const std::vector<std::string>& parts) {
    const std::string text = message(rest);
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << " not in " << text;
  };
  expect(R"("skins":[{"joints":[0,7]}])", {"skins[0].joints[1]", "7"});
  expect(R"("skins":[{"joints":[1,1]}])", {"skins[0].joints[1]", "no joint yet"});
  expect(R"("skins":[{"joints":[0,1],"inverseBindMatrices":1}])", {"each of the 2 joints"});
  expect(R"("skins":[{}])", {"'joints'"});
  expect(R"("animations":[{"samplers":[{"input":0,"output":1}]}])",
         {"output", "each of the 2 times"});
  expect(R"("animations":[{"samplers":[{"input":0,"output":9}]}])", {"output", "9"});
  expect(R"("animations":[{"channels":[{"sampler":3,"target":{"node":0}}]}])", {"sampler", "3"});
  expect(R"("animations":[{"samplers":[{"input":0,"output":0}],)"
         R"("channels":[{"sampler":0,"target":{"node":5}}]}])",
         {"target.node", "5"});
}

TEST(BodyFiles, TheBindPoseIsThatOfAssimp) {
  for (const char* name : {"cesium_man.gltf", "greenman.glb"}) {
    const std::string path = data_file(name);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
    const Body body = read_body(path);
    std::vector<Vec3d> skinned;
    skin_vertices(body.rig, bind_pose(body.rig, {}), skinned);
    ASSERT_EQ(skinned.size(), body.mesh.positions.size());
    double farthest = 0;
    for (std::size_t v = 0; v < skinned.size(); ++v)
      farthest = std::max(farthest, norm(skinned[v] - body.mesh.positions[v]));
    EXPECT_LE(farthest, 1e-6) << name;
    RecordProperty(name, std::to_string(farthest));
    std::printf("%s: %.2e m from assimp\n", name, farthest);
  }
}

/// A vertex by its place in the mesh of the file, and where Blender has it.
struct BlenderVertex {
  Vec3d rest, posed[3];
};

/// The largest distance [m] at the frames, of 24 a second, counted from the first key.
double distance_to_blender(const std::string& path, std::size_t clip, const int (&frames)[3],
                           const std::vector<BlenderVertex>& vertices) {
  const auto rig = std::make_shared<Rig>(read_body(path).rig);
  const auto y_up = [](Vec3d p) { return Vec3d{p.x, p.z, -p.y}; };
  double farthest = 0;
  for (int k = 0; k < 3; ++k) {
    const std::vector<Vec3d> x = pose_of(SkinnedPoses(rig, clip, {}, {}), frames[k] / 24.0);
    for (const BlenderVertex& vertex : vertices) {
      std::size_t nearest = 0;
      for (std::size_t v = 0; v < x.size(); ++v)
        if (norm(rig->rest[v] - y_up(vertex.rest)) < norm(rig->rest[nearest] - y_up(vertex.rest)))
          nearest = v;
      EXPECT_LE(norm(rig->rest[nearest] - y_up(vertex.rest)), 1e-5);
      farthest = std::max(farthest, norm(x[nearest] - y_up(vertex.posed[k])));
    }
  }
  std::printf("%s: %.2e m from Blender\n", path.c_str(), farthest);
  return farthest;
}

// Values of Blender 3.4.1: import_scene.gltf with 24 frames a second, the action set, the mesh
// evaluated in world space (Z up) at the frames. The first number of each line names the vertex.
TEST(BodyFiles, ClipsAreWhereBlenderHasThem) {
  const std::string green = data_file("greenman.glb"), cesium = data_file("cesium_man.gltf");
  if (!std::filesystem::exists(green) || !std::filesystem::exists(cesium))
    GTEST_SKIP() << green << " or " << cesium << " is missing";
  EXPECT_LE(distance_to_blender(green, 2, {0, 7, 20},
                                {{{0.6748328, 0.3905448, 0.0794586},
                                  {{0.7539156, 0.0353635, 0.1621583},
                                   {0.7627895, 0.3149901, 0.1425114},
                                   {0.6839134, 0.5427182, 0.3221445}}},
                                 {{0.2906886, -0.6640163, 0.4449008},
                                  {{0.1846901, -0.6722451, 0.4969292},
                                   {0.2433061, -0.6869621, 0.3639480},
                                   {0.3094578, -0.6488128, 0.3125045}}},
                                 {{-0.3188101, -0.3048709, 0.0075781},
                                  {{-0.3277211, -0.0489194, 0.0556962},
                                   {-0.3642507, -0.2032012, 0.0544157},
                                   {-0.3146612, -0.3657040, -0.0031028}}},
                                 {{-1.2179031, 0.1276462, 0.5901121},
                                  {{-1.0635560, -0.1807003, 0.5903482},
                                   {-1.0884905, 0.0157612, 0.6071655},
                                   {-1.0899839, 0.0546619, 0.5888294}}}}),
            1e-4);
  EXPECT_LE(distance_to_blender(cesium, 0, {0, 12, 31},
                                {{{0.0934292, -0.9735749, 0.0487146},
                                  {{0.1163098, 0.0258371, 0.9196380},
                                   {0.1044538, 0.0165233, 0.9621822},
                                   {0.1114388, 0.0107926, 0.9795548}}},
                                 {{0.0785872, -0.0251757, -0.1235600},
                                  {{0.2306697, -0.1517611, 0.0195040},
                                   {-0.2671987, -0.1467432, 0.0853771},
                                   {-0.1760123, -0.1507151, 0.2811670}}},
                                 {{-0.1310001, -1.4384702, -0.0610470},
                                  {{-0.0414111, -0.1540209, 1.3797871},
                                   {-0.0853318, -0.0649284, 1.4397423},
                                   {-0.0335914, -0.0953307, 1.4724369}}},
                                 {{-0.1310001, -1.4370602, 0.0303956},
                                  {{-0.0384738, -0.0656539, 1.4031625},
                                   {-0.1011414, 0.0237701, 1.4240460},
                                   {-0.0376242, -0.0043378, 1.4642043}}}}),
            1e-4);
}

/// A sheet that falls on the head of a walking man.
std::shared_ptr<const Scene> walking_scene(const TemporaryFolder& folder) {
  std::filesystem::copy_file(data_file("cesium_man.gltf"), folder.path("man.gltf"),
                             std::filesystem::copy_options::overwrite_existing);
  return load_scene(
      folder.write("a.json", R"({"cloths": [{"mesh": {"grid": {"size": [0.5, 0.5], "orientation":
      "horizontal"}}, "triangles": 600, "transform": {"translate": [0, 1.58, 0]}}], "obstacles": [
      {"name": "man", "mesh": "man.gltf", "clip": 0, "loop": true, "blend_in": 0.1, "offset": 0.002,
       "motion": [{"time": 0}, {"time": 2, "translate": [0, 0, 0.2]}]}]})"),
      {});
}

TEST(SkinnedBody, IsWhereTheHostHasItToTheLastBit) {
  if (!std::filesystem::exists(data_file("cesium_man.gltf"))) GTEST_SKIP() << "no data";
  const TemporaryFolder folder;
  const auto scene = walking_scene(folder);
  const auto simulator = make_simulator(Build::cpu32, scene);
  std::vector<Vec3f> x;
  std::vector<Vec3d> pose;
  for (int step = 0; step < 3; ++step) {
    simulator->positions(x);
    scene->obstacles[0].pose(simulator->time(), pose);
    for (std::size_t v = 0; v < pose.size(); ++v)
      ASSERT_EQ(x[x.size() - pose.size() + v], convert<float>(pose[v])) << "vertex " << v;
    ASSERT_TRUE(simulator->step({}).accepted);
  }
}

TEST(SkinnedBody, WalksUnderClothWithoutAnyPenetrationWhateverTheThreads) {
  if (!std::filesystem::exists(data_file("cesium_man.gltf"))) GTEST_SKIP() << "no data";
  const TemporaryFolder folder;
  const auto scene = walking_scene(folder);
  std::uint64_t hashes[2];
  std::vector<Vec3f> x;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const auto simulator = make_simulator(Build::cpu32, scene);
    Snapshot middle;
    for (int step = 0; step < 60; ++step) {
      if (step == 30) middle = simulator->snapshot();
      ASSERT_TRUE(simulator->step({}).accepted) << step;
    }
    hashes[threads - 1] = simulator->state_hash();
    simulator->positions(x);

    // Back in time the body is where it was.
    simulator->restore(middle);
    for (int step = 30; step < 60; ++step) simulator->step({});
    EXPECT_EQ(simulator->state_hash(), hashes[threads - 1]);
  }
  set_thread_count(0);
  EXPECT_EQ(hashes[0], hashes[1]);

  const SceneFaces soup = scene_faces(*scene);
  std::vector<Vec3d> positions;
  for (const Vec3f& p : x) positions.push_back(convert<double>(p));
  EXPECT_TRUE(find_intersections(positions, soup.faces, soup.group).empty());
}

/// Vertices of the body of the walking scene after so many steps, each at its speed.
std::vector<Vec3f> body_after(const std::shared_ptr<const Scene>& scene,
                              const std::vector<double>& speeds) {
  const auto simulator = make_simulator(Build::cpu32, scene);
  for (const double speed : speeds) {
    Parameters parameters = simulator->parameters();
    parameters.bodies.speed = speed;
    simulator->set_parameters(parameters);
    EXPECT_TRUE(simulator->step({}).accepted);
  }
  std::vector<Vec3f> x;
  simulator->positions(x);
  return {x.begin() + static_cast<std::ptrdiff_t>(scene->cloths[0].mesh.positions.size()), x.end()};
}

TEST(SkinnedBody, StandsStillWhileItIsHeldAndGoesOnFromThere) {
  if (!std::filesystem::exists(data_file("cesium_man.gltf"))) GTEST_SKIP() << "no data";
  const TemporaryFolder folder;
  const auto scene = walking_scene(folder);
  const std::vector<Vec3f> moved = body_after(scene, {1, 1, 1});
  EXPECT_EQ(body_after(scene, {1, 1, 1, 0, 0}), moved);
  const auto nearly_equal = [](const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    double largest = 0;
    for (std::size_t v = 0; v < a.size(); ++v)
      largest = std::max(largest, norm(convert<double>(a[v]) - convert<double>(b[v])));
    return largest < 1e-6;
  };
  const std::vector<Vec3f> further = body_after(scene, {1, 1, 1, 1});
  EXPECT_FALSE(nearly_equal(further, moved));
  EXPECT_TRUE(nearly_equal(body_after(scene, {1, 0, 1, 0, 1, 1}), further));
  EXPECT_TRUE(nearly_equal(body_after(scene, {0.5, 0.5, 2, 1}), further));
}

TEST(SkinnedBody, GoesBackInTimeToWhereItWasHeld) {
  if (!std::filesystem::exists(data_file("cesium_man.gltf"))) GTEST_SKIP() << "no data";
  const TemporaryFolder folder;
  const auto simulator = make_simulator(Build::cpu32, walking_scene(folder));
  const auto step_at = [&](double speed) {
    Parameters parameters = simulator->parameters();
    parameters.bodies.speed = speed;
    simulator->set_parameters(parameters);
    simulator->step({});
  };
  for (const double speed : {1.0, 0.0, 1.0}) step_at(speed);
  const Snapshot middle = simulator->snapshot();
  EXPECT_NEAR(middle.body_lag, simulator->parameters().step.time_step, 1e-12);
  step_at(1);
  const std::uint64_t hash = simulator->state_hash();
  step_at(1);
  simulator->restore(middle);
  step_at(1);
  EXPECT_EQ(simulator->state_hash(), hash);
}

TEST(SkinnedBody, AClipThatIsNotThereIsRefusedWithThoseThatAre) {
  if (!std::filesystem::exists(data_file("greenman.glb"))) GTEST_SKIP() << "no data";
  const TemporaryFolder folder;
  std::filesystem::copy_file(data_file("greenman.glb"), folder.path("g.glb"));
  const auto load = [&](const std::string& keys, SceneOrigin& origin) {
    return load_scene(folder.write("a.json", R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}},
        "triangles": 8}], "obstacles": [{"name": "g", "mesh": "g.glb")" +
                                                 keys + "}]}"),
                      {}, {}, &origin);
  };
  SceneOrigin origin;
  try {
    load(R"(, "clip": "wlk")", origin);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    for (const char* part :
         {"obstacles[0].clip", "wlk", "'0_pose'", "'1_idle' (2.5 s)", "'2_move'"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  EXPECT_THROW(load(R"(, "clip": 4)", origin), InputError);
  EXPECT_THROW(load(R"(, "loop": true)", origin), InputError);
  EXPECT_THROW(load(R"(, "up": "x")", origin), InputError);

  // Without a clip a note names them; another tells how tall the body is.
  SceneOrigin plain;
  load("", plain);
  ASSERT_EQ(plain.notes.size(), 2u);
  EXPECT_NE(plain.notes[0].find("'1_idle' (2.5 s)"), std::string::npos) << plain.notes[0];
  EXPECT_NE(plain.notes[1].find("m tall, Y up"), std::string::npos) << plain.notes[1];
  SceneOrigin large;
  load(R"(, "animation": "2_move", "scale": 100)", large);
  EXPECT_NE(large.notes.back().find("scale"), std::string::npos) << large.notes.back();
}

}  // namespace
}  // namespace icloth
