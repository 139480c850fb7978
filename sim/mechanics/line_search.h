// How far to go along the direction that a pass over the contacts found.
//
// With the friction limits held, the forces of a substep follow from a convex energy: the quadratic
// one of the linearised cloth, and for every contact one that is quadratic while it is closed. The
// direction comes from a system in which no contact opens, closes or begins to slide. Going all the
// way, contacts that it left out may be driven together hard, and the passes jump to and fro
// between two sets of contacts. The energy along the line has one minimum, where its slope is zero.
#pragma once

#include "sim/linear/linear_system.h"
#include "sim/mechanics/contact_motion.h"

namespace icloth::ICLOTH_BUILD {

/// A direction and what the system makes of it.
struct SearchDirection {
  View<const Vec3r> d;         ///< change of Δv [m/s] (cloth vertices)
  View<const Vec3r> product;   ///< of the system, couplings included, with d [N·s]
  View<const Vec3r> coupling;  ///< the part of each coupling, H Σ w d [N·s] (couplings)
};

/// The contacts of a step, and what moves them.
struct ContactLine {
  View<const Contact> contacts;
  View<ContactTravel> travels;  ///< (contacts)
  VertexMotion motion;
  ContactLaw law;
};

class LineSearch {
 public:
  /// Adds α d to Δv, takes α A d from b − A Δv, `residual`, where A and b are those without
  /// contacts, and moves the contacts on. α is where the slope of the energy along d has fallen to
  /// a tenth, 1 where it has at the end or where d does not lead downhill. Returns α.
  double go(const SystemView& system, const ContactLine& line, View<const Coupling> seams,
            const SearchDirection& direction, View<Vec3r> dv, View<Vec3r> residual);

 private:
  Array<Vec3r> product_;  ///< A d (cloth vertices)
  Array<Vec3r> along_;    ///< how d moves each contact [m] (contacts)
  Array<Index> closed_;   ///< 0: it stays open on the whole way (contacts)
  Array<double> share_;   ///< α (1)
};

}  // namespace icloth::ICLOTH_BUILD
