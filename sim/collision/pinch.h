// Cloth that bodies leave no room: where two of them, or two parts of one, overlap or come closer
// than the cloth needs, no position of the cloth is free of collisions (armpits, crossed legs).
//
// There the vertices of the cloth are let go from one of the two bodies, the later one of the
// scene: pairs with it are left out of proximity and CCD, the other body and the cloth itself still
// keep them. While they lie inside, soft contacts push them out along the surface, by at most about
// half the thickness a step. A vertex that is outside again, with all its faces, is taken back for
// good. Which vertices are let go follows from the collisions that the smallest substep could not
// resolve, and from what lies on the other side of the cloth there.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "kernels/contact.h"
#include "kernels/impact.h"
#include "sim/collision/body_surface.h"
#include "sim/collision/let_go.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// Works on State::let_go, which is all that a step remembers of it.
class Pinch {
 public:
  /// `world` must outlive it.
  explicit Pinch(const World& world) : world_(&world) {}

  /// Lets cloth go from a body where the impacts left (x0 → x1, cloth rolled back to x0) are
  /// between bodies. False when nothing more can be let go, as other cloth takes the room then.
  bool release(SubstepContext& step, const Array<Impact>& impacts);
  /// Lets go of every cloth vertex of these impacts, whatever else is there.
  void release_all(State& state, const Array<Impact>& impacts);
  /// Takes back the vertices that are outside at x1.
  void take_back(State& state, const Parameters& parameters);
  /// Contacts at x0 that push the let-go vertices, and faces around them, out.
  const Array<Contact>& push_outs(const SubstepContext& step);

  /// Number of cloth vertices that are let go from some body.
  static std::int64_t vertices(const State& state);

 private:
  using List = std::map<std::pair<Index, Index>, Index>;  ///< side by vertex and body

  /// One impact between cloth and a body, as `release` sees it.
  struct Squeeze {
    std::vector<Index> cloth;  ///< corners of the cloth
    Index body;
    Vec3d place;  ///< where the cloth is hit
    Vec3d away;   ///< unit, from the body to the cloth
  };

  const BodySurface& surface(Index object);
  const std::vector<Index>& faces_of(Index vertex);
  std::array<Vec3d, 3> corners(const std::vector<Vec3d>& x, Index face) const;
  std::optional<Squeeze> squeeze_of(const Impact& impact, const std::vector<Vec3d>& x) const;
  /// Bodies that leave no room on the other side of the cloth. The body that was hit is among them
  /// when another part of it is there.
  std::vector<Index> bodies_ahead(const Squeeze& squeeze, const std::vector<Vec3d>& x, double reach,
                                  const List& held);
  void let_go(List& list, Index vertex, Index body, const std::vector<Vec3d>& x);
  /// Lets go of the neighbours of vertices that are let go already. False: there were none.
  bool widen(List& list, const Squeeze& squeeze, const std::vector<Vec3d>& x);
  /// Whether cloth within two edges of a squeeze is let go from some body.
  bool is_near_pinch(const List& list, const Squeeze& squeeze);
  bool is_outside(const LetGo& entry, const std::vector<Vec3d>& x, double least);

  const World* world_;
  std::map<Index, std::unique_ptr<BodySurface>> surfaces_;
  std::vector<std::vector<Index>> faces_of_;  ///< of each cloth vertex; empty until it is asked for
  Array<Contact> push_outs_;
};

}  // namespace icloth::ICLOTH_BUILD
