// How vertices reach OpenGL. Everything around interop is tested with a writer that is none of
// CUDA's; interop itself only where OpenGL draws on a CUDA device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "app/session/session.h"
#include "render/cuda_vertices.h"
#include "render/gl_context_egl.h"
#include "render/renderer.h"
#include "sim/cuda_devices.h"
#include "sim/files/error.h"
#include "tests/support/fake_device.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::FakeDevicePositions;

constexpr int kWidth = 200, kHeight = 150;

/// A sheet that falls on a ball.
std::shared_ptr<const Scene> small_scene() {
  auto scene = std::make_shared<Scene>();
  scene->name = "sheet on a ball";
  scene->cloths.push_back(testing::make_sheet(testing::lying(0.5, 900), {0, 0.16, 0}));
  scene->obstacles.push_back(testing::make_obstacle(make_sphere(0.15, 600), {0, 0, 0}));
  return scene;
}

Camera camera() { return Camera({"test", {0.5, 0.6, 0.9}, {0, 0.1, 0}, {0, 1, 0}, 40}); }

::testing::AssertionResult same_bits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  if (a.size() != b.size()) return ::testing::AssertionFailure() << "lengths differ";
  if (std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0)
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "bits differ";
}

struct Content {
  std::vector<Vec3f> positions, normals;
};

Content content_of(const VertexBuffers& buffers) {
  const auto count = static_cast<std::size_t>(buffers.vertices());
  Content content{std::vector<Vec3f>(count), std::vector<Vec3f>(count)};
  buffers.read_back(content.positions, content.normals);
  return content;
}

/// A record of a fake writer, for tests to read after the renderer took it.
struct Log {
  int made = 0, written = 0, destroyed = 0;
  int fail_at = -1;  ///< this write fails, counted from 0
};

class FakeWriter final : public VertexWriter {
 public:
  FakeWriter(const VertexFaces& faces, const VertexBuffers& buffers, Log& log)
      : faces_(faces), buffers_(buffers), log_(log) {}
  ~FakeWriter() override { ++log_.destroyed; }

  std::string write(const DevicePositions& from) override {
    if (!from.failure.empty()) return from.failure;
    if (log_.written == log_.fail_at) return "mapping the buffers failed: out of order";
    ++log_.written;
    buffers_.fill_from_host(faces_, {from.data, static_cast<std::size_t>(from.count)});
    return {};
  }
  std::string place() const override { return "fake device"; }

 private:
  const VertexFaces& faces_;
  const VertexBuffers& buffers_;
  Log& log_;
};

MakeVertexWriter fake_maker(Log& log) {
  return [&log](const VertexFaces& faces, const VertexBuffers& buffers, int) {
    ++log.made;
    return MadeWriter{std::make_unique<FakeWriter>(faces, buffers, log), {}};
  };
}

MakeVertexWriter failing_maker(Log& log) {
  return [&log](const VertexFaces&, const VertexBuffers&, int) {
    ++log.made;
    return MadeWriter{nullptr, "injected"};
  };
}

class Interop : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      context_ = make_egl_context();
    } catch (const DeviceError& error) {
      GTEST_SKIP() << error.what();
    }
    world_ = make_world(*small_scene());
    for (const Vec3d p : world_.position) positions_.push_back(convert<float>(p));
    on_device_.assign(positions_);
  }

  Image picture(Renderer& renderer, const DevicePositions* on_device) const {
    Frame frame;
    frame.positions = positions_;
    frame.on_device = on_device;
    return renderer.picture(frame, camera(), kWidth, kHeight);
  }
  Image host_picture() const {
    Renderer renderer(world_, {.on_device = false});
    return picture(renderer, nullptr);
  }
  /// Other positions on host and device.
  void move() {
    for (Vec3f& p : positions_) p = p + Vec3f{0.01f, 0.02f * p.x, 0};
    on_device_.assign(positions_);
  }

  std::unique_ptr<GlContext> context_;
  World world_;
  std::vector<Vec3f> positions_;
  FakeDevicePositions on_device_;
};

TEST_F(Interop, HostCopiesWhatASolverOnTheCpuTells) {
  SharedVertices vertices(world_);
  vertices.update(positions_, nullptr);
  EXPECT_EQ(vertices.path_text(), "host copy (the solver runs on the CPU)");
  Content packed{positions_, positions_};
  pack_vertices(vertex_faces(world_.vertices, world_.face), positions_, packed.positions.data(),
                packed.normals.data());
  const Content content = content_of(vertices.buffers());
  EXPECT_TRUE(same_bits(content.positions, packed.positions));
  EXPECT_TRUE(same_bits(content.normals, packed.normals));
}

TEST_F(Interop, HostCopiesWhenAskedTo) {
  Log log;
  Renderer renderer(world_, {.on_device = false, .make_writer = fake_maker(log)});
  picture(renderer, &on_device_);
  EXPECT_EQ(renderer.upload_path(), "host copy (asked for)");
  EXPECT_EQ(log.made, 0);
}

TEST_F(Interop, AFailingProbeFallsBackAndIsNotRepeated) {
  Log log;
  Renderer renderer(world_, {.make_writer = failing_maker(log)});
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(picture(renderer, &on_device_).pixels, host_picture().pixels);
    EXPECT_EQ(renderer.upload_path(), "host copy (injected)");
    EXPECT_FALSE(renderer.shares_vertices());
    move();
  }
  EXPECT_EQ(log.made, 1);
}

TEST_F(Interop, AWriterDrawsWhatTheHostWouldDraw) {
  Log log;
  {
    Renderer renderer(world_, {.make_writer = fake_maker(log)});
    for (int frame = 0; frame < 3; ++frame) {
      const Image image = picture(renderer, &on_device_);
      EXPECT_EQ(image.pixels, host_picture().pixels);
      move();
      EXPECT_NE(image.pixels, host_picture().pixels) << "the test must see a difference";
    }
    EXPECT_EQ(renderer.upload_path(), "CUDA-OpenGL interop (fake device)");
    EXPECT_TRUE(renderer.shares_vertices());
    EXPECT_EQ(log.destroyed, 0);
  }
  EXPECT_EQ(log.made, 1);
  EXPECT_EQ(log.written, 3);
  EXPECT_EQ(log.destroyed, 1);
}

TEST_F(Interop, ALaterFailureFallsBackForGoodInTheSameFrame) {
  Log log;
  log.fail_at = 2;
  Renderer renderer(world_, {.make_writer = fake_maker(log)});
  for (int frame = 0; frame < 5; ++frame) {
    EXPECT_EQ(picture(renderer, &on_device_).pixels, host_picture().pixels);
    EXPECT_EQ(renderer.shares_vertices(), frame < 2);
    move();
  }
  EXPECT_EQ(renderer.upload_path(), "host copy (mapping the buffers failed: out of order)");
  EXPECT_EQ(log.made, 1);
  EXPECT_EQ(log.written, 2);
  EXPECT_EQ(log.destroyed, 1) << "the buffers must be let go before the host maps them";
}

TEST_F(Interop, PositionsThatCouldNotBeCopiedFallBack) {
  Log log;
  Renderer renderer(world_, {.make_writer = fake_maker(log)});
  on_device_.failure = "CUDA: out of memory";
  EXPECT_EQ(picture(renderer, &on_device_).pixels, host_picture().pixels);
  EXPECT_EQ(renderer.upload_path(), "host copy (CUDA: out of memory)");
}

TEST_F(Interop, FramesWithoutDevicePositionsLetTheBuffersGo) {
  Log log;
  Renderer renderer(world_, {.make_writer = fake_maker(log)});
  picture(renderer, &on_device_);
  EXPECT_EQ(picture(renderer, nullptr).pixels, host_picture().pixels);
  EXPECT_EQ(log.destroyed, 1);
  EXPECT_EQ(renderer.upload_path(), "host copy (the solver runs on the CPU)");
  picture(renderer, &on_device_);
  EXPECT_TRUE(renderer.shares_vertices());
}

TEST_F(Interop, TheRealProbeSaysInOneLineWhyNot) {
  std::string reason;
  if (gl_runs_on_cuda(0, reason)) GTEST_SKIP() << "OpenGL draws on CUDA device 0";
  const std::string where = reason;
  EXPECT_FALSE(where.empty());
  EXPECT_EQ(where.find('\n'), std::string::npos);
  if (cuda_device_count() == 0) {
    EXPECT_TRUE(where == "no CUDA device" || where.starts_with("built without ")) << where;
  } else if (gl_is_software()) {
    EXPECT_NE(where.find("OpenGL runs on llvmpipe, not on "), std::string::npos) << where;
  }
  EXPECT_FALSE(interop_works(0, reason));
  EXPECT_EQ(reason, where);
  Renderer renderer(world_);
  EXPECT_EQ(picture(renderer, &on_device_).pixels, host_picture().pixels);
  EXPECT_EQ(renderer.upload_path(), "host copy (" + where + ")");
  EXPECT_NO_THROW(check_gl("the probe"));
}

TEST(InteropWithoutAWindow, SolversOnTheCpuShareNoPositionsOfADevice) {
  for (const Build build : {Build::cpu32, Build::cpu64}) {
    std::unique_ptr<DevicePositions> slot = std::make_unique<FakeDevicePositions>();
    make_simulator(build, small_scene())->positions_on_device(slot);
    EXPECT_EQ(slot, nullptr) << build_name(build);
  }
}

TEST(InteropWithoutAWindow, EglDevicesOfCudaComeFirstAndTheWantedNumberBeforeAll) {
  using Order = std::vector<std::size_t>;
  const int numbers[] = {kNone, 1, 0, kNone, 2};
  EXPECT_EQ(egl_order(numbers, 0), (Order{2, 1, 4, 0, 3}));
  EXPECT_EQ(egl_order(numbers, 2), (Order{4, 1, 2, 0, 3}));
  EXPECT_EQ(egl_order(numbers, 7), (Order{1, 2, 4, 0, 3}));
  EXPECT_EQ(egl_order(numbers, kNone), (Order{0, 1, 2, 3, 4}));
  EXPECT_TRUE(egl_order({}, 0).empty());
}

// ---- on a device --------------------------------------------------------------------------------

/// The words by which a test says that it could not run, with why.
std::string no_device(const std::string& reason) {
  return reason.starts_with("no device") ? reason : "no device: " + reason;
}

class InteropOnDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    if (!build_available(Build::cuda32, &reason)) GTEST_SKIP() << no_device(reason);
    try {
      context_ = make_egl_context(cuda_device());
    } catch (const DeviceError& error) {
      GTEST_SKIP() << no_device(error.what());
    }
    if (!gl_runs_on_cuda(cuda_device(), reason)) GTEST_SKIP() << no_device(reason);
    scene_ = small_scene();
    world_ = make_world(*scene_);
  }

  std::unique_ptr<GlContext> context_;
  std::shared_ptr<const Scene> scene_;
  World world_;
};

TEST_F(InteropOnDevice, TheProbePasses) {
  std::string reason;
  EXPECT_TRUE(interop_works(cuda_device(), reason)) << reason;
  EXPECT_NO_THROW(check_gl("the probe"));
}

TEST_F(InteropOnDevice, BothWaysDrawEqualPixels) {
  const std::unique_ptr<Simulator> simulator = make_simulator(Build::cuda32, scene_);
  Renderer shared(world_), copied(world_, {.on_device = false});
  std::unique_ptr<DevicePositions> on_device;
  std::vector<Vec3f> positions;
  for (int step = 0; step < 5; ++step) {
    for (int k = 0; k < 10; ++k) simulator->step({});
    simulator->positions_on_device(on_device);
    simulator->positions(positions);
    ASSERT_NE(on_device, nullptr);
    Frame frame;
    frame.positions = positions;
    const Image expected = copied.picture(frame, camera(), kWidth, kHeight);
    frame.on_device = on_device.get();
    EXPECT_EQ(shared.picture(frame, camera(), kWidth, kHeight).pixels, expected.pixels);
    EXPECT_TRUE(shared.shares_vertices()) << shared.upload_path();
    EXPECT_FALSE(copied.shares_vertices());
  }
}

TEST_F(InteropOnDevice, BothWaysGiveEqualBits) {
  const std::unique_ptr<Simulator> simulator = make_simulator(Build::cuda32, scene_);
  SharedVertices shared(world_), copied(world_, {.on_device = false});
  std::unique_ptr<DevicePositions> on_device;
  std::vector<Vec3f> positions;
  for (int step = 0; step < 20; ++step) {
    simulator->step({});
    simulator->positions_on_device(on_device);
    simulator->positions(positions);
    shared.update(positions, on_device.get());
    copied.update(positions, nullptr);
    ASSERT_EQ(shared.path(), SharedVertices::Path::interop) << shared.path_text();
    const Content a = content_of(shared.buffers()), b = content_of(copied.buffers());
    EXPECT_TRUE(same_bits(a.positions, positions));
    EXPECT_TRUE(same_bits(a.positions, b.positions));
    EXPECT_TRUE(same_bits(a.normals, b.normals));
  }
}

/// The solver goes on while its states are drawn: what is drawn is one state, never half of two.
TEST_F(InteropOnDevice, DrawsWholeStatesWhileTheSolverRuns) {
  SessionOptions options;
  options.real_time = false;
  Session session(make_simulator(Build::cuda32, scene_), options);
  SharedVertices vertices(world_);
  session.play();
  int seen = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(4);  // a hang
  while (seen < 100 && std::chrono::steady_clock::now() < end) {
    if (!session.take()) continue;
    ++seen;
    const PublishedState& state = session.state();
    vertices.update(state.positions, state.on_device.get());
    ASSERT_EQ(vertices.path(), SharedVertices::Path::interop) << vertices.path_text();
    ASSERT_TRUE(same_bits(content_of(vertices.buffers()).positions, state.positions));
  }
  EXPECT_EQ(seen, 100);
}

}  // namespace
}  // namespace icloth
