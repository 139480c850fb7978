#include "sim/scene/exact_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace icloth {
namespace {

/// Whole number of any size: sign and magnitude, lowest 32 bits first, no leading zeros.
class Integer {
 public:
  Integer() = default;
  /// value · 2^-exponent, which must be whole.
  Integer(double value, int exponent) {
    // A double is a whole number of 53 bits times a power of two.
    int power = 0;
    const double fraction = std::frexp(std::fabs(value), &power);
    auto bits = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    if (bits == 0) return;
    negative_ = value < 0;

    // Without its trailing zeros that number is odd, so a whole result needs a shift to the left,
    // never one to the right.
    const int zeros = std::countr_zero(bits);
    bits >>= zeros;
    const int shift = power - 53 + zeros - exponent;
    limbs_.assign(static_cast<std::size_t>(shift / 32), 0);

    // 53 bits shifted by less than 32 fit three limbs.
    const std::uint64_t low = (bits & 0xffffffffu) << (shift % 32);
    const std::uint64_t high = ((bits >> 32) << (shift % 32)) + (low >> 32);
    for (const std::uint64_t limb : {low, high, high >> 32})
      limbs_.push_back(static_cast<std::uint32_t>(limb));
    trim();
  }

  int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }

  friend Integer operator-(Integer a) {
    a.negative_ = !a.negative_;
    return a;
  }
  friend Integer operator+(const Integer& a, const Integer& b) {
    if (a.negative_ != b.negative_ && a.smaller_than(b)) return b + a;

    // The sum has the sign of `a`, whose magnitude is at least that of `b` where the signs differ.
    Integer sum = a;
    std::int64_t carry = 0;
    const std::int64_t factor = a.negative_ == b.negative_ ? 1 : -1;
    sum.limbs_.resize(std::max(a.limbs_.size(), b.limbs_.size()) + 1, 0);
    for (std::size_t i = 0; i < sum.limbs_.size(); ++i) {
      carry += std::int64_t{sum.limbs_[i]} + factor * (i < b.limbs_.size() ? b.limbs_[i] : 0);
      sum.limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;  // rounds down, so a borrow is −1
    }
    sum.trim();
    return sum;
  }
  friend Integer operator-(const Integer& a, const Integer& b) { return a + -b; }
  friend Integer operator*(const Integer& a, const Integer& b) {
    Integer product;
    product.negative_ = a.negative_ != b.negative_;
    product.limbs_.resize(a.limbs_.size() + b.limbs_.size(), 0);

    // Long multiplication: the product of two limbs, a carry and one more limb still fit 64 bits.
    for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.limbs_.size() || carry != 0; ++j) {
        if (j < b.limbs_.size()) carry += std::uint64_t{a.limbs_[i]} * b.limbs_[j];
        carry += product.limbs_[i + j];
        product.limbs_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    product.trim();
    return product;
  }

 private:
  void trim() {
    while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
    if (limbs_.empty()) negative_ = false;
  }
  bool smaller_than(const Integer& b) const {  // magnitudes
    if (limbs_.size() != b.limbs_.size()) return limbs_.size() < b.limbs_.size();
    return std::lexicographical_compare(limbs_.rbegin(), limbs_.rend(), b.limbs_.rbegin(),
                                        b.limbs_.rend());
  }

  std::vector<std::uint32_t> limbs_;
  bool negative_ = false;
};

/// Largest power of two that divides all values; 0 when all are 0.
int common_exponent(std::span<const double> values) {
  int least = 0;
  bool first = true;
  for (const double value : values) {
    if (value == 0) continue;

    // The lowest bit that is set gives the power of two that divides the value.
    int power = 0;
    const double fraction = std::frexp(std::fabs(value), &power);
    const int exponent =
        power - 53 + std::countr_zero(static_cast<std::uint64_t>(std::ldexp(fraction, 53)));
    least = first ? exponent : std::min(least, exponent);
    first = false;
  }
  return least;
}

double component(Vec3d p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Side of c against the line a b, seen along `axis`.
int side_in_plane(Vec3d a, Vec3d b, Vec3d c, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double values[6] = {component(a, x), component(a, y), component(b, x),
                            component(b, y), component(c, x), component(c, y)};

  // The sign of the difference is certain when it exceeds the rounding errors of both products.
  const double left = (values[2] - values[0]) * (values[5] - values[1]);
  const double right = (values[3] - values[1]) * (values[4] - values[0]);
  const double bound = 4.0 * 0x1p-53 * (std::fabs(left) + std::fabs(right)) + 1e-280;
  if (left - right > bound) return 1;
  if (left - right < -bound) return -1;

  // Otherwise integers decide: one power of two makes all coordinates whole.
  const int exponent = common_exponent(values);
  Integer n[6];
  for (int k = 0; k < 6; ++k) n[k] = Integer(values[k], exponent);
  return ((n[2] - n[0]) * (n[5] - n[1]) - (n[3] - n[1]) * (n[4] - n[0])).sign();
}

/// An axis along which the triangle does not look like a line; −1 for one without area.
int axis_of(const FaceCorners& t) {
  for (int axis = 0; axis < 3; ++axis)
    if (side_in_plane(t[0], t[1], t[2], axis) != 0) return axis;
  return -1;
}

bool overlap(double a, double b, double c, double d) {
  return std::max(std::min(a, b), std::min(c, d)) <= std::min(std::max(a, b), std::max(c, d));
}

/// Segments a b and c d in one plane.
bool segments_meet_in_plane(Vec3d a, Vec3d b, Vec3d c, Vec3d d, int axis) {
  const int abc = side_in_plane(a, b, c, axis), abd = side_in_plane(a, b, d, axis);
  const int cda = side_in_plane(c, d, a, axis), cdb = side_in_plane(c, d, b, axis);
  if (abc == 0 && abd == 0 && cda == 0 && cdb == 0) {  // on one line
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    return overlap(component(a, x), component(b, x), component(c, x), component(d, x)) &&
           overlap(component(a, y), component(b, y), component(c, y), component(d, y));
  }
  return abc * abd <= 0 && cda * cdb <= 0;
}

/// A point in the triangle's plane.
bool contains(const FaceCorners& t, Vec3d p, int axis) {
  bool left = false, right = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = side_in_plane(t[k], t[(k + 1) % 3], p, axis);
    left = left || side > 0;
    right = right || side < 0;
  }
  return !(left && right);
}

bool meet_in_plane(Vec3d p, Vec3d q, const FaceCorners& t, int axis) {
  for (std::size_t k = 0; k < 3; ++k)
    if (segments_meet_in_plane(p, q, t[k], t[(k + 1) % 3], axis)) return true;
  return contains(t, p, axis);
}

/// Segment p q against a triangle; the sides of p and q against its plane are known.
bool segment_meets(Vec3d p, Vec3d q, int p_side, int q_side, const FaceCorners& t, int axis) {
  if (p_side * q_side > 0) return false;
  if (p_side == 0 && q_side == 0) return meet_in_plane(p, q, t, axis);
  bool left = false, right = false;  // the line p q passes the edges on one side: through t
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = exact_side(p, q, t[k], t[(k + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
  }
  return !(left && right);
}

/// Whether an edge of s meets t.
bool edges_meet(const FaceCorners& s, const FaceCorners& t, int axis) {
  int side[3];
  for (std::size_t k = 0; k < 3; ++k) side[k] = exact_side(t[0], t[1], t[2], s[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (segment_meets(s[k], s[next], side[k], side[next], t, axis)) return true;
  }
  return false;
}

}  // namespace

// Bound of Shewchuk 1997, "Adaptive precision floating-point arithmetic", Section 4.3.
int certain_side(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d u = a - d, v = b - d, w = c - d;
  const double vw0 = v.x * w.y, vw1 = w.x * v.y, wu0 = w.x * u.y, wu1 = u.x * w.y;
  const double uv0 = u.x * v.y, uv1 = v.x * u.y;
  const double det = u.z * (vw0 - vw1) + v.z * (wu0 - wu1) + w.z * (uv0 - uv1);
  const double size = (std::fabs(vw0) + std::fabs(vw1)) * std::fabs(u.z) +
                      (std::fabs(wu0) + std::fabs(wu1)) * std::fabs(v.z) +
                      (std::fabs(uv0) + std::fabs(uv1)) * std::fabs(w.z);
  // The second term covers products that underflow.
  const double bound = 8.0 * 0x1p-53 * size + 1e-280;
  return det > bound ? 1 : det < -bound ? -1 : 0;
}

int exact_side(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const int certain = certain_side(a, b, c, d);
  if (certain != 0) return certain;

  // Cloth that lies flat has all its points in one plane across an axis, and needs no determinant.
  for (int axis = 0; axis < 3; ++axis) {
    const double same = component(d, axis);
    if (component(a, axis) == same && component(b, axis) == same && component(c, axis) == same)
      return 0;
  }

  // Integers decide the rest by the determinant of a − d, b − d and c − d, after one power of two
  // has made all coordinates whole.
  const double values[12] = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z};
  const int exponent = common_exponent(values);
  Integer m[3][3];
  for (int k = 0; k < 3; ++k) {
    const Integer from(values[9 + k], exponent);
    for (int row = 0; row < 3; ++row) m[row][k] = Integer(values[3 * row + k], exponent) - from;
  }
  return (m[0][2] * (m[1][0] * m[2][1] - m[2][0] * m[1][1]) +
          m[1][2] * (m[2][0] * m[0][1] - m[0][0] * m[2][1]) +
          m[2][2] * (m[0][0] * m[1][1] - m[1][0] * m[0][1]))
      .sign();
}

bool triangles_meet(const FaceCorners& s, const FaceCorners& t) {
  const int s_axis = axis_of(s), t_axis = axis_of(t);
  if (s_axis < 0 || t_axis < 0) return false;
  // Triangles in different planes meet along a segment, which ends at an edge of one of them.
  return edges_meet(s, t, t_axis) || edges_meet(t, s, s_axis);
}

bool point_meets(Vec3d p, const FaceCorners& t) {
  // The test along an axis comes first, since it costs less and most points lie beside the
  // triangle.
  const int axis = axis_of(t);
  return axis >= 0 && contains(t, p, axis) && exact_side(t[0], t[1], t[2], p) == 0;
}

bool segments_meet(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  // Points of two segments that meet lie in one plane.
  for (int axis = 0; axis < 3; ++axis)
    if (!overlap(component(a, axis), component(b, axis), component(c, axis), component(d, axis)))
      return false;

  // Along every axis they have to meet; along one that is not in their plane that is enough.
  for (int axis = 0; axis < 3; ++axis)
    if (!segments_meet_in_plane(a, b, c, d, axis)) return false;
  return exact_side(a, b, c, d) == 0;
}

}  // namespace icloth
