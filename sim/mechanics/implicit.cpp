#include "sim/mechanics/implicit.h"

#include <algorithm>
#include <tuple>

#include "kernels/parallel/parallel.h"
#include "sim/mechanics/work.h"
#include "sim/mechanics/yarns.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Gathers one row of the matrix and of the right-hand side in a fixed order.
struct AssembleRow {
  View<const Index> row_first, column, face_first, face_source, hinge_first, hinge_source;
  View<const FaceTerm> face_term;
  View<const HingeTerm> hinge_term;
  View<const Real> mass, inverse_mass, spring_stiffness;
  View<const Vec3r> spring_target, x, v, free;
  bool springs;
  Vec3r gravity;
  Real dt;
  View<Mat3r> value;
  View<Vec3r> rhs;

  ICLOTH_HD void operator()(Index i) const {
    Vec3r impulse = (dt * mass[i]) * gravity;
    for (Index k = row_first[i]; k < row_first[i + 1]; ++k) {
      const bool diagonal = column[k] == i;
      Mat3r sum = diagonal ? Mat3r::identity(mass[i]) : Mat3r{};
      for (Index e = face_first[k]; e < face_first[k + 1]; ++e) {
        const Index code = face_source[e];
        const FaceTerm& t = face_term[code / 9];
        const int a = (code % 9) / 3, b = code % 3;
        sum += a <= b ? t.block[block_slot(a, b)] : transpose(t.block[block_slot(b, a)]);
        if (diagonal) impulse += t.impulse[a];
      }
      for (Index e = hinge_first[k]; e < hinge_first[k + 1]; ++e) {
        const Index code = hinge_source[e];
        const HingeTerm& t = hinge_term[code / 16];
        const int a = (code % 16) / 4, b = code % 4;
        sum += outer(t.k * t.gradient[a], t.gradient[b]);
        if (diagonal) impulse += t.s * t.gradient[a];
      }
      if (diagonal && springs) add_spring(i, sum, impulse);
      value[k] = sum;
    }
    rhs[i] = inverse_mass[i] > 0 ? impulse : Vec3r{};
  }

  /// Implicit, critically damped spring of a hand.
  ICLOTH_HD void add_spring(Index i, Mat3r& sum, Vec3r& impulse) const {
    const Real k = spring_stiffness[i];
    if (!(k > 0)) return;
    const Real c = 2 * std::sqrt(k * mass[i]);
    sum += Mat3r::identity(dt * dt * k + dt * c);
    impulse += (dt * k) * (spring_target[i] - (x[i] + free[i])) - (dt * c) * v[i];
  }
};

/// Motion of the vertices in the step: as they move now, and with what the solve adds.
struct VertexMotion {
  View<const Vec3r> free;  ///< x1 − x0 with Δv = 0 [m] (vertices)
  View<const Vec3r> dv;    ///< (cloth vertices)
  View<const Real> inverse_mass;
  Real dt;
  bool solved;

  ICLOTH_HD ContactMotion of(const Contact& c) const {
    ContactMotion motion{apply(c.s, free), {}, solved};
    motion.end = motion.free;
    if (!solved) return motion;
    for (int a = 0; a < 4; ++a) {
      const Index i = c.s.v[a];
      if (inverse_mass[i] > 0) motion.end += (dt * c.s.w[a]) * dv[i];
    }
    return motion;
  }

  /// Of the cloth's side of the contact, as solved.
  ICLOTH_HD Vec3r of_cloth(const Contact& c) const {
    Vec3r sum{};
    for (int a = 0; a < 4; ++a) {
      const Index i = c.s.v[a];
      if (inverse_mass[i] > 0) sum += c.s.w[a] * (free[i] + dt * dv[i]);
    }
    return sum;
  }
};

struct ContactTerms {
  VertexMotion motion;
  ContactLaw law;
  View<const Contact> contacts;
  View<ContactTerm> term;

  ICLOTH_HD void operator()(Index i) const {
    const Contact& c = contacts[i];
    Real mobility = 0;
    for (int a = 0; a < 4; ++a) mobility += c.s.w[a] * c.s.w[a] * motion.inverse_mass[c.s.v[a]];
    term[i] = contact_term(c, law, motion.of(c), mobility, term[i]);
  }
};

/// How far the contact forces of a solve are from those of the contact law at its solution.
struct ContactResidual {
  double error;  ///< contact forces that acted and should not have, or the other way round [N]
  double load;   ///< what the contacts carry [N]
  double work;   ///< of the contacts on the cloth [J]
  ICLOTH_HD friend ContactResidual operator+(ContactResidual a, ContactResidual b) {
    return {a.error + b.error, a.load + b.load, a.work + b.work};
  }
};

/// The residual of one contact is what the linear term applied in place of the law's force at the
/// solved motion: it pulled, was left out and has closed, slid and was to stick, or the other way
/// round.
struct ContactResidualOf {
  VertexMotion motion;
  ContactLaw law;
  View<const Contact> contacts;
  View<const ContactTerm> term;

  ICLOTH_HD ContactResidual operator()(Index i) const {
    const Contact& c = contacts[i];
    const ContactMotion m = motion.of(c);
    const Real normal = normal_force(c, law, m.end);
    const Vec3r applied = applied_force(term[i], law, m);
    Vec3r wrong = applied - normal * c.normal;
    if (c.friction > 0) wrong = wrong - friction_of(c, law, m.end, normal).force;
    return {static_cast<double>(norm(wrong)), static_cast<double>(normal),
            dot_double(applied, motion.of_cloth(c))};
  }
};

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
    const Vec3r way = x1[i] - x0[i], last = rule.remembers() ? rule.w * past_motion[i] : Vec3r{};
    const bool touched = touches(i);
    const Vec3r end = touched ? (Real(1) / rule.dt) * way : (Real(1) / rule.h) * (way - last);
    const bool held = !(inverse_mass[i] > 0);
    past_change[i] = touched || held ? Vec3r{} : end - v[i];
    past_motion[i] = held ? Vec3r{} : way;
    v[i] = held ? Vec3r{} : end;
  }

  ICLOTH_HD bool touches(Index i) const {
    const Vec3r correction = x1[i] - candidate[i];
    return !(norm2(correction) == 0) || couplings.touch(i);
  }
};

/// Adds the contacts of one vertex to its right-hand side and inverts its diagonal block.
struct FinishRow {
  View<const Index> row_first;
  View<const Mat3r> value;
  CouplingView couplings;
  View<const Real> inverse_mass;
  View<const Vec3r> rhs;
  View<Vec3r> contact_rhs;  ///< with the contacts
  View<Mat3r> inverse_diagonal;

  ICLOTH_HD void operator()(Index i) const {
    contact_rhs[i] = rhs[i];
    if (!(inverse_mass[i] > 0)) {
      inverse_diagonal[i] = Mat3r{};
      return;
    }
    Mat3r block = value[row_first[i]];  // the diagonal comes first
    couplings.of_vertex(i, [&](Index k, Real w) {
      const Coupling& c = couplings.list[k];
      contact_rhs[i] += w * c.impulse;
      block += c.h.scaled(w * w);
    });
    inverse_diagonal[i] = inverse_spd(block);
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

/// From the solution to the end of the step as the next iteration will solve it.
struct PredictedMotion {
  View<const Vec3r> dv;
  View<Vec3r> predicted;
  Real dt;
  ICLOTH_HD void operator()(Index i) const { predicted[i] = -dt * dv[i]; }
};

/// Tension of the strain that is of second order in the motion since the point of linearisation,
/// ½ ΔFᵀΔF: the linear solve leaves it out.
struct LinearizationError {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  Linearization point;
  View<const Vec3r> dv;

  ICLOTH_HD Real operator()(Index i) const {
    Vec3r start[3], motion[3];
    for (int a = 0; a < 3; ++a) {
      const Index v = face[i].v[a];
      start[a] = point.start[v];
      motion[a] = point.predicted[v] + point.dt * dv[v];
    }
    const Stiffness k =
        stiffness_at(fabric[face_fabric[i]], green_strain(face_frame(start, inverse[i].m)));
    const FaceFrame change = face_frame(motion, inverse[i].m);
    return Real(0.5) * std::fmax(k.k11 * norm2(change.fu), k.k22 * norm2(change.fv));
  }
};

/// Host-side list of (row, column, source) triples that becomes the pattern.
struct PatternEntry {
  Index row, column, source;  ///< source: face code, or hinge code + face codes' end as ~code
  auto key() const { return std::tuple(row, column, source < 0, source < 0 ? ~source : source); }
};

std::vector<PatternEntry> pattern_entries(const World& world, bool bending) {
  std::vector<PatternEntry> entries;
  entries.reserve(6 * static_cast<std::size_t>(world.cloth_faces) + 10 * world.hinges.size());
  // The upper half only: row ≤ column.
  const auto add = [&](Index row, Index column, Index source) {
    if (row <= column) entries.push_back({row, column, source});
  };
  for (Index f = 0; f < world.cloth_faces; ++f) {
    const Triangle& t = world.face[static_cast<std::size_t>(f)];
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) add(t[a], t[b], 9 * f + static_cast<Index>(3 * a + b));
  }
  for (std::size_t h = 0; bending && h < world.hinges.size(); ++h) {
    const auto& v = world.hinges[h].vertices;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) add(v[a], v[b], ~static_cast<Index>(16 * h + 4 * a + b));
  }
  std::sort(entries.begin(), entries.end(),
            [](const auto& p, const auto& q) { return p.key() < q.key(); });
  return entries;
}

}  // namespace

void Implicit::set_up(const World& world, bool bending) {
  const std::vector<PatternEntry> entries = pattern_entries(world, bending);
  std::vector<Index> row_first{0}, column, face_first{0}, face_source, hinge_first{0}, hinge_source;
  Index row = 0;
  const auto close_row = [&] { row_first.push_back(static_cast<Index>(column.size())), ++row; };
  for (std::size_t e = 0; e < entries.size();) {
    while (row < entries[e].row) close_row();
    const PatternEntry block = entries[e];
    column.push_back(block.column);
    for (; e < entries.size() && entries[e].row == block.row && entries[e].column == block.column;
         ++e) {
      if (entries[e].source >= 0)
        face_source.push_back(entries[e].source);
      else
        hinge_source.push_back(~entries[e].source);
    }
    face_first.push_back(static_cast<Index>(face_source.size()));
    hinge_first.push_back(static_cast<Index>(hinge_source.size()));
  }
  while (row < world.cloth_vertices) close_row();
  matrix_.set_pattern(row_first, column);
  solver_.set_up(row_first, column);
  face_source_first_.upload(face_first);
  face_source_.upload(face_source);
  hinge_source_first_.upload(hinge_first);
  hinge_source_.upload(hinge_source);
}

void Implicit::bend(SubstepContext& step, const Linearization& point) {
  const Topology& mesh = step.mesh;
  const Real damping_extra = static_cast<Real>(step.parameters.material.damping);
  if (!mesh.bends) return;
  hinge_terms_.resize(mesh.hinge_count);
  if (step.parameters.material.bending == BendingModel::hinge) {
    for_each("implicit.bending", mesh.hinge_count,
             BendingTerms{mesh.hinge.view(), mesh.fabric.view(), point, hinge_terms_.view(),
                          damping_extra});
    return;
  }
  plate_terms_.resize(mesh.cloth_faces);
  for_each("implicit.angles", mesh.hinge_count,
           HingeAngles{mesh.hinge.view(), mesh.fabric.view(), point, hinge_terms_.view(),
                       damping_extra});
  for_each("implicit.plates", mesh.cloth_faces,
           PlateTerms{mesh.plate.view(), mesh.hinge.view(), mesh.face_area.view(),
                      mesh.face_fabric.view(), mesh.fabric.view(), point, hinge_terms_.view(),
                      plate_terms_.view(), damping_extra, step.state.yarns.view()});
  for_each("implicit.bending", mesh.hinge_count,
           GatherPlates{mesh.hinge_slots.view(), plate_terms_.view(), mesh.hinge.view(),
                        mesh.fabric.view(), point, hinge_terms_.view(), damping_extra});
}

void Implicit::assemble(SubstepContext& step, const Linearization& point) {
  const Topology& mesh = step.mesh;
  const State& s = step.state;
  const Parameters& p = step.parameters;
  const Real damping_extra = static_cast<Real>(p.material.damping);
  face_terms_.resize(mesh.cloth_faces);
  rhs_.resize(mesh.cloth_vertices);
  for_each("implicit.membrane", mesh.cloth_faces,
           MembraneTerms{mesh.face.view(), mesh.face_inverse.view(), mesh.face_area.view(),
                         mesh.face_fabric.view(), mesh.fabric.view(), point, face_terms_.view(),
                         damping_extra, wind_of(p), s.yarns.view()});
  bend(step, point);
  for_each("implicit.assemble", mesh.cloth_vertices,
           AssembleRow{matrix_.row_first.view(),
                       matrix_.column.view(),
                       face_source_first_.view(),
                       face_source_.view(),
                       hinge_source_first_.view(),
                       hinge_source_.view(),
                       face_terms_.view(),
                       hinge_terms_.view(),
                       s.mass.view(),
                       s.inverse_mass.view(),
                       s.spring_stiffness.view(),
                       s.spring_target.view(),
                       s.x0.view(),
                       point.v,
                       free_motion_.view(),
                       s.has_springs,
                       step.gravity(),
                       rule_.h,
                       matrix_.value.view(),
                       rhs_.view()});
}

void Implicit::integrate(SubstepContext& step, const Proximity& proximity) {
  const Topology& mesh = step.mesh;
  const Parameters& p = step.parameters;
  State& s = step.state;
  dv_.resize(mesh.cloth_vertices + kPadding);
  dv_.fill(Vec3r{});
  update_yarn_anchors(mesh, p, s);
  rule_ = time_rule(p.implicit.integrator, static_cast<double>(step.dt), s.past.dt);
  const View<const Vec3r> velocity = move_freely(step);
  Linearization point{s.x0.view(), s.x0.view(), free_motion_.view(), velocity, rule_.h};
  for (int iteration = 0;; ++iteration) {
    assemble(step, point);
    ++step.report.newton_iterations;
    solve_with_contacts(step, proximity, iteration > 0);
    linearization_error_ = move(step, point);
    if (iteration + 1 >= p.implicit.newton_iterations ||
        !(linearization_error_ > p.implicit.newton_tolerance))
      break;
    at_.copy_from(s.candidate);
    predicted_.resize(mesh.cloth_vertices);
    for_each("implicit.predicted", mesh.cloth_vertices,
             PredictedMotion{dv_.view(), predicted_.view(), rule_.h});
    point.at = at_.view();
    point.predicted = predicted_.view();
  }
  outer_work_ = air_work(step, point, dv_.view()) + hand_work(step, point, dv_.view()) +
                yarn_work(mesh, p, s);
}

View<const Vec3r> Implicit::move_freely(const SubstepContext& step) {
  const Topology& mesh = step.mesh;
  const State& s = step.state;
  free_motion_.resize(mesh.vertices);
  for_each("implicit.free_motion", mesh.vertices,
           FreeMotion{s.x0.view(), s.x1.view(), s.v.view(), free_motion_.view(),
                      mesh.cloth_vertices, rule_.h});
  if (!rule_.remembers()) return s.v.view();
  free_velocity_.resize(mesh.cloth_vertices);
  for_each("implicit.past", mesh.cloth_vertices,
           FreeMotionFromPast{s.past.motion.view(), s.past.change.view(), s.v.view(),
                              free_motion_.view(), free_velocity_.view(), rule_});
  return free_velocity_.view();
}

/// Solves for Δv. The repulsion acts one way only, and friction sticks or slides: which contacts
/// close and which slide is known for certain after a solve. `solved`: dv_ is a solution already.
void Implicit::solve_with_contacts(SubstepContext& step, const Proximity& proximity, bool solved) {
  const Topology& mesh = step.mesh;
  State& s = step.state;
  const Array<Contact>& contacts = proximity.contacts();
  contact_terms_.resize(contacts.size());
  inverse_diagonal_.resize(mesh.cloth_vertices);
  contact_rhs_.resize(mesh.cloth_vertices);
  const ContactLaw law{static_cast<Real>(step.parameters.proximity.stiffness), rule_.h};
  VertexMotion motion{free_motion_.view(), dv_.view(), s.inverse_mass.view(), rule_.h, solved};
  for (int pass = 0; pass < step.parameters.implicit.contact_passes; ++pass) {
    for_each("implicit.contact_terms", contacts.size(),
             ContactTerms{motion, law, contacts.view(), contact_terms_.view()});
    couplings_.gather(contacts.view(), contact_terms_.view(), mesh.cloth_vertices);
    const SystemView system{matrix_.view(), s.inverse_mass.view(), couplings_.view()};
    for_each("implicit.finish_rows", mesh.cloth_vertices,
             FinishRow{matrix_.row_first.view(), matrix_.value.view(), system.couplings,
                       s.inverse_mass.view(), rhs_.view(), contact_rhs_.view(),
                       inverse_diagonal_.view()});
    const LinearSolution solution = solver_.solve(
        system, inverse_diagonal_.view(), contact_rhs_.view(), dv_.view(),
        {step.parameters.implicit.preconditioner, step.parameters.implicit.cg_tolerance,
         step.parameters.implicit.cg_max_iterations, pass > 0});
    step.report.cg_iterations += solution.iterations;
    step.report.cg_bytes += solution.bytes;
    step.report.cg_residual = std::max(step.report.cg_residual, solution.residual);
    lost_force_ = (1 / static_cast<double>(rule_.h)) * solution.lost;
    ++step.report.linear_solves;
    motion.solved = true;
    const ContactResidual residual =
        reduce("implicit.contact_residual", contacts.size(), ContactResidual{0, 0, 0},
               ContactResidualOf{motion, law, contacts.view(), contact_terms_.view()}, Sum{});
    contact_work_ = residual.work;
    if (!(residual.error > step.parameters.implicit.contact_tolerance * residual.load)) break;
  }
}

/// Writes x1; returns the linearisation error [N/m].
double Implicit::move(SubstepContext& step, const Linearization& point) {
  const Topology& mesh = step.mesh;
  State& s = step.state;
  for_each("implicit.move", mesh.cloth_vertices,
           MoveVertices{s.x0.view(), free_motion_.view(), dv_.view(), s.x1.view(),
                        s.candidate.view(), rule_.h});
  return static_cast<double>(
      reduce("implicit.linearization_error", mesh.cloth_faces, Real(0),
             LinearizationError{mesh.face.view(), mesh.face_inverse.view(), mesh.face_fabric.view(),
                                mesh.fabric.view(), point, dv_.view()},
             Max{}));
}

void Implicit::finish_substep(State& state) {
  const Index vertices = state.mass.size();
  const Real dt = rule_.dt;
  if (rule_.integrator == Integrator::backward_euler) {
    state.past.forget();
    for_each("implicit.velocities", vertices,
             EndVelocity{state.x0.view(), state.x1.view(), state.inverse_mass.view(),
                         state.v.view(), Real(1) / dt});
    return;
  }
  state.past.motion.resize(vertices);
  state.past.change.resize(vertices);
  for_each("implicit.velocities", vertices,
           EndTwoSteps{state.x0.view(), state.x1.view(), state.candidate.view(),
                       state.inverse_mass.view(), couplings_.view(), rule_, state.v.view(),
                       state.past.motion.view(), state.past.change.view()});
  state.past.dt = static_cast<double>(dt);
}

}  // namespace icloth::ICLOTH_BUILD
