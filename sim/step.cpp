// READ FIRST. One step of the simulation: the pipeline of Tang et al. 2018, Section 2.4.
//
// A step is made of substeps, one as long as the step where nothing is fast (run_substeps). Each of
// them is the pipeline of the paper (try_substep):
//
//   begin_substep             obstacles at t and t + dt, x0 ← x1
//   proximity                 (1) VF and EE pairs closer than the thickness        Section 2.5
//   implicit                  (2) anchors of the yarn friction follow;
//                                 candidate x1, may penetrate                      Section 2.4–2.5
//   ccd                       (3) impacts on the segments x0 → x1
//                                 many: they join the contacts, and (2) goes on once
//   repeat
//     ccd                     (3) first all pairs, then only pairs with a dirty
//                                 vertex                                           Algorithm 1
//     none left → accept
//     impact_zones            (4) moves only what must move                        Algorithms 2–3
//   impacts left → refuse, halve the step and try again; in the smallest step, what still collides
//   stays where it was. Where bodies overlap, the cloth between them is let go from one of them
//   (sim/collision/pinch.h). Other penetrations are never accepted.

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/mechanics/energy.h"
#include "sim/mechanics/membrane.h"
#include "sim/mechanics/yarns.h"
#include "sim/solver.h"
#include "sim/state/stillness.h"
#include "sim/substep_clock.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// So few impacts are solved faster by the zones than by another solve of the whole cloth.
constexpr std::int64_t kFewImpacts = 8;

/// Zones that stretch a face by more than this are solved as contacts all the same.
constexpr double kMostZoneStretch = 0.1;

/// Runs a stage and adds its wall time to one row of the report.
template <class Stage>
void timed(double& milliseconds, const Stage& stage) {
  const auto begin = std::chrono::steady_clock::now();
  stage();
  milliseconds +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

StepReport Solver::step(std::span<const InputEvent> events) {
  use_device();
  StepReport report;
  report.step = state_.step;
  report.dt = parameters_.step.time_step;

  timed(report.ms_total, [&] {
    begin_step(events, report);
    report.accepted = sleeps(events, report) || run_substeps(report);
    finish_step(report);
    report_end_state(report);
    grow_reserve();
  });
  close_report(report);
  return report;
}

/// A refused step goes back to the state that is saved here. The orders that the hands were given
/// are part of that state and stay.
void Solver::begin_step(std::span<const InputEvent> events, StepReport& report) {
  match_yarns(mesh_, parameters_, state_);
  use_hands(events, report);
  save_start();
}

/// True where the cloth is still and nothing touches it: the step changes nothing but the clock.
/// What is about to touch it ends its sleep.
bool Solver::sleeps(std::span<const InputEvent> events, StepReport& report) {
  const auto is_open = [](const SeamProgress& seam) { return seam.welded == 0; };
  if (!parameters_.step.sleep || !events.empty() || !hands_.empty() || !state_.let_go.empty() ||
      std::ranges::any_of(state_.seams, is_open)) {
    disturb(state_);
    return false;
  }
  if (!is_still(state_)) return false;

  // Bodies are posed at the end of the step to see whether they move.
  begin_substep(state_.time, report.dt);
  const bool move = bodies_move(mesh_, state_);
  back_to_substep_start();
  if (move) {
    disturb(state_);
    return false;
  }
  report.substeps = 0;
  report.min_gap = parameters_.proximity.thickness;
  return true;
}

/// False when a substep was refused that cannot be halved any more.
bool Solver::run_substeps(StepReport& report) {
  SubstepClock clock(state_.time, report.dt, parameters_.step.max_substep_levels,
                     travel_level(report));
  report.substeps = 0;

  while (!clock.is_done()) {
    const double start = clock.start(), dt = clock.length();
    if (try_substep(report, start, dt, clock.is_shortest())) {
      accept_substep(report, dt);
      ++report.substeps;
      clock.advance(travel_level(report));
      continue;
    }

    // The shortest substep is tried once more where cloth was let go from bodies that squeeze it.
    // Other refused substeps are tried again at half their length.
    report_offending(report);
    const bool let_go = clock.is_shortest() && let_go_of_bodies(report, start, dt);
    back_to_substep_start();
    ++report.retries;
    if (!let_go && !clock.halve()) return false;
  }
  return true;
}

/// The state of an accepted step is that of its last substep. A refused step leaves the state of
/// its start, whatever its substeps had reached.
void Solver::finish_step(StepReport& report) {
  if (!report.accepted) {
    back_to_start();
    report.momentum_error = 0;
    return;
  }
  report.offending.clear();
  report.no_room = false;
  watch_seams(mesh_, parameters_, state_);
  advance_clocks(report.dt);
  if (parameters_.step.sleep && report.substeps > 0) watch_stillness(mesh_, state_);
  report.step = ++state_.step;
}

/// Energies and hash are those of the state that was reached, or kept. A step that was slept
/// through has reached nothing new.
void Solver::report_end_state(StepReport& report) {
  if (report.accepted && report.substeps == 0 && measured_) {
    static_cast<StateReport&>(report) = *measured_;
    return;
  }
  const double energy = measure(report);
  measured_ = report;
  if (!reports_energies_) return;
  if (report.accepted) report.energy_balance = energy - *energy_ - work_;
  energy_ = energy;
}

double Solver::measure(StateReport& report) {
  use_device();
  report.state_hash = hash_state(state_);
  report.pinched = pinch_.vertices(state_);
  report_seams(mesh_, state_, report);
  if (reports_energies_)
    return report_state(implicit_.forces(), mesh_, state_, parameters_, report);
  report_extremes(mesh_, state_, report);
  return 0;
}

/// Time that no stage has measured counts as the rest of the step.
void Solver::close_report(StepReport& report) const {
  report.time = state_.time;
  report.static_faces = mesh_.faces - report.dynamic_faces;
  report.candidate_pairs = broad_phase_.candidate_count();
  report.ms_other = report.ms_total - report.ms_proximity - report.ms_implicit -
                    report.ms_broad_phase - report.ms_ccd - report.ms_impact_zones;
}

bool Solver::try_substep(StepReport& report, double start, double dt, bool last_resort) {
  // Obstacles move first: pairs are found along their paths.
  begin_substep(start, dt);
  SubstepContext step = substep(report, start, dt);
  timed(report.ms_broad_phase, [&] { broad_phase_.prepare(step); });
  timed(report.ms_proximity, [&] { find_contacts(step); });

  // Forces alone decide the candidate, which may penetrate.
  timed(report.ms_implicit, [&] { implicit_.integrate(step, proximity_); });
  if (!check_candidate(report, last_resort)) return false;
  find_impacts(step, true);
  if (!resolve_by_contacts(step, kFewImpacts, last_resort)) return false;

  // Impacts of the candidate are corrected. Where that stretches the cloth, forces decide anew.
  bool resolved = resolve_by_zones(step);
  if (resolved && zones_stretch_cloth(step)) {
    impact_zones_.back_to_candidate(step);
    find_impacts(step, true);
    if (!resolve_by_contacts(step, 1, last_resort)) return false;
    resolved = resolve_by_zones(step);
  }
  if (resolved) return true;

  // In the last resort they are taken back.
  if (!last_resort) return false;
  report.reach(Limit::substep_levels);
  return resolve_by_rollback(step);
}

SubstepContext Solver::substep(StepReport& report, double start, double dt) {
  return {.mesh = mesh_,
          .parameters = parameters_,
          .state = state_,
          .report = report,
          .dt = static_cast<Real>(dt),
          .time = start,
          .sums_up_work = reports_energies_,
          .fastest = fastest_};
}

/// Cloth that was let go from a body is pushed out of it instead of being kept away from it.
void Solver::find_contacts(SubstepContext& step) {
  if (parameters_.proximity.enabled)
    proximity_.find(step, broad_phase_, let_go_view(state_, mesh_));
  else
    proximity_.clear();
  if (!state_.let_go.empty()) proximity_.add(pinch_.push_outs(step));
}

/// False when the candidate is not finite, or when a shorter substep would be much more accurate:
/// half the length leaves a quarter of the strain that the linear solve does not see.
bool Solver::check_candidate(StepReport& report, bool last_resort) {
  report.finite = all_finite(state_);
  if (!report.finite) return false;
  const double error = implicit_.linearization_error();
  if (!(error > parameters_.implicit.max_linearization_error)) return true;
  report.reach(Limit::linearization_error);
  return last_resort;
}

/// Fast cloth meets what was not near it at the start. So many impacts, `fewest` or more, join the
/// contacts, and the forces decide anew, with stiffness and friction that the zones do not know.
/// False when the new candidate is wrong.
bool Solver::resolve_by_contacts(SubstepContext& step, std::int64_t fewest, bool last_resort) {
  StepReport& report = step.report;
  if (!parameters_.proximity.enabled) return true;
  for (int round = 0; round < parameters_.proximity.late_rounds; ++round) {
    if (report.impacts_left < fewest) return true;
    report.late_contacts += report.impacts_left;

    // The motion and the state of the contacts so far are where the solve goes on from.
    timed(report.ms_proximity, [&] { proximity_.add(step, ccd_.impacts()); });
    timed(report.ms_implicit, [&] { implicit_.integrate_again(step, proximity_); });
    if (!check_candidate(report, last_resort)) return false;
    find_impacts(step, true);
  }
  return true;
}

/// Whether the zones have stretched a face that the forces had not, and contacts may mend it. They
/// do not where bodies squeeze cloth: it is stretched at the rim, and stiff contacts would keep it
/// from leaving the bodies.
bool Solver::zones_stretch_cloth(const SubstepContext& step) const {
  if (!impact_zones_.corrected() || !state_.let_go.empty()) return false;
  if (!parameters_.proximity.enabled || parameters_.proximity.late_rounds == 0) return false;
  return largest_stretch(step.mesh, state_.candidate.view(), state_.x1.view()) > kMostZoneStretch;
}

/// The impacts of the candidate are known.
bool Solver::resolve_by_zones(SubstepContext& step) {
  StepReport& report = step.report;
  impact_zones_.begin_substep();

  // Each round solves the zones of the impacts that are left, until none is.
  report.impacts_first += report.impacts_left;
  for (int round = 0;; ++round) {
    if (round > 0) find_impacts(step, false);
    report.impacts_in_rounds.push_back(report.impacts_left);
    if (report.impacts_left == 0) return true;
    if (!parameters_.impact_zones.enabled) return false;
    if (round == parameters_.impact_zones.max_rounds) {
      report.reach(Limit::zone_rounds);
      return false;
    }

    // Constraints are kept over the rounds, so that a correction does not undo those before it.
    ++report.rounds;
    timed(report.ms_impact_zones, [&] { impact_zones_.solve(step, ccd_.impacts()); });

    // A correction of more than about an edge would tear the fabric; half the step corrects less.
    const double correction = static_cast<double>(impact_zones_.largest_correction());
    report.finite = std::isfinite(correction);
    if (!(correction <= parameters_.impact_zones.max_correction * world_.median_edge)) {
      report.reach(Limit::zone_correction);
      return false;
    }
  }
}

/// Puts vertices that still collide back to where they started. With resting obstacles this always
/// succeeds, at the latest when the whole cloth is back at its start. It fails when moving
/// obstacles squeeze cloth that is back already.
bool Solver::resolve_by_rollback(SubstepContext& step) {
  if (!step.report.finite || !parameters_.impact_zones.enabled) return false;
  impact_zones_.back_to_candidate(step);
  find_impacts(step, true);

  // Each round takes vertices back to the start, and there are only so many.
  while (step.report.impacts_left > 0) {
    ++step.report.rounds;
    bool moved = false;
    timed(step.report.ms_impact_zones,
          [&] { moved = impact_zones_.roll_back(step, ccd_.impacts()); });
    if (!moved) return false;
    find_impacts(step, false);
  }
  return true;
}

/// Tests all pairs in the first round, later only those with a dirty vertex if ccd.incremental is
/// on.
void Solver::find_impacts(SubstepContext& step, bool first_round) {
  StepReport& report = step.report;
  const bool incremental = !first_round && parameters_.ccd.incremental;

  // A pair without a dirty vertex moves as in the round before, where it was found free of impacts.
  timed(report.ms_broad_phase, [&] {
    if (incremental)
      broad_phase_.cover_dirty(step, impact_zones_.dirty());
    else if (first_round)
      broad_phase_.cover_candidate(step);
    else
      broad_phase_.cover_again(step);
  });

  timed(report.ms_ccd, [&] {
    ccd_.find(step, broad_phase_, impact_zones_.dirty(), incremental, let_go_view(state_, mesh_));
  });
  report.impacts_left = ccd_.impacts().size();
}

/// True when cloth was let go that bodies squeeze in the smallest substep: it is tried once more.
bool Solver::let_go_of_bodies(StepReport& report, double start, double dt) {
  if (!report.finite || !parameters_.impact_zones.enabled || ccd_.impacts().empty()) return false;
  SubstepContext step = substep(report, start, dt);
  return pinch_.release(step, ccd_.impacts());
}

/// The bodies move against resting cloth; what they hit is let go.
void Solver::pass_over() {
  use_device();
  const double dt = parameters_.step.time_step;
  begin_substep(state_.time, dt);
  StepReport report;
  fastest_ = largest_speed();
  SubstepContext step = substep(report, state_.time, dt);
  broad_phase_.cover_candidate(step);
  ccd_.find(step, broad_phase_, {}, false, let_go_view(state_, mesh_));
  pinch_.release_all(state_, ccd_.impacts());

  // The cloth goes on from rest: what it remembers of the motion before is not true any more.
  rest_cloth();
  advance_clocks(dt);
  ++state_.step;
}

std::vector<OffendingPair> Solver::contacts_at_rest() {
  use_device();
  Memory before;
  before.copy_from(state_);
  state_.x0.copy_from(state_.x1);

  // The test of a step, of motions that all are 0.
  StepReport report;
  SubstepContext step = substep(report, state_.time, parameters_.step.time_step);
  broad_phase_.cover_candidate(step);
  ccd_.find(step, broad_phase_, {}, false, let_go_view(state_, mesh_));
  report_offending(report);

  static_cast<Memory&>(state_).copy_from(before);
  broad_phase_.follow_memory();
  return report.offending;
}

}  // namespace icloth::ICLOTH_BUILD
