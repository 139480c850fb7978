// Bending stiffness of whole sheets: single hinges against plates on meshes of all layouts (double
// build).
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "kernels/index.h"
#include "sim/mechanics/bending_terms.h"
#include "sim/mechanics/plates.h"
#include "tests/sim/files/mesh_layouts.h"

namespace icloth::cpu64 {
namespace {

using testing::kLayouts;
using testing::Layout;

/// Every hinge has k_e = 4: the bending modulus D is 1.
Fabric unit_fabric() {
  Fabric f{};
  for (auto& row : f.bending)
    for (Real& k : row) k = 4;
  return f;
}

struct Sheet {
  explicit Sheet(Cloth cloth, const Fabric& f = unit_fabric()) : fabric(f) {
    Scene scene;
    scene.cloths.push_back(std::move(cloth));
    world = make_world(scene);
    for (const FacePlate& plate : make_plates(world)) {
      PlateRest rest{};
      for (std::size_t i = 0; i < 9; ++i) rest.w[i] = plate.w[i];
      for (std::size_t a = 0; a < 3; ++a) rest.hinge[a] = plate.hinge[a];
      plates.push_back(rest);
    }
    for (const Hinge& h : world.hinges)
      hinges.push_back({{{h.vertices[0], h.vertices[1], h.vertices[2], h.vertices[3]}},
                        0,
                        0,
                        h.rest_angle,
                        h.rest_length,
                        h.rest_area,
                        h.direction,
                        h.weight});
  }

  std::vector<Real> angles(const std::vector<Vec3r>& x) const {
    std::vector<Real> theta;
    for (const HingeRest& h : hinges)
      theta.push_back(hinge_angle_of(h, {x.data(), static_cast<Index>(x.size())}).theta - h.angle);
    return theta;
  }

  /// Energy of each face: half of that of its hinges, or of it as a plate.
  std::vector<Real> energies(const std::vector<Real>& theta, bool plate) const {
    std::vector<Real> energy(plates.size(), Real(0));
    for (std::size_t h = 0; !plate && h < hinges.size(); ++h) {
      const Real k = hinge_stiffness(fabric, fabric, hinges[h], theta[h] + hinges[h].angle);
      for (const Index f : {world.hinges[h].face0, world.hinges[h].face1})
        energy[at(f)] += k * theta[h] * theta[h] / 4;
    }
    for (std::size_t f = 0; plate && f < plates.size(); ++f) {
      Real angle[3] = {0, 0, 0};
      for (int a = 0; a < 3; ++a)
        if (plates[f].hinge[a] >= 0) angle[a] = theta[at(plates[f].hinge[a])];
      const Sym2 c = plate_curvature(plates[f], angle);
      energy[f] = world.face_area[f] * plate_energy(plate_moduli(fabric, c), c);
    }
    return energy;
  }

  Fabric fabric;
  World world;
  std::vector<PlateRest> plates;
  std::vector<HingeRest> hinges;
};

/// Small deflections z of a flat sheet over squares of side 1, whose angles are linear in z.
class Deflection {
 public:
  Deflection(const Sheet& sheet, bool plate) : sheet_(sheet), plate_(plate) {
    std::vector<Vec3r> x;
    for (const Vec3d& p : sheet.world.rest) x.push_back({p.x, 0, p.z});
    for (const HingeRest& h : sheet.hinges)
      angle_.push_back(hinge_angle_of(h, {x.data(), static_cast<Index>(x.size())}));
    for (const Vec3d& p : sheet.world.rest)
      high_ = {std::max(high_.x, p.x), 0, std::min(high_.z, p.z)};
    for (const Vec3d& p : sheet.world.rest) free_.push_back(from_border(p) > 1.6);
  }

  std::vector<Real> surface(const std::function<Real(Real, Real)>& height) const {
    std::vector<Real> z;
    for (const Vec3d& p : sheet_.world.rest)
      z.push_back(height(p.x - high_.x / 2, high_.z / 2 - p.z));
    return z;
  }

  /// Energy per area in the middle.
  Real energy(const std::vector<Real>& z) const {
    const std::vector<Real> each = sheet_.energies(angles(z), plate_);
    Real energy = 0, area = 0;
    for (std::size_t f = 0; f < each.size(); ++f) {
      Vec3d centre{};
      for (const Index v : sheet_.world.face[f]) centre += (1.0 / 3) * sheet_.world.rest[at(v)];
      if (from_border(centre) < 3.99) continue;
      energy += each[f], area += sheet_.world.face_area[f];
    }
    return energy / area;
  }

  /// Heights of least energy for all vertices but those of the border, by conjugate gradients.
  std::vector<Real> relaxed(std::vector<Real> z) const {
    std::vector<Real> r = gradient(z);
    for (Real& c : r) c = -c;
    std::vector<Real> p = r;
    Real rr = product(r, r);
    const Real enough = 1e-16 * rr;
    for (int i = 0; i < 3000 && rr > enough && rr > 1e-24; ++i) {
      const std::vector<Real> ap = gradient(p);
      const Real step = rr / product(p, ap);
      for (std::size_t v = 0; v < z.size(); ++v) z[v] += step * p[v], r[v] -= step * ap[v];
      const Real next = product(r, r);
      for (std::size_t v = 0; v < z.size(); ++v) p[v] = r[v] + next / rr * p[v];
      rr = next;
    }
    return z;
  }

 private:
  double from_border(Vec3d p) const { return std::min({p.x, high_.x - p.x, -p.z, p.z - high_.z}); }
  static Real product(const std::vector<Real>& a, const std::vector<Real>& b) {
    Real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }
  std::vector<Real> angles(const std::vector<Real>& z) const {
    std::vector<Real> theta(angle_.size(), Real(0));
    for (std::size_t h = 0; h < angle_.size(); ++h)
      for (int a = 0; a < 4; ++a)
        theta[h] += angle_[h].gradient[a].y * z[at(sheet_.hinges[h].v.v[a])];
    return theta;
  }
  /// Gradient of the energy, which is quadratic in z, at the vertices that are free.
  std::vector<Real> gradient(const std::vector<Real>& z) const {
    const std::vector<Real> theta = angles(z);
    std::vector<Real> torque(theta.size(), Real(0)), g(z.size(), Real(0));
    for (std::size_t h = 0; !plate_ && h < theta.size(); ++h)
      torque[h] = hinge_stiffness(sheet_.fabric, sheet_.fabric, sheet_.hinges[h], 0) * theta[h];
    for (std::size_t f = 0; plate_ && f < sheet_.plates.size(); ++f) {
      const PlateRest& plate = sheet_.plates[f];
      Real angle[3] = {0, 0, 0};
      for (int a = 0; a < 3; ++a)
        if (plate.hinge[a] >= 0) angle[a] = theta[at(plate.hinge[a])];
      const Sym2 c = plate_curvature(plate, angle);
      const Sym2 moment = plate_moment(plate_moduli(sheet_.fabric, c), c);
      for (int a = 0; a < 3; ++a)
        if (plate.hinge[a] >= 0)
          torque[at(plate.hinge[a])] += plate_torque(plate, moment, sheet_.world.face_area[f], a);
    }
    for (std::size_t h = 0; h < theta.size(); ++h)
      for (int a = 0; a < 4; ++a) {
        const Index v = sheet_.hinges[h].v.v[a];
        if (free_[at(v)]) g[at(v)] += torque[h] * angle_[h].gradient[a].y;
      }
    return g;
  }

  const Sheet& sheet_;
  bool plate_;
  std::vector<HingeAngle> angle_;
  std::vector<bool> free_;
  Vec3d high_{};
};

constexpr double kDirections[] = {0, 22.5, 45, 67.5, 90, 135};

/// Modulus against a cylinder curved along each direction, then against a twist, 2 E / D.
std::vector<double> moduli(const Deflection& deflection, bool relax) {
  std::vector<double> list;
  const auto add = [&](double degrees, bool twist) {
    const double c = std::cos(degrees * std::numbers::pi / 180),
                 s = std::sin(degrees * std::numbers::pi / 180);
    const std::vector<Real> z = deflection.surface([&](Real x, Real y) {
      const Real along = c * x + s * y, across = c * y - s * x;
      return twist ? along * across : along * along / 2;
    });
    list.push_back((twist ? 1 : 2) * deflection.energy(relax ? deflection.relaxed(z) : z));
  };
  for (const double degrees : kDirections) add(degrees, false);
  add(0, true);
  return list;
}

std::vector<double> moduli(Layout layout, bool plate, bool relax) {
  const Sheet sheet(testing::make_layout(layout, 20, 20, 1.0));
  const std::vector<double> list = moduli(Deflection(sheet, plate), relax);
  std::printf("%-12s %-5s %-8s", testing::name_of(layout), plate ? "plate" : "hinge",
              relax ? "at rest" : "imposed");
  for (const double modulus : list) std::printf(" %.2f", modulus);
  std::printf("\n");
  return list;
}

void expect_moduli(Layout layout, bool plate, bool relax, const std::vector<double>& expected,
                   double tolerance) {
  const std::vector<double> measured = moduli(layout, plate, relax);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(measured[i], expected[i], tolerance) << testing::name_of(layout) << ", place " << i;
}

TEST(BendingStiffness, OfHingesDependsOnTheLayoutOfTheMesh) {
  // Right triangles with one diagonal: three times as stiff along it. Last: the twist, 1 for a
  // plate.
  expect_moduli(Layout::equilateral, false, false, {1, 1, 1, 1, 1, 1, 1.333}, 0.01);
  expect_moduli(Layout::one_diagonal, false, false, {1, 2.207, 3, 2.207, 1, 1, 3}, 0.01);
  expect_moduli(Layout::alternating, false, false, {1, 1.25, 1.5, 1.25, 1, 1.5, 2}, 0.01);
  expect_moduli(Layout::cross, false, false, {1.5, 1.25, 1, 1.25, 1.5, 1, 1}, 0.01);
  expect_moduli(Layout::jittered, false, false, {1.3, 1.7, 2.1, 1.7, 1.3, 2.1, 2.9}, 0.3);
  expect_moduli(Layout::one_diagonal, false, true, {1, 2.207, 3, 2.207, 1, 1, 3}, 0.01);
}

TEST(BendingStiffness, OfPlatesIsTheSameOnEveryLayout) {
  for (const Layout layout : {Layout::equilateral, Layout::one_diagonal})
    expect_moduli(layout, true, true, {1, 1, 1, 1, 1, 1, 1}, 1e-3);
  for (const Layout layout : {Layout::alternating, Layout::cross, Layout::jittered}) {
    const std::vector<double> plate = moduli(layout, true, true);
    for (std::size_t i = 0; i < std::size(kDirections); ++i) EXPECT_NEAR(plate[i], 1, 0.1);
    EXPECT_NEAR(plate.back(), 1.1, 0.2);
    const std::vector<double> hinge = moduli(layout, false, true);
    const auto [low, high] = std::minmax_element(hinge.begin(), hinge.end() - 1);
    EXPECT_GT(*high / *low, 1.5);  // what it is compared with
  }
}

TEST(BendingStiffness, OfOrthotropicPlatesFollowsTheTensor) {
  Fabric fabric = unit_fabric();
  for (int c = 0; c < 5; ++c) fabric.bending[0][c] = 12, fabric.bending[1][c] = 6;
  fabric.bending_poisson = 0.3;
  const Sheet sheet(testing::make_layout(Layout::one_diagonal, 20, 20, 1.0), fabric);
  const std::vector<double> measured = moduli(Deflection(sheet, true), false);
  // D_u = 1, D_v = 3 (a hinge along u bends along v), D at 45° 1.5.
  EXPECT_NEAR(measured[0], 1, 1e-3);
  EXPECT_NEAR(measured[2], 1.5, 1e-3);
  EXPECT_NEAR(measured[4], 3, 1e-3);
  EXPECT_NEAR(measured[5], 1.5, 1e-3);
}

TEST(Plate, MeasuredModuliAreThoseOfTheDataInTheirDirections) {
  Fabric fabric = unit_fabric();
  fabric.measured = true;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 5; ++c) fabric.bending[r][c] = 10 + r + 2 * c;
  fabric.bending_spacing = 20;
  // Curvature 30 /m is half way between the second and third sample; 100 is beyond the last.
  for (const auto& [size, sample] : {std::pair{0.0, 0.0}, {30.0, 1.5}, {100.0, 4.0}}) {
    for (const double degrees : {0.0, 45.0, 90.0}) {
      const double c = std::cos(degrees * std::numbers::pi / 180),
                   s = std::sin(degrees * std::numbers::pi / 180);
      const Sym2 curvature{size * c * c, size * c * s, size * s * s};
      const PlateModuli m = plate_moduli(fabric, curvature);
      const double row = degrees == 0 ? 2 : (degrees == 90 ? 0 : 1);
      const Sym2 unit{c * c, c * s, s * s};
      EXPECT_NEAR(2 * plate_energy(m, unit), (10 + row + 2 * sample) / 4, 1e-9);
    }
  }
}

TEST(Plate, ModuliStayPositiveForEveryFabricAndCurvature) {
  for (const char* name : {"gray-interlock", "11oz-black-denim", "white-dots-on-blk",
                           "ivory-rib-knit", "pink-ribbon-brown", "camel-ponte-roma"}) {
    Fabric fabric{};
    const Material material = load_material(name, "");
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 5; ++c) fabric.bending[r][c] = material.bending[r][c];
    fabric.measured = true;
    fabric.bending_spacing = material.bending_spacing;
    for (double curvature = 0; curvature < 120; curvature += 5) {
      const PlateModuli m = plate_moduli(fabric, {curvature, 0, 0});
      EXPECT_GT(m.d33, 0) << name << " at " << curvature;
      EXPECT_GT(m.d11 * m.d22, m.d12 * m.d12) << name;
    }
  }
}

/// Cloth with free borders, a seam-free patch of every kind of vertex, folded at random.
std::vector<Vec3r> folded(const Sheet& sheet, double size) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Vec3r> x;
  for (const Vec3d& p : sheet.world.rest)
    x.push_back(p + Vec3d{uniform(random), 2 * uniform(random), uniform(random)});
  return x;
}

/// Impulses of one step as the implicit stage makes them; with a velocity and anchors of yarns, or
/// at rest without.
std::vector<HingeTerm> plate_terms(const Sheet& sheet, const std::vector<Vec3r>& x, Real dt,
                                   std::vector<Vec3r> v = {},
                                   const std::vector<YarnAnchor>& yarns = {}) {
  v.resize(x.size());
  std::vector<Vec3r> predicted;
  for (const Vec3r& u : v) predicted.push_back(dt * u);
  const Index count = static_cast<Index>(x.size()),
              hinges = static_cast<Index>(sheet.hinges.size());
  const Index faces = static_cast<Index>(sheet.plates.size());
  const View<const Vec3r> here(x.data(), count);
  const Linearization point{.start = here,
                            .at = here,
                            .predicted = {predicted.data(), count},
                            .v = {v.data(), count},
                            .dt = dt};
  const std::vector<Index> fabric_of(sheet.plates.size());
  std::vector<HingeSlots> slots(sheet.hinges.size(), HingeSlots{{-1, -1}});
  for (Index f = 0; f < faces; ++f)
    for (int a = 0; a < 3; ++a) {
      const Index h = sheet.plates[at(f)].hinge[a];
      if (h >= 0) slots[at(h)].slot[slots[at(h)].slot[0] < 0 ? 0 : 1] = 3 * f + a;
    }
  std::vector<HingeTerm> terms(sheet.hinges.size());
  std::vector<PlateTerm> plate_term(sheet.plates.size());
  const View<const HingeRest> rest(sheet.hinges.data(), hinges);
  const View<const Fabric> fabric(&sheet.fabric, 1);
  const View<HingeTerm> term(terms.data(), hinges);
  std::vector<HingeMotion> motions(sheet.hinges.size());
  const View<HingeMotion> motion(motions.data(), hinges);
  const HingeBending single{
      .hinge = rest, .fabric = fabric, .point = point, .term = term, .extra_damping = 0};
  const HingeAngles angles{.hinge = rest,
                           .slots = {slots.data(), hinges},
                           .fabric = fabric,
                           .point = point,
                           .motion = motion,
                           .term = term,
                           .extra_damping = 0};
  const PlatePass pass{.plate = {sheet.plates.data(), faces},
                       .hinge = rest,
                       .slots = {slots.data(), hinges},
                       .area = {sheet.world.face_area.data(), faces},
                       .face_fabric = {fabric_of.data(), faces},
                       .fabric = fabric,
                       .point = point,
                       .motion = motion,
                       .hinge_term = term,
                       .term = {plate_term.data(), faces},
                       .extra_damping = 0,
                       .friction = {{yarns.data(), static_cast<Index>(yarns.size())}}};
  const GatherPlates gather{{slots.data(), hinges}, {plate_term.data(), faces}, single};
  for (Index h = 0; h < hinges; ++h) angles(h);
  for (Index f = 0; f < faces; ++f) pass(f);
  for (Index h = 0; h < hinges; ++h) gather(h);
  return terms;
}

std::vector<Vec3r> impulses(const Sheet& sheet, const std::vector<HingeTerm>& terms) {
  std::vector<Vec3r> sum(sheet.world.rest.size());
  for (std::size_t h = 0; h < terms.size(); ++h)
    for (int a = 0; a < 4; ++a)
      sum[at(sheet.hinges[h].v.v[a])] += terms[h].impulse * terms[h].gradient[a];
  return sum;
}

double plate_sum(const Sheet& sheet, const std::vector<Vec3r>& x) {
  double sum = 0;
  for (const Real e : sheet.energies(sheet.angles(x), true)) sum += e;
  return sum;
}

/// Also a cloth whose neighbours are not all oriented alike, and one that is curved at rest.
std::vector<Cloth> varied_cloths() {
  std::vector<Cloth> cloths;
  for (const Layout layout : kLayouts) cloths.push_back(testing::make_layout(layout, 3, 3, 1.0));
  Cloth flipped = cloths.back();
  for (std::size_t f = 0; f < flipped.mesh.faces.size(); f += 3)
    std::swap(flipped.mesh.faces[f][1], flipped.mesh.faces[f][2]);
  Cloth curved = cloths.back();
  for (Vec3d& p : curved.rest) p.y = 0.2 * p.x * p.x;
  cloths.push_back(flipped);
  cloths.push_back(curved);
  return cloths;
}

TEST(Plate, ForcesAreMinusTheGradientOfTheEnergy) {
  for (const Cloth& cloth : varied_cloths()) {
    const Sheet sheet(cloth);
    const std::vector<Vec3r> x = folded(sheet, 0.15);
    const std::vector<Vec3r> force = impulses(sheet, plate_terms(sheet, x, 1));
    double largest = 0;
    for (const Vec3r& f : force) largest = std::max(largest, norm(f));
    Vec3r total{};
    for (std::size_t i = 0; i < x.size(); ++i) {
      total += force[i];
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-6;
        const Vec3r e{axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
        std::vector<Vec3r> plus = x, minus = x;
        plus[i] += e, minus[i] -= e;
        const double slope = (plate_sum(sheet, plus) - plate_sum(sheet, minus)) / (2 * h);
        EXPECT_NEAR(dot(force[i], (1 / h) * e), -slope, 1e-5 * largest) << cloth.name << " " << i;
      }
    }
    EXPECT_LT(norm(total), 1e-10 * largest);
  }
}

TEST(Plate, RestShapeIsFreeOfForceHoweverItIsTurned) {
  for (const Cloth& cloth : varied_cloths()) {
    const Sheet sheet(cloth);
    std::vector<Vec3r> x;
    for (const Vec3d& p : sheet.world.rest)
      x.push_back({0.6 * p.x - 0.8 * p.y + 3, 0.8 * p.x + 0.6 * p.y, p.z - 1});
    for (const Vec3r& f : impulses(sheet, plate_terms(sheet, x, 1))) EXPECT_LT(norm(f), 1e-9);
  }
}

TEST(Plate, FoldsTurnedBySomeRotationTurnTheirForces) {
  const Sheet sheet(testing::make_layout(Layout::jittered, 3, 3, 1.0));
  const std::vector<Vec3r> x = folded(sheet, 0.2);
  const auto turned = [](Vec3r p) {
    return Vec3r{0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z};
  };
  std::vector<Vec3r> y;
  for (const Vec3r& p : x) y.push_back(turned(p));
  const std::vector<Vec3r> a = impulses(sheet, plate_terms(sheet, x, 1));
  const std::vector<Vec3r> b = impulses(sheet, plate_terms(sheet, y, 1));
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(norm(turned(a[i]) - b[i]), 1e-10);
}

TEST(Plate, DampingLeavesTheFrictionOfYarnsAlone) {
  // Its moment is HB at most, which damping would exceed where the cloth moves fast.
  Fabric rubbing = unit_fabric();
  rubbing.bending_friction = 0.3;
  for (const Real damping : {0.0, 2.0}) {
    rubbing.damping = damping;
    const Sheet sheet(testing::make_layout(Layout::jittered, 3, 3, 1.0), rubbing);
    const std::vector<Vec3r> x = folded(sheet, 0.15), v = folded(sheet, 20.0);
    const Real dt = 0.01;
    const std::vector<HingeTerm> with = plate_terms(
        sheet, x, dt, v, std::vector<YarnAnchor>(sheet.plates.size(), YarnAnchor{{9, 4, -7}, 0}));
    const std::vector<HingeTerm> without = plate_terms(sheet, x, dt, v);
    std::vector<Real> most(sheet.hinges.size());
    for (std::size_t f = 0; f < sheet.plates.size(); ++f)
      for (int a = 0; a < 3; ++a) {
        const Index h = sheet.plates[f].hinge[a];
        if (h < 0) continue;
        Real bend[3] = {0, 0, 0};
        bend[a] = 1;
        most[at(h)] += dt * sheet.world.face_area[f] * rubbing.bending_friction *
                       curvature_size(plate_curvature(sheet.plates[f], bend));
      }
    double largest = 0;
    for (std::size_t h = 0; h < most.size(); ++h) {
      const double share = std::fabs(with[h].impulse - without[h].impulse) / most[h];
      EXPECT_LE(share, 1 + 1e-9) << h;
      largest = std::max(largest, share);
    }
    EXPECT_GT(largest, 0.3) << "it slips somewhere";
  }
}

Eigen::Matrix3d full(const PlateStiffness& s) {
  Eigen::Matrix3d m;
  m << s.k[0], s.k[1], s.k[2], s.k[1], s.k[3], s.k[4], s.k[2], s.k[4], s.k[5];
  return m;
}

TEST(Plate, BoundIsAtLeastTheStiffnessAndNotMuchMore) {
  Fabric fabric = unit_fabric();
  fabric.bending_poisson = 0.3;
  for (int c = 0; c < 5; ++c) fabric.bending[2][c] = 9;
  for (const Cloth& cloth : varied_cloths()) {
    const Sheet sheet(cloth, fabric);
    for (const PlateRest& plate : sheet.plates) {
      const PlateStiffness s = plate_stiffness(plate, plate_moduli(fabric, {0, 0, 0}), 0.5);
      Real bound[3];
      plate_bound(s, bound);
      const Eigen::Matrix3d k = full(s),
                            d = Eigen::Vector3d(bound[0], bound[1], bound[2]).asDiagonal();
      const auto smallest = [](const Eigen::Matrix3d& m) {
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues()(0);
      };
      EXPECT_GT(smallest(k), -1e-12 * k.norm());
      EXPECT_GT(smallest(d - k), -1e-12 * k.norm());
      for (int a = 0; a < 3; ++a) EXPECT_LE(bound[a], 3.0001 * k(a, a));
    }
  }
}

TEST(Plate, SliversAndSixVerticesOnACircleStayFinite) {
  // A face with corners of every second vertex of a regular hexagon; then one 10⁻⁵ high.
  Cloth hexagon = testing::make_layout(Layout::cross, 1, 1, 1.0);
  hexagon.mesh.positions.clear();
  for (int i = 0; i < 6; ++i)
    hexagon.mesh.positions.push_back(
        {std::cos(i * std::numbers::pi / 3), 0, -std::sin(i * std::numbers::pi / 3)});
  hexagon.mesh.faces = {{0, 2, 4}, {0, 1, 2}, {2, 3, 4}, {4, 5, 0}};
  hexagon.rest = hexagon.mesh.positions;
  Cloth sliver = hexagon;
  sliver.mesh.positions[0].x = sliver.rest[0].x = -0.5 + 1e-5;
  for (const Cloth& cloth : {hexagon, sliver}) {
    const Sheet sheet(cloth);
    for (const PlateRest& plate : sheet.plates)
      for (const Real w : plate.w) EXPECT_TRUE(std::isfinite(w));
    const std::vector<Vec3r> x = folded(sheet, 0.3), flat(x.size());
    for (const auto& state : {x, flat})  // all vertices in one point, too
      for (const Vec3r& f : impulses(sheet, plate_terms(sheet, state, 1)))
        EXPECT_TRUE(std::isfinite(norm(f)));
  }
}

}  // namespace
}  // namespace icloth::cpu64
