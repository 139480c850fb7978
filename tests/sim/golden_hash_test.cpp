// One golden hash a scene: the bits of all positions and velocities after a short run. They must
// not depend on the number of threads, the compiler or its optimisation;
// tests/determinism_matrix.sh runs this test in builds of two compilers. A hash changes only with a
// commit that says why.
//
// ICLOTH_UPDATE_GOLDEN=1 writes the hashes of this build to tests/goldens/hashes.txt.
#include <gtest/gtest.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "sim/scene/input.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"

namespace icloth {
namespace {

constexpr int kSteps = 100;

struct GoldenScene {
  const char* name;
  const char* triangles;  ///< of all of its cloths together
};
constexpr GoldenScene kScenes[] = {{"scarf", "600"},  {"sphere", "900"}, {"twisting", "600"},
                                   {"funnel", "450"}, {"drape", "300"},  {"flag", "500"}};

std::string golden_file() { return std::string(ICLOTH_TEST_FOLDER) + "/goldens/hashes.txt"; }

/// The lines "SCENE BUILD HASH" of the file.
std::map<std::string, std::string> golden_hashes() {
  std::map<std::string, std::string> hashes;
  std::ifstream file(golden_file());
  for (std::string scene, build, hash; file >> scene >> build >> hash;)
    hashes[scene + " " + build] = hash;
  return hashes;
}

/// The hash after kSteps steps with the scene's scripted hands, as 16 hexadecimal digits.
std::string hash_after_run(const GoldenScene& golden, Build build, int threads) {
  set_thread_count(threads);
  const std::string triangles = std::string("triangles=") + golden.triangles;
  const auto scene = load_scene(golden.name, std::vector<std::string>{triangles});
  const auto simulator = make_simulator(build, scene);

  ScriptedInput script(*scene);
  for (int step = 0; step < kSteps; ++step)
    simulator->step(script.events(simulator->time(), simulator->parameters().step.time_step));
  set_thread_count(0);

  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, simulator->state_hash());
  return text;
}

class GoldenHash : public ::testing::TestWithParam<GoldenScene> {};

TEST_P(GoldenHash, IsTheSameForAllThreadCountsCompilersAndOptimisations) {
  static const bool update = std::getenv("ICLOTH_UPDATE_GOLDEN") != nullptr;
  auto hashes = golden_hashes();

  for (const Build build : {Build::cpu32, Build::cpu64}) {
    const std::string key = std::string(GetParam().name) + " " + std::string(build_name(build));
    const std::string hash = hash_after_run(GetParam(), build, 1);
    for (const int threads : {2, 8})
      EXPECT_EQ(hash_after_run(GetParam(), build, threads), hash) << key;
    if (update)
      hashes[key] = hash;
    else
      EXPECT_EQ(hash, hashes[key]) << key;
  }

  if (!update) return;
  std::ofstream file(golden_file());
  for (const auto& [key, hash] : hashes) file << key << " " << hash << "\n";
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenHash, ::testing::ValuesIn(kScenes),
                         [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
}  // namespace icloth
