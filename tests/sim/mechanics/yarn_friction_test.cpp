// Friction between yarns: the loops of the Kawabata tests on one face (double build).
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include "kernels/yarn_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "sim/mechanics/membrane.h"

namespace icloth::cpu64 {
namespace {

constexpr double kBending = 1e-3, kShear = 3;

Fabric rubbing() {
  Fabric f{};
  f.bending_friction = kBending;
  f.shear_friction = kShear;
  return f;
}

Sym2 moment(const YarnAnchor& anchor, Sym2 curvature) {
  const Sym2 away = curvature - anchor.curvature;
  return plate_moment(bending_friction_moduli(rubbing(), away), away);
}

/// Fold of a curvature along a direction.
Sym2 fold(double curvature, double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180),
               s = std::sin(degrees * std::numbers::pi / 180);
  return {curvature * c * c, curvature * c * s, curvature * s * s};
}

/// From 0 to `most`, to −most and back in small steps.
std::vector<double> loop(double most) {
  constexpr int kSteps = 1000;
  std::vector<double> path;
  for (int k = 0; k <= kSteps; ++k) path.push_back(most * k / kSteps);
  for (int k = 1; k <= 2 * kSteps; ++k) path.push_back(most - most * k / kSteps);
  for (int k = 1; k <= 2 * kSteps; ++k) path.push_back(-most + most * k / kSteps);
  return path;
}

struct Loop {
  double width = 0;  ///< between the branches, at 0
  double area = 0;   ///< work lost in the closed part
};

/// Drives a deformation through `path`, whose first fifth is not part of the closed loop.
Loop drive(const std::vector<double>& path, const std::function<YarnAnchor(double)>& deformation,
           const std::function<double(const YarnAnchor&, double)>& force) {
  Loop out;
  YarnAnchor anchor = deformation(0);
  double before = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double now = force(anchor, path[i]);
    if (i > path.size() / 5) {
      out.area += 0.5 * (now + before) * (path[i] - path[i - 1]);
      if (std::fabs(path[i]) < 1e-9) out.width += path[i] > path[i - 1] ? now : -now;
    }
    before = now;
    anchor = dragged(anchor, deformation(path[i]));
  }
  return out;
}

TEST(YarnFriction, ABendingLoopIs2HBWideAndLosesItsArea) {
  const double most = 100;
  for (const double degrees : {0.0, 30.0, 45.0, 90.0}) {
    const Sym2 unit = fold(1, degrees);
    const Loop l = drive(
        loop(most),
        [&](double curvature) {
          return YarnAnchor{fold(curvature, degrees), 0};
        },
        [&](const YarnAnchor& anchor, double curvature) {
          const Sym2 m = moment(anchor, fold(curvature, degrees));
          return m.uu * unit.uu + m.vv * unit.vv + m.uv * unit.uv;
        });
    EXPECT_NEAR(l.width, 2 * kBending, 1e-12) << degrees;
    EXPECT_NEAR(l.area, 4 * kBending * (most - kCurvatureSlip), 1e-4 * l.area) << degrees;
  }
}

TEST(YarnFriction, AShearLoopIs2HGWideAndLosesItsArea) {
  const double most = 0.05;
  const Loop l = drive(
      loop(most),
      [](double strain) {
        return YarnAnchor{{0, 0, 0}, strain};
      },
      [](const YarnAnchor& anchor, double strain) {
        const double away = strain - anchor.shear;
        return shear_friction_stiffness(rubbing(), away) * away;
      });
  EXPECT_NEAR(l.width, 2 * kShear, 1e-9);
  EXPECT_NEAR(l.area, 4 * kShear * (most - kShearSlip), 1e-4 * l.area);
}

TEST(YarnFriction, SmallDeformationsAreElastic) {
  const YarnAnchor rest{fold(20, 10), 0.01};
  YarnAnchor anchor = rest;
  for (const double share : {0.5, -0.9, 0.99, 0.0}) {
    const Sym2 away = fold(share * kCurvatureSlip, 70);
    const YarnAnchor now{rest.curvature + away, rest.shear + share * kShearSlip};
    const Sym2 m = moment(anchor, now.curvature);
    EXPECT_NEAR(m.uu, kBending / kCurvatureSlip * away.uu, 1e-15);
    EXPECT_NEAR(m.uv, 2 * kBending / kCurvatureSlip * away.uv, 1e-15);
    anchor = dragged(anchor, now);
    EXPECT_EQ(anchor.shear, rest.shear);
    EXPECT_EQ(anchor.curvature.uu, rest.curvature.uu);
  }
}

TEST(YarnFriction, WorkIsWhatTheLoopsLose) {
  const double most = 100, shear = 5e-4;  // at the same time
  double work = 0;
  YarnAnchor anchor{{0, 0, 0}, 0}, before = anchor;
  const std::vector<double> path = loop(most);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const YarnAnchor now{fold(path[i], 30), shear * path[i]};
    if (i > path.size() / 5) work += yarn_work_density(rubbing(), anchor, before, now);
    anchor = dragged(anchor, now);
    before = now;
  }
  const double lost =
      4 * kBending * (most - kCurvatureSlip) + 2 * 4 * kShear * (shear * most - kShearSlip);
  EXPECT_NEAR(work, -lost, 2e-2 * lost);
}

TEST(YarnFriction, NeverPullsHarderThanTheYarnsHold) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-200, 200);
  YarnAnchor anchor{{0, 0, 0}, 0};
  for (int k = 0; k < 1000; ++k) {
    const YarnAnchor now{{uniform(random), uniform(random), uniform(random)},
                         1e-3 * uniform(random)};
    const Sym2 m = moment(anchor, now.curvature);
    EXPECT_LE(std::sqrt(m.uu * m.uu + m.vv * m.vv + 0.5 * m.uv * m.uv), kBending * (1 + 1e-12));
    anchor = dragged(anchor, now);
    EXPECT_LE(curvature_size(now.curvature - anchor.curvature), kCurvatureSlip * (1 + 1e-12));
    EXPECT_LE(std::fabs(now.shear - anchor.shear), kShearSlip * (1 + 1e-12));
    const YarnAnchor again = dragged(anchor, now);
    EXPECT_NEAR(curvature_size(again.curvature - anchor.curvature), 0, 1e-10);
    EXPECT_NEAR(again.shear, anchor.shear, 1e-15);
  }
}

TEST(YarnFriction, DampingLeavesTheShearForceAlone) {
  // A half of a unit square, sheared fast: corners feel area · HG times the gradient of 2 G_uv.
  const std::vector<Vec3r> x{{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, v{{0, 0, 0}, {0, 0, -3}, {3, 0, 0}};
  const Real dt = 0.01;
  std::vector<Vec3r> predicted;
  for (const Vec3r& u : v) predicted.push_back(dt * u);
  const Int3 face{{0, 1, 2}};
  const Topology::Inverse inverse{{1, 0, 0, 1}};
  const Real area = 0.5;
  const Index first = 0;
  YarnAnchor anchor{{0, 0, 0}, 0};
  const auto impulse = [&](Real damping, bool rubs) {
    Fabric fabric = rubbing();
    fabric.damping = damping;
    FaceTerm term;
    const View<const Vec3r> here(x.data(), 3);
    const Linearization point{.start = here,
                              .at = here,
                              .predicted = {predicted.data(), 3},
                              .v = {v.data(), 3},
                              .dt = dt};
    const View<const YarnAnchor> yarns =
        rubs ? View<const YarnAnchor>(&anchor, 1) : View<const YarnAnchor>{};
    const auto shares =
        bundle_of(MembraneShare{.point = point, .extra_damping = 0, .friction = {yarns}});
    FacePass<std::decay_t<decltype(shares)>>{.face = {&face, 1},
                                             .inverse = {&inverse, 1},
                                             .area = {&area, 1},
                                             .face_fabric = {&first, 1},
                                             .fabric = {&fabric, 1},
                                             .point = point,
                                             .term = {&term, 1},
                                             .shares = shares}(0);
    return term.impulse[1];
  };
  for (const Real damping : {0.0, 2.0}) {
    const Vec3r share = impulse(damping, true) - impulse(damping, false);
    EXPECT_NEAR(norm(share), dt * area * kShear, 1e-9) << damping;
  }
  anchor.shear = -0.05;  // stress already before the step
  const Vec3r held = impulse(0, true) - impulse(0, false);
  EXPECT_NEAR(norm(held), dt * area * kShear, 0.05 * dt * area * kShear);
  EXPECT_LT(norm(impulse(2, true) - impulse(2, false) - held), 1e-9);
}

}  // namespace
}  // namespace icloth::cpu64
