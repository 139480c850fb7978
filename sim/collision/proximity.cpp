#include "sim/collision/proximity.h"

#include "kernels/distance.h"
#include "kernels/parallel/parallel.h"
#include "kernels/parallel/partition_point.h"
#include "sim/collision/rest_gap.h"
#include "sim/collision/seam_exclusion.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Tension that contacts hold over a sharp edge however fine the mesh is: the weight of half a
/// metre of cloth of 200 g/m² that hangs down from it [N/m].
constexpr double kLineLoad = 1;

/// Areas of the elements of cloths [m²].
struct ElementAreas {
  View<const Real> vertex, face, edge;

  ICLOTH_HD Real of_vertex_face(Pair pair) const {
    return pair.a < vertex.size() ? vertex[pair.a] : face[pair.b];
  }
  /// The smaller number is that of a cloth edge.
  ICLOTH_HD Real of_edges(Pair pair) const {
    return pair.b < edge.size() ? std::fmin(edge[pair.a], edge[pair.b]) : edge[pair.a];
  }
};

/// The data and the part of the search that vertex–face and edge–edge pairs share.
struct ContactMaker {
  View<const Vec3r> x, v;
  RestGap rest_gap;
  View<const Real> inverse_mass;
  View<const Index> object;
  ElementAreas areas;
  Index cloth_vertices;
  Real thickness, slack, reach, dt;
  Vec3r fall_speed;  ///< gravity · dt [m/s]
  Real friction_cloth, friction_obstacle;
  View<const Real> own_friction;  ///< −1: none (objects), empty: none has one
  Real line_area;                 ///< kLineLoad / (k h) [m], see carrying_area
  LetGoView let_go;
  SeamView seams;

  /// Corners 0 and 2 are of the two elements, VF or EE; an obstacle's, if any, may be either.
  ICLOTH_HD Real coefficient(const Stencil& s, bool on_obstacle) const {
    const Real usual = on_obstacle ? friction_obstacle : friction_cloth;
    if (own_friction.size() == 0) return usual;
    const Real first = own_friction[object[s.v[0]]], second = own_friction[object[s.v[2]]];
    if (on_obstacle) {
      const Real own = s.v[0] >= cloth_vertices ? first : second;
      return own >= 0 ? own : usual;
    }
    if (first >= 0 && second >= 0) return std::sqrt(first * second);
    return first >= 0 ? first : (second >= 0 ? second : usual);
  }

  /// Cloth under tension that is bent over a sharp edge lies on it with one row of features, each
  /// about √a wide: it carries up to k a h / √a for each metre of the edge. Where that is less than
  /// kLineLoad, as with fine meshes, the pair counts as if its features were larger: tension would
  /// pull the cloth through the thickness and leave the edge to the impact zones.
  ICLOTH_HD Real carrying_area(Real area) const {
    return std::fmax(area, line_area * std::sqrt(area));
  }

  ICLOTH_HD bool boxes_apart(const Index* p, int np, const Index* q, int nq) const {
    for (int axis = 0; axis < 3; ++axis) {
      Real low_p = coordinate(p[0], axis), high_p = low_p;
      Real low_q = coordinate(q[0], axis), high_q = low_q;
      for (int k = 1; k < np; ++k) {
        const Real c = coordinate(p[k], axis);
        low_p = std::fmin(low_p, c);
        high_p = std::fmax(high_p, c);
      }
      for (int k = 1; k < nq; ++k) {
        const Real c = coordinate(q[k], axis);
        low_q = std::fmin(low_q, c);
        high_q = std::fmax(high_q, c);
      }

      // The boxes are apart when they are apart along one axis.
      if (low_p > high_q + reach || low_q > high_p + reach) return true;
    }
    return false;
  }

  ICLOTH_HD Real coordinate(Index i, int axis) const {
    const Vec3r& p = x[i];
    return axis == 0 ? p.x : (axis == 1 ? p.y : p.z);
  }

  /// Writes gap and normal; false when the pair is too far apart to repel. `across` is
  /// perpendicular to both elements, or zero where no such direction is known. It gives the normal,
  /// since the gap vector of a small gap has lost its digits.
  ICLOTH_HD bool measure_gap(Contact& c, Vec3r across) const {
    const Vec3r g = apply(c.s, x);
    c.gap = norm(g);
    if (!(c.gap < reach) || c.gap <= 0) return false;
    c.normal = (Real(1) / c.gap) * g;

    // The gap vector of a small gap only decides the side on which the perpendicular points.
    const Real length = norm(across), along = dot(across, c.normal);
    if (std::fabs(along) > Real(0.9) * length) {
      c.normal = (along > 0 ? 1 / length : -1 / length) * across;
      c.gap = dot(c.normal, g);
    }
    return true;
  }

  /// Whether the pair is expected to be near at the end of the step. Pairs a little further apart
  /// than the thickness count too, since elastic forces may bring them together.
  ICLOTH_HD bool comes_near(const Contact& c) const {
    Vec3r relative{};
    Real mobility = 0;

    // The expected motion includes the fall of free vertices. Pairs that cannot move are left out.
    for (int a = 0; a < 4; ++a) {
      const Index i = c.s.v[a];
      relative += c.s.w[a] * v[i];
      if (inverse_mass[i] > 0) relative += c.s.w[a] * fall_speed;
      mobility += c.s.w[a] * c.s.w[a] * inverse_mass[i];
    }
    return mobility > 0 && c.gap + dt * dot(c.normal, relative) < thickness + slack;
  }

  ICLOTH_HD bool touches_obstacle(const Stencil& s) const {
    bool touches = false;
    for (const Index i : s.v) touches = touches || i >= cloth_vertices;
    return touches;
  }

  /// Whether the elements are of one cloth and near each other at rest: such elements are
  /// neighbours in the fabric, not layers.
  ICLOTH_HD bool are_neighbours(const Stencil& s) const {
    bool same_cloth = true;
    for (const Index i : s.v)
      same_cloth = same_cloth && i < cloth_vertices && object[i] == object[s.v[0]];
    return same_cloth && rest_gap.norm2_of(s) < 4 * thickness * thickness;
  }

  /// Fills the contact of a stencil; false when the pair does not repel in this step. `across` is
  /// that of measure_gap.
  ICLOTH_HD bool make(Contact& c, Vec3r across) const {
    if (let_go.ignores(c.s.v) || !measure_gap(c, across)) return false;
    if (seams.holds(key_is_edge_edge(c.key), c.s.v)) return false;
    if (!comes_near(c) || are_neighbours(c.s)) return false;
    c.thickness = thickness;
    c.held = Vec3r{};
    c.stuck = 0;
    c.friction = coefficient(c.s, touches_obstacle(c.s));
    return true;
  }
};

ContactMaker contact_maker(const SubstepContext& step, const LetGoView& let_go) {
  const Topology& mesh = step.mesh;
  const State& s = step.state;
  const Real h = step.thickness();
  const ProximityParameters& p = step.parameters.proximity;

  // Pairs count up to a part of an edge beyond the thickness, since forces may bring them nearer.
  return {.x = s.x0.view(),
          .v = s.v.view(),
          .rest_gap = {.rest = mesh.rest.view(),
                       .panel = mesh.rest_panel.view(),
                       .seam_first = mesh.seam_first.view(),
                       .seam = mesh.seam.view()},
          .inverse_mass = s.inverse_mass.view(),
          .object = mesh.object.view(),
          .areas = {mesh.vertex_area.view(), mesh.face_area.view(), mesh.edge_area.view()},
          .cloth_vertices = mesh.cloth_vertices,
          .thickness = h,
          .slack = static_cast<Real>(0.25) * mesh.median_edge,
          .reach = h + static_cast<Real>(0.5) * mesh.median_edge,
          .dt = step.dt,
          .fall_speed = step.dt * step.gravity(),
          .friction_cloth = static_cast<Real>(p.friction_cloth),
          .friction_obstacle = static_cast<Real>(p.friction_obstacle),
          .own_friction = mesh.object_friction.view(),
          .line_area = static_cast<Real>(kLineLoad / (p.stiffness * p.thickness)),
          .let_go = let_go,
          .seams = seam_view(mesh)};
}

struct FindVertexFace {
  ContactMaker maker;
  View<const Pair> candidates;
  View<const Int3> face;

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Pair pair = candidates[i];
    const Int3 f = face[pair.b];
    if (maker.boxes_apart(&pair.a, 1, f.v, 3)) return;
    const auto closest = closest_point_triangle(maker.x[pair.a], maker.x[f.v[0]], maker.x[f.v[1]],
                                                maker.x[f.v[2]], ClosestPoints::interior_only);
    if (!closest.interior) return;

    // The weights give the gap vector from the face to the vertex.
    Contact c;
    c.key = pair_key(false, pair);
    c.s = {{pair.a, f.v[0], f.v[1], f.v[2]},
           {Real(1), -closest.w[0], -closest.w[1], -closest.w[2]}};
    c.area = maker.carrying_area(maker.areas.of_vertex_face(pair));
    const Vec3r corner = maker.x[f.v[0]];
    if (maker.make(c, cross(maker.x[f.v[1]] - corner, maker.x[f.v[2]] - corner))) emit(c);
  }
};

struct FindEdgeEdge {
  ContactMaker maker;
  View<const Pair> candidates;
  View<const Int2> edge;

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Pair pair = candidates[i];
    const Int2 p = edge[pair.a], q = edge[pair.b];
    if (maker.boxes_apart(p.v, 2, q.v, 2)) return;
    const auto closest = closest_points_segments(maker.x[p.v[0]], maker.x[p.v[1]], maker.x[q.v[0]],
                                                 maker.x[q.v[1]], ClosestPoints::interior_only);
    if (!closest.interior) return;

    // The weights give the gap vector from the first edge to the second one.
    Contact c;
    c.key = pair_key(true, pair);
    c.s = {{p.v[0], p.v[1], q.v[0], q.v[1]},
           {-(1 - closest.s), -closest.s, 1 - closest.t, closest.t}};
    c.area = maker.carrying_area(maker.areas.of_edges(pair));
    const Vec3r along_p = maker.x[p.v[1]] - maker.x[p.v[0]];
    const Vec3r along_q = maker.x[q.v[1]] - maker.x[q.v[0]];
    const Vec3r across = cross(along_p, along_q);

    // Nearly parallel edges leave the common perpendicular undetermined.
    const bool parallel = norm2(across) < Real(1e-2) * norm2(along_p) * norm2(along_q);
    if (maker.make(c, parallel ? Vec3r{} : across)) emit(c);
  }
};

/// Stiffness of a contact that an impact made, over that of one found at the start. Taut cloth on a
/// limb presses with more than those carry, and the candidate lies within the limb. A late contact
/// is as stiff as the fabric, so that little is left to the impact zones.
constexpr Real kLateStiffness = 100;

/// The contact of a pair that collides. Its gap is that of the planes at the time of impact, which
/// the elements keep from then on.
struct ContactOfImpact {
  ContactMaker maker;
  View<const Impact> impacts;
  View<Contact> contacts;

  ICLOTH_HD void operator()(Index i) const {
    const Impact& hit = impacts[i];
    const bool edge_edge = key_is_edge_edge(hit.key);
    const Pair pair = key_pair(hit.key);
    Contact c{};
    c.key = hit.key;
    c.s = hit.s;
    c.normal = hit.normal;
    c.gap = dot(hit.normal, apply(hit.s, maker.x));
    c.area = kLateStiffness * maker.carrying_area(edge_edge ? maker.areas.of_edges(pair)
                                                            : maker.areas.of_vertex_face(pair));
    c.friction = maker.coefficient(hit.s, maker.touches_obstacle(hit.s));

    // A pair that starts closer than h comes no closer, but is not driven apart either: the normal
    // at the time of impact may lead along the layers.
    c.thickness = std::fmin(maker.thickness, std::fmax(c.gap, hit.offset));
    contacts[i] = c;
  }
};

struct ContactSlots {
  View<const Contact> contacts;
  View<Int4> slots;
  ICLOTH_HD void operator()(Index i) const {
    for (int a = 0; a < 4; ++a) slots[i].v[a] = contacts[i].s.v[a];
  }
};

struct GapOf {
  View<const Contact> contacts;
  ICLOTH_HD Real operator()(Index i) const { return contacts[i].gap; }
};

/// Smallest gap among the contacts of a vertex, at most h.
struct StartGap {
  View<const Contact> contacts;
  View<const Index> first, entries;
  View<Real> gap;
  Real thickness;

  /// 1 where it is below h.
  ICLOTH_HD Index operator()(Index v) const {
    Real least = thickness;
    for (Index k = first[v]; k < first[v + 1]; ++k)
      least = std::fmin(least, contacts[entries[k] / 4].gap);
    gap[v] = least;
    return least < thickness ? 1 : 0;
  }
};

/// The thickness of a pair grows from the gap that its vertices started with.
struct RampThickness {
  View<const Real> start_gap;
  View<Contact> contacts;
  Real share;  ///< 0 at the start, 1 where the whole thickness is reached

  ICLOTH_HD void operator()(Index i) const {
    Contact& c = contacts[i];
    for (const Index v : c.s.v) {
      if (v >= start_gap.size()) continue;
      const Real ramped = start_gap[v] + share * (c.thickness - start_gap[v]);
      if (ramped < c.thickness) c.thickness = ramped;
    }
  }
};

/// The force that a pair held at the end of the last substep.
struct RecallFriction {
  View<const HeldForce> held;
  View<Contact> contacts;

  ICLOTH_HD void operator()(Index i) const {
    Contact& c = contacts[i];
    const Index k = partition_point(held.size(), [&](Index h) { return held[h].key < c.key; });
    if (k == held.size() || held[k].key != c.key) return;
    c.held = tangential(c, held[k].force);
    c.stuck = held[k].stuck;
  }
};

struct KeepFriction {
  View<const Contact> contacts;
  View<const Vec3r> x0, x1;
  ContactLaw law;

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Contact& c = contacts[i];
    Vec3r motion{};
    for (int a = 0; a < 4; ++a) motion += c.s.w[a] * (x1[c.s.v[a]] - x0[c.s.v[a]]);
    const Real normal = normal_force(c, law, motion);
    if (!(c.friction > 0 && normal > 0)) return;
    const Friction friction = friction_of(c, law, motion, normal);
    emit(HeldForce{c.key, friction.force, friction.sliding ? 0 : 1});
  }
};

struct CopyContacts {
  View<const Contact> from;
  View<Contact> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[i]; }
};

constexpr double kRampTime = 0.2;  // [s]

}  // namespace

/// Layers that start closer than h would be thrown apart by a repulsion that acts at once.
void Proximity::note_start_gaps(SubstepContext& step) {
  Array<Int4> slots(contacts_.size());
  for_each("proximity.slots", contacts_.size(), ContactSlots{contacts_.view(), slots.view()});
  Incidence incidence;
  incidence.build(slots.view(), step.mesh.cloth_vertices);

  // A vertex that starts closer than the thickness keeps its gap; often there is none.
  Array<Real>& start_gap = step.state.start_gap;
  start_gap.resize(step.mesh.cloth_vertices);
  const Index close = reduce("proximity.start_gaps", step.mesh.cloth_vertices, Index{0},
                             StartGap{contacts_.view(), incidence.first(), incidence.entries(),
                                      start_gap.view(), step.thickness()},
                             Sum{});
  if (close == 0) start_gap.resize(0);
}

void Proximity::ramp_thickness(const SubstepContext& step) {
  const double share = std::fmin(step.time / kRampTime, 1.0);
  for_each("proximity.ramp", contacts_.size(),
           RampThickness{step.state.start_gap.view(), contacts_.view(), static_cast<Real>(share)});
}

void Proximity::keep_friction(State& state, const Parameters& parameters, Real dt) {
  state.held.resize(0);
  if (!rubs_) return;
  const ContactLaw law{static_cast<Real>(parameters.proximity.stiffness), dt};
  collect("proximity.keep_friction", found_at_start_,
          KeepFriction{contacts_.view(), state.x0.view(), state.x1.view(), law}, state.held);
}

void Proximity::recall_friction(const State& state) {
  if (!state.held.empty())
    for_each("proximity.recall_friction", contacts_.size(),
             RecallFriction{state.held.view(), contacts_.view()});
}

void Proximity::clear() {
  contacts_.resize(0);
  found_at_start_ = 0;
  rubs_ = false;
}

void Proximity::add(const Array<Contact>& more) {
  const Index old = contacts_.size();
  contacts_.resize_keep(old + more.size());
  for_each("proximity.add", more.size(),
           CopyContacts{more.view(), contacts_.view().sub(old, more.size())});
}

void Proximity::add(const SubstepContext& step, const Array<Impact>& impacts) {
  const Index old = contacts_.size();
  contacts_.resize_keep(old + impacts.size());
  for_each("proximity.add", impacts.size(),
           ContactOfImpact{contact_maker(step, {}), impacts.view(),
                           contacts_.view().sub(old, impacts.size())});
}

void Proximity::find(SubstepContext& step, const BroadPhase& broad_phase, const LetGoView& let_go) {
  const Topology& mesh = step.mesh;
  State& s = step.state;
  const ContactMaker maker = contact_maker(step, let_go);

  // Pairs of a vertex and a face come before pairs of edges, each kind in the order of the keys.
  rubs_ = maker.friction_cloth > 0 || maker.friction_obstacle > 0 || !mesh.object_friction.empty();
  contacts_.resize(0);
  const Array<Pair>& vf = broad_phase.vertex_faces();
  collect("proximity.vertex_face", vf.size(), FindVertexFace{maker, vf.view(), mesh.face.view()},
          found_);
  append_sorted_("proximity.sort", found_, contacts_);
  const Array<Pair>& ee = broad_phase.edge_edges();
  collect("proximity.edge_edge", ee.size(), FindEdgeEdge{maker, ee.view(), mesh.edge.view()},
          found_);
  append_sorted_("proximity.sort", found_, contacts_);

  // Friction goes on where the last step left it, and layers that start very close are pushed apart
  // little by little.
  found_at_start_ = contacts_.size();
  recall_friction(s);
  if (step.time == 0) note_start_gaps(step);
  if (step.time >= kRampTime) s.start_gap.resize(0);
  if (!s.start_gap.empty()) ramp_thickness(step);

  step.report.proximity_pairs = contacts_.size();
  step.report.min_gap = static_cast<double>(reduce(
      "proximity.min_gap", contacts_.size(), step.thickness(), GapOf{contacts_.view()}, Min{}));
}

}  // namespace icloth::ICLOTH_BUILD
