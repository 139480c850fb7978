// A scene as the user describes it: const while it is simulated. SI units, Y up.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/bodies/pose_source.h"
#include "sim/bodies/rigid_motion.h"
#include "sim/bodies/skinned_poses.h"
#include "sim/files/mesh.h"
#include "sim/scene/garment.h"
#include "sim/scene/material.h"
#include "sim/scene/parameters.h"
#include "sim/scene/seam.h"

namespace icloth {

struct Cloth {
  std::string name;
  TriangleMesh mesh;        ///< start state
  std::vector<Vec3d> rest;  ///< rest positions [m] (V), the start state's where none were given
  /// The rest shape is the material space, mesh.uv in metres, in place of `rest`. Panels that are
  /// sewn together have no rest shape in space.
  bool rest_in_uv = false;
  Material material;
  bool flat_angles = false;  ///< rest angles are 0, whatever folds the rest shape has
  std::vector<Index> pins;   ///< vertices held where they start
  /// Coulomb coefficient of the cloth on itself and on other cloths, in place of the parameter
  /// proximity.friction_cloth; between two cloths that have one, the geometric mean.
  std::optional<double> friction;
};

struct Obstacle {
  std::string name;
  TriangleMesh mesh;                        ///< pose at rest
  std::shared_ptr<const PoseSource> poses;  ///< clip or point cache; null: the mesh at all times
  std::vector<Keyframe> motion;             ///< of the whole body, sorted by time; empty: none
  /// Coulomb coefficient of cloth on it, in place of the parameter proximity.friction_obstacle.
  std::optional<double> friction;

  bool moves() const { return motion.size() > 1 || (poses && poses->moves()); }
  /// Vertex positions at a time [s]; written to out (V).
  void pose(double time, std::vector<Vec3d>& out) const;
  /// The body as bones move it, null where they do not.
  const SkinnedPoses* skinned() const { return poses ? poses->skinned() : nullptr; }
  /// Of a skinned body: the bones at a time [s], keyframes included.
  SkinPose skin_pose(double time) const;
};

struct PathPoint {
  double time;   ///< [s]
  Vec3d target;  ///< [m]
};

/// A grab the scene file performs by itself: a patch around `vertex` follows the path.
struct ScriptedGrab {
  Index cloth = 0;
  Index vertex = 0;
  double radius = 0;              ///< [m]; 0: the parameter grab.radius
  double stiffness = 0;           ///< [N/m]; 0: the parameter grab.stiffness
  double start = 0, release = 0;  ///< [s]
  std::vector<PathPoint> path;    ///< absolute targets, linear in between, sorted by time
};

struct CameraPose {
  std::string name = "default";
  Vec3d eye{0, 1.2, 2.5}, target{0, 1, 0}, up{0, 1, 0};
  double fov = 35;  ///< vertical [degrees]
};

/// The outcome of repairing a start state (sim/scene/repair.h).
struct StartRepair {
  std::size_t pairs_before = 0, pairs_left = 0;  ///< intersecting pairs of faces
  std::size_t moved = 0;                         ///< vertices that are somewhere else now
  double largest_move = 0;                       ///< [m]
};

struct Scene {
  std::string name;
  std::string source;     ///< path or built-in name it was loaded from
  double duration = 10;   ///< [s]
  Parameters parameters;  ///< defaults overlaid with the scene's own
  std::vector<Cloth> cloths;
  std::vector<Garment> garments;  ///< what is known of the cloths that are sewn, in their order
  std::vector<Seam> seams;        ///< that are open at the start
  std::vector<Obstacle> obstacles;
  std::vector<ScriptedGrab> input;
  std::vector<CameraPose> cameras;
  std::optional<StartRepair> repair;  ///< where it was asked for
};

}  // namespace icloth
