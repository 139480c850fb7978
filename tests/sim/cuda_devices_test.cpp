// Which CUDA device is used, and what is said where none can be.
#include "sim/cuda_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

#include "kernels/parallel/device_problem.h"
#include "sim/files/error.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

/// The choice is the program's; every test starts from device 0.
class CudaDevices : public ::testing::Test {
 protected:
  void TearDown() override { set_cuda_device(0); }
};

std::shared_ptr<Scene> sheet_scene() {
  auto scene = std::make_shared<Scene>();
  scene->cloths.push_back(testing::make_sheet(testing::lying(0.2, 60), {}));
  return scene;
}

bool one_line(const std::string& text) {
  return !text.empty() && text.find('\n') == std::string::npos;
}

TEST(DeviceProblem, NamesDeviceAndWhatIsNeeded) {
  constexpr std::array built = {75, 80, 90};
  EXPECT_EQ(no_code_problem(0, "GeForce GTX 1080", 61, built, 13000),
            "CUDA device 0 'GeForce GTX 1080' has compute capability 6.1; this program needs 7.5 "
            "or later (CUDA 12 builds can include it)");
  EXPECT_EQ(no_code_problem(1, "Tesla K40m", 35, built, 13000),
            "CUDA device 1 'Tesla K40m' has compute capability 3.5; this program needs 7.5 or "
            "later");
  constexpr std::array hopper = {90};
  EXPECT_EQ(no_code_problem(0, "A100", 80, hopper, 12040),
            "CUDA device 0 'A100' has compute capability 8.0; this program needs 9.0 or later");
  constexpr std::array turing = {75};
  EXPECT_EQ(no_code_problem(0, "B", 120, turing, 13000),
            "CUDA device 0 'B' has compute capability 12.0, for which this program holds no code; "
            "it was built for 7.5");
}

TEST(DeviceProblem, TellsAMissingDriverFromAnOldOne) {
  EXPECT_EQ(no_device_problem(0, 13000, "x"), "no device: there is no NVIDIA driver");
  EXPECT_EQ(no_device_problem(12040, 13000, "x"),
            "no device: the NVIDIA driver is for CUDA 12.4, this program needs one for CUDA 13.0 "
            "or later");
  EXPECT_EQ(no_device_problem(12020, 12040, "x"), "no device: x");
}

TEST(DeviceProblem, SaysWhichOrdinalsThereAre) {
  EXPECT_EQ(no_such_device_problem(3, 1),
            "there is no CUDA device 3, the driver shows only cuda:0");
  EXPECT_EQ(no_such_device_problem(3, 2),
            "there is no CUDA device 3, the driver shows cuda:0 to cuda:1");
}

TEST_F(CudaDevices, SystemCountAndUseAgree) {
  const CudaSystem system = cuda_system();
  std::string reason;
  EXPECT_EQ(cuda_device_count(&reason), static_cast<int>(system.devices.size()));
  EXPECT_EQ(system.devices.empty(), one_line(system.problem));
  EXPECT_EQ(reason, system.problem);
  for (const CudaDevice& device : system.devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_GE(device.capability, 20);
    EXPECT_GT(device.memory, 0);
    std::string problem;
    EXPECT_EQ(cuda_device_usable(device.ordinal, &problem), device.problem.empty());
    EXPECT_EQ(problem, device.problem);
  }
}

TEST_F(CudaDevices, AMissingOneIsRefusedInOneLine) {
  for (const int ordinal : {-1, 1000}) {
    std::string reason;
    EXPECT_FALSE(cuda_device_usable(ordinal, &reason));
    EXPECT_TRUE(one_line(reason)) << reason;
    set_cuda_device(ordinal);
    EXPECT_EQ(cuda_device(), ordinal);
    EXPECT_FALSE(build_available(Build::cuda32));
    EXPECT_TRUE(build_available(Build::cpu32));
    EXPECT_THROW(make_simulator(Build::cuda32, sheet_scene()), DeviceError);
  }
}

TEST_F(CudaDevices, BandwidthIsThatOfADevice) {
  std::string reason;
  if (!cuda_device_usable(0, &reason)) GTEST_SKIP() << reason;
  const double bandwidth = measure_copy_bandwidth(0);

  // The unit is B/s: an emulated device on a busy machine is as slow as a disk, none is faster.
  EXPECT_GT(bandwidth, 1e8);
  EXPECT_LT(bandwidth, 1e14);
}

/// A simulator stays on its device, whichever is chosen later and whichever thread calls it.
TEST_F(CudaDevices, ASimulatorKeepsItsOwn) {
  std::string reason;
  if (!build_available(Build::cuda32, &reason)) GTEST_SKIP() << reason;
  const auto simulator = make_simulator(Build::cuda32, sheet_scene());
  set_cuda_device(1000);
  std::uint64_t hash = 0;
  std::jthread([&] { hash = simulator->step({}).state_hash; }).join();
  EXPECT_EQ(simulator->state_hash(), hash);
}

}  // namespace
}  // namespace icloth
