// A motion of another skeleton that an obstacle of a scene file plays: "animation": "walk.bvh".
#pragma once

#include "sim/bodies/rig.h"
#include "sim/scene/scene_json.h"

namespace icloth {

/// The body that a motion is for.
struct MovedBody {
  std::string name;  ///< of the obstacle, for notes
  std::string file;  ///< for messages
  Vec3d up;          ///< in the space of the file
};

/// Reads the motion file that "animation" names and makes a clip for a rig of it. "bones" pairs
/// joints of the motion with nodes of the rig that have other names. Notes say which joints have no
/// partner. Throws InputError where too few have one.
Clip clip_of_motion(JsonObject& object, const SceneFolder& folder, const MovedBody& body,
                    const Rig& rig);

}  // namespace icloth
