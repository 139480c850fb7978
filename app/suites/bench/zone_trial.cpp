#include "app/suites/bench/zone_trial.h"

#include <algorithm>
#include <chrono>
#include <random>

#include "kernels/zones/zone_solve.h"
#include "sim/linear/incidence.h"

namespace icloth::ICLOTH_BUILD {
namespace {

constexpr double kSpacing = 5e-3, kDepth = 2e-3;  // [m]

/// The zone on the host.
struct TrialZone {
  std::vector<Vec3r> position;
  std::vector<ZoneConstraint> constraint;
  std::vector<Int4> slot;
};

/// Makes the two sheets and one constraint between each vertex of the lower one and the face of the
/// upper one that it has passed.
TrialZone make_zone(Index side) {
  std::mt19937 random(42);  // its numbers are the same everywhere; those of distributions are not

  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  TrialZone zone;

  // A sheet lies in a plane, its vertices moved at random by up to a share of the spacing.
  const auto add_sheet = [&](double height, double jitter) {
    for (Index i = 0; i < side; ++i)
      for (Index k = 0; k < side; ++k)
        zone.position.push_back(convert<Real>(Vec3d{kSpacing * (i + jitter * uniform()), height,
                                                    kSpacing * (k + jitter * uniform())}));
  };

  // The upper sheet is regular, so that the cell below a vertex follows from its coordinates.
  add_sheet(0.5 * kDepth, 0);
  add_sheet(-0.5 * kDepth, 0.9);

  for (Index i = 0; i + 1 < side; ++i) {
    for (Index k = 0; k + 1 < side; ++k) {
      const Index v = side * side + i * side + k, corner = i * side + k;
      const Vec3d p = convert<double>(zone.position[static_cast<std::size_t>(v)]);
      const double s = p.x / kSpacing - i, t = p.z / kSpacing - k;  // place in the cell below

      // The cell is split into two faces by its diagonal; the weights are barycentric in the face.
      const bool first = s >= t;
      ZoneConstraint c;
      c.s.v[0] = v, c.s.v[1] = corner, c.s.v[3] = corner + side + 1;
      c.s.v[2] = first ? corner + side : corner + 1;
      const double w[3] = {1 - std::max(s, t), std::fabs(s - t), std::min(s, t)};
      c.s.w[0] = 1;
      for (int a = 0; a < 3; ++a) c.s.w[a + 1] = static_cast<Real>(-w[a]);

      // Every vertex of the zone can move, and the normals are tilted by up to 9° each way.
      const double tilt = 0.3;
      for (int a = 0; a < 4; ++a) c.slot.v[a] = c.s.v[a];
      c.normal =
          convert<Real>(normalized(Vec3d{tilt * (uniform() - 0.5), 1, tilt * (uniform() - 0.5)}));
      c.offset = static_cast<Real>(Parameters{}.impact_zones.offset);
      zone.constraint.push_back(c);
      zone.slot.push_back(c.slot);
    }
  }
  return zone;
}

ZoneSettings make_settings(int iterations) {
  const Parameters p;
  const Real offset = static_cast<Real>(p.impact_zones.offset);
  // In double precision the trial is the reference: it goes on until nothing moves.
  return {.offset = offset,
          .tolerance = sizeof(Real) == 8 ? Real(1e-10) * offset : Real(0.2) * offset,
          .iterations = iterations,
          .penalty = static_cast<Real>(p.impact_zones.penalty),
          .rho = static_cast<Real>(p.impact_zones.rho),
          .step_threshold = static_cast<Real>(p.impact_zones.step_threshold),
          .chebyshev = p.impact_zones.chebyshev};
}

/// One zone in the memory of the device.
class Trial {
 public:
  explicit Trial(Index side) {
    const TrialZone zone = make_zone(side);
    nv_ = static_cast<Index>(zone.position.size());
    nc_ = static_cast<Index>(zone.constraint.size());

    // All vertices want to stay where they have passed through each other.
    target_.upload(zone.position);
    x_.upload(zone.position);
    constraints_.upload(zone.constraint);
    slots_.upload(zone.slot);
    incidence_.build(slots_.view(), nv_);
    vertex_first_.upload(std::vector<Index>{0, nv_});
    constraint_first_.upload(std::vector<Index>{0, nc_});

    // All vertices have one mass, and no multipliers come from an earlier round.
    mass_.resize(nv_);
    mass_.fill(Real(5e-6));
    for (Array<Vec3r>* a : {&before_, &direction_}) a->resize(nv_);
    for (Array<Real>* a : {&multiplier_, &shortfall_, &scratch1_, &scratch2_}) a->resize(nc_);
    multiplier_.fill(Real(0));
    result_.resize(1);
  }

  template <template <class> class Solver>
  void solve(int iterations) {
    const ZoneArrays arrays{.constraints = constraints_.view(),
                            .constraint_first = constraint_first_.view(),
                            .vertex_first = vertex_first_.view(),
                            .incidence_first = incidence_.first(),
                            .incidence = incidence_.entries(),
                            .target = target_.view(),
                            .mass = mass_.view(),
                            .fixed = x_.view(),
                            .start = target_.view(),
                            .x = x_.view(),
                            .before = before_.view(),
                            .direction = direction_.view(),
                            .multiplier = multiplier_.view(),
                            .shortfall = shortfall_.view(),
                            .scratch1 = scratch1_.view(),
                            .scratch2 = scratch2_.view(),
                            .result = result_.view()};

    // The size decides between a team and the whole device, as it does in a step.
    const SolveZone<Solver> solver{arrays, make_settings(iterations)};
    if (nv_ <= kLargestTeamZone)
      for_each_team("zone_trial", 1, solver);
    else
      with_device_team("zone_trial", nv_ + nc_, SolveLargeZone<Solver>{solver, 0});
  }

  ZoneTrial result() const {
    const ZoneResult r = result_.download()[0];
    ZoneTrial trial{.vertices = nv_,
                    .constraints = nc_,
                    .iterations = r.iterations,
                    .violation = static_cast<double>(r.violation),
                    .complementarity = static_cast<double>(r.complementarity),
                    .momentum_residual = static_cast<double>(r.momentum_residual)};

    // All masses are equal, so all weights a are 1.
    const std::vector<Vec3r> x = x_.download(), target = target_.download();
    for (std::size_t i = 0; i < x.size(); ++i)
      trial.objective += 0.5 * norm2(convert<double>(x[i]) - convert<double>(target[i]));
    return trial;
  }

 private:
  Index nv_, nc_;
  Array<Vec3r> target_, x_, before_, direction_;
  Array<ZoneConstraint> constraints_;
  Array<Int4> slots_;
  Incidence incidence_;
  Array<Index> vertex_first_, constraint_first_;
  Array<Real> mass_, multiplier_, shortfall_, scratch1_, scratch2_;
  Array<ZoneResult> result_;
};

}  // namespace

ZoneTrial solve_zone_trial(Index side, ZoneSolver solver, int iterations) {
  ZoneTrial best;
  for (int run = 0; run < (sizeof(Real) == 8 ? 1 : 3); ++run) {
    Trial trial(side);

    // Making the zone is not part of the time.
    const auto clock = std::chrono::steady_clock::now();
    switch (solver) {
      case ZoneSolver::augmented_lagrangian:
        trial.solve<ZoneAugmentedLagrangian>(iterations);
        break;
      case ZoneSolver::dual:
        trial.solve<ZoneDual>(iterations);
        break;
      case ZoneSolver::linear:
        trial.solve<ZoneLinear>(iterations);
        break;
    }

    // Reading the result waits for the device, so it belongs to the time.
    const ZoneTrial result = trial.result();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - clock).count();

    const double least = run == 0 ? ms : std::min(ms, best.milliseconds);
    best = result;
    best.milliseconds = least;
  }
  return best;
}

}  // namespace icloth::ICLOTH_BUILD
