#include "sim/mechanics/contact_pass.h"

#include <algorithm>
#include <cmath>

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct Travel {
  VertexMotion motion;
  View<const Contact> contacts;
  View<const Vec3r> dv;
  View<ContactTravel> travel;
  ICLOTH_HD void operator()(Index i) const { travel[i] = motion.travel(contacts[i], dv); }
};

struct NoTerm {
  View<ContactTerm> term;
  ICLOTH_HD void operator()(Index i) const { term[i] = ContactTerm{}; }
};

/// How far the contact forces of a solve are from those of the contact law at its solution.
struct ContactError {
  double error;  ///< contact forces that acted and should not have, or the other way round [N]
  double load;   ///< what the contacts carry [N]
  ICLOTH_HD friend ContactError operator+(ContactError a, ContactError b) {
    return {a.error + b.error, a.load + b.load};
  }
};

/// Compares the term of a contact in the last solve with the law at its solution, and renews it.
struct RenewTerm {
  ContactLaw law;
  View<const Contact> contacts;
  View<const ContactTravel> travel;
  bool solved;
  View<ContactTerm> term;

  ICLOTH_HD ContactError operator()(Index i) const {
    const Contact& c = contacts[i];
    const ContactMotion m = travel[i].motion(solved);
    const bool open = !(end_gap(c, m.end) < c.thickness);
    if (open && solved && term[i].active == 0) return {0, 0};
    const ContactError error = solved ? error_of(c, m, term[i]) : ContactError{0, 0};
    term[i] = contact_term(c, law, m, travel[i].mobility, term[i]);
    return error;
  }

  /// What is wrong is what the linear term applied in place of the law's force: it pulled, was left
  /// out and has closed, slid and was to stick, or the other way round.
  ICLOTH_HD ContactError error_of(const Contact& c, const ContactMotion& m,
                                  const ContactTerm& last) const {
    const Real normal = normal_force(c, law, m.end);
    Vec3r wrong = applied_force(last, law, m) - normal * c.normal;
    if (c.friction > 0) wrong = wrong - friction_of(c, law, m.end, normal).force;
    return {static_cast<double>(norm(wrong)), static_cast<double>(normal)};
  }
};

/// Work of the term of a contact on the cloth [J].
struct TermWork {
  ContactLaw law;
  VertexMotion motion;
  View<const Contact> contacts;
  View<const ContactTravel> travel;
  View<const Vec3r> dv;
  View<const ContactTerm> term;

  ICLOTH_HD double operator()(Index i) const {
    if (term[i].active == 0) return 0;
    return dot_double(applied_force(term[i], law, travel[i].motion(true)),
                      motion.of_cloth(contacts[i], dv));
  }
};

/// The force of each coupling at the present Δv, where a pass starts from [N·s].
struct CouplingForce {
  View<const Coupling> list;
  View<const Vec3r> dv;
  View<Vec3r> force;

  ICLOTH_HD void operator()(Index k) const {
    const Coupling& c = list[k];
    force[k] = c.impulse - c.h * c.of_cloth(dv, dv.size());
  }
};

/// Sums over the rows of the system of a pass, A Δv = b with contacts.
struct RowSums {
  double bb, gg;  ///< b·b and g·g with g = b − A Δv
  Vec3d g;
  ICLOTH_HD friend RowSums operator+(const RowSums& a, const RowSums& b) {
    return {a.bb + b.bb, a.gg + b.gg, a.g + b.g};
  }
};

/// Adds the contacts of one vertex to its row and inverts its diagonal block.
struct FinishRow {
  View<const Index> row_first;
  View<const Mat3r> value;
  CouplingView couplings;
  View<const Vec3r> force;  ///< see CouplingForce
  View<const Real> inverse_mass;
  View<const Vec3r> rhs, residual;  ///< b and b − A Δv without contacts
  View<Vec3r> g, d;  ///< b − A Δv with contacts; where its correction starts, zero
  View<Mat3r> inverse_diagonal;
  bool later;  ///< not the first pass of this matrix: contacts have kept their places since

  ICLOTH_HD RowSums operator()(Index i) const {
    d[i] = Vec3r{};

    // A prescribed vertex has no equation.
    if (!(inverse_mass[i] > 0)) {
      g[i] = Vec3r{};
      inverse_diagonal[i] = Mat3r{};
      return {};
    }

    // A row without contacts stays as the first pass left it.
    if (later && !couplings.hold(i)) {
      g[i] = residual[i];
      return {dot_double(rhs[i], rhs[i]), dot_double(g[i], g[i]), convert<double>(g[i])};
    }

    // The contacts at the vertex add their impulses, and their blocks to its diagonal block.
    Mat3r block = value[row_first[i]];  // the diagonal comes first
    Vec3r b = rhs[i], left = residual[i];
    couplings.of_vertex(i, [&](Index k, Real w) {
      const Coupling& c = couplings.list[k];
      b += w * c.impulse;
      left += w * force[k];
      block += c.h.scaled(w * w);
    });
    g[i] = left;
    inverse_diagonal[i] = inverse_spd(block);
    return {dot_double(b, b), dot_double(left, left), convert<double>(left)};
  }
};

/// b − A Δv without contacts.
struct ResidualWithoutContacts {
  MatrixView matrix;
  View<const Real> inverse_mass;
  View<const Vec3r> rhs, dv;
  bool starts_at_zero;
  View<Vec3r> residual;

  ICLOTH_HD void operator()(Index i) const {
    residual[i] = inverse_mass[i] > 0 ? rhs[i] : Vec3r{};
    if (!starts_at_zero && inverse_mass[i] > 0)
      residual[i] -= multiply_row(matrix, i, &dv.data()->x);
  }
};

/// The share of the imbalance that a solve may leave while it is not known which contacts act.
constexpr double kLooseSolve = 0.1;

}  // namespace

void ContactPasses::solve(SubstepContext& step, const ContactSystem& system,
                          const ContactGoal& goal, View<Vec3r> dv, bool solved) {
  const ContactLaw law{static_cast<Real>(step.parameters.proximity.stiffness), system.h};
  const VertexMotion motion{
      .free = system.free_motion, .inverse_mass = step.state.inverse_mass.view(), .dt = system.h};
  start(step, system, motion, dv, solved);

  // A system that the solver did not see leaves changes behind, in rows that are not known here.
  const bool seen = change_ == MatrixChange::none;
  if (seen || system.change == MatrixChange::all)
    change_ = system.change;
  else if (system.change == MatrixChange::some_rows)
    change_ = MatrixChange::all;

  // A system without contacts is linear, and solved at once.
  const ImplicitParameters& p = step.parameters.implicit;
  const View<const Contact> contacts = system.contacts.view();
  const ContactLine line{contacts, travels_.view(), motion, law};
  for (int pass = 0;; ++pass) {
    // Each contact acts as the last solve left it: open or closed, sticking or sliding.
    const bool compared = solved || pass > 0;
    const ContactError found =
        reduce("implicit.contact_terms", contacts.size(), ContactError{0, 0},
               RenewTerm{law, contacts, travels_.view(), compared, terms_.view()}, Sum{});

    // The passes end when what the contacts did is what they should have done.
    const bool wrong = found.error > goal.contact_tolerance * found.load;
    if (pass > 0 && !wrong && result_.exact) break;
    if (pass >= p.contact_passes) {
      // A tolerance of 0 asks for all passes.
      if (goal.contact_tolerance > 0) step.report.reach(Limit::contact_passes);
      break;
    }

    // As long as it is not known which contacts act, it is no use to solve to many digits.
    double loose = 0;
    if (!compared && contacts.size() > 0) loose = kLooseSolve;
    if (wrong) loose = std::min(found.error / found.load, kLooseSolve);
    couplings_.gather(contacts, terms_.view(), step.mesh.cloth_vertices, system.seams);
    result_ = correct(step, system, line, dv, goal.cg_tolerance, loose, pass > 0);
  }
  if (step.sums_up_work)
    work_ = reduce("implicit.contact_work", contacts.size(), 0.0,
                   TermWork{law, motion, contacts, travels_.view(), dv, terms_.view()}, Sum{});
}

/// Prepares for the passes: what is left of the system without contacts at the Δv they start from.
void ContactPasses::start(SubstepContext& step, const ContactSystem& system,
                          const VertexMotion& motion, View<const Vec3r> dv, bool solved) {
  const Index vertices = step.mesh.cloth_vertices, contacts = system.contacts.size();
  couplings_.clear();
  travels_.resize(contacts);

  // Contacts that were added since the last solve did not act in it.
  const Index known = solved ? terms_.size() : contacts;
  terms_.resize_keep(contacts);
  for_each("implicit.contact_terms", contacts - known,
           NoTerm{terms_.view().sub(known, contacts - known)});
  for_each("implicit.contact_travel", contacts,
           Travel{motion, system.contacts.view(), dv, travels_.view()});
  inverse_diagonal_.resize(vertices);
  residual_.resize(vertices);
  g_.resize(vertices);
  d_.resize(vertices + kPadding);
  d_.fill(Vec3r{});  // the padding is read
  for_each("implicit.residual", vertices,
           ResidualWithoutContacts{.matrix = system.matrix.view(),
                                   .inverse_mass = step.state.inverse_mass.view(),
                                   .rhs = system.rhs,
                                   .dv = dv,
                                   .starts_at_zero = !solved,
                                   .residual = residual_.view()});
}

/// Solves for a correction of Δv with the couplings as they are, and goes along it.
ContactPasses::PassResult ContactPasses::correct(SubstepContext& step, const ContactSystem& system,
                                                 const ContactLine& line, View<Vec3r> dv,
                                                 double cg_tolerance, double loose, bool later) {
  const State& s = step.state;
  const ImplicitParameters& p = step.parameters.implicit;
  const Index vertices = step.mesh.cloth_vertices;
  const SystemView view{system.matrix.view(), s.inverse_mass.view(), couplings_.view()};

  // The right-hand side is the imbalance at the present Δv.
  force_.resize(view.couplings.size());
  for_each("implicit.coupling_forces", view.couplings.size(),
           CouplingForce{view.couplings.list, dv.sub(0, vertices), force_.view()});
  const RowSums sums = reduce("implicit.finish_rows", vertices, RowSums{0, 0, {}},
                              FinishRow{.row_first = system.matrix.row_first.view(),
                                        .value = system.matrix.value.view(),
                                        .couplings = view.couplings,
                                        .force = force_.view(),
                                        .inverse_mass = s.inverse_mass.view(),
                                        .rhs = system.rhs,
                                        .residual = residual_.view(),
                                        .g = g_.view(),
                                        .d = d_.view(),
                                        .inverse_diagonal = inverse_diagonal_.view(),
                                        .later = later},
                              Sum{});
  if (sums.gg == 0) {
    residual_force_ = {};
    return {.exact = true, .residual = 0};
  }

  // The tolerance is that of the whole system, except while the contacts are still wrong.
  const double whole = cg_tolerance * std::sqrt(sums.bb / sums.gg);
  const double tolerance = std::max(whole, loose);
  const LinearSolution solution =
      solver_.solve(view, inverse_diagonal_.view(), g_.view(), d_.view(),
                    {.preconditioner = p.preconditioner,
                     .tolerance = tolerance,
                     .max_iterations = p.cg_max_iterations,
                     .change = change_,
                     .changed_rows = system.changed_rows});
  change_ = MatrixChange::none;
  const double share = line_search_.go(
      view, line, system.seams,
      {.d = d_.view(), .product = solver_.product(), .coupling = solver_.coupling_products()}, dv,
      residual_.view());

  // Iterations add up over all solves of the step.
  ++step.report.linear_solves;
  step.report.cg_iterations += solution.iterations;
  step.report.cg_bytes += solution.bytes;
  if (solution.iterations >= p.cg_max_iterations && solution.residual > tolerance)
    step.report.reach(Limit::cg_iterations);

  // What is left is a mixture of the imbalance before and of that at the end of the direction.
  residual_force_ =
      (1 / static_cast<double>(system.h)) * (share * solution.residual_sum + (1 - share) * sums.g);
  return {.exact = share == 1 && !(tolerance > whole),
          .residual = (share * solution.residual + 1 - share) * std::sqrt(sums.gg / sums.bb)};
}

}  // namespace icloth::ICLOTH_BUILD
