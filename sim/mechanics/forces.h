// The list of the forces on the cloth.
//
// To add a force: write a class with the base Force (sim/mechanics/force.h) in a header of its own,
// include the header below and name the class in the list. A source file, where it has one, goes
// into sim/CMakeLists.txt. Nothing else needs to know it:
//
//   pattern    lay_out       which vertices its elements couple; faces are coupled already
//   assembly   face_share    for a force on faces: one kernel goes over all faces and calls the
//                            shares of all forces, so the deformation is worked out once
//              prepare       for other elements: passes of its own that fill an array of terms
//              row_share     adds those terms to the blocks of a row and to its right-hand side
//   energy     add_energy    where it has a potential
//   work       work          where it has none: the work of the force that the solve applied
//
// Shares are added in the order of the list, after mass and gravity and, in a row, after the faces.
// Sums of floating-point numbers depend on it: a new force goes to the end.
#pragma once

#include <tuple>

#include "sim/mechanics/air.h"
#include "sim/mechanics/bending.h"
#include "sim/mechanics/hand_springs.h"
#include "sim/mechanics/membrane.h"
#include "sim/mechanics/pressure.h"
#include "sim/mechanics/yarns.h"

namespace icloth::ICLOTH_BUILD {

using ForceList = std::tuple<Membrane, Air, Bending, HandSprings, YarnFriction, Pressure>;

/// One object of each force.
class Forces {
 public:
  /// Calls visit(force) for each force in the order of the list.
  template <class Visit>
  void each(const Visit& visit) {
    std::apply([&](auto&... force) { (visit(force), ...); }, list_);
  }
  template <class Visit>
  void each(const Visit& visit) const {
    std::apply([&](const auto&... force) { (visit(force), ...); }, list_);
  }

  /// The Bundle of make(force) of all forces, for a kernel.
  template <class Make>
  auto bundle(const Make& make) const {
    return std::apply([&](const auto&... force) { return bundle_of(make(force)...); }, list_);
  }

  /// Potential energies of a shape of the cloth.
  ForceEnergy energy(const EnergyContext& context) const {
    ForceEnergy sum;
    each([&](const auto& force) { force.add_energy(context, sum); });
    return sum;
  }

 private:
  ForceList list_;
};

}  // namespace icloth::ICLOTH_BUILD
