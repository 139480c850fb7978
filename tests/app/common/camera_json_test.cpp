// Cameras go through the clipboard unchanged, and other text is refused.
#include "app/common/camera_json.h"

#include <gtest/gtest.h>

namespace icloth {
namespace {

TEST(CameraJson, ACameraReadsBackAsItWas) {
  CameraPose pose;
  pose.name = "close \"up\"";
  pose.eye = {0.1, 1.0 / 3, -2.5};
  pose.target = {1e-3, 4, 5};
  pose.fov = 28.5;
  const auto back = camera_from_json(camera_to_json(pose));
  ASSERT_TRUE(back.has_value());
  EXPECT_TRUE(back->eye == pose.eye);
  EXPECT_TRUE(back->target == pose.target);
  EXPECT_EQ(back->fov, pose.fov);
}

TEST(CameraJson, RefusesWhatIsNoCamera) {
  for (const char* text :
       {"", "hello", "[1, 2]", "{}", R"({"eye": [0, 0, 1]})",
        R"({"eye": [0, 0], "target": [0, 0, 0]})", R"({"eye": [0, 0, "1"], "target": [0, 0, 0]})",
        R"({"eye": [0, 0, 1e300], "target": [0, 0, 0]})",
        R"({"eye": [1, 1, 1], "target": [1, 1, 1]})",
        R"({"eye": [0, 0, 1], "target": [0, 0, 0], "fov": 0})"}) {
    EXPECT_FALSE(camera_from_json(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace icloth
