#include "sim/mechanics/contact_pass.h"

#include <algorithm>

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Motion of the vertices in the substep: with the velocity they have, and as the last solve
/// changed it.
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

  /// Motion of the cloth's side of the contact, as solved.
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

/// Adds the contacts of one vertex to its right-hand side and inverts its diagonal block.
struct FinishRow {
  View<const Index> row_first;
  View<const Mat3r> value;
  CouplingView couplings;
  View<const Real> inverse_mass;
  View<const Vec3r> rhs;    ///< without contacts
  View<Vec3r> contact_rhs;  ///< with contacts
  View<Mat3r> inverse_diagonal;

  ICLOTH_HD void operator()(Index i) const {
    contact_rhs[i] = rhs[i];

    // A prescribed vertex has no equation.
    if (!(inverse_mass[i] > 0)) {
      inverse_diagonal[i] = Mat3r{};
      return;
    }

    // The contacts at the vertex add their impulses, and their blocks to its diagonal block.
    Mat3r block = value[row_first[i]];  // the diagonal comes first
    couplings.of_vertex(i, [&](Index k, Real w) {
      const Coupling& c = couplings.list[k];
      contact_rhs[i] += w * c.impulse;
      block += c.h.scaled(w * w);
    });
    inverse_diagonal[i] = inverse_spd(block);
  }
};

}  // namespace

void ContactPasses::solve(SubstepContext& step, const ContactSystem& system, View<Vec3r> dv,
                          bool solved) {
  const Array<Contact>& contacts = system.contacts;
  terms_.resize(contacts.size());
  const ContactLaw law{static_cast<Real>(step.parameters.proximity.stiffness), system.h};
  VertexMotion motion{.free = system.free_motion,
                      .dv = dv,
                      .inverse_mass = step.state.inverse_mass.view(),
                      .dt = system.h,
                      .solved = solved};

  const ImplicitParameters& p = step.parameters.implicit;
  for (int pass = 0; pass < p.contact_passes; ++pass) {
    // Each contact acts as the last solve left it: open or closed, sticking or sliding.
    for_each("implicit.contact_terms", contacts.size(),
             ContactTerms{motion, law, contacts.view(), terms_.view()});
    couplings_.gather(contacts.view(), terms_.view(), step.mesh.cloth_vertices, system.seams);
    solve_once(step, system, dv, pass > 0);
    motion.solved = true;

    // The passes end when what the contacts did is what they should have done.
    const ContactResidual residual =
        reduce("implicit.contact_residual", contacts.size(), ContactResidual{0, 0, 0},
               ContactResidualOf{motion, law, contacts.view(), terms_.view()}, Sum{});
    work_ = residual.work;
    if (!(residual.error > p.contact_tolerance * residual.load)) return;
  }
  // A tolerance of 0 asks for all passes.
  if (p.contact_tolerance > 0) step.report.reach(Limit::contact_passes);
}

void ContactPasses::solve_once(SubstepContext& step, const ContactSystem& system, View<Vec3r> dv,
                               bool same_matrix) {
  const State& s = step.state;
  const ImplicitParameters& p = step.parameters.implicit;
  const Index vertices = step.mesh.cloth_vertices;
  inverse_diagonal_.resize(vertices);
  rhs_.resize(vertices);
  const SystemView view{system.matrix.view(), s.inverse_mass.view(), couplings_.view()};
  for_each("implicit.finish_rows", vertices,
           FinishRow{.row_first = system.matrix.row_first.view(),
                     .value = system.matrix.value.view(),
                     .couplings = view.couplings,
                     .inverse_mass = s.inverse_mass.view(),
                     .rhs = system.rhs,
                     .contact_rhs = rhs_.view(),
                     .inverse_diagonal = inverse_diagonal_.view()});
  const LinearSolution solution = solver_.solve(view, inverse_diagonal_.view(), rhs_.view(), dv,
                                                {.preconditioner = p.preconditioner,
                                                 .tolerance = p.cg_tolerance,
                                                 .max_iterations = p.cg_max_iterations,
                                                 .same_matrix = same_matrix});

  // Iterations add up over all solves of the step; the residual is that of the worst.
  ++step.report.linear_solves;
  step.report.cg_iterations += solution.iterations;
  step.report.cg_bytes += solution.bytes;
  if (solution.iterations >= p.cg_max_iterations && solution.residual > p.cg_tolerance)
    step.report.reach(Limit::cg_iterations);
  step.report.cg_residual = std::max(step.report.cg_residual, solution.residual);
  residual_force_ = (1 / static_cast<double>(system.h)) * solution.residual_sum;
}

}  // namespace icloth::ICLOTH_BUILD
