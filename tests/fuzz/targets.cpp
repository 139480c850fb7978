#include "tests/fuzz/targets.h"

#include <algorithm>

namespace icloth::fuzz {

std::span<const Target> targets() {
  static constexpr Target kTargets[] = {
      {"scene", read_scene},
      {"material", read_material},
      {"recording", read_recording},
      {"camera", read_camera},
      {"obj", read_obj},
      {"ply", read_ply},
      {"pc2", read_pc2},
      {"mdd", read_mdd},
      {"query", read_query},
      {"pattern", read_pattern_json},
      {"dxf", read_dxf},
      {"body", read_body_answer},
  };
  return kTargets;
}

const Target* find_target(std::string_view name) {
  const auto all = targets();
  const auto found = std::ranges::find(all, name, &Target::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace icloth::fuzz
