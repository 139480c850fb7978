#include "sim/sewing_simulator.h"

#include <algorithm>
#include <set>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/weld_memory.h"

namespace icloth {
namespace {

constexpr Index kFirstDelay = 10, kLongestDelay = 640;  // steps after a weld that failed

/// Whether the straight way from a to b goes through a triangle.
bool crosses(Vec3d a, Vec3d b, Vec3d p, Vec3d q, Vec3d r) {
  const Vec3d d = b - a, n = cross(q - p, r - p);
  const double along = dot(d, n);
  if (along == 0) return false;

  // The way meets the plane of the triangle, at a place inside all three edges.
  const double t = dot(p - a, n) / along;
  if (!(t > 0 && t < 1)) return false;
  const Vec3d at_plane = a + t * d;
  const auto side = [&](Vec3d from, Vec3d to) { return dot(cross(to - from, at_plane - from), n); };
  return side(p, q) >= 0 && side(q, r) >= 0 && side(r, p) >= 0;
}

/// "obstacle 'ball' and cloth 'coat'": what the straight way between the ends of a pair goes
/// through; empty where that is nothing.
std::string names_between(const StitchedPair& pair, const World& world,
                          const std::vector<Vec3d>& x) {
  std::set<std::string> between;
  for (const Triangle& t : world.face) {
    const auto is_end = [&](Index v) { return v == pair.a || v == pair.b; };
    if (std::ranges::any_of(t, is_end)) continue;
    if (!crosses(x[at(pair.a)], x[at(pair.b)], x[at(t[0])], x[at(t[1])], x[at(t[2])])) continue;
    const WorldObject& object = world.objects[at(world.object[at(t[0])])];
    between.insert((object.cloth ? "cloth " : "obstacle ") + in_quotes(object.name));
  }

  std::string names;
  for (const std::string& name : between) names += (names.empty() ? "" : " and ") + name;
  return names;
}

std::string seconds_text(double time) { return rounded_text(time, 6) + " s"; }

}  // namespace

SewingSimulator::SewingSimulator(Build build, std::shared_ptr<const Scene> scene, MakeSolver make)
    : build_(build),
      make_(make),
      scene_(std::move(scene)),
      progress_(scene_->seams.size()),
      told_closed_(scene_->seams.size()),
      told_stuck_(scene_->seams.size()) {
  start_again();
}

/// Back to the scene with all seams open.
void SewingSimulator::start_again() {
  sewn_ = scene_;
  world_ = make_world(*scene_);
  solver_ = make_(build_, scene_);
  solver_->report_energies(reports_energies_);
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

void SewingSimulator::report_energies(bool on) {
  reports_energies_ = on;
  solver_->report_energies(on);
}

/// Whether all pairs of a seam are near enough to be welded.
bool SewingSimulator::is_closed(const Seam& seam) const {
  const double most = weld_tolerance(world_.median_edge);
  const Index from = world_.objects[at(seam.from)].first_vertex;
  const Index to = world_.objects[at(seam.to)].first_vertex;
  std::vector<Vec3f> x;
  solver_->positions(x);
  return std::ranges::all_of(seam.pairs, [&](const auto& p) {
    return norm(convert<double>(x[at(from + p[0])] - x[at(to + p[1])])) < most;
  });
}

/// Moves both sides of a seam together and goes on with the welded cloth; false where something is
/// in the way. The report then tells of the welded cloth, and its energy balance counts what the
/// weld changed.
bool SewingSimulator::weld(std::size_t seam, StepReport& report) {
  std::optional<WeldedScene> welded = weld_seam(*sewn_, world_, static_cast<Index>(seam));
  if (!welded) return false;
  try {
    // The move is made only where it passes through nothing.
    World world = make_world(welded->scene);
    const Snapshot state = solver_->snapshot();
    const std::vector<Vec3d> positions =
        welded_positions(state, world_, *welded, world, build_ != Build::cpu64);
    if (!weld_is_free(state, world_, *welded, positions)) return false;

    // The new solver goes on with the parameters and the memory of the old one.
    auto solver = make_(build_, std::make_shared<const Scene>(welded->scene));
    solver->report_energies(reports_energies_);
    solver->set_parameters(solver_->parameters());
    solver->restore(weld_memory(state, world_, *welded, world, positions));
    const double energy = solver_->measure(report);
    report.energy_balance += solver->measure(report) - energy;
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

  for (std::size_t s = 0; s < progress_.size(); ++s) close_seam(s, report);
  if (report.stuck_pairs > 0) note_stuck(report);
  return report;
}

/// Welds a seam of one cloth as soon as it is closed. That of two cloths stays a row of springs.
void SewingSimulator::close_seam(std::size_t s, StepReport& report) {
  SeamProgress& p = progress_[s];
  const Seam& seam = sewn_->seams[s];
  const bool one_cloth = seam.from == seam.to;
  if (p.welded != 0 || seam.pairs.empty() || report.step < p.next) return;
  if (!one_cloth && told_closed_[s]) return;
  if (!is_closed(seam)) return;

  // What happened is said once for each seam.
  const std::string name = "seam " + in_quotes(seam.name) + ": ";
  const std::string pairs = std::to_string(seam.pairs.size()) + " pairs";
  const auto tell = [&](const std::string& text) {
    if (!told_closed_[s]) report.notes.push_back(name + text);
    told_closed_[s] = true;
  };
  if (!one_cloth) {
    tell("closed at " + seconds_text(report.time) + ", " + pairs +
         "; springs hold the two cloths together");
  } else if (weld(s, report)) {
    p.welded = static_cast<Index>(
        1 + std::ranges::count_if(progress_, [](const auto& q) { return q.welded > 0; }));
    report.notes.push_back(name + "welded at " + seconds_text(report.time) + ", " + pairs);
  } else {
    tell("closed at " + seconds_text(report.time) +
         " but not welded: the last move or the welded mesh meets something; springs hold it");
    p.delay = p.delay == 0 ? kFirstDelay : std::min(2 * p.delay, kLongestDelay);
    p.next = report.step + p.delay;
  }
}

/// Names each stuck seam once, with what its worst pair has between its ends.
void SewingSimulator::note_stuck(StepReport& report) {
  const Snapshot state = solver_->snapshot();
  const std::vector<StitchedPair> pairs = stitched_pairs(*sewn_, world_);
  struct Worst {
    const StitchedPair* pair = nullptr;
    double distance = 0;
  };

  // The worst pair of a seam is the one that is widest apart.
  std::vector<Worst> worst(progress_.size());
  for (std::size_t i = 0; i < pairs.size() && i < state.stitches.size(); ++i) {
    if (state.stitches[i].age <= kStuckSteps) continue;
    const double distance = norm(state.x1[at(pairs[i].a)] - state.x1[at(pairs[i].b)]);
    Worst& w = worst[at(pairs[i].seam)];
    if (distance > w.distance) w = {&pairs[i], distance};
  }

  for (std::size_t s = 0; s < worst.size(); ++s) {
    if (!worst[s].pair || told_stuck_[s]) continue;
    told_stuck_[s] = true;
    const std::string names = names_between(*worst[s].pair, world_, state.x1);
    report.notes.push_back("seam " + in_quotes(sewn_->seams[s].name) + ": " +
                           rounded_text(100 * worst[s].distance, 2) + " cm apart, " +
                           (names.empty() ? "comes no nearer, with nothing between its sides"
                                          : "held apart by " + names));
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
