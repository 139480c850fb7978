// The hands that hold the cloth: grabbed patches, their springs and targets.
#pragma once

#include <span>
#include <vector>

#include "sim/input.h"
#include "sim/world.h"

namespace icloth {

class Hands {
 public:
  explicit Hands(const World& world) : world_(&world) {}

  /// Applies grabs, moves and releases; `positions` (≥ cloth_vertices) is the present state [m].
  /// A grab of a face that does not exist and a move of a handle that is not held are ignored.
  void apply(std::span<const InputEvent> events, const Parameters& parameters,
             std::span<const Vec3d> positions);

  /// Moves the followed targets on by at most grab_max_speed · dt and works out the springs.
  void advance(double dt, const Parameters& parameters, std::span<const Vec3d> positions);

  void clear() { held_.clear(); }
  bool empty() const { return held_.empty(); }

  /// Dense springs of all cloth vertices: stiffness [N/m] (0: none) and target [m].
  void springs(std::vector<double>& stiffness, std::vector<Vec3d>& target) const;

  std::vector<HandleState> states(std::span<const Vec3d> positions) const;

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

  Vec3d hit(const Held& held, std::span<const Vec3d> positions) const;
  Held grab(const InputEvent& event, const Parameters& parameters,
            std::span<const Vec3d> positions) const;

  const World* world_;
  std::vector<Held> held_;
};

}  // namespace icloth
