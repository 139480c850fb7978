#include "sim/scene/material.h"

#include <cmath>

namespace icloth {

double coupling(const std::array<double, 4>& row) {
  return std::fabs(row[1]) / std::sqrt(row[0] * row[2]);
}

void set_orthotropic(Material& material, const OrthotropicFabric& f) {
  material.law = Material::Law::orthotropic;
  const double poisson_vu = f.poisson * f.young_v / f.young_u;
  const double plane = 1 / (1 - f.poisson * poisson_vu);
  // Stiffness against Green strain is k11 = E_u / (1 − ν_uv ν_vu), and k33 = 2 G as γ = 2 G_uv; the
  // table holds half of each.
  const double c11 = plane * f.young_u / 2, c22 = plane * f.young_v / 2;
  material.stretching.fill({c11, poisson_vu * c11, c22, f.shear});
  const double mean = (std::sqrt(f.bend_u) + std::sqrt(f.bend_v)) / 2;
  const double diagonal = f.bend_diagonal < 0 ? mean * mean : f.bend_diagonal;
  // A hinge along u bends the cloth along v; the table holds four times the modulus of a plate.
  material.bending[0].fill(4 * f.bend_v);
  material.bending[1].fill(4 * diagonal);
  material.bending[2].fill(4 * f.bend_u);
  material.bending_poisson = f.bending_poisson;
}

void bend_as_sheet(OrthotropicFabric& f, double thickness) {
  const double ratio = f.poisson * std::sqrt(f.young_v / f.young_u);
  const double second_moment = thickness * thickness / 12;
  f.bend_u = second_moment * f.young_u / (1 - ratio * ratio);
  f.bend_v = second_moment * f.young_v / (1 - ratio * ratio);
  f.bending_poisson = ratio;
  f.bend_diagonal = (f.bend_u + f.bend_v + 2 * ratio * std::sqrt(f.bend_u * f.bend_v)) / 4 +
                    second_moment * f.shear;
}

}  // namespace icloth
