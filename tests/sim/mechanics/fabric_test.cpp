// Stiffness laws of a fabric and its strain limit (double build).
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include "kernels/fabric.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <vector>

#include "kernels/strain_limit.h"
#include "sim/scene/material_io.h"

namespace icloth::cpu64 {
namespace {

Fabric fabric_of(const Material& material) {
  Fabric f{};
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 4; ++c) f.stretching[r][c] = material.stretching[r][c];
  f.measured = material.law == Material::Law::measured;
  return f;
}

Material cotton() {
  OrthotropicFabric constants;
  constants.young_u = 900, constants.young_v = 1500, constants.poisson = 0.2;
  constants.shear = 25, constants.bend_u = 4e-6, constants.bend_v = 9e-6;
  Material material;
  set_orthotropic(material, constants);
  return material;
}

TEST(OrthotropicFabric, TensionAndShearGiveTheConstants) {
  const Fabric fabric = fabric_of(cotton());
  const Stiffness k = stiffness_at(fabric, {0.01, 0.02, -0.005});
  // Tension along u alone: S_vv = 0.
  const double poisson = k.k12 / k.k22;
  EXPECT_NEAR(poisson, 0.2, 1e-12);
  EXPECT_NEAR(k.k11 - k.k12 * poisson, 900, 1e-9);
  EXPECT_NEAR(k.k22 - k.k12 * k.k12 / k.k11, 1500, 1e-9);
  EXPECT_NEAR(stress(k, {0, 0.001, 0}).uv, 25 * 0.002, 1e-12);
}

TEST(OrthotropicFabric, StiffnessIsTheSameAtEveryStrain) {
  const Fabric fabric = fabric_of(cotton());
  const Stiffness rest = stiffness_at(fabric, {0, 0, 0});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.4, 0.8);
  for (int i = 0; i < 20; ++i) {
    const Stiffness k = stiffness_at(fabric, {uniform(random), uniform(random), uniform(random)});
    EXPECT_EQ(k.k11, rest.k11);
    EXPECT_EQ(k.k12, rest.k12);
    EXPECT_EQ(k.k33, rest.k33);
  }
}

TEST(OrthotropicFabric, BendingOfASheetIsThatOfAPlate) {
  OrthotropicFabric constants;
  constants.young_u = constants.young_v = 1000, constants.poisson = 0.3;
  constants.shear = 1000 / (2 * 1.3);
  bend_as_sheet(constants, 1e-3);
  const double plate = 1000 * 1e-6 / (12 * (1 - 0.09));
  EXPECT_NEAR(constants.bend_u, plate, 1e-12);
  EXPECT_NEAR(constants.bend_v, plate, 1e-12);
  EXPECT_NEAR(constants.bend_diagonal, plate, 1e-12);  // isotropic: alike in all directions
  EXPECT_NEAR(constants.bending_poisson, 0.3, 1e-12);
  Material material;
  set_orthotropic(material, constants);
  for (const auto& row : material.bending) EXPECT_NEAR(row[2], 4 * plate, 1e-12);
}

struct Table {
  explicit Table(const Fabric& measured) : nodes(StiffnessTable::kSize), fabric(measured) {
    const FillStiffnessTable fill{measured, {nodes.data(), StiffnessTable::kSize}};
    for (Index i = 0; i < StiffnessTable::kSize; ++i) fill(i);
    fabric.table = nodes.data();
  }
  std::vector<Stiffness> nodes;
  Fabric fabric;
};

TEST(StiffnessTable, AgreesWithTheLawAtItsNodesAndAveragesBetweenThem) {
  const Fabric direct = fabric_of(load_material("gray-interlock", ""));
  const Table table(direct);
  for (const Index node : {Index{0}, Index{7 * 900 + 9 * 30 + 2}, StiffnessTable::kSize - 1}) {
    const Sym2 g = StiffnessTable::strain(node);
    EXPECT_NEAR(stiffness_at(table.fabric, g).k22, stiffness_at(direct, g).k22, 1e-9);
  }
  // Half way between two nodes: their mean; the sign of the shear does not matter.
  const Index node = 8 * 900 + 9 * 30 + 2, next = node + 900;
  const Sym2 a = StiffnessTable::strain(node), b = StiffnessTable::strain(next);
  const Sym2 middle{0.5 * (a.uu + b.uu), -a.uv, a.vv};
  EXPECT_NEAR(stiffness_at(table.fabric, middle).k33,
              0.5 * (stiffness_at(direct, a).k33 + stiffness_at(direct, b).k33), 1e-9);
}

/// Median relative difference of the stress between table and law at strains of −3 to 8 %.
double table_error(const char* name) {
  const Fabric direct = fabric_of(load_material(name, ""));
  const Table table(direct);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-0.03, 0.08);
  std::vector<double> errors;
  for (int i = 0; i < 2001; ++i) {
    const Sym2 g{uniform(random), 0.5 * uniform(random), uniform(random)};
    const Sym2 s = stress(stiffness_at(direct, g), g), t = stress(stiffness_at(table.fabric, g), g);
    const double size = std::hypot(s.uu, s.vv, s.uv);
    errors.push_back(std::hypot(t.uu - s.uu, t.vv - s.vv, t.uv - s.uv) / size);
  }
  std::ranges::nth_element(errors, errors.begin() + 1000);
  return errors[1000];
}

TEST(StiffnessTable, IsCoarseForKnitsAndGoodForDenim) {
  const double knit = table_error("gray-interlock"), denim = table_error("11oz-black-denim");
  EXPECT_GT(knit, 0.04);
  EXPECT_LT(knit, 0.25);
  EXPECT_LT(denim, 0.01);
}

TEST(StiffnessTable, StrainsFarOutsideUseItsBorder) {
  const Table table(fabric_of(load_material("white-dots-on-blk", "")));
  for (const double far : {-1e30, -3.0, 5.0, 1e30}) {
    const Stiffness k = stiffness_at(table.fabric, {far, far, -far});
    EXPECT_TRUE(std::isfinite(k.k11) && k.k11 > 0);
  }
}

TEST(Fabric, StiffnessAndStrainStayWithinTheirBounds) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-0.4, 0.8);
  for (const char* name : {"gray-interlock", "11oz-black-denim", "white-dots-on-blk"}) {
    const Fabric fabric = fabric_of(load_material(name, ""));
    const double bound = tensile_bound(fabric);
    double most = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Sym2 g{uniform(random), uniform(random), uniform(random)};
      const Stiffness k = stiffness_at(fabric, g);
      most = std::max({most, k.k11, k.k22});
      EXPECT_LE(0.5 * (largest_stretch2(g) - 1), strain_bound(g) + 1e-12);
    }
    EXPECT_LE(most, bound * (1 + 1e-12)) << name;
    EXPECT_GT(most, 0.5 * bound) << name;
  }
  EXPECT_EQ(strain_bound({0.1, 0, 0.2}), 0.2) << "reached where nothing shears";
}

Fabric limited() {
  Fabric fabric = fabric_of(cotton());
  fabric.limit_strain = 0.05, fabric.limit_stiffness = 3e4;
  return fabric;
}

TEST(StrainLimit, CostsNothingBelowItAndActsBeyond) {
  const Fabric fabric = limited();
  EXPECT_FALSE(strain_limit(fabric, {0.049, 0, 0.02}).active);
  EXPECT_FALSE(strain_limit(fabric, {0.0, 0.0499, 0.0}).active);
  EXPECT_TRUE(strain_limit(fabric, {0.0, 0.0501, 0.0}).active);  // principal strains ± 0.0501
  EXPECT_FALSE(strain_limit(fabric_of(cotton()), {3, 0, 3}).active);
}

TEST(StrainLimit, StressIsTheSlopeOfItsEnergyAlsoAtEqualStrains) {
  const Fabric fabric = limited();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.1, 0.2);
  for (int trial = 0; trial < 300; ++trial) {
    Sym2 g{uniform(random), uniform(random), uniform(random)};
    if (trial % 3 == 0) g.vv = g.uu, g.uv = trial % 2 == 0 ? 0 : 1e-9;
    const StrainLimit limit = strain_limit(fabric, g);
    const Sym2 s = limit.active ? limit_stress(limit) : Sym2{0, 0, 0};
    const double h = 1e-6;
    const auto slope = [&](double uu, double uv, double vv) {
      const Sym2 plus{g.uu + h * uu, g.uv + h * uv, g.vv + h * vv};
      const Sym2 minus{g.uu - h * uu, g.uv - h * uv, g.vv - h * vv};
      return (limit_energy(fabric, plus) - limit_energy(fabric, minus)) / (2 * h);
    };
    EXPECT_NEAR(s.uu, slope(1, 0, 0), 1e-3);
    EXPECT_NEAR(s.vv, slope(0, 0, 1), 1e-3);
    EXPECT_NEAR(2 * s.uv, slope(0, 1, 0), 1e-3);
  }
}

TEST(StrainLimit, LinearisationMissesWhatComesInOnTheWay) {
  const Fabric fabric = limited();
  const Real limit = fabric.limit_strain, width = Real(kLimitWidth);
  const auto missed = [&](Real at, Real end) {
    return missed_limit_strain(fabric, {at, 0, 0}, {end, 0, 0});
  };

  // Nothing is missed below the limit, nor where all of its stiffness has come in.
  EXPECT_NEAR(missed(0, limit), 0, 1e-12);
  EXPECT_NEAR(missed(limit + 2 * width, limit + 5 * width), 0, 1e-6);

  // A face that jumps over the limit was linearised as if there were none: all is missed but for
  // half the width in which the stiffness comes in.
  EXPECT_NEAR(missed(0, limit + Real(0.1)), Real(0.1) - width / 2, 1e-6);

  // On the way down, the linearisation goes on pulling where nothing pulls any more.
  EXPECT_NEAR(missed(limit + 2 * width, 0), limit + width / 2, 1e-6);
  EXPECT_EQ(missed_limit_strain(fabric_of(cotton()), {0, 0, 0}, {3, 0, 0}), 0);
}

using Matrix9 = Eigen::Matrix<double, 9, 9>;

TEST(StrainLimit, HessianIsTheDerivativeOfTheForceAndPositive) {
  const Fabric fabric = limited();
  const double inverse[4] = {100, 20, 0, 125}, area = 4e-5;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto force = [&](const Vec3r* x, int a) {
    const FaceFrame frame = face_frame(x, inverse);
    const StrainLimit limit = strain_limit(fabric, green_strain(frame));
    return limit.active ? membrane_force(frame, limit_stress(limit), area, a) : Vec3r{};
  };
  int active = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Vec3r x[3] = {{0, 0, 0}, {0.0105, 0, 0}, {-0.002, 0.0083, 0}};
    for (Vec3r& p : x) p += 1e-3 * Vec3r{uniform(random), uniform(random), uniform(random)};
    const FaceFrame frame = face_frame(x, inverse);
    const StrainLimit limit = strain_limit(fabric, green_strain(frame));
    if (!limit.active) continue;
    ++active;
    const FaceFrame principal = principal_frame(frame, limit);
    const Sym2 s = limit_stress(limit);
    Matrix9 tangent, with_stress;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const Mat3r h = limit_block(principal, limit, area, a, b);
        const Mat3r g = membrane_block(frame, {0, 0, 0, 0}, s, area, a, b);
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) {
            tangent(3 * a + r, 3 * b + c) = h(r, c);
            with_stress(3 * a + r, 3 * b + c) = h(r, c) + g(r, c);
          }
      }
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix9>(tangent).eigenvalues()(0),
              -1e-12 * tangent.norm());
    for (int column = 0; column < 9; ++column) {
      const double step = 1e-9;
      Vec3r plus[3] = {x[0], x[1], x[2]}, minus[3] = {x[0], x[1], x[2]};
      const Vec3r e{column % 3 == 0 ? step : 0, column % 3 == 1 ? step : 0,
                    column % 3 == 2 ? step : 0};
      plus[column / 3] += e, minus[column / 3] -= e;
      for (int a = 0; a < 3; ++a) {
        const Vec3r slope = (-1 / (2 * step)) * (force(plus, a) - force(minus, a));
        EXPECT_NEAR(with_stress(3 * a, column), slope.x, 2e-3 * with_stress.norm());
        EXPECT_NEAR(with_stress(3 * a + 1, column), slope.y, 2e-3 * with_stress.norm());
        EXPECT_NEAR(with_stress(3 * a + 2, column), slope.z, 2e-3 * with_stress.norm());
      }
    }
  }
  EXPECT_GT(active, 20);
}

}  // namespace
}  // namespace icloth::cpu64
