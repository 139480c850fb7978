// Membrane and bending against finite differences and exact states (double build).
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "kernels/bending.h"

namespace icloth::cpu64 {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Gray interlock of Wang et al. 2011, the fabric of the paper.
Fabric interlock(bool measured) {
  return {{{16.593832, -14.695990, 34.477123, 36.860302},
           {46.364765, 53.694656, 261.013855, -29.691301},
           {49.285110, 87.596100, 206.373993, 22.768457},
           {123.989220, 105.181770, 365.966217, 44.217571},
           {139.686325, 73.592560, 413.553162, -174.43853},
           {127.443810, 85.848587, 405.872833, 32.238411}},
          {{23.2e-6, 32.9e-6, 34.4e-6, 39.0e-6, 23.4e-6},
           {24.7e-6, 18.7e-6, 16.4e-6, 25.1e-6, 8.9e-6},
           {14.3e-6, 7.1e-6, 14.5e-6, 24.7e-6, 19.4e-6}},
          0,
          measured};
}

/// The same stiffness at every strain.
Fabric plain_fabric() {
  Fabric fabric = interlock(false);
  const Real row[4] = {40, 9, 70, 20};
  for (auto& r : fabric.stretching)
    for (int c = 0; c < 4; ++c) r[c] = row[c];
  return fabric;
}

struct RandomFace {
  Vec3r x[3];
  double inverse[4];
  double area;
};

/// A face of about 1 cm with random material frame, deformed by up to `strain`.
RandomFace random_face(std::mt19937& random, double strain) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Vec3r{uniform(random), uniform(random), uniform(random)}; };
  RandomFace f{};
  const double a = 0.01, b = 0.003 * uniform(random), c = 0.008;
  const double dm[4] = {a, b, 0, c};  // columns (a, 0), (b, c)
  const double det = dm[0] * dm[3];
  f.inverse[0] = dm[3] / det, f.inverse[1] = -dm[1] / det, f.inverse[2] = 0;
  f.inverse[3] = dm[0] / det;
  f.area = 0.5 * det;
  const Vec3r u = normalized(point());
  Vec3r v = point();
  v = normalized(v - dot(u, v) * u);
  const Vec3r uv[3] = {{0, 0, 0}, {a, 0, 0}, {b, c, 0}};
  for (int k = 0; k < 3; ++k) f.x[k] = uv[k].x * u + uv[k].y * v + (strain * 0.01) * point();
  return f;
}

double frozen_energy(const RandomFace& f, const Stiffness& k) {
  return f.area * membrane_energy(k, green_strain(face_frame(f.x, f.inverse)));
}

double& coordinate(Vec3r& p, int axis) { return axis == 0 ? p.x : (axis == 1 ? p.y : p.z); }

/// Force = −∂W/∂x by central differences, within `relative` × Σ|f| + `absolute`.
void expect_force_of_energy(const RandomFace& f, const Stiffness& k, double relative,
                            double absolute) {
  const FaceFrame frame = face_frame(f.x, f.inverse);
  const Sym2 s = stress(k, green_strain(frame));
  double scale = 0;
  for (int a = 0; a < 3; ++a) scale += norm(membrane_force(frame, s, f.area, a));
  for (int a = 0; a < 3; ++a) {
    Vec3r force = membrane_force(frame, s, f.area, a);
    for (int axis = 0; axis < 3; ++axis) {
      const double h = 1e-7;
      RandomFace plus = f, minus = f;
      coordinate(plus.x[a], axis) += h, coordinate(minus.x[a], axis) -= h;
      const double slope = (frozen_energy(plus, k) - frozen_energy(minus, k)) / (2 * h);
      EXPECT_NEAR(coordinate(force, axis), -slope, relative * scale + absolute);
    }
  }
}

TEST(Membrane, ForceIsMinusTheGradientOfTheFrozenEnergy) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    RandomFace f = random_face(random, trial < 100 ? 0.1 : 0.5);
    const FaceFrame frame = face_frame(f.x, f.inverse);
    const Sym2 g = green_strain(frame);
    const Stiffness k = stiffness_at(interlock(true), g);
    expect_force_of_energy(f, k, 1e-5, 1e-12);
  }
}

Eigen::Matrix<double, 9, 9> hessian(const RandomFace& f, const Stiffness& k, bool project) {
  const FaceFrame frame = face_frame(f.x, f.inverse);
  const Sym2 s = stress(k, green_strain(frame));
  Eigen::Matrix<double, 9, 9> h;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const Mat3r block = membrane_block(frame, k, project ? positive_part(s) : s, f.area, a, b);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) h(3 * a + r, 3 * b + c) = block(r, c);
    }
  return h;
}

TEST(Membrane, UnprojectedHessianIsTheDerivativeOfTheForce) {
  std::mt19937 random(2);
  const Stiffness k{60, 10, 90, 30};
  for (int trial = 0; trial < 50; ++trial) {
    const RandomFace f = random_face(random, 0.3);
    const auto h = hessian(f, k, false);
    for (int b = 0; b < 3; ++b)
      for (int axis = 0; axis < 3; ++axis) {
        const double step = 1e-8;
        RandomFace plus = f, minus = f;
        coordinate(plus.x[b], axis) += step, coordinate(minus.x[b], axis) -= step;
        const auto force = [&](const RandomFace& at, int a) {
          const FaceFrame frame = face_frame(at.x, at.inverse);
          return membrane_force(frame, stress(k, green_strain(frame)), at.area, a);
        };
        for (int a = 0; a < 3; ++a) {
          Vec3r slope = (1 / (2 * step)) * (force(plus, a) - force(minus, a));
          for (int r = 0; r < 3; ++r)
            EXPECT_NEAR(h(3 * a + r, 3 * b + axis), -coordinate(slope, r), 1e-5 * h.norm());
        }
      }
  }
}

TEST(Membrane, ProjectedHessianIsPositiveSemiDefinite) {
  std::mt19937 random(3);
  for (const double strain : {0.05, 0.5, 3.0}) {  // 3: inverted and collapsed faces too
    for (int trial = 0; trial < 300; ++trial) {
      const RandomFace f = random_face(random, strain);
      const Stiffness k = stiffness_at(interlock(true), green_strain(face_frame(f.x, f.inverse)));
      const auto h = hessian(f, k, true);
      EXPECT_LT((h - h.transpose()).norm(), 1e-12 * h.norm());
      const double smallest =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>(h).eigenvalues()(0);
      EXPECT_GT(smallest, -1e-12 * h.norm());
    }
  }
}

TEST(Membrane, RestStateAndRotationsAreFreeOfForce) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const RandomFace f = random_face(random, 0);
    const FaceFrame frame = face_frame(f.x, f.inverse);
    const Sym2 g = green_strain(frame);
    EXPECT_NEAR(g.uu, 0, 1e-13);
    EXPECT_NEAR(g.uv, 0, 1e-13);
    EXPECT_NEAR(g.vv, 0, 1e-13);
  }
}

TEST(Membrane, UniaxialStretchGivesTheMeasuredRows) {
  // 16.7 % along weft: row 1; along warp: row 5. Small shear has modulus c33.
  const Fabric fabric = interlock(true);
  const auto at = [&](double stretch_u, double stretch_v) {
    return stiffness_at(fabric,
                        {0.5 * (stretch_u * stretch_u - 1), 0, 0.5 * (stretch_v * stretch_v - 1)});
  };
  const double full = 7.0 / 6.0;
  EXPECT_NEAR(at(full, 1).k11, 2 * 46.364765, 1e-3);
  EXPECT_NEAR(at(full, 1).k22, 2 * 261.013855, 1e-2);
  EXPECT_NEAR(at(1, full).k11, 2 * 127.443810, 1e-3);
  EXPECT_NEAR(at(1, full).k33, 2 * 32.238411, 1e-3);
  EXPECT_NEAR(at(1, 1).k22, 2 * 34.477123, 1e-9);
  EXPECT_EQ(at(1, 1).k12, 0);  // negative measured entries act as zero
}

/// States in which formulas like to fail: squashed to a line or a point, an edge of no length,
/// turned inside out, stretched a hundredfold.
std::vector<RandomFace> degenerate_faces() {
  std::mt19937 random(11);
  std::vector<RandomFace> faces;
  const auto add = [&](auto deform) {
    RandomFace f = random_face(random, 0);
    deform(f);
    faces.push_back(f);
  };
  add([](RandomFace& f) { f.x[2] = f.x[1]; });
  add([](RandomFace& f) { f.x[1] = f.x[2] = f.x[0]; });
  add([](RandomFace& f) { f.x[2] = 0.5 * (f.x[0] + f.x[1]); });
  add([](RandomFace& f) { f.x[2] = f.x[0] - (f.x[2] - f.x[0]); });
  add([](RandomFace& f) {
    for (Vec3r& p : f.x) p = 100.0 * p;
  });
  add([](RandomFace& f) { f.x[2] = f.x[0] + 1e-6 * (f.x[2] - f.x[0]) + 0.3 * (f.x[1] - f.x[0]); });
  return faces;
}

TEST(Membrane, DegenerateAndInvertedFacesKeepForceHessianAndPositivity) {
  for (const bool measured : {false, true}) {
    const Fabric fabric = measured ? interlock(true) : plain_fabric();
    for (const RandomFace& f : degenerate_faces()) {
      const FaceFrame frame = face_frame(f.x, f.inverse);
      const Stiffness k = stiffness_at(fabric, green_strain(frame));
      expect_force_of_energy(f, k, 1e-4, 1e-13);
      const auto h = hessian(f, k, true);
      EXPECT_TRUE(h.allFinite());
      const double smallest =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>(h).eigenvalues()(0);
      EXPECT_GE(smallest, -1e-12 * h.norm());
    }
  }
}

TEST(Membrane, ForcesTurnWithTheFace) {
  std::mt19937 random(12);
  const Eigen::Matrix3d r = (Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(-0.7, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(2.3, Eigen::Vector3d::UnitZ()))
                                .toRotationMatrix();
  const auto turned = [&](Vec3r p) {
    const Eigen::Vector3d q = r * Eigen::Vector3d(p.x, p.y, p.z);
    return Vec3r{q.x(), q.y(), q.z()};
  };
  for (int trial = 0; trial < 50; ++trial) {
    const RandomFace f = random_face(random, 0.3);
    RandomFace g = f;
    for (Vec3r& p : g.x) p = turned(p) + Vec3r{1, -2, 3};
    const auto force = [&](const RandomFace& face, int a) {
      const FaceFrame frame = face_frame(face.x, face.inverse);
      const Sym2 strain = green_strain(frame);
      return membrane_force(frame, stress(stiffness_at(interlock(true), strain), strain), face.area,
                            a);
    };
    Vec3r sum{}, torque{};
    double scale = 0;
    for (int a = 0; a < 3; ++a) {
      const Vec3r one = force(f, a);
      sum += one, torque += cross(f.x[a], one), scale += norm(one);
      EXPECT_LT(norm(turned(one) - force(g, a)), 1e-10 * (1 + norm(one)));
    }
    EXPECT_LT(norm(sum), 1e-12 * scale);
    EXPECT_LT(norm(torque), 1e-12 * scale);
  }
}

/// A patch of irregular triangles under x = F U: every face has the strain and the stress of F, and
/// all forces on the vertex in the middle cancel.
TEST(Membrane, AffinePatchIsInBalanceWithTheStressOfTheFormula) {
  const double f[3][2] = {{1.1, 0.2}, {-0.1, 0.9}, {0.3, -0.2}};
  const Vec2d ring[6] = {{0.012, 0.001},   {0.004, 0.011},   {-0.008, 0.006},
                         {-0.011, -0.002}, {-0.002, -0.009}, {0.009, -0.007}};
  const Vec2d centre{0.001, -0.002};
  const double guu = 0.5 * (f[0][0] * f[0][0] + f[1][0] * f[1][0] + f[2][0] * f[2][0] - 1);
  const double gvv = 0.5 * (f[0][1] * f[0][1] + f[1][1] * f[1][1] + f[2][1] * f[2][1] - 1);
  const double guv = 0.5 * (f[0][0] * f[0][1] + f[1][0] * f[1][1] + f[2][0] * f[2][1]);
  for (const bool measured : {false, true}) {
    const Fabric fabric = measured ? interlock(true) : plain_fabric();
    const Stiffness k = stiffness_at(fabric, {guu, guv, gvv});
    Vec3r middle{};
    double scale = 0;
    for (int i = 0; i < 6; ++i) {
      const Vec2d u[3] = {centre, ring[i], ring[(i + 1) % 6]};
      const Vec2d a = u[1] - u[0], b = u[2] - u[0];
      const double det = a.x * b.y - a.y * b.x;
      const double inverse[4] = {b.y / det, -b.x / det, -a.y / det, a.x / det};
      Vec3r x[3];
      for (int c = 0; c < 3; ++c)
        x[c] = {f[0][0] * u[c].x + f[0][1] * u[c].y, f[1][0] * u[c].x + f[1][1] * u[c].y,
                f[2][0] * u[c].x + f[2][1] * u[c].y};
      const FaceFrame frame = face_frame(x, inverse);
      const Sym2 g = green_strain(frame);
      EXPECT_NEAR(g.uu, guu, 1e-12);
      EXPECT_NEAR(g.uv, guv, 1e-12);
      EXPECT_NEAR(g.vv, gvv, 1e-12);
      const Sym2 s = stress(stiffness_at(fabric, g), g);
      EXPECT_NEAR(s.uu, k.k11 * guu + k.k12 * gvv, 1e-9);
      EXPECT_NEAR(s.vv, k.k22 * gvv + k.k12 * guu, 1e-9);
      EXPECT_NEAR(s.uv, k.k33 * guv, 1e-9);
      const Vec3r force = membrane_force(frame, s, 0.5 * det, 0);
      middle += force, scale += norm(force);
    }
    EXPECT_LT(norm(middle), 1e-10 * scale);
  }
}

TEST(Bending, AngleGradientMatchesFiniteDifferences) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const double fold = 0.9 * kPi * uniform(random);
    Vec3r x[4] = {{0, 0, 0},
                  {0.01, 0, 0},
                  {0.004 + 0.002 * uniform(random), 0.008, 0},
                  {0.005, -0.007 * std::cos(fold), 0.007 * std::sin(fold)}};
    for (Vec3r& p : x) p += Vec3r{1e-3 * uniform(random), 1e-3 * uniform(random), 0};
    const HingeAngle angle = hinge_angle(x);
    for (int a = 0; a < 4; ++a)
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-8;
        Vec3r plus[4] = {x[0], x[1], x[2], x[3]}, minus[4] = {x[0], x[1], x[2], x[3]};
        coordinate(plus[a], axis) += h, coordinate(minus[a], axis) -= h;
        const double slope = (hinge_angle(plus).theta - hinge_angle(minus).theta) / (2 * h);
        Vec3r gradient = angle.gradient[a];
        EXPECT_NEAR(coordinate(gradient, axis), slope, 1e-4 * (1 + std::fabs(slope)));
      }
  }
}

TEST(Bending, GradientNeitherPushesNorTurnsTheHinge) {
  const Vec3r x[4] = {{0, 0, 0}, {0.01, 0, 0}, {0.004, 0.008, 0.001}, {0.005, -0.005, 0.006}};
  const HingeAngle angle = hinge_angle(x);
  Vec3r force{}, torque{};
  for (int a = 0; a < 4; ++a) {
    force += angle.gradient[a];
    torque += cross(x[a], angle.gradient[a]);
  }
  EXPECT_LT(norm(force), 1e-10);
  EXPECT_LT(norm(torque), 1e-12);
}

TEST(Bending, FlatAndDegenerateHingesStayFinite) {
  const Vec3r flat[4] = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}};
  EXPECT_NEAR(hinge_angle(flat).theta, 0, 1e-15);
  const Vec3r sliver[4] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0.5, -1, 0}};
  const Vec3r point[4] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (const auto* x : {sliver, point}) {
    const HingeAngle angle = hinge_angle(x);
    EXPECT_TRUE(std::isfinite(angle.theta));
    for (const Vec3r& g : angle.gradient) EXPECT_TRUE(std::isfinite(norm(g)));
  }
}

/// Energy of a hinge whose stiffness is the same at every curvature.
double hinge_energy(const Vec3r x[4], const HingeRest& rest, const Fabric& fabric) {
  const double theta = hinge_angle(x).theta;
  const double k = hinge_stiffness(fabric, fabric, rest, theta);
  return 0.5 * k * (theta - rest.angle) * (theta - rest.angle);
}

TEST(Bending, ForceIsMinusTheGradientOfTheEnergyAlsoFoldedFlatAndOnSlivers) {
  const Fabric fabric = plain_fabric();
  HingeRest rest{};
  rest.length = 0.01, rest.area = 8e-5, rest.weight = 1, rest.direction = 0.3, rest.angle = 0.2;
  const Vec3r states[][4] = {
      {{0, 0, 0}, {0.01, 0, 0}, {0.004, 0.008, 0}, {0.005, -0.007, 0}},      // flat
      {{0, 0, 0}, {0.01, 0, 0}, {0.004, 0.008, 0}, {0.005, 0.007, 1e-4}},    // nearly folded
      {{0, 0, 0}, {0.01, 0, 0}, {0.004, 0.008, 0}, {0.005, 0.001, -0.006}},  // a right angle
      {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0.0005, 0.001}, {0.003, -0.00005, 0.00005}},  // slivers
      {{0, 0, 0}, {0.001, 0, 0}, {0.004, 0.008, 0}, {0.005, -0.007, 0.003}}};        // a short edge
  for (const auto& x : states) {
    const HingeAngle angle = hinge_angle(x);
    const double k = hinge_stiffness(fabric, fabric, rest, angle.theta);
    for (int a = 0; a < 4; ++a)
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-9;
        Vec3r plus[4] = {x[0], x[1], x[2], x[3]}, minus[4] = {x[0], x[1], x[2], x[3]};
        coordinate(plus[a], axis) += h, coordinate(minus[a], axis) -= h;
        const double slope =
            (hinge_energy(plus, rest, fabric) - hinge_energy(minus, rest, fabric)) / (2 * h);
        Vec3r force = -k * (angle.theta - rest.angle) * angle.gradient[a];
        EXPECT_NEAR(coordinate(force, axis), -slope, 1e-4 * std::fabs(slope) + 1e-9);
      }
  }
}

TEST(Bending, ValleyAndMountainFoldsAreEquallyStiff) {
  HingeRest hinge{};
  hinge.length = 0.01, hinge.area = 1e-4, hinge.weight = 1, hinge.direction = 0.3;
  const Fabric fabric = interlock(true);
  for (const double theta : {0.01, 0.1, 0.5, 2.0})
    EXPECT_EQ(hinge_stiffness(fabric, fabric, hinge, theta),
              hinge_stiffness(fabric, fabric, hinge, -theta));
}

}  // namespace
}  // namespace icloth::cpu64
