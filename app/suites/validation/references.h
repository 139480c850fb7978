// The references of the measured quantities: solutions of the continuous problems, computed here.
#pragma once

#include <array>
#include <vector>

namespace icloth::validation {

/// The elongation [m] of a strip that hangs by its end under its own weight. The second Piola
/// stress is k G, so the local stretch λ at weight w = ρ g (L − s) solves λ(λ² − 1)k/2 = w.
double hanging_elongation(double length, double density, double gravity, double tensile);

/// An inextensible chain between level points, with length/span = ratio > 1. All lengths are in
/// spans.
struct Catenary {
  double sag;        ///< a (cosh z − 1), with sinh z / z = ratio and a = 1/(2z)
  double parameter;  ///< a: horizontal tension / weight per length
  double end_angle;  ///< atan(sinh z) [rad]
};
Catenary catenary(double ratio);

/// Zero number n = 1, 2, … of the Bessel function J₀.
double bessel_zero(int n);

/// A clamped, horizontal, heavy, inextensible strip: θ'' = −Γ (1 − s) cos θ, θ(0) = 0, θ'(1) = 0,
/// with Γ = ρ g L³/D. Drop H and reach W of the tip are in lengths.
struct HeavyElastica {
  double drop, reach, tip_angle;
};
HeavyElastica heavy_elastica(double gamma);

/// A weightless strip clamped upright whose other end, straight below, sticks to a ground that has
/// come closer by `shortening` lengths: θ'' = −P sin θ + Q cos θ, θ(0) = 0, θ'(1) = 0, ∫ sin θ = 0,
/// ∫ cos θ = 1 − shortening.
struct PressedElastica {
  double curvature;         ///< θ'(0), in 1/L
  double pressure;          ///< P, in D/L² per width
  double sideways;          ///< Q, in D/L² per width
  double friction() const;  ///< |Q|/P, the coefficient that is needed
};
PressedElastica pressed_elastica(double shortening);
/// The point of the strip at arc length s, in lengths from the clamp: across and along the clamp's
/// direction.
std::array<double, 2> pressed_point(const PressedElastica& elastica, double s);

/// A belt with weight, of line density ρ, over a half cylinder, at the verge of sliding towards its
/// heavy leg. With N = T/r + ρ g sin φ it satisfies dT/dφ = μT + ρ g r (cos φ + μ sin φ) from one
/// leg to the other. Returns the length of the heavy leg that just holds, for the other leg's
/// length and the radius r of the belt [m].
double belt_leg(double friction, double leg, double radius);
/// The friction that just holds the two legs.
double belt_friction(double light_leg, double heavy_leg, double radius);

}  // namespace icloth::validation
