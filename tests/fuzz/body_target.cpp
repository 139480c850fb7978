// The answer of the process that reads bodies. It has read a hostile file, so its bytes are not
// trusted either.
#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/bodies/skinned_poses.h"
#include "sim/files/body_transport.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace icloth::fuzz {
namespace {

constexpr const char* kName = "fuzz.glb";

/// Every clip puts every vertex somewhere, at its start and its end and beyond.
void require_poses(const Body& body) {
  const auto rig = std::make_shared<const Rig>(body.rig);
  std::vector<Vec3d> positions;
  for (std::size_t c = 0; c < rig->clips.size(); ++c) {
    const double duration = rig->clips[c].duration;
    const SkinnedPoses poses(rig, c, {.loop = true}, {});
    for (const double time : {0.0, 0.4 * duration, duration, 2.5 * duration}) {
      poses.pose(time, positions);
      require(positions.size() == body.mesh.positions.size(), "a place for every vertex");
      require_finite(positions);
    }
  }
}

}  // namespace

std::string read_body_answer(std::string_view bytes) {
  Body body;
  const std::string reason = refusal([&] { body = decode_body(bytes, kName); });
  if (!reason.empty()) return reason;
  require_valid(body.mesh);
  if (!body.rig.empty()) require_poses(body);

  // What was accepted can be sent again, and is the same then.
  const std::string again = encode_body(body);
  require(encode_body(decode_body(again, kName)) == again, "the same body again");
  return "";
}

}  // namespace icloth::fuzz
