// Elementary CCD by brute force: a proof, by subdivision of time, that two primitives never touch.
//
// Over a part of [0,1] a fixed direction d proves it when d·(y − x) > 0 for all points x of the one
// and y of the other primitive at both ends of the part, since these products are linear in time.
// They are computed with a bound of their rounding errors, so that the proof holds for the stored
// numbers. Every feature of either primitive gives directions to try, at the middle of the part; a
// part for which none of them serves is halved.
#pragma once

#include <vector>

#include "kernels/ccd/elementary_ccd.h"

namespace icloth::oracle {

template <class Real, int kBits>
class CertifiedCcd {
  using Vector = Vec3<Real>;

 public:
  CertifiedCcd(PairKind kind, const CcdQuery<double>& q) : kind_(kind) {
    for (int k = 0; k < 4; ++k) {
      p0_[k] = convert<Real>(q.p0[k]);
      p1_[k] = convert<Real>(q.p1[k]);
    }
    // The bound of the rounding errors, and the length below which parts are not halved: all times
    // and their differences from 1 are exact then.
    for (int bit = 0; bit < kBits - 4; ++bit) roundoff_ /= 2;
    for (int bit = 0; bit < kBits - 10; ++bit) shortest_ /= 2;
  }

  /// True when the pair certainly stays apart over [start,end].
  bool apart(Real start, Real end) {
    const Real middle = (start + end) / 2;
    for (const Vector& d : directions(middle)) {
      if (separates(d, start) && separates(d, end)) return true;
    }
    if (end - start <= shortest_ || --budget_ < 0) return false;
    return apart(start, middle) && apart(middle, end);
  }

 private:
  /// Point k at time t.
  Vector at(int k, Real t) const { return (1 - t) * p0_[k] + t * p1_[k]; }

  /// Index of the first point of the second primitive; vf has the vertex first.
  int split() const { return kind_ == PairKind::vf ? 1 : 2; }

  static Real absolute(Real x) { return x < 0 ? -x : x; }

  /// True when d certainly points from every point of the first to every one of the second
  /// primitive. The differences, two products, their sum and the dot product make at most 10
  /// roundings; 16 are counted.
  bool separates(const Vector& d, Real t) const {
    for (int x = 0; x < split(); ++x) {
      for (int y = split(); y < 4; ++y) {
        const Vector r0 = p0_[y] - p0_[x], r1 = p1_[y] - p1_[x];
        const Real size = absolute(d.x) * (absolute(r0.x) + absolute(r1.x)) +
                          absolute(d.y) * (absolute(r0.y) + absolute(r1.y)) +
                          absolute(d.z) * (absolute(r0.z) + absolute(r1.z));
        if (!(dot(d, (1 - t) * r0 + t * r1) > roundoff_ * size)) return false;
      }
    }
    return true;
  }

  /// The part of r perpendicular to the direction e.
  static Vector perpendicular(const Vector& r, const Vector& e) {
    const Real ee = dot(e, e);
    return ee > 0 ? r - (dot(r, e) / ee) * e : r;
  }

  /// Directions between all features at time t.
  std::vector<Vector> directions(Real t) const {
    // Between points, and between a point and each edge of the other primitive.
    std::vector<Vector> out;
    for (int x = 0; x < split(); ++x) {
      for (int y = split(); y < 4; ++y) {
        const Vector r = at(y, t) - at(x, t);
        out.push_back(r);
        for (int z = split(); z < 4; ++z) {
          if (z != y) out.push_back(perpendicular(r, at(z, t) - at(y, t)));
        }
        if (kind_ == PairKind::ee) out.push_back(perpendicular(r, at(1 - x, t) - at(x, t)));
      }
    }

    // The normal of the face, or the common normal of the edges.
    const Vector n = kind_ == PairKind::vf ? cross(at(2, t) - at(1, t), at(3, t) - at(1, t))
                                           : cross(at(1, t) - at(0, t), at(3, t) - at(2, t));
    out.push_back(n);
    out.push_back(-n);
    return out;
  }

  PairKind kind_;
  Vector p0_[4], p1_[4];
  Real roundoff_ = 1, shortest_ = 1;
  long budget_ = 5000;  // halvings that are left
};

/// True when the pair certainly does not touch in [0,1], by extended precision (64 bits).
inline bool certainly_apart(PairKind kind, const CcdQuery<double>& q) {
  return CertifiedCcd<long double, 64>(kind, q).apart(0, 1);
}

/// The same by quadruple precision (113 bits), which takes a hundred times as long.
inline bool certainly_apart_by_a_little(PairKind kind, const CcdQuery<double>& q) {
  return CertifiedCcd<__float128, 113>(kind, q).apart(0, 1);
}

}  // namespace icloth::oracle
