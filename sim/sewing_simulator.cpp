#include "sim/sewing_simulator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kernels/index.h"
#include "sim/collision/detect.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {
namespace {

constexpr Index kFirstDelay = 10, kLongestDelay = 640;  // steps after a weld that failed

// Keys of pairs, as in kernels/stencil.h.
constexpr std::uint64_t kEdgeBit = std::uint64_t{1} << 63, kHalf = (std::uint64_t{1} << 31) - 1;

/// Where merged vertices meet: halfway between them, or where a held one stays. Places are those
/// that the build can tell apart.
std::vector<Vec3d> merged_positions(const Snapshot& state, const World& before,
                                    const WeldedScene& welded, std::size_t vertices,
                                    bool single_precision) {
  std::vector<Vec3d> sum(vertices);
  std::vector<double> count(vertices);
  std::vector<bool> held(vertices);
  for (std::size_t v = 0; v < state.x1.size(); ++v) {
    const std::size_t to = at(welded.vertex[v]);
    const bool pinned = v < before.pinned.size() && before.pinned[v] != 0;
    if (held[to]) continue;
    if (pinned) sum[to] = {}, count[to] = 0;
    held[to] = pinned;
    sum[to] += state.x1[v];
    ++count[to];
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    if (count[v] == 1) continue;
    sum[v] = (1 / count[v]) * sum[v];
    if (single_precision) sum[v] = convert<double>(convert<float>(sum[v]));
  }
  return sum;
}

/// Whether the small move of the welded vertices lets nothing pass through anything. Elements that
/// have a vertex in common afterwards meet there, and bodies may touch each other.
bool moves_freely(const Snapshot& state, const World& before, const WeldedScene& welded,
                  const std::vector<Vec3d>& merged) {
  std::vector<Vec3d> end;
  for (const Index v : welded.vertex) end.push_back(merged[at(v)]);
  const Collisions found = cpu64::detect_collisions(state.x1, end, before.face);

  const auto matters = [&](std::span<const Index> first, std::span<const Index> second) {
    bool cloth = false;
    for (const Index a : first) {
      cloth = cloth || a < before.cloth_vertices;
      for (const Index b : second) {
        cloth = cloth || b < before.cloth_vertices;
        if (welded.vertex[at(a)] == welded.vertex[at(b)]) return false;
      }
    }
    return cloth;
  };
  for (const auto& [vertex, face] : found.vertex_face)
    if (matters({&vertex, 1}, before.face[at(face)])) return false;
  for (const auto& v : found.edge_edge)
    if (matters({v.data(), 2}, {v.data() + 2, 2})) return false;
  return true;
}

bool intersects(const Scene& scene, const std::vector<Vec3d>& positions) {
  const SceneFaces soup = scene_faces(scene);
  return !find_intersections(positions, soup.faces, soup.group).empty();
}

/// Edge numbers of the world after a weld for those before it.
class NewKeys {
 public:
  NewKeys(const World& before, const WeldedScene& welded, const World& after)
      : before_(before), welded_(welded) {
    for (std::size_t e = 0; e < after.edge.size(); ++e)
      edge_[after.edge[e]] = static_cast<std::uint64_t>(e);
  }

  std::uint64_t of(std::uint64_t key) const {
    const std::uint64_t a = (key >> 31) & kHalf, b = key & kHalf;
    if ((key & kEdgeBit) == 0)
      return (static_cast<std::uint64_t>(welded_.vertex[static_cast<std::size_t>(a)]) << 31) | b;
    const std::uint64_t first = edge(a), second = edge(b);
    return kEdgeBit | (std::min(first, second) << 31) | std::max(first, second);
  }

 private:
  std::uint64_t edge(std::uint64_t old) const {
    const auto& e = before_.edge[static_cast<std::size_t>(old)];
    const Index a = welded_.vertex[at(e[0])], b = welded_.vertex[at(e[1])];
    return edge_.at({std::min(a, b), std::max(a, b)});
  }

  const World& before_;
  const WeldedScene& welded_;
  std::map<std::array<Index, 2>, std::uint64_t> edge_;
};

/// Means of merged vertices weighted with mass; obstacles keep what they have.
std::vector<Vec3d> weighted_means(const std::vector<Vec3d>& values, const World& before,
                                  const WeldedScene& welded, std::size_t count) {
  std::vector<Vec3d> sum(count);
  std::vector<double> mass(count);
  for (std::size_t v = 0; v < values.size(); ++v) {
    const double m = v < before.mass.size() ? before.mass[v] : 1.0;
    sum[at(welded.vertex[v])] += m * values[v];
    mass[at(welded.vertex[v])] += m;
  }
  for (std::size_t v = 0; v < count; ++v) sum[v] = (1 / mass[v]) * sum[v];
  return sum;
}

/// A hand holds merged vertices once, with the sum of their shares.
void follow_hand(HeldPatch& hand, const WeldedScene& welded) {
  for (Index& corner : hand.corners) corner = welded.vertex[at(corner)];
  HeldPatch merged = hand;
  merged.vertices.clear(), merged.share.clear(), merged.offset.clear();
  for (std::size_t i = 0; i < hand.vertices.size(); ++i) {
    const Index v = welded.vertex[at(hand.vertices[i])];
    const auto known = std::ranges::find(merged.vertices, v);
    if (known == merged.vertices.end()) {
      merged.vertices.push_back(v);
      merged.share.push_back(hand.share[i]);
      merged.offset.push_back(hand.offset[i]);
      continue;
    }
    const auto k = static_cast<std::size_t>(known - merged.vertices.begin());
    const double sum = merged.share[k] + hand.share[i];
    if (sum > 0)
      merged.offset[k] =
          (1 / sum) * (merged.share[k] * merged.offset[k] + hand.share[i] * hand.offset[i]);
    merged.share[k] = sum;
  }
  hand = std::move(merged);
}

/// Whether the straight way from a to b goes through a triangle.
bool crosses(Vec3d a, Vec3d b, Vec3d p, Vec3d q, Vec3d r) {
  const Vec3d d = b - a, n = cross(q - p, r - p);
  const double along = dot(d, n);
  if (along == 0) return false;
  const double t = dot(p - a, n) / along;
  if (!(t > 0 && t < 1)) return false;
  const Vec3d at_plane = a + t * d;
  const auto side = [&](Vec3d from, Vec3d to) { return dot(cross(to - from, at_plane - from), n); };
  return side(p, q) >= 0 && side(q, r) >= 0 && side(r, p) >= 0;
}

}  // namespace

Snapshot weld_memory(const Snapshot& state, const World& before, const WeldedScene& welded,
                     const World& after, const std::vector<Vec3d>& positions) {
  Snapshot s = state;
  const auto vertices = at(after.vertices), cloth = at(after.cloth_vertices);
  s.x1 = positions;
  s.v = weighted_means(state.v, before, welded, vertices);
  if (!state.past.motion.empty()) {
    s.past.motion = weighted_means(state.past.motion, before, welded, cloth);
    s.past.change = weighted_means(state.past.change, before, welded, cloth);
  }

  // Contacts keep their friction under the new numbers of their elements.
  const NewKeys keys(before, welded, after);
  for (auto& held : s.held) held.key = keys.of(held.key);
  std::ranges::sort(s.held, {}, [](const auto& held) { return held.key; });
  const auto same = [](const auto& a, const auto& b) { return a.key == b.key; };
  s.held.erase(std::unique(s.held.begin(), s.held.end(), same), s.held.end());

  // Gaps of merged vertices are the smaller ones; the candidate lists have to be made anew.
  if (!state.start_gap.empty()) {
    s.start_gap.assign(cloth, 1e30);
    for (std::size_t v = 0; v < state.start_gap.size(); ++v) {
      double& gap = s.start_gap[at(welded.vertex[v])];
      gap = std::min(gap, state.start_gap[v]);
    }
  }
  s.trusted.clear();
  s.trusted_complete = false;

  for (LetGo& entry : s.let_go) entry.vertex = welded.vertex[at(entry.vertex)];
  const auto order = [](const LetGo& e) { return std::pair(e.vertex, e.body); };
  std::ranges::sort(s.let_go, {}, order);
  const auto again = [&](const LetGo& a, const LetGo& b) { return order(a) == order(b); };
  s.let_go.erase(std::unique(s.let_go.begin(), s.let_go.end(), again), s.let_go.end());

  s.stitches.clear();
  for (const Index pair : welded.pairs) s.stitches.push_back(state.stitches[at(pair)]);
  for (HeldPatch& hand : s.hands) follow_hand(hand, welded);
  return s;
}

SewingSimulator::SewingSimulator(Build build, std::shared_ptr<const Scene> scene, MakeSolver make)
    : build_(build),
      make_(make),
      scene_(std::move(scene)),
      progress_(scene_->seams.size()),
      named_(scene_->seams.size()) {
  start_again();
}

/// Back to the scene with all seams open.
void SewingSimulator::start_again() {
  sewn_ = scene_;
  world_ = make_world(*scene_);
  solver_ = make_(build_, scene_);
  vertex_.resize(at(world_.vertices));
  for (std::size_t v = 0; v < vertex_.size(); ++v) vertex_[v] = static_cast<Index>(v);
  original_ = vertex_;
  progress_.assign(scene_->seams.size(), {});
}

void SewingSimulator::take(WeldedScene welded, std::unique_ptr<Simulator> solver, World world) {
  for (Index& v : vertex_) v = welded.vertex[at(v)];
  original_.assign(at(world.vertices), kNone);
  for (std::size_t v = vertex_.size(); v-- > 0;) original_[at(vertex_[v])] = static_cast<Index>(v);
  sewn_ = std::make_shared<const Scene>(std::move(welded.scene));
  world_ = std::move(world);
  solver_ = std::move(solver);
}

/// Whether all pairs of a seam are near enough to be welded.
bool SewingSimulator::is_closed(const Seam& seam, const std::vector<Vec3f>& x) const {
  const double most = weld_tolerance(world_.median_edge);
  const Index from = world_.objects[at(seam.from)].first_vertex;
  const Index to = world_.objects[at(seam.to)].first_vertex;
  return std::ranges::all_of(seam.pairs, [&](const auto& p) {
    return norm(convert<double>(x[at(from + p[0])] - x[at(to + p[1])])) < most;
  });
}

/// Moves both sides of a seam together and goes on with the welded cloth; false where something is
/// in the way.
bool SewingSimulator::weld(std::size_t seam) {
  std::optional<WeldedScene> welded = weld_seam(*sewn_, world_, static_cast<Index>(seam));
  if (!welded) return false;
  try {
    World world = make_world(welded->scene);
    const Snapshot state = solver_->snapshot();
    const std::vector<Vec3d> merged =
        merged_positions(state, world_, *welded, at(world.vertices), build_ != Build::cpu64);
    if (!moves_freely(state, world_, *welded, merged) || intersects(welded->scene, merged))
      return false;

    // The new solver goes on with the parameters and the memory of the old one.
    auto solver = make_(build_, std::make_shared<const Scene>(welded->scene));
    solver->set_parameters(solver_->parameters());
    solver->restore(weld_memory(state, world_, *welded, world, merged));
    take(std::move(*welded), std::move(solver), std::move(world));
    return true;
  } catch (const InputError&) {
    return false;  // the merged mesh cannot be simulated
  }
}

StepReport SewingSimulator::step(std::span<const InputEvent> events) {
  StepReport report = solver_->step(events);
  name_originally(report.offending);
  if (!report.accepted) return report;

  // A seam of one cloth is welded as soon as it is closed; those of two cloths stay springs.
  std::vector<Vec3f> x;
  for (std::size_t s = 0; s < progress_.size(); ++s) {
    SeamProgress& p = progress_[s];
    const Seam& seam = sewn_->seams[s];
    if (p.welded != 0 || seam.from != seam.to || report.step < p.next) continue;
    if (x.empty()) solver_->positions(x);
    if (!is_closed(seam, x)) continue;
    const std::string name = "seam " + in_quotes(seam.name);
    const std::size_t pairs = seam.pairs.size();
    if (weld(s)) {
      p.welded = static_cast<Index>(
          1 + std::ranges::count_if(progress_, [](const auto& q) { return q.welded > 0; }));
      report.notes.push_back(name + ": welded at " + number_text(report.time) + " s, " +
                             std::to_string(pairs) + " pairs");
      report.state_hash = solver_->state_hash();
      x.clear();
    } else {
      p.delay = p.delay == 0 ? kFirstDelay : std::min(2 * p.delay, kLongestDelay);
      p.next = report.step + p.delay;
    }
  }
  if (report.stuck_pairs > 0) note_stuck(report);
  return report;
}

/// Names each stuck seam once, with what its worst pair has between its ends.
void SewingSimulator::note_stuck(StepReport& report) {
  const Snapshot state = solver_->snapshot();
  const std::vector<StitchedPair> pairs = stitched_pairs(*sewn_, world_);
  struct Worst {
    const StitchedPair* pair = nullptr;
    double distance = 0;
  };
  std::vector<Worst> worst(progress_.size());
  for (std::size_t i = 0; i < pairs.size() && i < state.stitches.size(); ++i) {
    if (state.stitches[i].age <= kStuckSteps) continue;
    const double distance = norm(state.x1[at(pairs[i].a)] - state.x1[at(pairs[i].b)]);
    Worst& w = worst[at(pairs[i].seam)];
    if (distance > w.distance) w = {&pairs[i], distance};
  }

  for (std::size_t s = 0; s < worst.size(); ++s) {
    if (!worst[s].pair || named_[s]) continue;
    named_[s] = true;
    const Vec3d a = state.x1[at(worst[s].pair->a)], b = state.x1[at(worst[s].pair->b)];
    std::set<std::string> between;
    for (std::size_t f = 0; f < world_.face.size(); ++f) {
      const Triangle& t = world_.face[f];
      const auto is_end = [&](Index v) { return v == worst[s].pair->a || v == worst[s].pair->b; };
      if (std::ranges::any_of(t, is_end)) continue;
      if (!crosses(a, b, state.x1[at(t[0])], state.x1[at(t[1])], state.x1[at(t[2])])) continue;
      const WorldObject& object = world_.objects[at(world_.object[at(t[0])])];
      between.insert((object.cloth ? "cloth " : "obstacle ") + in_quotes(object.name));
    }

    std::string line = "seam " + in_quotes(sewn_->seams[s].name) + ": " +
                       rounded_text(100 * worst[s].distance, 2) + " cm apart";
    std::string names;
    for (const std::string& name : between) names += (names.empty() ? "" : " and ") + name;
    line += names.empty() ? ", comes no nearer, with nothing between its sides"
                          : ", held apart by " + names;
    report.notes.push_back(line);
  }
}

/// Numbers of vertices as the scene has them that users know.
void SewingSimulator::name_originally(std::vector<OffendingPair>& pairs) const {
  for (OffendingPair& pair : pairs)
    for (Index& v : pair.vertices) v = original_[at(v)];
}

std::vector<OffendingPair> SewingSimulator::contacts_at_rest() {
  std::vector<OffendingPair> pairs = solver_->contacts_at_rest();
  name_originally(pairs);
  return pairs;
}

void SewingSimulator::positions(std::vector<Vec3f>& out) const {
  std::vector<Vec3f> x;
  solver_->positions(x);
  out.resize(vertex_.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = x[at(vertex_[v])];
}

/// The vertices on the device are those of the scene only as long as nothing is welded.
void SewingSimulator::positions_on_device(std::unique_ptr<DevicePositions>& slot) const {
  if (sewn_ == scene_)
    solver_->positions_on_device(slot);
  else
    slot.reset();
}

Snapshot SewingSimulator::snapshot() const {
  Snapshot s = solver_->snapshot();
  s.seams = progress_;
  return s;
}

/// Welds the seams of a snapshot in the order in which they were welded; false where they cannot
/// be.
bool SewingSimulator::sew_as(const std::vector<SeamProgress>& progress) {
  const auto order = [](const SeamProgress& p) { return p.welded; };
  if (std::ranges::equal(progress, progress_, {}, order, order)) return true;

  // Numbers of vertices depend on the order, so all starts anew.
  const Parameters parameters = solver_->parameters();
  start_again();
  solver_->set_parameters(parameters);
  const Index last = static_cast<Index>(
      std::ranges::count_if(progress, [](const SeamProgress& p) { return p.welded > 0; }));
  for (Index k = 1; k <= last; ++k) {
    const auto found = std::ranges::find(progress, k, order);
    if (found == progress.end()) return false;
    const auto s = static_cast<Index>(found - progress.begin());
    std::optional<WeldedScene> welded = weld_seam(*sewn_, world_, s);
    if (!welded) return false;
    World world = make_world(welded->scene);
    auto solver = make_(build_, std::make_shared<const Scene>(welded->scene));
    solver->set_parameters(parameters);
    take(std::move(*welded), std::move(solver), std::move(world));
  }
  return true;
}

void SewingSimulator::restore(const Snapshot& snapshot) {
  if (snapshot.seams.size() != progress_.size() || !sew_as(snapshot.seams))
    throw std::invalid_argument("snapshot of another scene: seams: other ones are welded");
  progress_ = snapshot.seams;
  solver_->restore(snapshot);
}

}  // namespace icloth
