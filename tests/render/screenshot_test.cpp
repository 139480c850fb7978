// Renderer goldens: a frozen state, one frame. The solver has no part in them.
#include <gtest/gtest.h>

#include <memory>

#include "render/gl_context_egl.h"
#include "render/renderer.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/shapes.h"
#include "tests/support/golden.h"

namespace icloth {
namespace {

constexpr int kWidth = 480, kHeight = 360;

/// A square of cloth over a ball on a stand, frozen in tests/data/drape.obj.
Scene drape_scene() {
  Scene scene;
  Cloth cloth;
  cloth.name = "square";
  cloth.mesh = read_mesh(std::string(ICLOTH_TEST_FOLDER) + "/data/drape.obj").mesh;
  cloth.rest = cloth.mesh.positions;
  scene.cloths.push_back(cloth);
  const auto add = [&scene](const char* name, TriangleMesh mesh, double y) {
    for (Vec3d& p : mesh.positions) p.y += y;
    Obstacle obstacle;
    obstacle.name = name;
    obstacle.mesh = std::move(mesh);
    scene.obstacles.push_back(std::move(obstacle));
  };
  add("ball", make_sphere(0.25, 1200), 0);
  add("stand", make_box({0.2, 0.06, 0.2}, 0.1), -0.27);
  return scene;
}

CameraPose drape_pose() { return {"test", {0.55, 0.55, 1.25}, {0.02, -0.06, 0}, {0, 1, 0}, 38}; }

class Screenshot : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      context_ = make_egl_context();
    } catch (const DeviceError& error) {
      GTEST_SKIP() << error.what();
    }
    if (!gl_is_software()) tolerance_ = {.fraction = 0.015, .blob_pixels = 200};
    world_ = make_world(drape_scene());
    for (const Vec3d p : world_.position) positions_.push_back(convert<float>(p));
    renderer_ = std::make_unique<Renderer>(world_);
    frame_.positions = positions_;
  }
  void TearDown() override { renderer_.reset(); }  // before its context

  Image picture(const Camera& camera) {
    return renderer_->picture(frame_, camera, kWidth, kHeight);
  }

  /// The golden must tell the picture from a neighbour: one that is only a little different.
  void expect_other(const Image& neighbour, const std::string& golden) {
    const ImageDifference difference =
        compare(neighbour, read_png(golden_path(golden)), tolerance_);
    EXPECT_FALSE(difference.accepted(tolerance_))
        << golden << " takes a neighbour for itself: " << difference.text();
  }

  std::unique_ptr<GlContext> context_;
  ImageTolerance tolerance_;
  World world_;
  std::vector<Vec3f> positions_;
  std::unique_ptr<Renderer> renderer_;
  Frame frame_;
};

TEST_F(Screenshot, FabricInTheStudio) {
  renderer_->set_quality(Quality::still);
  Camera camera(drape_pose());
  EXPECT_TRUE(matches_golden("drape_still", picture(camera), tolerance_));
  renderer_->set_quality(Quality::interactive);
  expect_other(picture(camera), "drape_still");
  renderer_->set_quality(Quality::draft);
  camera.orbit(1, 0, kHeight, 0);
  expect_other(picture(camera), "drape_still");
}

TEST_F(Screenshot, StrainWithHandlesAndMarkers) {
  const std::vector<HandleState> handles{
      {{.id = 1, .target = world_.position[0] + Vec3d{0.16, 0.02, 0.02}}, world_.position[0], 0.15},
      {{.id = 2, .target = world_.position[30] + Vec3d{0.1, 0.2, 0.1}}, world_.position[30], 0.95}};
  const std::vector<Index> marked{940, 941, 942, 943, 944}, pins{600, 602, 604};
  const std::vector<Vec3f> hover{positions_[500]};
  frame_.handles = handles;
  frame_.marked_faces = marked;
  frame_.marked_vertices = pins;
  frame_.hover = hover;
  frame_.view = ViewMode::strain;
  frame_.strain_range = 0.05;
  const Camera camera(drape_pose());
  EXPECT_TRUE(matches_golden("drape_strain", picture(camera), tolerance_));
  frame_.strain_range = 0.06;
  expect_other(picture(camera), "drape_strain");
  frame_.strain_range = 0.05;
  frame_.marked_faces = {};
  expect_other(picture(camera), "drape_strain");
}

TEST_F(Screenshot, GoldensDifferFromEachOther) {
  expect_other(read_png(golden_path("drape_strain")), "drape_still");
}

TEST_F(Screenshot, SamePictureTwiceIsEqualInEveryByte) {
  const Camera camera(drape_pose());
  const Image first = picture(camera);
  Camera elsewhere(drape_pose());
  elsewhere.dolly(2);
  picture(elsewhere);
  EXPECT_EQ(picture(camera).pixels, first.pixels);
}

TEST_F(Screenshot, OddSizesAreFilledWhole) {
  for (const int width : {1, 17, 333}) {
    const Image image = renderer_->picture(frame_, Camera(drape_pose()), width, 31);
    for (std::size_t k = 3; k < image.pixels.size(); k += 4) ASSERT_EQ(image.pixels[k], 255);
    EXPECT_GT(image.at(0, 0)[0], 100);  // the backdrop is light, up to the corners
    EXPECT_GT(image.at(width - 1, 30)[0], 100);
  }
}

}  // namespace
}  // namespace icloth
