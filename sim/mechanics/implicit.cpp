#include "sim/mechanics/implicit.h"

#include <algorithm>

#include "kernels/parallel/parallel.h"
#include "kernels/strain_limit.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// x1 − x0 of all vertices when the cloth keeps its velocity.
struct FreeMotion {
  View<const Vec3r> x0, x1, v;
  View<Vec3r> motion;
  Index cloth_vertices;
  Real dt;
  ICLOTH_HD void operator()(Index i) const {
    motion[i] = i < cloth_vertices ? dt * v[i] : x1[i] - x0[i];
  }
};

/// The same of the cloth, with what a two-step rule adds.
struct FreeMotionFromPast {
  View<const Vec3r> past_motion, past_change, v;
  View<Vec3r> motion, velocity;
  TimeRule rule;
  ICLOTH_HD void operator()(Index i) const {
    velocity[i] = v[i] + rule.w * past_change[i];
    motion[i] = rule.w * past_motion[i] + rule.h * velocity[i];
  }
};

struct EndVelocity {
  View<const Vec3r> x0, x1;
  View<const Real> inverse_mass;
  View<Vec3r> v;
  Real inverse_dt;
  ICLOTH_HD void operator()(Index i) const {
    v[i] = inverse_mass[i] > 0 ? inverse_dt * (x1[i] - x0[i]) : Vec3r{};
  }
};

/// For the next step of a two-step rule. A vertex that touched something was stopped or deflected:
/// it starts afresh from its mean velocity, or the past would make it rebound.
struct EndTwoSteps {
  View<const Vec3r> x0, x1, candidate;
  View<const Real> inverse_mass;
  CouplingView couplings;  ///< of the last solve
  TimeRule rule;
  View<Vec3r> v, past_motion, past_change;

  ICLOTH_HD void operator()(Index i) const {
    const Vec3r moved = x1[i] - x0[i];
    const Vec3r last = rule.remembers() ? rule.w * past_motion[i] : Vec3r{};
    const bool touched = touches(i);
    const Vec3r end = touched ? (Real(1) / rule.dt) * moved : (Real(1) / rule.h) * (moved - last);
    const bool held = !(inverse_mass[i] > 0);
    past_change[i] = touched || held ? Vec3r{} : end - v[i];
    past_motion[i] = held ? Vec3r{} : moved;
    v[i] = held ? Vec3r{} : end;
  }

  ICLOTH_HD bool touches(Index i) const {
    const Vec3r correction = x1[i] - candidate[i];
    return !(norm2(correction) == 0) || couplings.touch(i);
  }
};

struct MoveVertices {
  View<const Vec3r> x0, free, dv;
  View<Vec3r> x1, candidate;
  Real dt;
  ICLOTH_HD void operator()(Index i) const {
    x1[i] = x0[i] + (free[i] + dt * dv[i]);
    candidate[i] = x1[i];
  }
};

/// Where the cloth would come to without forces.
struct FreeShape {
  View<const Vec3r> x0, free;
  View<Vec3r> shape;
  ICLOTH_HD void operator()(Index i) const { shape[i] = x0[i] + free[i]; }
};

/// From the solution, where the next iteration linearises, to the end of the step with Δv = 0.
struct PredictedMotion {
  View<const Vec3r> dv;
  View<Vec3r> predicted;
  Real dt;
  ICLOTH_HD void operator()(Index i) const { predicted[i] = -dt * dv[i]; }
};

/// Faces whose error, or its bound, is this share of what is allowed are linearised again together
/// with those that have more.
constexpr Real kNegligibleError = Real(0.25);

/// What the linear solve leaves out of a face: tension [N/m], and the strain that it belongs to.
struct FaceError {
  Real tension, strain;
};
struct LargestErrors {
  ICLOTH_HD FaceError operator()(FaceError a, FaceError b) const {
    return {Max{}(a.tension, b.tension), Max{}(a.strain, b.strain)};
  }
};

/// Tension that the linear solve leaves out: that of the strain which is of second order in the
/// motion since the point of linearisation, ½ ΔFᵀΔF, and that of strain beyond the limit, as if the
/// fabric had not hardened. Where a bound of it is negligible, the bound stands for it.
struct LinearizationError {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  Linearization point;
  View<const Vec3r> dv;
  Real allowed;                 ///< error up to which no other linearisation is needed
  View<std::uint8_t> to_renew;  ///< becomes 1 where a face needs it; empty: not written

  ICLOTH_HD FaceError operator()(Index i) const {
    const View<const Vec3r> shape = point.shape_of(i);
    Vec3r at[3], motion[3], end[3];
    for (int a = 0; a < 3; ++a) {
      const Index v = face[i].v[a];
      at[a] = shape[v];
      motion[a] = point.predicted[v] + point.dt * dv[v];
      if (point.keeps(i)) motion[a] = motion[a] + (point.at[v] - at[a]);
      end[a] = at[a] + motion[a];
    }

    // Most faces turn and stretch so little that no fabric is stiff enough to make it count.
    const Fabric& cloth = fabric[face_fabric[i]];
    const FaceFrame change = face_frame(motion, inverse[i].m);
    const Real strain = Real(0.5) * std::fmax(norm2(change.fu), norm2(change.fv));
    const Real most = cloth.most_stiffness * strain;
    const bool hardens = may_reach_limit(cloth, at, i) || may_reach_limit(cloth, end, i);
    const Real negligible = kNegligibleError * allowed;
    const FaceError error =
        most > negligible || hardens ? exactly(i, cloth, at, end, change) : FaceError{most, strain};

    // Hardened fabric is so stiff that it always counts.
    if (to_renew.size() > 0 && (hardens || error.tension > negligible)) to_renew[i] = 1;
    return error;
  }

  ICLOTH_HD bool may_reach_limit(const Fabric& cloth, const Vec3r x[3], Index i) const {
    return cloth.limit_strain > 0 &&
           strain_bound(green_strain(face_frame(x, inverse[i].m))) > cloth.limit_strain;
  }

  ICLOTH_HD FaceError exactly(Index i, const Fabric& cloth, const Vec3r at[3], const Vec3r end[3],
                              const FaceFrame& change) const {
    Vec3r start[3];
    for (int a = 0; a < 3; ++a) start[a] = point.start[face[i].v[a]];

    // The stiffness is the one that the linearisation used.
    const Stiffness k = stiffness_at(cloth, green_strain(face_frame(start, inverse[i].m)));
    const Real missed = Real(0.5) * std::fmax(k.k11 * norm2(change.fu), k.k22 * norm2(change.fv));

    // The limit is much stiffer than the fabric. What counts is the strain that it lets pass.
    const Real passed = missed_limit_strain(cloth, green_strain(face_frame(at, inverse[i].m)),
                                            green_strain(face_frame(end, inverse[i].m)));
    const Real strain = Real(0.5) * std::fmax(norm2(change.fu), norm2(change.fv));
    return {missed + passed * std::fmax(k.k11, k.k22), strain + passed};
  }
};

/// A linearisation whose start was this many times too wrong is expected to be followed by another
/// one: the error falls to about a third from one to the next.
constexpr double kDraftError = 2.5;

/// A linearisation that leaves out more strain than this may be followed by twice as many as usual.
constexpr double kGrossStrain = 0.05;

/// The goal of a solution at which the system is going to be linearised again.
ContactGoal draft_of(const ContactGoal& fair) {
  return {std::max(fair.contact_tolerance, 0.1),
          std::max(fair.cg_tolerance, std::min(10 * fair.cg_tolerance, 0.03))};
}

}  // namespace

void Implicit::match_pattern(const World& world, const Topology& mesh) {
  if (const std::optional<Pattern> pattern = assembly_.match_pattern(world, mesh))
    contacts_.set_up(*pattern);
}

void Implicit::integrate(SubstepContext& step, const Proximity& proximity) {
  const ImplicitParameters& p = step.parameters.implicit;
  dv_.resize(step.mesh.cloth_vertices + kPadding);
  dv_.fill(Vec3r{});

  // The time rule and the motion without forces are where the solve starts from.
  rule_ = time_rule(p.integrator, static_cast<double>(step.dt), step.state.past.dt);
  assembly_.begin_substep(step);
  move_freely(step);

  // The first iteration linearises at x0, as the paper does.
  const View<const Vec3r> x0 = step.state.x0.view(), free_motion = free_motion_.view();
  point_ = {.start = x0,
            .at = x0,
            .predicted = free_motion,
            .v = rule_.remembers() ? free_velocity_.view() : step.state.v.view(),
            .dt = rule_.h};
  iteration_ = 0;

  // The springs of open seams are linear, hence the same in every iteration.
  seams_.assemble(step, free_motion, point_.v, rule_.h);

  // How much the motion without forces turns the faces says whether one linearisation will do.
  linearization_error_ = 0;
  if (p.newton_iterations > 1) find_linearization_error(step);
  renew_no_face(step);
  linearize(step);
  find_candidate(step, proximity, false);
}

/// The linear system is still that of the candidate; what it lacked are the contacts.
void Implicit::integrate_again(SubstepContext& step, const Proximity& proximity) {
  find_candidate(step, proximity, true);
}

void Implicit::linearize(SubstepContext& step) {
  assembly_.assemble(context(step));
  change_ = point_.renewed.size() > 0 ? MatrixChange::some_rows : MatrixChange::all;
  ++step.report.newton_iterations;
  ++iteration_;
}

/// Newton's method: it linearises at the candidate again until the tension is accurate. `solved`:
/// dv_ solves the system without contacts that were added since.
void Implicit::find_candidate(SubstepContext& step, const Proximity& proximity, bool solved) {
  const ImplicitParameters& p = step.parameters.implicit;
  const ContactGoal fair{p.contact_tolerance, p.cg_tolerance};
  for (;; solved = true) {
    // A solution at which the system is going to be linearised again is a draft. The candidate
    // shows how much tension the linearisation left out.
    const bool draft =
        iteration_ < most_iterations(p) && linearization_error_ > kDraftError * p.newton_tolerance;
    solve(step, proximity, draft ? draft_of(fair) : fair, solved);
    if (draft && !(linearization_error_ > p.newton_tolerance)) solve(step, proximity, fair, true);
    if (!(linearization_error_ > p.newton_tolerance)) break;
    if (iteration_ >= most_iterations(p)) {
      step.report.reach(Limit::newton_iterations);
      break;
    }
    linearize_at_candidate(step);
    linearize(step);
  }
  step.report.cg_residual = std::max(step.report.cg_residual, contacts_.residual());

  // Work is that of the forces as they were linearised last, since these made the motion.
  if (step.sums_up_work)
    outer_work_ =
        assembly_.work(context(step), dv_.view()) +
        seams_.work(free_motion_.view(), dv_.view(), step.state.inverse_mass.view(), rule_.h);
}

/// Iterations that the present error may take. A gross one may take twice the usual number:
/// contacts that were added late find it used up, and single faces of soft fabrics would stay
/// stretched.
int Implicit::most_iterations(const ImplicitParameters& p) const {
  const bool more = p.newton_iterations > 1 && missed_strain_ > kGrossStrain;
  return more ? 2 * p.newton_iterations : p.newton_iterations;
}

/// Solves the present linear system and moves the vertices.
void Implicit::solve(SubstepContext& step, const Proximity& proximity, const ContactGoal& goal,
                     bool solved) {
  contacts_.solve(step,
                  {.matrix = assembly_.matrix(),
                   .rhs = assembly_.rhs(),
                   .contacts = proximity.contacts(),
                   .seams = seams_.couplings(),
                   .free_motion = free_motion_.view(),
                   .h = rule_.h,
                   .change = change_,
                   .changed_rows = assembly_.renewed_rows()},
                  goal, dv_.view(), solved);
  change_ = MatrixChange::none;
  move(step);
  find_linearization_error(step);
}

/// Writes free_motion_ and, where the rule remembers the step before, free_velocity_.
void Implicit::move_freely(const SubstepContext& step) {
  const Topology& mesh = step.mesh;
  const State& s = step.state;

  // Cloth goes on with its velocity, and obstacles make the motion that they are given.
  free_motion_.resize(mesh.vertices);
  for_each("implicit.free_motion", mesh.vertices,
           FreeMotion{.x0 = s.x0.view(),
                      .x1 = s.x1.view(),
                      .v = s.v.view(),
                      .motion = free_motion_.view(),
                      .cloth_vertices = mesh.cloth_vertices,
                      .dt = rule_.h});

  // A rule of two steps replaces the cloth's part by what follows from the step before.
  if (!rule_.remembers()) return;
  free_velocity_.resize(mesh.cloth_vertices);
  for_each("implicit.past", mesh.cloth_vertices,
           FreeMotionFromPast{.past_motion = s.past.motion.view(),
                              .past_change = s.past.change.view(),
                              .v = s.v.view(),
                              .motion = free_motion_.view(),
                              .velocity = free_velocity_.view(),
                              .rule = rule_});
}

/// Writes x1 and the candidate.
void Implicit::move(SubstepContext& step) {
  State& s = step.state;
  for_each("implicit.move", step.mesh.cloth_vertices,
           MoveVertices{.x0 = s.x0.view(),
                        .free = free_motion_.view(),
                        .dv = dv_.view(),
                        .x1 = s.x1.view(),
                        .candidate = s.candidate.view(),
                        .dt = rule_.h});
}

/// Notes that no face needs another linearisation yet. The pressure of a gas, which is not
/// linearised at all, follows the shape everywhere.
void Implicit::renew_no_face(const SubstepContext& step) {
  const bool anywhere =
      step.parameters.material.pressure != 0 || step.parameters.implicit.newton_iterations <= 1;
  to_renew_.resize(anywhere ? 0 : step.mesh.cloth_faces);
  to_renew_.fill(0);
}

void Implicit::find_linearization_error(const SubstepContext& step) {
  const Topology& mesh = step.mesh;
  const ImplicitParameters& p = step.parameters.implicit;
  const double allowed = std::min(p.newton_tolerance, p.max_linearization_error);
  const FaceError error = reduce("implicit.linearization_error", mesh.cloth_faces, FaceError{0, 0},
                                 LinearizationError{.face = mesh.face.view(),
                                                    .inverse = mesh.face_inverse.view(),
                                                    .face_fabric = mesh.face_fabric.view(),
                                                    .fabric = mesh.fabric.view(),
                                                    .point = point_,
                                                    .dv = dv_.view(),
                                                    .allowed = static_cast<Real>(allowed),
                                                    .to_renew = to_renew_.view()},
                                 LargestErrors{});
  linearization_error_ = static_cast<double>(error.tension);
  missed_strain_ = static_cast<double>(error.strain);

  // Friction of yarns decides which faces are renewed, but not whether there is another iteration.
  if (iteration_ > 0 && step.state.yarns.size() > 0 && to_renew_.size() > 0 &&
      linearization_error_ > p.newton_tolerance) {
    free_shape_.resize(mesh.cloth_vertices);
    for_each("implicit.free_shape", mesh.cloth_vertices,
             FreeShape{step.state.x0.view(), free_motion_.view(), free_shape_.view()});
    mark_wrong_friction(context(step), free_shape_.view(),
                        kNegligibleError * static_cast<Real>(allowed), to_renew_.view());
  }
}

void Implicit::linearize_at_candidate(const SubstepContext& step) {
  const Index vertices = step.mesh.cloth_vertices;
  at_.copy_from(step.state.candidate);
  predicted_.resize(vertices);
  for_each("implicit.predicted", vertices, PredictedMotion{dv_.view(), predicted_.view(), rule_.h});
  point_.at = at_.view();
  point_.predicted = predicted_.view();
  renewed_.copy_from(to_renew_);
  point_.renewed = renewed_.view();
}

void Implicit::finish_substep(State& state) {
  const Index vertices = state.mass.size();
  const Real dt = rule_.dt;

  // Euler goes on from positions and velocities alone.
  if (rule_.integrator == Integrator::backward_euler) {
    state.past.forget();
    for_each("implicit.velocities", vertices,
             EndVelocity{.x0 = state.x0.view(),
                         .x1 = state.x1.view(),
                         .inverse_mass = state.inverse_mass.view(),
                         .v = state.v.view(),
                         .inverse_dt = Real(1) / dt});
    return;
  }

  // A rule of two steps also remembers the motion and the change of the velocity.
  state.past.motion.resize(vertices);
  state.past.change.resize(vertices);
  for_each("implicit.velocities", vertices,
           EndTwoSteps{.x0 = state.x0.view(),
                       .x1 = state.x1.view(),
                       .candidate = state.candidate.view(),
                       .inverse_mass = state.inverse_mass.view(),
                       .couplings = contacts_.couplings(),
                       .rule = rule_,
                       .v = state.v.view(),
                       .past_motion = state.past.motion.view(),
                       .past_change = state.past.change.view()});
  state.past.dt = static_cast<double>(dt);
}

}  // namespace icloth::ICLOTH_BUILD
