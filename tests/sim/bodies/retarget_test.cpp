// Motions of other skeletons on a body: against a slow version that is written out joint by joint,
// against the body's own clips, and in scenes.
#include "sim/bodies/retarget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "kernels/index.h"
#include "sim/bodies/skinned_poses.h"
#include "sim/files/assets.h"
#include "sim/files/body_io.h"
#include "sim/files/bvh_io.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/scene/scene_io.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Vec3d kUp{0, 1, 0};

std::string wave() { return read_file(std::string(ICLOTH_TEST_FOLDER) + "/data/wave.bvh"); }
std::string woman() { return assets_folder() + "/bodies/woman.glb"; }

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix turn_about(int axis, double degrees) {
  const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
  const auto i = static_cast<std::size_t>((axis + 1) % 3),
             j = static_cast<std::size_t>((axis + 2) % 3);
  Matrix m{};
  m[static_cast<std::size_t>(axis)][static_cast<std::size_t>(axis)] = 1;
  m[i][i] = m[j][j] = c;
  m[i][j] = -s;
  m[j][i] = s;
  return m;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Vec3d operator*(const Matrix& a, Vec3d x) {
  return {a[0][0] * x.x + a[0][1] * x.y + a[0][2] * x.z,
          a[1][0] * x.x + a[1][1] * x.y + a[1][2] * x.z,
          a[2][0] * x.x + a[2][1] * x.y + a[2][2] * x.z};
}

Affine map_of(const Matrix& m, Vec3d t) {
  return {{m[0][0], m[0][1], m[0][2], t.x, m[1][0], m[1][1], m[1][2], t.y, m[2][0], m[2][1],
           m[2][2], t.z}};
}

Matrix transposed(const Matrix& m) {
  Matrix t{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[i][j] = m[j][i];
  return t;
}

/// A joint of the slow version: where it is in the rest pose, and which joint it hangs on.
struct SlowJoint {
  const char* node;  ///< of the body
  int parent;
  Vec3d place;  ///< of the motion
};

/// The joints of tests/data/wave.bvh that the body has, in their order.
const std::vector<SlowJoint> kSlow = {{"pelvis", -1, {0, 10, 0}},     {"spine", 0, {0, 14, 0}},
                                      {"upper_arm.L", 1, {2, 17, 0}}, {"forearm.L", 2, {5, 17, 0}},
                                      {"thigh.L", 0, {1, 9, 0}},      {"shin.L", 4, {1, 5, 0}}};

/// The local turns of these joints in a frame of that file, written out in the order of its
/// channels.
std::vector<Matrix> slow_turns(int frame) {
  const auto zxy = [](double z, double x, double y) {
    return turn_about(2, z) * turn_about(0, x) * turn_about(1, y);
  };
  const auto yzx = [](double y, double z, double x) {
    return turn_about(1, y) * turn_about(2, z) * turn_about(0, x);
  };
  if (frame == 1)
    return {zxy(10, 20, 30), zxy(5, -10, 15),  yzx(40, -30, 20),
            zxy(0, 25, -35), zxy(-20, 30, 10), zxy(0, -45, 5)};
  if (frame == 2)
    return {zxy(-15, 5, 60),  zxy(-5, 20, -25),  yzx(-60, 35, 10),
            zxy(15, -20, 70), zxy(25, -30, -15), zxy(5, 50, -10)};
  return {zxy(0, 0, 0), zxy(0, 0, 0), yzx(0, 0, 0), zxy(0, 0, 0), zxy(0, 0, 0), zxy(0, 0, 0)};
}
const Vec3d kSlowHips[] = {{0, 10, 0}, {1, 9, 2}, {2, 11, -1}};

/// A body with the joints of the slow version, `size` times as large, under a node that turns and
/// shrinks; each node is turned in its rest pose in its own way. Two vertices follow each node.
Rig body_of(double size) {
  Rig rig;
  const auto add = [&](const std::string& name, Index parent, const Affine& local) {
    rig.names.push_back(name);
    rig.parent.push_back(parent);
    rig.local.push_back(local);
  };

  // The node above all has other axes and units, as in files of Blender.
  Affine armature = map_of(turn_about(0, -90), {3, 4, 5});
  for (int row = 0; row < 3; ++row)
    for (int c = 0; c < 3; ++c) armature.m[4 * row + c] *= 0.01;
  add("Armature", kNone, armature);

  // The inverse of the place of a node is written out for a turn T, a scale 0.01 and a place p.
  std::vector<Affine> inverse;
  std::vector<Matrix> turned;
  rig.weight_first = {0};
  for (std::size_t j = 0; j < kSlow.size(); ++j) {
    turned.push_back(turn_about(static_cast<int>(j) % 3, 30.0 + 20 * static_cast<double>(j)) *
                     turn_about(1, 15));
    const Vec3d place = size * kSlow[j].place;
    Affine global = map_of(turned[j], place), back = map_of(transposed(turned[j]), {});
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) {
        global.m[4 * row + c] *= 0.01;
        back.m[4 * row + c] *= 100;
      }
    const Vec3d moved = back(place);
    back.m[3] = -moved.x, back.m[7] = -moved.y, back.m[11] = -moved.z;

    // The hips hang on the node above all, the others on each other.
    Affine above_back = map_of(turn_about(0, 90), {});
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) above_back.m[4 * row + c] *= 100;
    const Vec3d start = above_back(Vec3d{3, 4, 5});
    above_back.m[3] = -start.x, above_back.m[7] = -start.y, above_back.m[11] = -start.z;
    const Affine above = kSlow[j].parent < 0 ? above_back : inverse[at(kSlow[j].parent)];
    add(kSlow[j].node, kSlow[j].parent + 1, above * global);
    inverse.push_back(back);

    // Two vertices follow the node.
    rig.bone_node.push_back(static_cast<Index>(j) + 1);
    rig.inverse_bind.push_back(back);
    for (const Vec3d from_node : {Vec3d{0.1, 0.2, 0.3}, Vec3d{-0.5, 0.4, 0}}) {
      rig.rest.push_back(place + from_node);
      rig.weight_bone.push_back(static_cast<Index>(j));
      rig.weight.push_back(1);
      rig.weight_first.push_back(static_cast<Index>(rig.weight.size()));
    }
  }
  return rig;
}

/// Where the vertices of body_of are in a frame, joint by joint from the hips.
std::vector<Vec3d> slow_vertices(double size, int frame) {
  const std::vector<Matrix> local = slow_turns(frame);
  std::vector<Matrix> turn(kSlow.size());
  std::vector<Vec3d> place(kSlow.size()), vertices;
  for (std::size_t j = 0; j < kSlow.size(); ++j) {
    const Vec3d rest = size * kSlow[j].place;
    if (kSlow[j].parent < 0) {
      turn[j] = local[j];
      place[j] = rest + size * (kSlowHips[frame] - kSlowHips[0]);
    } else {
      const std::size_t p = at(kSlow[j].parent);
      turn[j] = turn[p] * local[j];
      place[j] = place[p] + turn[p] * (rest - size * kSlow[p].place);
    }
    for (const Vec3d from_node : {Vec3d{0.1, 0.2, 0.3}, Vec3d{-0.5, 0.4, 0}})
      vertices.push_back(place[j] + turn[j] * from_node);
  }
  return vertices;
}

std::vector<Vec3d> vertices_of(const Rig& body, const Clip& clip, double time) {
  SkinPose pose;
  std::vector<Vec3d> vertices;
  pose_rig(body, &clip, {time, 1}, pose.bones, pose.morphs);
  skin_vertices(body, pose, vertices);
  return vertices;
}

double farthest(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v)
    largest = std::max(largest, norm(a[v] - b[v]));
  return largest;
}

TEST(NodeNames, OfOneJointAreManyAndMeanOnePart) {
  EXPECT_EQ(plain_name("mixamorig:LeftUp_Leg"), "leftupleg");
  for (const char* name : {"mixamorig:LeftUpLeg", "thigh.L", "L_Thigh", "lThigh", "LeftHip",
                           "upper_leg_left", "Bip01 L Thigh"})
    EXPECT_EQ(part_name(name), "thigh.l") << name;
  for (const char* name : {"RightForeArm", "forearm.R", "rForeArm", "right elbow"})
    EXPECT_EQ(part_name(name), "forearm.r") << name;
  for (const char* name : {"Hips", "pelvis", "mixamorig1:Hips", "hip"})
    EXPECT_EQ(part_name(name), "hips") << name;
  for (const char* name : {"", "Tail", "lump", "left", "LeftHips", "relic"})
    EXPECT_EQ(part_name(name), "") << name;
}

TEST(NodeNames, AreGivenFirstThenEqualThenAlike) {
  const std::vector<std::string> joints = {"Hips", "Spine", "LeftShoulder", "LeftArm", "Tail"};
  const std::vector<std::string> nodes = {"root", "SPINE", "pelvis", "clavicle.L", "upper_arm.L"};
  const std::vector<NodePair> pairs = pair_nodes(joints, nodes, {{4, 0}});
  std::vector<std::pair<Index, Index>> found;
  for (const NodePair pair : pairs) found.emplace_back(pair.joint, pair.node);
  EXPECT_EQ(found, (std::vector<std::pair<Index, Index>>{{0, 2}, {1, 1}, {2, 3}, {3, 4}, {4, 0}}));

  // A shoulder is an upper arm where no arm is.
  EXPECT_EQ(pair_nodes({"LeftCollar", "LeftShoulder"}, nodes, {}).at(1).node, 4);
}

TEST(Retarget, EveryVertexIsWhereTheSlowVersionHasIt) {
  for (const double size : {1.0, 0.1, 2.5}) {
    const Rig motion = parse_bvh(wave(), "wave.bvh"), body = body_of(size);
    const std::vector<NodePair> pairs = pair_nodes(motion.names, body.names, {});
    ASSERT_EQ(pairs.size(), kSlow.size());
    ASSERT_TRUE(root_pair(motion, pairs).has_value());
    const Retargeted result = retarget(motion, body, pairs, kUp);
    EXPECT_NEAR(result.scale, size, 1e-12);
    EXPECT_FALSE(result.turned);
    EXPECT_EQ(result.clip.duration, 1);
    for (const int frame : {0, 1, 2})
      EXPECT_LE(farthest(vertices_of(body, result.clip, 0.5 * frame), slow_vertices(size, frame)),
                1e-10)
          << size << " " << frame;
  }
}

/// A motion whose axes are others: what was (x, y, z) is (x, −z, y).
TEST(Retarget, FindsTheAxesOfAMotionWithZUp) {
  Rig motion = parse_bvh(wave(), "wave.bvh");
  const Rig body = body_of(1);
  const auto turn = [](Vec3d p) { return Vec3d{p.x, -p.z, p.y}; };
  for (Affine& local : motion.local) {
    const Vec3d p = turn({local.m[3], local.m[7], local.m[11]});
    local.m[3] = p.x, local.m[7] = p.y, local.m[11] = p.z;
  }
  for (NodeChannel& channel : motion.clips[0].channels) {
    for (VectorKey& key : channel.translation) key.value = turn(key.value);
    for (RotationKey& key : channel.rotation) {
      const Vec3d axis = turn({key.x, key.y, key.z});
      key.x = axis.x, key.y = axis.y, key.z = axis.z;
    }
  }
  const Retargeted result = retarget(motion, body, pair_nodes(motion.names, body.names, {}), kUp);
  EXPECT_TRUE(result.turned);
  for (const int frame : {0, 1, 2})
    EXPECT_LE(farthest(vertices_of(body, result.clip, 0.5 * frame), slow_vertices(1, frame)),
              1e-10);
}

TEST(Retarget, HipsOfARestPoseAtTheOriginStandOnTheirLegs) {
  // The rest pose is 10 lower than where the motion starts; the lowest end is at −10 then.
  Rig motion = parse_bvh(wave(), "wave.bvh");
  motion.local[0].m[7] = 0;
  const Rig body = body_of(1);
  const Retargeted result = retarget(motion, body, pair_nodes(motion.names, body.names, {}), kUp);
  EXPECT_LE(farthest(vertices_of(body, result.clip, 0.5), slow_vertices(1, 1)), 1e-10);
}

TEST(Retarget, AMotionThatStartsFarAwayStartsAtTheBody) {
  Rig motion = parse_bvh(wave(), "wave.bvh");
  for (VectorKey& key : motion.clips[0].channels[0].translation) key.value += Vec3d{70, 0, -30};
  const Rig body = body_of(1);
  const Retargeted result = retarget(motion, body, pair_nodes(motion.names, body.names, {}), kUp);
  EXPECT_NEAR(result.moved, std::sqrt(5800.0), 1e-9);
  EXPECT_LE(farthest(vertices_of(body, result.clip, 1), slow_vertices(1, 2)), 1e-10);
}

/// The arm of the body hangs down at 45° and that of the motion is level in the rest pose: where
/// the motion is level, that of the body is level as well.
TEST(Retarget, ArmsPointWhereThoseOfTheMotionPoint) {
  const Rig motion = parse_bvh(wave(), "wave.bvh");
  Rig body = body_of(1);
  const std::vector<Affine> rest = pose_nodes(body, nullptr, {});
  const Vec3d shoulder{2, 17, 0}, elbow = shoulder + turn_about(2, -45) * Vec3d{3, 0, 0};
  const Affine& arm = rest[3];
  for (int row = 0; row < 3; ++row) {
    // The arm is turned by T and shrunk by 0.01, so its inverse is Tᵀ enlarged by 100.
    double local = 0;
    const double away[] = {elbow.x - shoulder.x, elbow.y - shoulder.y, elbow.z - shoulder.z};
    for (int c = 0; c < 3; ++c) local += 1e4 * arm.m[4 * c + row] * away[c];
    body.local[4].m[4 * row + 3] = local;
  }
  const Retargeted result = retarget(motion, body, pair_nodes(motion.names, body.names, {}), kUp);
  for (const double time : {0.0, 0.5, 1.0}) {
    const std::vector<Affine> nodes = pose_nodes(body, &result.clip, {time, 1});
    const std::vector<Affine> joints = pose_nodes(motion, &motion.clips[0], {time, 1});
    const Vec3d limb = nodes[4](Vec3d{}) - nodes[3](Vec3d{});
    EXPECT_LE(norm(limb - (joints[3](Vec3d{}) - joints[2](Vec3d{}))), 1e-9) << time;
  }
}

/// A BVH file of a clip, from a node downwards. Angles in the order z, x, y; one frame every
/// `step` seconds. Only for rigs that are turned nowhere and have the size 1 in the bind pose.
class BvhExporter {
 public:
  BvhExporter(const Rig& rig, const Clip& clip, double step) : rig_(rig) {
    text_.precision(12);
    text_ << "HIERARCHY\n";
    const auto root = std::ranges::find(rig.names, "hips") - rig.names.begin();
    add_joint(static_cast<Index>(root), true);
    const int frames = static_cast<int>(std::floor(clip.duration / step + 1e-6)) + 1;
    text_ << "MOTION\nFrames: " << frames << "\nFrame Time: " << step << "\n";
    for (int f = 0; f < frames; ++f) add_frame(pose_nodes(rig, &clip, {f * step, 1}));
  }
  std::string text() const { return text_.str(); }

 private:
  void add_joint(Index node, bool is_root) {
    const double* m = rig_.local[at(node)].m;
    text_ << (is_root ? "ROOT " : "JOINT ") << rig_.names[at(node)] << "\n{\nOFFSET " << m[3] << " "
          << m[7] << " " << m[11] << "\nCHANNELS " << (is_root ? 6 : 3)
          << (is_root ? " Xposition Yposition Zposition" : "")
          << " Zrotation Xrotation Yrotation\n";
    order_.push_back(node);
    for (std::size_t n = 0; n < rig_.parent.size(); ++n)
      if (rig_.parent[n] == node) add_joint(static_cast<Index>(n), false);
    text_ << "}\n";
  }

  void add_frame(const std::vector<Affine>& nodes) {
    for (const Index node : order_) {
      const Affine& map = nodes[at(node)];
      if (node == order_[0]) text_ << map.m[3] << " " << map.m[7] << " " << map.m[11] << " ";
      const Affine above = node == order_[0] ? Affine{} : nodes[at(rig_.parent[at(node)])];
      double r[3][3] = {};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k) r[i][j] += above.m[4 * k + i] * map.m[4 * k + j];
      text_ << std::atan2(-r[0][1], r[1][1]) / kDegree << " "
            << std::asin(std::clamp(r[2][1], -1.0, 1.0)) / kDegree << " "
            << std::atan2(-r[2][0], r[2][2]) / kDegree << " ";
    }
    text_ << "\n";
  }

  const Rig& rig_;
  std::vector<Index> order_;
  std::ostringstream text_;
};

TEST(Retarget, ClipsOfTheWomanComeBackThroughBvh) {
  const Body body = read_body(woman());
  for (const Clip& clip : body.rig.clips) {
    const double step = 1.0 / 120;
    const std::string text = BvhExporter(body.rig, clip, step).text();
    const Rig motion = parse_bvh(text, "own.bvh");
    const std::vector<NodePair> pairs = pair_nodes(motion.names, body.rig.names, {});
    ASSERT_EQ(pairs.size(), motion.names.size()) << clip.name;
    const Retargeted back = retarget(motion, body.rig, pairs, kUp);
    EXPECT_NEAR(back.scale, 1, 1e-6);

    // In frames and between them; the keys of the clip are elsewhere.
    double largest = 0;
    for (double time = 0; time < clip.duration - step; time += 0.0371)
      largest = std::max(largest, farthest(vertices_of(body.rig, back.clip, time),
                                           vertices_of(body.rig, clip, time)));
    std::printf("%s: %.2e m from the clip\n", clip.name.c_str(), largest);
    EXPECT_LE(largest, 1e-3) << clip.name;
  }
}

/// The notes of a scene whose body plays tests/data/wave.bvh, or the message that refuses it.
struct Loaded {
  std::vector<std::string> notes;
  std::string refusal;
  std::shared_ptr<const Scene> scene;
};

Loaded load(const TemporaryFolder& folder, const std::string& keys, const std::string& bvh) {
  std::filesystem::copy_file(woman(), folder.path("woman.glb"),
                             std::filesystem::copy_options::overwrite_existing);
  folder.write("wave.bvh", bvh);
  const std::string scene = folder.write(
      "a.json", R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 2, "transform":
      {"translate": [0, 9, 0]}}], "obstacles": [{"name": "woman", "mesh": "woman.glb", )" +
                    keys + "}]}");
  Loaded loaded;
  SceneOrigin origin;
  try {
    loaded.scene = load_scene(scene, {}, {}, &origin);
  } catch (const InputError& error) {
    loaded.refusal = error.what();
  }
  loaded.notes = origin.notes;
  return loaded;
}

TEST(MotionScenes, PlayAMotionAsAClip) {
  const TemporaryFolder folder;
  const Loaded loaded = load(
      folder, R"("animation": "wave.bvh", "speed": 2, "blend_in": 1, "offset": 0.002)", wave());
  ASSERT_EQ(loaded.refusal, "");
  const std::string notes = std::string() + (loaded.notes.empty() ? "" : loaded.notes[0]);
  EXPECT_NE(notes.find("without a partner among the bones of woman.glb: 1 ("), std::string::npos)
      << notes;
  EXPECT_NE(notes.find("mixamorig:Tail"), std::string::npos) << notes;

  // The clip begins after the blend and is played at double speed.
  const Obstacle& body = loaded.scene->obstacles.at(0);
  std::vector<Vec3d> start, middle, end, later;
  body.pose(0, start);
  body.pose(1.25, middle);
  body.pose(1.5, end);
  body.pose(7, later);
  EXPECT_GT(farthest(start, middle), 0.1);
  EXPECT_GT(farthest(middle, end), 0.1);
  EXPECT_EQ(farthest(end, later), 0);
}

TEST(MotionScenes, GiveJointsToBonesOfOtherNames) {
  const TemporaryFolder folder;
  const Loaded loaded =
      load(folder, R"("animation": "wave.bvh", "bones": {"mixamorig:Tail": "head"})", wave());
  EXPECT_EQ(loaded.refusal, "");
  for (const std::string& note : loaded.notes)
    EXPECT_EQ(note.find("partner"), std::string::npos) << note;
}

TEST(MotionScenes, RefuseWhatCannotBePlayed) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& keys, const std::string& bvh,
                          const std::vector<std::string>& parts) {
    const std::string message = load(folder, keys, bvh).refusal;
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << part << " not in " << message;
  };
  const std::string play = R"("animation": "wave.bvh")";
  expect(play + R"(, "bones": {"Hips": "hips"})", wave(), {"bones", "\"Hips\"", "a joint of"});
  expect(play + R"(, "bones": {"mixamorig:Hips": "hip"})", wave(), {"mixamorig:Hips", "a bone of"});
  expect(play + R"(, "bones": {"mixamorig:Tail": "neck", "mixamorig:Hips": "neck"})", wave(),
         {"no other joint"});
  expect(play + R"(, "bones": [])", wave(), {"an object"});
  expect(play + R"(, "clip": 0)", wave(), {"clip"});
  expect(R"("bones": {})", wave(), {"bones"});
  expect(R"("animation": "none.bvh")", wave(), {"none.bvh"});
  expect(R"("animation": "../wave.bvh")", wave(), {"../wave.bvh"});

  // Names that say nothing, and hips below what hangs on them.
  std::string strange = wave(), headless = wave();
  for (std::size_t k; (k = strange.find("mixamorig:")) != std::string::npos;)
    strange.replace(k, 10, "bone of ape ");
  expect(play, strange, {"at least three joints", "only 0", "bone of ape"});
  headless.replace(headless.find("mixamorig:Hips"), 14, "ape");
  expect(play, headless, {"hips above the others"});
}

}  // namespace
}  // namespace icloth
