#include "sim/collision/pinch.h"

#include <algorithm>
#include <set>

#include "kernels/index.h"

namespace icloth::ICLOTH_BUILD {
namespace {

std::vector<Vec3d> doubles(const Array<Vec3r>& array) {
  std::vector<Vec3d> out;
  out.reserve(at(array.size()));
  for (const Vec3r& p : array.download()) out.push_back(convert<double>(p));
  return out;
}

/// Whether any of the cloth corners is let go from the body, so that their pair is left out.
template <class List>
bool any_held(const List& list, const std::vector<Index>& cloth, Index body) {
  return std::ranges::any_of(cloth, [&](Index v) { return list.contains({v, body}); });
}

std::map<std::pair<Index, Index>, Index> read(const State& state) {
  std::map<std::pair<Index, Index>, Index> list;
  for (const LetGo& entry : state.let_go.download()) list[{entry.vertex, entry.body}] = entry.side;
  return list;
}

void write(State& state, const std::map<std::pair<Index, Index>, Index>& list) {
  std::vector<LetGo> entries;
  entries.reserve(list.size());
  for (const auto& [pair, side] : list) entries.push_back({pair.first, pair.second, side});
  state.let_go.upload(entries);
}

/// A contact without friction that pushes a cloth point out of a body: with the whole force of the
/// thickness h near the surface, with half of it from h/2 on and inside.
Contact push_out(std::uint64_t key, const Stencil& stencil, Vec3d normal, double distance,
                 double area, Real h) {
  Contact c{};
  c.key = key;
  c.s = stencil;
  c.normal = convert<Real>(normal);
  c.gap = std::fmax(static_cast<Real>(distance), Real(0.5) * h);
  c.area = static_cast<Real>(area);
  c.thickness = h;
  return c;
}

}  // namespace

const BodySurface& Pinch::surface(Index object) {
  std::unique_ptr<BodySurface>& slot = surfaces_[object];
  if (!slot) slot = std::make_unique<BodySurface>(*world_, object);
  return *slot;
}

const std::vector<Index>& Pinch::faces_of(Index vertex) {
  if (faces_of_.empty()) {
    faces_of_.resize(at(world_->cloth_vertices));
    for (Index f = 0; f < world_->cloth_faces; ++f)
      for (const Index v : world_->face[at(f)]) faces_of_[at(v)].push_back(f);
  }
  return faces_of_[at(vertex)];
}

std::array<Vec3d, 3> Pinch::corners(const std::vector<Vec3d>& x, Index face) const {
  const Triangle& t = world_->face[at(face)];
  return {x[at(t[0])], x[at(t[1])], x[at(t[2])]};
}

std::int64_t Pinch::vertices(const State& state) {
  if (state.let_go.empty()) return 0;
  std::set<Index> distinct;
  for (const LetGo& entry : state.let_go.download()) distinct.insert(entry.vertex);
  return static_cast<std::int64_t>(distinct.size());
}

std::optional<Pinch::Squeeze> Pinch::squeeze_of(const Impact& impact,
                                                const std::vector<Vec3d>& x) const {
  Squeeze squeeze;
  squeeze.body = -1;
  double weight = 0;
  for (int a = 0; a < 4; ++a) {
    const Index v = impact.s.v[a];
    if (v >= world_->cloth_vertices) {
      squeeze.body = world_->object[at(v)];
      continue;
    }
    squeeze.cloth.push_back(v);
    weight += static_cast<double>(impact.s.w[a]);
    squeeze.place += static_cast<double>(impact.s.w[a]) * x[at(v)];
  }
  if (squeeze.body < 0 || squeeze.cloth.empty()) return std::nullopt;

  // The weights of one element add up to ±1; the gap vector points to the element with +1.
  squeeze.place = (1 / weight) * squeeze.place;
  squeeze.away = (weight > 0 ? 1.0 : -1.0) * convert<double>(impact.normal);
  return squeeze;
}

std::vector<Index> Pinch::bodies_ahead(const Squeeze& squeeze, const std::vector<Vec3d>& x,
                                       double reach, const List& held) {
  std::vector<Index> found;
  for (Index o = 0; o < static_cast<Index>(world_->objects.size()); ++o) {
    if (world_->objects[at(o)].cloth || any_held(held, squeeze.cloth, o)) continue;
    // A part of the hit body itself must face its other part, or it is what hits the cloth.
    const BodySurface& body = surface(o);
    if (o == squeeze.body && body.own_side() == 0) continue;
    const double most = o == squeeze.body ? -0.2 : 2;
    if (body.distance_ahead(x, squeeze.place, squeeze.away, most) < reach) found.push_back(o);
  }
  return found;
}

void Pinch::let_go(List& list, Index vertex, Index body, const std::vector<Vec3d>& x) {
  if (list.contains({vertex, body})) return;

  // An open surface has no inside of its own: outside is where the vertex comes from.
  const BodySurface& other = surface(body);
  Index side = other.own_side();
  if (side == 0) side = other.nearest(x, x[at(vertex)], 1).distance >= 0 ? 1 : -1;
  list[{vertex, body}] = side;
}

bool Pinch::widen(List& list, const Squeeze& squeeze, const std::vector<Vec3d>& x) {
  const std::size_t before = list.size();
  for (const Index v : squeeze.cloth) {
    // The bodies are collected first, since the list grows while neighbours are let go.
    std::vector<Index> bodies;
    for (auto it = list.lower_bound({v, 0}); it != list.end() && it->first.first == v; ++it)
      bodies.push_back(it->first.second);
    for (const Index body : bodies)
      for (const Index f : faces_of(v))
        for (const Index n : world_->face[at(f)]) let_go(list, n, body, x);
  }
  return list.size() > before;
}

bool Pinch::is_near_pinch(const List& list, const Squeeze& squeeze) {
  const auto is_let_go = [&](Index v) {
    const auto entry = list.lower_bound({v, 0});
    return entry != list.end() && entry->first.first == v;
  };

  // The corners of the squeeze, then two rings of faces around them.
  std::set<Index> near(squeeze.cloth.begin(), squeeze.cloth.end());
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<Index> inner(near.begin(), near.end());
    for (const Index v : inner)
      for (const Index f : faces_of(v))
        near.insert(world_->face[at(f)].begin(), world_->face[at(f)].end());
  }
  return std::ranges::any_of(near, is_let_go);
}

bool Pinch::release(SubstepContext& step, const Array<Impact>& impacts) {
  // Distances are those at the start of the substep, where nothing intersects.
  const std::vector<Vec3d> x = doubles(step.state.x0);
  const double reach =
      std::max(4 * static_cast<double>(step.thickness()), 0.5 * world_->median_edge);
  const List held = read(step.state);
  List list = held;
  std::vector<Squeeze> alone;

  // Cloth between two bodies is let go from the one that comes later in the scene.
  for (const Impact& impact : impacts.download()) {
    const std::optional<Squeeze> squeeze = squeeze_of(impact, x);
    if (!squeeze) continue;
    const std::vector<Index> ahead = bodies_ahead(*squeeze, x, reach, held);
    if (ahead.empty()) {
      alone.push_back(*squeeze);
      continue;
    }
    const Index body = std::max(squeeze->body, ahead.back());
    for (const Index v : squeeze->cloth) let_go(list, v, body, x);
  }

  // If no cloth is between two bodies any more, too few vertices around the impacts are let go.
  if (list.size() == held.size())
    for (const Squeeze& squeeze : alone) widen(list, squeeze, x);

  // At the rim of a pinch the cloth is held back by what is squeezed there, so the body that hits
  // it passes.
  if (list.size() == held.size())
    for (const Squeeze& squeeze : alone)
      if (is_near_pinch(held, squeeze))
        for (const Index v : squeeze.cloth) let_go(list, v, squeeze.body, x);

  if (list.size() == held.size()) return false;
  write(step.state, list);
  return true;
}

void Pinch::release_all(State& state, const Array<Impact>& impacts) {
  const std::vector<Vec3d> x = doubles(state.x0);
  List list = read(state);
  for (const Impact& impact : impacts.download())
    if (const auto squeeze = squeeze_of(impact, x))
      for (const Index v : squeeze->cloth) let_go(list, v, squeeze->body, x);
  write(state, list);
}

bool Pinch::is_outside(const LetGo& entry, const std::vector<Vec3d>& x, double least) {
  const BodySurface& body = surface(entry.body);
  if (body.nearest(x, x[at(entry.vertex)], entry.side).distance < least) return false;
  return std::ranges::none_of(faces_of(entry.vertex),
                              [&](Index f) { return body.touches(x, corners(x, f)); });
}

void Pinch::take_back(State& state, const Parameters& parameters) {
  if (state.let_go.empty()) return;
  const std::vector<Vec3d> x = doubles(state.x1);
  // More room than the cloth needs, or the next substep would let go again.
  const double least =
      std::max(2 * parameters.impact_zones.offset, 0.25 * parameters.proximity.thickness);
  std::vector<LetGo> kept;
  for (const LetGo& entry : state.let_go.download())
    if (!is_outside(entry, x, least)) kept.push_back(entry);
  if (kept.size() < at(state.let_go.size())) state.let_go.upload(kept);
}

const Array<Contact>& Pinch::push_outs(const SubstepContext& step) {
  // Without let-go vertices, which is the usual case, nothing is downloaded.
  push_outs_.resize(0);
  if (step.state.let_go.empty()) return push_outs_;
  const std::vector<Vec3d> x = doubles(step.state.x0);
  const Real h = step.thickness();
  std::vector<Contact> contacts;
  std::map<std::pair<Index, Index>, Index> faces;  // side by body and cloth face

  // Vertices are pushed along the normal of the nearest point of the body.
  for (const LetGo& entry : step.state.let_go.download()) {
    const auto [v, object, side] = entry;
    for (const Index f : faces_of(v)) faces[{object, f}] = side;
    if (world_->pinned[at(v)] != 0) continue;
    const SurfacePoint q = surface(object).nearest(x, x[at(v)], side);
    if (!(q.distance < static_cast<double>(h)) || norm2(q.normal) == 0) continue;
    const Triangle& t = world_->face[at(q.face)];
    const Stencil stencil{{v, t[0], t[1], t[2]},
                          {Real(1), static_cast<Real>(-q.w[0]), static_cast<Real>(-q.w[1]),
                           static_cast<Real>(-q.w[2])}};
    contacts.push_back(push_out(pair_key(false, {v, q.face}), stencil, q.normal, q.distance,
                                world_->area[at(v)], h));
  }

  // A face is pushed where an edge of the body goes through it.
  for (const auto& [key, side] : faces) {
    const auto [object, f] = key;
    const Triangle& t = world_->face[at(f)];
    if (std::ranges::all_of(t, [&](Index v) { return world_->pinned[at(v)] != 0; })) continue;
    for (const SurfaceCrossing& c : surface(object).crossings(x, corners(x, f), side)) {
      const Stencil stencil{{c.vertex, t[0], t[1], t[2]},
                            {Real(-1), static_cast<Real>(c.w[0]), static_cast<Real>(c.w[1]),
                             static_cast<Real>(c.w[2])}};
      contacts.push_back(push_out(pair_key(false, {c.vertex, f}), stencil, c.normal, 0,
                                  world_->face_area[at(f)] / 3, h));
    }
  }

  push_outs_.upload(contacts);
  return push_outs_;
}

}  // namespace icloth::ICLOTH_BUILD
