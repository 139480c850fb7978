// An unevaluated sum of two doubles, about 106 bits, for the few queries that fp64 cannot decide.
//
// Sum and product are error-free transformations after Knuth and Dekker. Every operation below has
// a relative error under 2⁻¹⁰² (the bounds of Joldes, Muller and Popescu, 2017, are 2⁻¹⁰² to 2⁻¹⁰⁴)
// while nothing underflows. It is about twenty times as slow as double.
#pragma once

#include <cmath>

#include "kernels/parallel/platform.h"

namespace icloth {

struct DoubleDouble {
  double hi{}, lo{};  // |lo| ≤ half a unit in the last place of hi

  constexpr DoubleDouble() = default;
  ICLOTH_HD constexpr DoubleDouble(double x) : hi(x) {}  // exact, hence implicit
  ICLOTH_HD constexpr DoubleDouble(double h, double l) : hi(h), lo(l) {}
  ICLOTH_HD constexpr explicit operator double() const { return hi; }
};

/// a + b exactly.
ICLOTH_HD inline DoubleDouble exact_sum(double a, double b) {
  const double s = a + b, bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}
/// a + b exactly, for |a| ≥ |b|.
ICLOTH_HD inline DoubleDouble exact_sum_ordered(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
/// a b exactly.
ICLOTH_HD inline DoubleDouble exact_product(double a, double b) {
#if defined(__CUDA_ARCH__)
  const double p = __dmul_rn(a, b);  // never contracted
#else
  const double p = a * b;
#endif
  return {p, std::fma(a, b, -p)};
}

ICLOTH_HD inline DoubleDouble operator-(DoubleDouble a) { return {-a.hi, -a.lo}; }
ICLOTH_HD inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  DoubleDouble s = exact_sum(a.hi, b.hi);
  const DoubleDouble t = exact_sum(a.lo, b.lo);
  s = exact_sum_ordered(s.hi, s.lo + t.hi);
  return exact_sum_ordered(s.hi, s.lo + t.lo);
}
ICLOTH_HD inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
ICLOTH_HD inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble p = exact_product(a.hi, b.hi);
  const double low = std::fma(a.lo, b.hi, std::fma(a.hi, b.lo, a.lo * b.lo));
  return exact_sum_ordered(p.hi, p.lo + low);
}
ICLOTH_HD inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  // This is long division with three quotient digits of 53 bits.
  const double q1 = a.hi / b.hi;
  DoubleDouble r = a - b * DoubleDouble(q1);
  const double q2 = r.hi / b.hi;
  r = r - b * DoubleDouble(q2);
  const double q3 = r.hi / b.hi;
  return exact_sum_ordered(q1, q2) + DoubleDouble(q3);
}
ICLOTH_HD inline bool operator<(DoubleDouble a, DoubleDouble b) {
  return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
}
ICLOTH_HD inline bool operator>(DoubleDouble a, DoubleDouble b) { return b < a; }
ICLOTH_HD inline bool operator<=(DoubleDouble a, DoubleDouble b) {
  return a.hi < b.hi || (a.hi == b.hi && a.lo <= b.lo);
}
ICLOTH_HD inline bool operator>=(DoubleDouble a, DoubleDouble b) { return b <= a; }
ICLOTH_HD inline bool operator==(DoubleDouble a, DoubleDouble b) {
  return a.hi == b.hi && a.lo == b.lo;
}

}  // namespace icloth
