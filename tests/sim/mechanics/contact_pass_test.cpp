// The passes over the contacts of an implicit step, and the line search between them, compared with
// slow ways to the same in double: relaxation vertex by vertex, and the slope of the whole energy.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include "sim/mechanics/contact_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/sim/linear/linear_system_support.h"

namespace icloth::cpu32 {
namespace {

constexpr Real kStep = Real(0.01), kThickness = Real(1e-3), kStiffness = Real(1e6);

/// A net of side × side particles with springs between neighbours that falls on a floor, which is
/// an obstacle of one vertex. Some particles hover above the thickness, others are below it.
struct Net : TestSystem {
  Index count;
  std::vector<Vec3r> rhs, free;
  std::vector<Contact> contacts;
  Array<Vec3r> free_motion;
  Array<Contact> contact_array;

  explicit Net(Index side, Real friction) : count(side * side) {
    std::mt19937 random(11);
    std::uniform_real_distribution<Real> uniform(0, 1);
    const Real mass = Real(1e-3), spring = Real(2e-3);
    inverse_mass.assign(at(count), 1 / mass);
    inverse_mass[0] = 0;
    for (Index i = 0; i < count; ++i) blocks[{i, i}] = Mat3r::identity(mass);
    for (Index j = 0; j < side; ++j)
      for (Index i = 0; i < side; ++i) {
        if (i + 1 < side) add_spring(j * side + i, j * side + i + 1, spring);
        if (j + 1 < side) add_spring(j * side + i, (j + 1) * side + i, spring);
      }

    // Gravity, and a push to the side and down that differs from place to place.
    for (Index i = 0; i < count; ++i) {
      rhs.push_back(
          {Real(2e-5) * uniform(random), -mass * Real(9.81) * kStep * uniform(random), 0});
      free.push_back({Real(1e-4) * uniform(random), Real(-8e-4) * uniform(random), 0});
      Contact c{};
      c.s = {{i, count, count, count}, {1, -1, 0, 0}};
      c.normal = {0, 1, 0};
      c.gap = Real(1.5e-3) * uniform(random) + Real(2e-4);
      c.area = Real(1e-4);
      c.friction = friction;
      c.thickness = kThickness;
      contacts.push_back(c);
    }
    free.push_back({});
    upload_matrix(count);
    inverse_mass.push_back(0);
    upload_rest(count, rhs);
    free_motion.upload(free);
    contact_array.upload(contacts);
  }

  void add_spring(Index i, Index j, Real stiffness) {
    const Mat3r k = Mat3r::identity(stiffness);
    blocks[{i, i}] += k;
    blocks[{j, j}] += k;
    blocks[{i, j}] += Real(-1) * k;
  }

  VertexMotion motion() { return {free_motion.view(), masses.view(), kStep}; }
  ContactLaw law() const { return {kStiffness, kStep}; }
  bool is_free(Index i) const { return inverse_mass[at(i)] > 0; }

  /// A v, in double.
  std::vector<Vec3d> product(const std::vector<Vec3d>& v) const {
    std::vector<Vec3d> sum(at(count));
    const auto add = [&](Index i, Index j, const Mat3r& block) {
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          (&sum[at(i)].x)[r] += static_cast<double>(block.m[3 * r + c]) * (&v[at(j)].x)[c];
    };
    for (const auto& [place, block] : blocks) {
      if (!is_free(place.first) || !is_free(place.second)) continue;
      add(place.first, place.second, block);
      if (place.first != place.second) add(place.second, place.first, block);
    }
    return sum;
  }

  /// The impulse of the contact of a vertex by the contact law [N·s].
  Vec3d impulse(Index i, Vec3d dv) const {
    const Contact& c = contacts[at(i)];
    const Vec3r end = free[at(i)] + convert<Real>(static_cast<double>(kStep) * dv);
    const Real normal = normal_force(c, law(), end);
    if (!(normal > 0)) return {};
    return static_cast<double>(kStep) *
           convert<double>(normal * c.normal + friction_of(c, law(), end, normal).force);
  }

  /// ‖b + contact impulses − A v‖ / ‖contact impulses‖.
  double imbalance(const std::vector<Vec3d>& v) const {
    const std::vector<Vec3d> held = product(v);
    double left = 0, load = 0;
    for (Index i = 0; i < count; ++i) {
      if (!is_free(i)) continue;
      const Vec3d push = impulse(i, v[at(i)]);
      left += norm2(convert<double>(rhs[at(i)]) + push - held[at(i)]);
      load += norm2(push);
    }
    return std::sqrt(left / load);
  }

  /// Δv by the passes. `late`: contacts at the end of the list that are not known before a solve
  /// with the others.
  std::vector<Vec3d> solve(double contact_tolerance, double cg_tolerance, StepReport& report,
                           Index late = 0) {
    Parameters parameters;
    parameters.proximity.stiffness = kStiffness;
    Topology mesh{};
    mesh.cloth_vertices = count;
    State state{};
    state.inverse_mass.upload(inverse_mass);
    SubstepContext step{mesh, parameters, state, report, kStep, 0};
    ContactPasses passes;
    passes.set_up({row_first, column});
    const auto solve_with = [&](bool solved) {
      passes.solve(step,
                   {.matrix = matrix,
                    .rhs = b.view(),
                    .contacts = contact_array,
                    .seams = {},
                    .free_motion = free_motion.view(),
                    .h = kStep},
                   {contact_tolerance, cg_tolerance}, x.view(), solved);
    };
    if (late > 0) {
      contact_array.upload({contacts.data(), contacts.size() - at(late)});
      solve_with(false);
      contact_array.upload(contacts);
    }
    solve_with(late > 0);
    std::vector<Vec3d> dv;
    for (const Vec3r& v : x.download()) dv.push_back(convert<double>(v));
    dv.resize(at(count));
    return dv;
  }

  /// Δv of the frictionless net by relaxation: each vertex in turn goes where its own forces are in
  /// balance, closed or open.
  std::vector<Vec3d> relaxed() const {
    const double dt = static_cast<double>(kStep);
    std::vector<Vec3d> v(at(count));
    for (int sweep = 0; sweep < 5000; ++sweep)
      for (Index i = 0; i < count; ++i) {
        if (!is_free(i)) continue;
        const double diagonal = static_cast<double>(blocks.at({i, i}).m[0]);
        const Vec3d left = convert<double>(rhs[at(i)]) - product_row(v, i);
        v[at(i)] = (1 / diagonal) * left;
        const Contact& c = contacts[at(i)];
        const double k = static_cast<double>(kStiffness) * static_cast<double>(c.area);
        const double open = static_cast<double>(c.gap + free[at(i)].y - c.thickness);
        if (open + dt * v[at(i)].y < 0)
          v[at(i)].y = (left.y - dt * k * open) / (diagonal + dt * dt * k);
      }
    return v;
  }

  /// Row i of A v but for its diagonal.
  Vec3d product_row(const std::vector<Vec3d>& v, Index i) const {
    Vec3d sum{};
    for (const Index j : {i - 1, i + 1, i - side(), i + side()}) {
      if (j < 0 || j >= count || !is_free(j)) continue;
      const auto found = blocks.find({std::min(i, j), std::max(i, j)});
      if (found != blocks.end()) sum += static_cast<double>(found->second.m[0]) * v[at(j)];
    }
    return sum;
  }
  Index side() const { return static_cast<Index>(std::lround(std::sqrt(count))); }
};

TEST(ContactPasses, FindWhatRelaxationFinds) {
  Net net(12, 0);
  StepReport report{};
  const std::vector<Vec3d> dv = net.solve(1e-5, 1e-6, report), expected = net.relaxed();
  EXPECT_FALSE(report.reached(Limit::contact_passes));
  double largest = 0;
  Index closed = 0;
  for (Index i = 0; i < net.count; ++i) {
    largest = std::max(largest, norm(expected[at(i)]));
    closed += norm(net.impulse(i, expected[at(i)])) > 0;
  }
  EXPECT_GT(closed, net.count / 10);
  EXPECT_LT(closed, net.count - net.count / 10);
  for (Index i = 0; i < net.count; ++i)
    EXPECT_LT(norm(dv[at(i)] - expected[at(i)]), 1e-4 * largest) << i;
}

TEST(ContactPasses, GoOnWithContactsThatAreAddedAfterASolve) {
  Net whole(12, 0), in_two(12, 0);
  StepReport report{}, late_report{};
  const std::vector<Vec3d> all = whole.solve(1e-5, 1e-6, report);
  const std::vector<Vec3d> late = in_two.solve(1e-5, 1e-6, late_report, in_two.count / 2);
  double largest = 0;
  for (const Vec3d& v : all) largest = std::max(largest, norm(v));
  for (Index i = 0; i < whole.count; ++i)
    EXPECT_LT(norm(late[at(i)] - all[at(i)]), 1e-4 * largest) << i;

  // Friction depends on the way to a solution, yet the law holds at the end of both.
  Net rough(12, Real(0.3));
  EXPECT_LT(rough.imbalance(rough.solve(1e-5, 1e-6, late_report, rough.count / 2)), 1e-4);
}

TEST(ContactPasses, BalanceTheForcesOfTheLawWithFriction) {
  for (const Real friction : {Real(0.05), Real(0.3), Real(2)}) {
    Net net(12, friction);
    StepReport report{};
    EXPECT_LT(net.imbalance(net.solve(1e-5, 1e-6, report)), 1e-4) << friction;
    EXPECT_FALSE(report.reached(Limit::contact_passes)) << friction;

    // The tolerances of every day leave less than they say.
    Net usual(12, friction);
    const Parameters parameters;
    EXPECT_LT(usual.imbalance(usual.solve(parameters.implicit.contact_tolerance,
                                          parameters.implicit.cg_tolerance, report)),
              2 * parameters.implicit.contact_tolerance)
        << friction;
  }
}

/// One search along `d` from Δv = 0.
struct Searched {
  double alpha;
  std::vector<Vec3d> dv, residual;
  std::vector<ContactTravel> travels;
};

Searched search(Net& net, const std::vector<Vec3r>& direction) {
  const Index count = net.count;
  Array<Vec3r> d, product(count), dv(count + kPadding), residual;
  std::vector<Vec3r> padded = direction;
  padded.resize(at(count + kPadding));
  d.upload(padded);
  dv.fill(Vec3r{});
  residual.upload(net.rhs);
  std::vector<Vec3d> wide(at(count));
  for (Index i = 0; i < count; ++i) wide[at(i)] = convert<double>(direction[at(i)]);
  std::vector<Vec3r> narrow;
  for (const Vec3d& v : net.product(wide)) narrow.push_back(convert<Real>(v));
  product.upload(narrow);
  std::vector<ContactTravel> start;
  for (const Contact& c : net.contacts) start.push_back(net.motion().travel(c, dv.view()));
  Array<ContactTravel> travels;
  travels.upload(start);
  LineSearch line_search;
  const ContactLine line{net.contact_array.view(), travels.view(), net.motion(), net.law()};
  Searched result;
  result.alpha = line_search.go(net.system(), line, {},
                                {.d = d.view(), .product = product.view(), .coupling = {}},
                                dv.view(), residual.view());
  for (const Vec3r& v : dv.download()) result.dv.push_back(convert<double>(v));
  result.dv.resize(at(count));
  for (const Vec3r& v : residual.download()) result.residual.push_back(convert<double>(v));
  result.travels = travels.download();
  return result;
}

/// The direction of the solution, so many times as far.
std::vector<Vec3r> beyond_the_solution(const Net& net, double times) {
  std::vector<Vec3r> d;
  for (const Vec3d& v : net.relaxed()) d.push_back(convert<Real>(times * v));
  return d;
}

TEST(LineSearch, StopsWhereTheEnergyIsLeast) {
  Net net(12, 0);
  const std::vector<Vec3r> d = beyond_the_solution(net, 2.5);
  const Searched found = search(net, d);

  // The slope of the energy at α, by the contact law.
  const auto slope = [&](double alpha) {
    std::vector<Vec3d> v(at(net.count));
    for (Index i = 0; i < net.count; ++i) v[at(i)] = alpha * convert<double>(d[at(i)]);
    const std::vector<Vec3d> held = net.product(v);
    double sum = 0;
    for (Index i = 0; i < net.count; ++i)
      if (net.is_free(i))
        sum += dot(convert<double>(d[at(i)]),
                   held[at(i)] - convert<double>(net.rhs[at(i)]) - net.impulse(i, v[at(i)]));
    return sum;
  };
  ASSERT_LT(slope(0), 0);
  ASSERT_GT(slope(1), -0.2 * slope(0)) << "the whole way leads up again";
  EXPECT_GT(found.alpha, 0);
  EXPECT_LT(found.alpha, 1);
  EXPECT_LT(std::fabs(slope(found.alpha)), -0.11 * slope(0));
}

TEST(LineSearch, MovesAllThatBelongsToTheVelocities) {
  Net net(12, Real(0.3));
  const std::vector<Vec3r> d = beyond_the_solution(net, 2.5);
  const Searched found = search(net, d);
  const std::vector<Vec3d> held = net.product(found.dv);
  for (Index i = 0; i < net.count; ++i) {
    EXPECT_LT(norm(found.dv[at(i)] - found.alpha * convert<double>(d[at(i)])), 1e-7) << i;
    const Vec3d left = net.is_free(i) ? convert<double>(net.rhs[at(i)]) - held[at(i)]
                                      : convert<double>(net.rhs[at(i)]);
    EXPECT_LT(norm(found.residual[at(i)] - left), 1e-9) << i;
    const Vec3d end = convert<double>(net.free[at(i)]) + 0.01 * found.dv[at(i)];
    EXPECT_LT(norm(convert<double>(found.travels[at(i)].end) - end), 1e-8) << i;
  }
}

TEST(LineSearch, GoesTheWholeWayWhereNothingCloses) {
  Net net(12, 0);
  std::vector<Vec3r> up(at(net.count));
  for (Index i = 1; i < net.count; ++i) up[at(i)] = {0, Real(0.001), 0};
  EXPECT_EQ(search(net, up).alpha, 1);
}

}  // namespace
}  // namespace icloth::cpu32
