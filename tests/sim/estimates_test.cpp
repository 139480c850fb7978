// A step's estimates of its own errors, in scenes whose errors are known (double build).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/scene/world.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::hanging;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;

/// One sheet, no air, linear systems solved to the last digits.
std::shared_ptr<Scene> sheet_scene(const GridShape& shape, Vec3d centre = {}) {
  auto scene = std::make_shared<Scene>();
  scene->cloths.push_back(make_sheet(shape, centre));
  scene->parameters.wind.air_density = 0;
  scene->parameters.implicit.cg_tolerance = 1e-12;
  scene->parameters.implicit.cg_max_iterations = 5000;
  return scene;
}

/// A simulator and what changed in its last step.
class Watched {
 public:
  explicit Watched(std::shared_ptr<const Scene> scene)
      : scene_(std::move(scene)), simulator_(make_simulator(Build::cpu64, scene_)) {
    const World world = make_world(*scene_);
    mass_ = world.mass;
    for (std::size_t i = 0; i < mass_.size(); ++i) free_.push_back(world.pinned[i] == 0);
    before_ = after_ = simulator_->snapshot();
  }

  const StepReport& step(std::span<const InputEvent> events = {}) {
    before_ = std::move(after_);
    last_ = report_;
    report_ = simulator_->step(events);
    after_ = simulator_->snapshot();
    EXPECT_TRUE(report_.accepted);
    return report_;
  }

  Simulator& simulator() { return *simulator_; }
  double mass() const {
    double sum = 0;
    for (std::size_t i = 0; i < mass_.size(); ++i) sum += free_[i] ? mass_[i] : 0;
    return sum;
  }
  Vec3d momentum_gained() const {
    Vec3d sum;
    for (std::size_t i = 0; i < mass_.size(); ++i) sum += mass_[i] * change(i);
    return sum;
  }
  /// ½ Σ m |Δv|²: what backward Euler takes from every motion [J].
  double euler_loss() const {
    double sum = 0;
    for (std::size_t i = 0; i < mass_.size(); ++i) sum += 0.5 * mass_[i] * norm2(change(i));
    return sum;
  }
  /// Change of all energy by the reports of the last two steps [J].
  double energy_gained() const { return energy(report_) - energy(last_); }

 private:
  Vec3d change(std::size_t i) const { return after_.v[i] - before_.v[i]; }
  static double energy(const StepReport& r) {
    return r.kinetic_energy + r.elastic_energy + r.gravity_energy;
  }

  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Simulator> simulator_;
  std::vector<double> mass_;
  std::vector<bool> free_;
  Snapshot before_, after_;
  StepReport report_, last_;
};

}  // namespace

TEST(EnergyBalance, OfFreeFallIsTheLossOfBackwardEuler) {
  Watched run(sheet_scene(lying(0.3, 200)));
  const Parameters& p = run.simulator().parameters();
  const double loss = 0.5 * run.mass() * std::pow(p.step.time_step * p.gravity.y, 2);
  for (int k = 0; k < 20; ++k) EXPECT_NEAR(run.step().energy_balance, -loss, 1e-9 * loss);
  // Known again after a jump.
  const Snapshot here = run.simulator().snapshot();
  run.step();
  run.simulator().restore(here);
  EXPECT_NEAR(run.step().energy_balance, -loss, 1e-9 * loss);
  Parameters heavier = p;
  heavier.material.density_scale = 2;
  run.simulator().set_parameters(heavier);
  EXPECT_NEAR(run.step().energy_balance, -2 * loss, 1e-9 * loss);
}

TEST(EnergyBalance, IsLeftOutWhereNobodyAsksForEnergies) {
  auto scene = sheet_scene(lying(0.3, 200));
  scene->obstacles.push_back(make_obstacle(make_sphere(0.1, 200), {0, -0.14, 0}));
  Watched with(scene), without(scene);
  without.simulator().report_energies(false);
  for (int k = 0; k < 40; ++k) {
    const StepReport& full = with.step();
    const StepReport& lean = without.step();
    EXPECT_NE(full.kinetic_energy, 0);
    EXPECT_EQ(lean.kinetic_energy, 0);
    EXPECT_EQ(lean.elastic_energy, 0);
    EXPECT_EQ(lean.energy_balance, 0);

    // The motion is the same, and so is what else is said of it.
    EXPECT_EQ(lean.state_hash, full.state_hash) << k;
    EXPECT_EQ(lean.max_strain, full.max_strain);
    EXPECT_EQ(lean.max_speed, full.max_speed);
  }
  EXPECT_GT(with.step().proximity_pairs, 0) << "the sheet reaches the ball";

  // Energies can be asked for at any time.
  without.step();
  without.simulator().report_energies(true);
  EXPECT_EQ(without.step().energy_balance, with.step().energy_balance);
}

TEST(EnergyBalance, OfFreeFallIsNothingInSecondOrder) {
  auto scene = sheet_scene(lying(0.3, 200));
  scene->parameters.implicit.integrator = Integrator::bdf2;
  Watched run(scene);
  const Parameters& p = run.simulator().parameters();
  const double loss = 0.5 * run.mass() * std::pow(p.step.time_step * p.gravity.y, 2);
  EXPECT_NEAR(run.step().energy_balance, -loss, 1e-9 * loss);  // starts by backward Euler
  for (int k = 0; k < 30; ++k) {
    const StepReport& report = run.step();
    ASSERT_EQ(report.substeps, 1);
    EXPECT_LT(std::fabs(report.energy_balance), k < 10 ? loss : 1e-3 * loss) << k;
    EXPECT_LT(report.momentum_error, 1e-9);
  }
}

TEST(EnergyBalance, SubstepsAddUp) {
  auto scene = sheet_scene(lying(0.3, 200));
  scene->parameters.step.max_travel = 0.5;  // of an edge: fast cloth takes several substeps
  Watched run(scene);
  StepReport report;
  for (int k = 0; k < 60; ++k) report = run.step();
  ASSERT_GT(report.substeps, 1);
  const Parameters& p = run.simulator().parameters();
  const double dt = p.step.time_step / static_cast<double>(report.substeps);
  const double loss =
      0.5 * run.mass() * std::pow(dt * p.gravity.y, 2) * static_cast<double>(report.substeps);
  EXPECT_NEAR(report.energy_balance, -loss, 1e-8 * loss);
}

TEST(EnergyBalance, OfClothHangingAtRestIsNothing) {
  auto scene = sheet_scene(hanging(0.2, 100));
  scene->cloths[0].pins = grid_vertices(make_grid(hanging(0.2, 100)), "top");
  scene->cloths[0].material.law = Material::Law::orthotropic;  // the measured law has no energy
  scene->parameters.material.damping = 0.05;
  Watched run(scene);
  StepReport report;
  double most = 0;
  for (int k = 0; k < 400; ++k) {
    report = run.step();
    most = std::max(most, report.energy_balance);
  }
  EXPECT_LT(std::fabs(report.energy_balance), 1e-12);
  EXPECT_LT(most, 1e-12);
}

/// The energy that a roll loses when it springs open, and its energy balance; [0]: elastic, [1]:
/// with internal friction of the yarns.
struct Unrolled {
  double lost[2] = {}, balance[2] = {}, largest_balance = -1;
};

Unrolled unroll(double dt, int steps) {
  Unrolled out;
  for (const int rub : {0, 1}) {
    auto scene = sheet_scene(lying(0.04, 200));
    Cloth& sheet = scene->cloths[0];
    for (Vec3d& p : sheet.mesh.positions)
      p = {std::sin(60 * p.x) / 60, std::cos(60 * p.x) / 60, p.z};
    sheet.material.law = Material::Law::orthotropic;  // the measured law has no energy
    sheet.material.bending_friction = rub * 1e-4;
    sheet.material.shear_friction = rub;
    sheet.flat_angles = true;
    scene->parameters.gravity.y = 0;
    scene->parameters.step.time_step = dt;
    Watched run(scene);
    double first = 0, last = 0;
    for (int k = 0; k < steps; ++k) {
      const StepReport& report = run.step();
      last = report.kinetic_energy + report.elastic_energy;
      if (k == 0) first = last - report.energy_balance;
      out.balance[rub] += report.energy_balance;
      out.largest_balance = std::max(out.largest_balance, report.energy_balance);
    }
    out.lost[rub] = first - last;
  }
  return out;
}

TEST(EnergyBalance, LeavesOutWhatRubbingYarnsTakeUp) {
  // In steps so small that they lose nothing themselves.
  const Unrolled roll = unroll(4e-6, 1000);
  EXPECT_NEAR(roll.lost[0], -roll.balance[0], 1e-9 * roll.lost[1]);  // no work
  EXPECT_GT(roll.lost[1], 5 * roll.lost[0]);
  EXPECT_LT(std::fabs(roll.balance[1]), 0.1 * roll.lost[1]);
}

TEST(EnergyBalance, OfRubbingYarnsMakesNoEnergyInUsualSteps) {
  for (const double dt : {1e-3, 5e-3}) {
    const Unrolled roll = unroll(dt, static_cast<int>(std::lround(0.02 / dt)));
    EXPECT_LT(roll.largest_balance, 0) << dt;
    // The yarns take up much of it, and it is not counted twice: backward Euler's share is left.
    const double yarns = roll.lost[1] + roll.balance[1];
    EXPECT_GT(yarns, 0.3 * roll.lost[1]) << dt;
    EXPECT_LT(yarns, 0.9 * roll.lost[1]) << dt;
  }
}

TEST(EnergyBalance, LeavesOutTheWorkOfTheAir) {
  auto scene = sheet_scene(hanging(0.3, 200));
  scene->parameters.gravity.y = 0;
  scene->parameters.wind.air_density = 1.2;
  scene->parameters.wind.air_drag = 0.1;
  scene->parameters.wind.z = 6, scene->parameters.wind.x = 2;
  Watched run(scene);
  for (int k = 0; k < 20; ++k) {
    // Every face is as large as the next, so that the sheet flies as a whole.
    const StepReport& report = run.step();
    EXPECT_NEAR(report.energy_balance, -run.euler_loss(), 0.02 * run.euler_loss()) << k;
    EXPECT_GT(run.euler_loss(), 0);
    if (k == 0) continue;
    EXPECT_GT(run.energy_gained(), 3 * run.euler_loss());
  }
}

/// A sheet that lands flat on a plane, under its vertices alone.
std::shared_ptr<Scene> landing_scene(double height) {
  auto scene = sheet_scene(lying(0.1, 100), {0.3, height, -0.1});
  scene->obstacles.push_back(make_obstacle(make_plane(2, 2, 2), {}));
  scene->parameters.proximity.friction_obstacle = 0;
  return scene;
}

TEST(EnergyBalance, LeavesOutTheWorkOfContacts) {
  auto scene = landing_scene(0.004);
  scene->parameters.step.time_step = 0.002;
  Watched run(scene);
  double work = 0, loss = 0;  // of the contacts, and of backward Euler
  for (int k = 0; k < 60; ++k) {
    const StepReport& report = run.step();
    EXPECT_EQ(report.rounds, 0);
    // The sheet goes down and up as a whole.
    EXPECT_NEAR(report.energy_balance, -run.euler_loss(), 1e-6 * run.euler_loss() + 1e-15) << k;
    if (k == 0) continue;
    work += std::fabs(run.energy_gained() - report.energy_balance), loss += run.euler_loss();
  }
  EXPECT_GT(work, 0.1 * loss);
}

TEST(EnergyBalance, LeavesOutTheWorkOfImpactZones) {
  auto scene = landing_scene(0.004);
  scene->parameters.proximity.enabled = false;
  Watched run(scene);
  const Parameters& p = run.simulator().parameters();
  const double loss = 0.5 * run.mass() * std::pow(p.step.time_step * p.gravity.y, 2);
  std::int64_t rounds = 0;
  for (int k = 0; k < 20; ++k) {
    const StepReport& report = run.step();
    rounds += report.rounds;
    EXPECT_NEAR(report.energy_balance, -loss, 0.05 * loss) << k;
  }
  EXPECT_GT(rounds, 5);
}

TEST(EnergyBalance, LeavesOutTheWorkOfHands) {
  auto scene = sheet_scene(lying(0.2, 100));
  scene->parameters.gravity.y = 0;
  Watched run(scene);
  InputEvent event;
  event.handle = 1;
  event.face = 50;
  event.barycentric = {0.2, 0.3, 0.5};
  const TriangleMesh& mesh = scene->cloths[0].mesh;
  for (int a = 0; a < 3; ++a) {
    const double w[3] = {0.2, 0.3, 0.5};
    event.target +=
        w[a] *
        mesh.positions[static_cast<std::size_t>(mesh.faces[50][static_cast<std::size_t>(a)])];
  }
  run.step(std::vector{event});
  event.kind = InputEvent::Kind::move;
  double gained = 0, balance = 0, loss = 0;
  for (int k = 0; k < 30; ++k) {
    event.target += Vec3d{0.004, 0.002, 0};
    const StepReport& report = run.step(std::vector{event});
    EXPECT_LT(report.energy_balance, 1e-9) << k;
    EXPECT_LT(report.energy_balance, -0.9 * run.euler_loss()) << k;
    gained += run.energy_gained(), balance += report.energy_balance, loss += run.euler_loss();
  }
  EXPECT_GT(gained, 0);  // the hand brought it
  EXPECT_GT(balance, -2 * loss);
}

TEST(MomentumError, IsWhatARoughSolveMakesOrLoses) {
  for (const Preconditioner preconditioner :
       {Preconditioner::block_jacobi, Preconditioner::multilevel}) {
    auto scene = sheet_scene(lying(0.3, 400));
    scene->parameters.implicit.preconditioner = preconditioner;
    scene->parameters.implicit.cg_tolerance = 0.1;
    scene->parameters.step.max_substep_levels = 0;
    // A wave that wants to straighten.
    for (Vec3d& x : scene->cloths[0].mesh.positions) x.y += 0.02 * std::sin(60 * x.x + 20 * x.z);
    Watched run(scene);
    const Parameters& p = run.simulator().parameters();
    double largest = 0;
    for (int k = 0; k < 20; ++k) {
      const StepReport& report = run.step();
      ASSERT_EQ(report.substeps, 1);
      ASSERT_EQ(report.rounds, 0);
      const Vec3d weight{0, run.mass() * p.gravity.y, 0};
      const Vec3d made = (1 / p.step.time_step) * run.momentum_gained() - weight;
      EXPECT_NEAR(report.momentum_error, norm(made) / run.mass(), 1e-9);
      largest = std::max(largest, report.momentum_error);
    }
    EXPECT_GT(largest, 1e-4);  // there was something to see
    EXPECT_LT(largest, 9.81);
  }
}

TEST(MomentumError, VanishesWithTheResidual) {
  auto scene = sheet_scene(lying(0.3, 400));
  for (Vec3d& x : scene->cloths[0].mesh.positions) x.y += 0.02 * std::sin(60 * x.x + 20 * x.z);
  Watched run(scene);
  for (int k = 0; k < 5; ++k) EXPECT_LT(run.step().momentum_error, 1e-9);
}

TEST(Estimates, ARefusedStepHasZeroEstimates) {
  auto scene = sheet_scene(lying(0.2, 100));
  Watched run(scene);
  run.step();
  Parameters wrong = run.simulator().parameters();
  wrong.gravity.y = std::numeric_limits<double>::quiet_NaN();
  run.simulator().set_parameters(wrong);
  const StepReport report = run.simulator().step({});
  EXPECT_FALSE(report.accepted);
  EXPECT_EQ(report.momentum_error, 0);
  EXPECT_EQ(report.energy_balance, 0);
}

}  // namespace icloth
