// The hands that hold the cloth: grabbed patches, their springs and targets.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/input.h"
#include "sim/scene/world.h"

namespace icloth {

/// A vertex that hands pull.
struct HandSpring {
  Index vertex;
  double stiffness;  ///< [N/m]
  Vec3d target;      ///< [m]
};

class Hands {
 public:
  explicit Hands(const World& world) : world_(&world) {}

  /// Applies grabs, moves and releases; `positions` (≥ cloth_vertices) is the present state [m].
  /// A grab of a face that does not exist and a move of a handle that is not held are ignored.
  void apply(std::span<const InputEvent> events, const Parameters& parameters,
             std::span<const Vec3d> positions);

  /// Corners of the faces that were hit, three a hand: all that the rest has to know of the state.
  std::vector<Index> watched() const;

  /// Moves the followed targets on by at most grab_max_speed · dt and limits the pull. `corners`:
  /// positions of the watched vertices [m].
  void advance(double dt, const Parameters& parameters, std::span<const Vec3d> corners);

  void clear() { held_.clear(); }
  bool empty() const { return held_.empty(); }

  /// One spring for each pulled vertex, by ascending vertex.
  std::vector<HandSpring> springs() const;

  /// `corners`: positions of the watched vertices [m].
  std::vector<HandleState> states(std::span<const Vec3d> corners) const;

 private:
  struct Held {
    int handle = 0;
    Triangle corners{};  ///< vertices of the face that was hit
    Vec3d barycentric;
    std::vector<Index> vertices;        ///< the patch
    std::vector<double> share;          ///< of the stiffness, sums to 1
    std::vector<Vec3d> offset;          ///< from the hit point at the grab [m]
    Vec3d target, followed, pulled_to;  ///< asked for; limited in speed; limited in force [m]
    double stiffness = 0, saturation = 0;
  };

  Held grab(const InputEvent& event, const Parameters& parameters,
            std::span<const Vec3d> positions) const;

  const World* world_;
  std::vector<Held> held_;
};

}  // namespace icloth
