// The stages of every build behind one signature, so that one program can compare their lists.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene/scene.h"

namespace icloth::testing {

/// The state from which the stages start, in numbers that single precision holds.
struct StageStart {
  const Scene* scene = nullptr;
  std::vector<Vec3f> x0;        ///< start of the step [m] (vertices)
  std::vector<Vec3f> velocity;  ///< [m/s] (vertices)
  std::vector<Vec3f> x1;        ///< end of the step [m] (vertices)
  float dt = 0.01f;             ///< [s]
};

/// The pairs that the stages find, as ascending keys (kernels/stencil.h).
struct StageLists {
  using Keys = std::vector<std::uint64_t>;
  Keys candidates;         ///< broad phase around x0 and x0 + dt·velocity
  Keys contacts;           ///< proximity at x0
  Keys covered;            ///< broad phase around x0 → x1
  Keys impacts;            ///< CCD on x0 → x1, all candidates
  Keys later;              ///< CCD on the dirty vertices, which have moved half the way back to x0
  std::vector<float> toi;  ///< of `impacts`
};

}  // namespace icloth::testing

namespace icloth::cpu32 {
testing::StageLists run_stages(const testing::StageStart& start);
}
namespace icloth::cpu64 {
testing::StageLists run_stages(const testing::StageStart& start);
}
namespace icloth::cuda32 {  // only where the program has CUDA
testing::StageLists run_stages(const testing::StageStart& start);
}
