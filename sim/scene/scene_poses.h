// What an obstacle of a scene file plays: a clip of its body, or a point cache.
#pragma once

#include "sim/files/body_io.h"
#include "sim/scene/scene_json.h"

namespace icloth {

/// A body as the scene places it.
struct PlacedBody {
  std::string file;  ///< for messages
  Affine place;      ///< from the space of the file to that of the scene
  double offset;     ///< of its skin [m]
  Vec3d up;          ///< in the space of the file
};

/// Sets the poses of an obstacle from the keys "clip", "animation", "bones", "frame_rate", "start",
/// "speed", "loop" and "blend_in". `body`: its mesh placed, its rig as in the file, which is taken.
void parse_poses(JsonObject& object, const SceneFolder& folder, const PlacedBody& placed,
                 Body& body, Obstacle& obstacle);

}  // namespace icloth
