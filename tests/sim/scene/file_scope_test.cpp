// A scene opens the files of its own folder and those of the program, and no others.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/scene/material_io.h"
#include "sim/scene/scene_io.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTriangle =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
constexpr const char* kOutside = "expected a file below the scene's folder";

/// A folder with the scene, and beside it one with files of somebody else.
class FileScopeTest : public ::testing::Test {
 protected:
  FileScopeTest() {
    fs::create_directories(folder_.path("scene/sub"));
    fs::create_directories(folder_.path("other"));
    for (const char* name : {"scene/in.obj", "scene/sub/deep.obj", "other/out.obj"})
      folder_.write(name, kTriangle);
    folder_.write("other/out.json", R"({"base": "default"})");
  }

  /// Message of the refusal of a scene with such cloths and obstacles, "" where it is accepted.
  std::string refusal(const std::string& text, bool allow_outside = false) const {
    SceneLimits limits;
    limits.allow_outside = allow_outside;
    try {
      load_scene(folder_.write("scene/a.json", text), {}, limits);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  /// A scene whose cloth is in this file.
  static std::string mesh(const std::string& name) {
    return R"({"cloths": [{"mesh": ")" + name + R"("}]})";
  }

  void expect_outside(const std::string& text, const std::string& where,
                      const std::string& name) const {
    const std::string message = refusal(text);
    for (const std::string& part : {std::string("a.json: ") + where, "'" + name + "'",
                                    std::string(kOutside), std::string("--allow-outside")})
      EXPECT_NE(message.find(part), std::string::npos) << "no \"" << part << "\" in: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  TemporaryFolder folder_;
};

TEST_F(FileScopeTest, FilesBelowTheSceneAndOfTheProgramAreOpened) {
  EXPECT_EQ(refusal(mesh("in.obj")), "");
  EXPECT_EQ(refusal(mesh("sub/deep.obj")), "");
  EXPECT_EQ(refusal(mesh("sub/../in.obj")), "");
  EXPECT_EQ(refusal(mesh(folder_.path("scene/in.obj"))), "");
  EXPECT_EQ(refusal(mesh("bodies/pedestal.obj")), "");
  EXPECT_EQ(refusal(mesh(assets_folder() + "/bodies/pedestal.obj")), "");
}

TEST_F(FileScopeTest, WhatLiesElsewhereIsNamedAndRefused) {
  expect_outside(mesh("../other/out.obj"), "cloths[0].mesh", "../other/out.obj");
  const std::string absolute = folder_.path("other/out.obj");
  EXPECT_NE(refusal(mesh(absolute)).find("cloths[0].mesh"), std::string::npos);
  EXPECT_NE(refusal(mesh(absolute)).find(kOutside), std::string::npos);

  // Whether such a file exists is not told either.
  expect_outside(mesh("../other/none.obj"), "cloths[0].mesh", "../other/none.obj");
  EXPECT_NE(refusal(mesh("/etc/passwd")).find(kOutside), std::string::npos);
  EXPECT_NE(refusal(mesh("in.obj\\u0000/../../other/out.obj")).find(kOutside), std::string::npos);
}

TEST_F(FileScopeTest, LinksCountAsWhatTheyLeadTo) {
  fs::create_symlink(folder_.path("other/out.obj"), folder_.path("scene/link.obj"));
  fs::create_directory_symlink(folder_.path("other"), folder_.path("scene/shelf"));
  fs::create_symlink("in.obj", folder_.path("scene/alias.obj"));
  fs::create_symlink("round.obj", folder_.path("scene/round.obj"));
  expect_outside(mesh("link.obj"), "cloths[0].mesh", "link.obj");
  expect_outside(mesh("shelf/out.obj"), "cloths[0].mesh", "shelf/out.obj");
  EXPECT_EQ(refusal(mesh("alias.obj")), "");
  EXPECT_NE(refusal(mesh("round.obj")), "");

  // A scene in a folder that is reached by a link has that folder.
  fs::create_directory_symlink(folder_.path("scene"), folder_.path("linked"));
  ASSERT_EQ(refusal(mesh("alias.obj")), "");
  EXPECT_NO_THROW(load_scene(folder_.path("linked/a.json"), {}));
}

TEST_F(FileScopeTest, EveryKeyThatNamesAFileObeys) {
  const std::string cloth = R"({"cloths": [{"mesh": "in.obj")", end = "}]}";
  const std::string out = R"("../other/out.obj")", material = R"("../other/out.json")";
  expect_outside(cloth + R"(, "rest": )" + out + end, "cloths[0].rest", "../other/out.obj");
  expect_outside(cloth + R"(, "material": )" + material + end, "cloths[0].material",
                 "../other/out.json");
  expect_outside(cloth + R"(, "material": {"base": )" + material + "}" + end,
                 "cloths[0].material.base", "../other/out.json");
  expect_outside(R"({"cloths": [{"pattern": )" + material + end, "cloths[0].pattern",
                 "../other/out.json");
  const std::string body = cloth + R"(}], "obstacles": [{"mesh": )";
  expect_outside(body + out + end, "obstacles[0].mesh", "../other/out.obj");
  expect_outside(body + R"("in.obj", "animation": "../other/walk.pc2")" + end,
                 "obstacles[0].animation", "../other/walk.pc2");
}

TEST_F(FileScopeTest, ABaseOfAMaterialObeysFromItsOwnFolder) {
  folder_.write("scene/sub/soft.json", R"({"base": "../../other/out.json"})");
  folder_.write("scene/sub/stiff.json", R"({"base": "../plain.json"})");
  folder_.write("scene/plain.json", R"({"base": "default"})");
  const auto scene = [](const std::string& material) {
    return R"({"cloths": [{"mesh": "in.obj", "material": "sub/)" + material + R"("}]})";
  };
  EXPECT_EQ(refusal(scene("stiff.json")), "");
  const std::string message = refusal(scene("soft.json"));
  EXPECT_NE(message.find("soft.json: base"), std::string::npos) << message;
  EXPECT_NE(message.find(kOutside), std::string::npos) << message;

  // A name of a material is no path, and a material that the user names has a folder of its own.
  EXPECT_NE(refusal(R"({"cloths": [{"mesh": "in.obj", "material": "../bodies/x"}]})").find("known"),
            std::string::npos);
  EXPECT_NO_THROW(load_material(folder_.path("other/out.json"), ""));
  EXPECT_THROW(load_material(folder_.path("scene/sub/stiff.json"), ""), InputError);
}

TEST_F(FileScopeTest, AllowOutsideOpensAllOfThem) {
  EXPECT_EQ(refusal(mesh("../other/out.obj"), true), "");
  EXPECT_EQ(refusal(mesh(folder_.path("other/out.obj")), true), "");
  fs::create_symlink(folder_.path("other/out.obj"), folder_.path("scene/link.obj"));
  EXPECT_EQ(refusal(mesh("link.obj"), true), "");
}

TEST_F(FileScopeTest, AMeshThatTheUserNamesMayBeAnywhere) {
  EXPECT_NO_THROW(load_scene(folder_.path("other/out.obj"), {}));
}

TEST_F(FileScopeTest, NothingButRegularFilesIsOpened) {
  ASSERT_EQ(mkfifo(folder_.path("scene/fifo.obj").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(folder_.path("scene/fifo.json").c_str(), 0600), 0);
  fs::create_directory(folder_.path("scene/folder.obj"));
  fs::create_symlink("/dev/zero", folder_.path("scene/zero.obj"));
  EXPECT_NE(refusal(mesh("fifo.obj")).find("expected a file"), std::string::npos);
  EXPECT_NE(refusal(mesh("folder.obj")).find("expected a file"), std::string::npos);
  EXPECT_NE(refusal(mesh("zero.obj")).find(kOutside), std::string::npos);
  EXPECT_NE(refusal(mesh("zero.obj"), true).find("expected a file"), std::string::npos);
  const std::string cloth = R"({"cloths": [{"mesh": "in.obj", "material": "fifo.json"}]})";
  EXPECT_NE(refusal(cloth).find("expected a file"), std::string::npos);
  EXPECT_THROW(load_scene(folder_.path("scene/fifo.json"), {}), InputError);
}

}  // namespace
}  // namespace icloth
