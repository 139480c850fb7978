// The hands that hold the cloth: grabbed patches, their springs and targets.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/world.h"
#include "sim/state/memory.h"

namespace icloth {

/// A vertex that hands pull.
struct HandSpring {
  Index vertex;
  double stiffness;  ///< [N/m]
  Vec3d target;      ///< [m]
};

/// Works on the hands of a memory, `held`, and remembers nothing itself.
class Hands {
 public:
  Hands(const World& world, std::vector<HeldPatch>& held) : world_(&world), held_(&held) {}

  /// Applies grabs, moves and releases; `positions` (≥ cloth_vertices) is the present state [m].
  /// A grab of a face that does not exist and a move of a handle that is not held are ignored.
  void apply(std::span<const InputEvent> events, const Parameters& parameters,
             std::span<const Vec3d> positions);

  /// Corners of the faces that were hit, three a hand: all that the rest has to know of the state.
  std::vector<Index> watched() const;

  /// Moves the followed targets on by at most grab.max_speed · dt and limits the pull. `corners`:
  /// positions of the watched vertices [m]. Returns the limits that were reached, a bit each.
  std::int64_t advance(double dt, const Parameters& parameters, std::span<const Vec3d> corners);

  bool empty() const { return held_->empty(); }

  /// One spring for each pulled vertex, by ascending vertex.
  std::vector<HandSpring> springs() const;

  /// `corners`: positions of the watched vertices [m].
  std::vector<HandleState> states(std::span<const Vec3d> corners) const;

 private:
  HeldPatch grab(const InputEvent& event, const Parameters& parameters,
                 std::span<const Vec3d> positions) const;

  const World* world_;
  std::vector<HeldPatch>* held_;
};

}  // namespace icloth
