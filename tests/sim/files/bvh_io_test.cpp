// Motions in BVH files: what is read of them, and what is refused.
#include "sim/files/bvh_io.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/files/body_io.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

const std::string kJoints =
    "HIERARCHY\nROOT hips\n{\nOFFSET 1 2 3\nCHANNELS 4 Yposition Zrotation Xrotation Yrotation\n"
    "JOINT left leg {\nOFFSET 0 -1 0\nCHANNELS 1 Xrotation\nEnd Site\n{\nOFFSET 0 -2 0\n}\n}\n}\n";

std::string motion(const std::string& frames, const std::string& numbers) {
  return kJoints + "MOTION\nFrames: " + frames + "\nFrame Time: 0.25\n" + numbers;
}

std::string refusal_of(const std::string& text) {
  try {
    parse_bvh(text, "a.bvh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
  const std::string message = refusal_of(text);
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << " not in " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(Bvh, JointsBecomeNodesAndFramesKeys) {
  const Rig rig = parse_bvh(motion("2", "5 90 0 0 30\r\n+6 0 90 90 -30\n"), "a.bvh");
  EXPECT_EQ(rig.names, (std::vector<std::string>{"hips", "left leg", ""}));
  EXPECT_EQ(rig.parent, (std::vector<Index>{kNone, 0, 1}));
  EXPECT_EQ(rig.local[0](Vec3d{}), (Vec3d{1, 2, 3}));
  EXPECT_EQ(rig.local[2](Vec3d{}), (Vec3d{0, -2, 0}));

  // A position channel replaces one coordinate of the offset.
  ASSERT_EQ(rig.clips.size(), 1u);
  const Clip& clip = rig.clips[0];
  EXPECT_EQ(clip.duration, 0.25);
  ASSERT_EQ(clip.channels.size(), 2u);
  EXPECT_EQ(clip.channels[0].translation.at(0).value, (Vec3d{1, 5, 3}));
  EXPECT_EQ(clip.channels[0].translation.at(1).value, (Vec3d{1, 6, 3}));
  EXPECT_EQ(clip.channels[0].translation[1].time, 0.25);
  EXPECT_TRUE(clip.channels[1].translation.empty());

  // A quarter turn about z; then one about x and one about the y axis that it has moved.
  const RotationKey& z = clip.channels[0].rotation.at(0);
  EXPECT_NEAR(z.w, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(z.z, std::sqrt(0.5), 1e-15);
  const RotationKey& xy = clip.channels[0].rotation.at(1);
  for (const double part : {xy.w, xy.x, xy.y, xy.z}) EXPECT_NEAR(part, 0.5, 1e-15);
  EXPECT_NEAR(clip.channels[1].rotation.at(0).x, std::sin(std::acos(-1.0) / 12), 1e-15);
}

TEST(Bvh, RefusesBrokenJoints) {
  expect_refused("", {"a.bvh: line 1", "HIERARCHY"});
  expect_refused("MOTION\nFrames: 1\n", {"'MOTION'", "HIERARCHY"});
  expect_refused("HIERARCHY\nMOTION\n", {"line 2", "at least one joint"});
  expect_refused("HIERARCHY\nJOINT a\n{\n", {"'JOINT'", "ROOT"});
  expect_refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n", {"(end of file)"});
  expect_refused("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\n", {"line 5", "CHANNELS", "'a'"});
  expect_refused("HIERARCHY\nROOT a\n{\nOFFSET 0 nan 0\n", {"'nan'", "coordinates"});
  expect_refused("HIERARCHY\nROOT a\n{\nCHANNELS 400000000 Xposition", {"400000000", "0 to 6"});
  expect_refused("HIERARCHY\nROOT a\n{\nCHANNELS -1\n", {"-1", "0 to 6"});
  expect_refused("HIERARCHY\nROOT a\n{\nCHANNELS 1 Wrotation\n", {"Wrotation", "Xposition"});
  expect_refused("HIERARCHY\nROOT \n{\n", {"a name"});
  expect_refused("HIERARCHY\nROOT a\n{\nCHANNELS 0\n}\nMOTION\nFrames: 1\n", {"channel"});

  std::string deep = "HIERARCHY\nROOT a\n{\n";
  for (int k = 0; k < 200000; ++k) deep += "JOINT a\n{\n";
  expect_refused(deep, {"10000 joints"});
}

TEST(Bvh, RefusesFramesThatTheFileDoesNotHold) {
  expect_refused(motion("-3", "0 0 0 0 0\n"), {"line 16", "'-3'", "frames"});
  expect_refused(motion("0", ""), {"'0'"});
  expect_refused(motion("4000000000", "0 0 0 0 0\n"), {"4000000000", "5 numbers"});
  expect_refused(motion("2", "0 0 0 0 0\n0 0 0 0"), {"(end of file)", "angle"});
  expect_refused(motion("1", "0 0 0 0 0\n0"), {"line 19", "end of the file after 1 frames"});
  expect_refused(motion("1", "0 0 inf 0 0\n"), {"'inf'", "angle"});
  expect_refused(motion("1", "1e300 0 0 0 0\n"), {"1e300", "coordinate"});
  expect_refused(kJoints + "MOTION\nFrames: 1\nFrame Time: 0\n0 0 0 0 0\n", {"'0'", "seconds"});
  expect_refused(kJoints + "MOTION\nFrames: 1\nFrame Time: nan\n0 0 0 0 0\n", {"'nan'"});
  expect_refused(kJoints, {"MOTION"});
}

TEST(Bvh, TheChildThatReadsSendsTheSame) {
  const std::string path = std::string(ICLOTH_TEST_FOLDER) + "/data/wave.bvh";
  const Rig rig = read_motion(path);
  EXPECT_EQ(rig.names.size(), 9u);
  EXPECT_EQ(rig.names.at(3), "mixamorig:LeftForeArm");
  EXPECT_EQ(rig.clips.at(0).duration, 1);
  EXPECT_EQ(rig.clips[0].channels.size(), 7u);
  EXPECT_THROW(read_motion(std::string(ICLOTH_TEST_FOLDER) + "/data/none.bvh"), InputError);
  EXPECT_THROW(read_motion(std::string(ICLOTH_TEST_FOLDER) + "/data/drape.obj"), InputError);
}

}  // namespace
}  // namespace icloth
