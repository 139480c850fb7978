#include "sim/solver.h"

#include <algorithm>
#include <utility>

#include "kernels/copy_to_device.h"
#include "kernels/parallel/device.h"
#include "kernels/parallel/parallel.h"
#include "kernels/parallel/reserve.h"
#include "sim/mechanics/energy.h"
#include "sim/mechanics/fabrics.h"
#include "sim/state/stillness.h"
#include "sim/state/upload.h"

namespace icloth::ICLOTH_BUILD {
namespace {

Real real(double value) { return static_cast<Real>(value); }

Vec3r to_real(Vec3d a) { return convert<Real>(a); }

/// Velocity at the end of the substep as it would be without impact zones.
struct CandidateVelocity {
  View<const Vec3r> candidate, x1, v;
  View<Vec3r> out;
  Real inverse_dt;
  ICLOTH_HD void operator()(Index i) const { out[i] = v[i] + inverse_dt * (candidate[i] - x1[i]); }
};

/// Velocity of an obstacle that moves from x0 to x1.
struct ObstacleVelocity {
  View<const Vec3r> x0, x1;
  View<Vec3r> v;
  Index first;
  Real inverse_dt;
  ICLOTH_HD void operator()(Index i) const {
    v[first + i] = inverse_dt * (x1[first + i] - x0[first + i]);
  }
};

struct Rest {
  View<Vec3r> v;
  ICLOTH_HD void operator()(Index i) const { v[i] = Vec3r{}; }
};

struct Gather {
  View<const Index> list;
  View<const Vec3r> from;
  View<Vec3r> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[list[i]]; }
};

struct SpreadSprings {
  View<const Spring> springs;
  View<Real> stiffness;
  View<Vec3r> target;
  ICLOTH_HD void operator()(Index i) const {
    stiffness[springs[i].vertex] = springs[i].stiffness;
    target[springs[i].vertex] = springs[i].target;
  }
};

struct Speed {
  View<const Vec3r> v;
  ICLOTH_HD Real operator()(Index i) const { return norm(v[i]); }
};

}  // namespace

Solver::Solver(std::shared_ptr<const Scene> scene, World world, int device)
    : device_(device),
      scene_(std::move(scene)),
      world_(std::move(world)),
      hands_(world_, state_.hands) {
  mesh_.upload(world_);
  upload_as(state_.x1, world_.position, to_real);
  state_.x0.copy_from(state_.x1);
  state_.candidate.resize(mesh_.cloth_vertices);
  state_.v.resize(mesh_.vertices);
  state_.v.fill(Vec3r{});
  upload_skins();
  upload_seams(mesh_, state_, *scene_, world_);
  state_.seams.resize(scene_->seams.size());
  set_parameters(scene_->parameters);
  reserve_memory();
}

void Solver::upload_skins() {
  skins_.resize(world_.objects.size());
  for (std::size_t o = 0; o < skins_.size(); ++o) {
    const WorldObject& object = world_.objects[o];
    if (object.cloth) continue;
    const Obstacle& obstacle = scene_->obstacles[static_cast<std::size_t>(object.source)];
    if (obstacle.skinned() && obstacle.moves())
      skins_[o] = std::make_unique<Skinning>(obstacle.skinned()->rig(), object.first_vertex);
  }
}

/// Lists of pairs grow when cloth touches something, and no step should wait for their memory.
void Solver::reserve_memory() {
  constexpr std::uint64_t kCandidatesPerVertex = 32;
  constexpr std::uint64_t kBytesPerCandidate = 160;
  constexpr std::uint64_t kLeast = std::uint64_t{4} << 20;  // what sorts and reductions take
  const auto vertices = static_cast<std::uint64_t>(mesh_.vertices);
  memory::reserve(kLeast + kCandidatesPerVertex * kBytesPerCandidate * vertices);
  reserved_ = memory::reserved();
}

/// Takes half as much again when a step needed more than was reserved, so that this stays a rare
/// event. The profile notes it.
void Solver::grow_reserve() {
  const std::uint64_t needed = memory::reserved();
  if (needed <= reserved_) return;
  const ProfileScope note("memory.grow");
  memory::reserve(needed / 2);
  reserved_ = memory::reserved();
}

void Solver::report_energies(bool on) {
  reports_energies_ = on;
  forget_measures();
}

/// The state has become another one than that of the last report, or is measured in another way.
void Solver::forget_measures() {
  energy_.reset();
  measured_.reset();
}

void Solver::use_device() const { select_device(device_); }

icloth::Build Solver::build() const {
  if (sizeof(Real) == 8) return icloth::Build::cpu64;
#if defined(__CUDACC__)
  return icloth::Build::cuda32;
#else
  return icloth::Build::cpu32;
#endif
}

void Solver::set_parameters(const Parameters& parameters) {
  use_device();
  parameters_ = parameters;

  // Fabrics depend on the parameters, and so does the pattern of the matrix: cloth that does not
  // resist bending couples only the corners of faces.
  upload_fabrics(mesh_, *scene_, parameters);
  if (mesh_.bends && parameters.material.bending == BendingModel::plate)
    upload_plates(mesh_, world_);
  implicit_.match_pattern(world_, mesh_);

  // Pinned vertices get an infinite mass, as obstacles have.
  std::vector<Real> mass, inverse(static_cast<std::size_t>(mesh_.vertices), Real(0));
  free_mass_ = 0;
  for (std::size_t i = 0; i < world_.mass.size(); ++i) {
    mass.push_back(real(parameters.material.density_scale * world_.mass[i]));
    if (world_.pinned[i] != 0) continue;
    inverse[i] = Real(1) / mass[i];
    free_mass_ += static_cast<double>(mass[i]);
  }
  state_.mass.upload(mass);
  state_.inverse_mass.upload(inverse);

  // The energy depends on the parameters, still cloth may start to move, and a new thickness needs
  // other boxes.
  forget_measures();
  disturb(state_);
  broad_phase_.invalidate(state_);
}

void Solver::begin_substep(double start, double dt) {
  state_.x0.copy_from(state_.x1);
  const double time = body_time(start + dt);

  // Obstacles that move are posed at the end of the substep. In between they move in straight
  // lines, as the cloth does.
  for (std::size_t o = 0; o < world_.objects.size(); ++o) {
    const WorldObject& object = world_.objects[o];
    if (object.cloth) continue;
    const Obstacle& obstacle = scene_->obstacles[static_cast<std::size_t>(object.source)];
    if (!obstacle.moves()) continue;
    if (skins_[o])
      skins_[o]->place(obstacle.skin_pose(time), state_.x1.view());
    else
      upload_pose(obstacle, time, object.first_vertex);
    for_each("step.obstacle", object.vertex_count,
             ObstacleVelocity{state_.x0.view(), state_.x1.view(), state_.v.view(),
                              object.first_vertex, real(1 / dt)});
  }
}

/// The time of clips and keyframes at a time of the step in progress. At full speed nothing is
/// rounded: both are the same to the last bit.
double Solver::body_time(double time) const {
  return time - (state_.body_lag + (1 - parameters_.bodies.speed) * (time - state_.time));
}

/// Moves the clock on by a step, and that of the bodies at their speed.
void Solver::advance_clocks(double dt) {
  state_.body_lag += (1 - parameters_.bodies.speed) * dt;
  state_.time += dt;
}

/// Poses a body on the host, where no bones move it.
void Solver::upload_pose(const Obstacle& obstacle, double time, Index first_vertex) {
  std::vector<Vec3d> pose;
  obstacle.pose(time, pose);
  std::vector<Vec3r> x;
  x.reserve(pose.size());
  for (const Vec3d& p : pose) x.push_back(to_real(p));
  state_.x1.upload_range(first_vertex, x);
}

void Solver::accept_substep(StepReport& report, double dt) {
  if (free_mass_ > 0)
    report.momentum_error =
        std::max(report.momentum_error, norm(implicit_.residual_force()) / free_mass_);
  proximity_.keep_friction(state_, parameters_, real(dt));
  pinch_.take_back(state_, parameters_);
  implicit_.finish_substep(state_);
  advance_seams(mesh_, parameters_, state_, real(dt));
  if (!reports_energies_) return;
  work_ += implicit_.work();
  if (impact_zones_.corrected()) work_ += zone_work(dt);
}

/// How much the impact zones changed the energy: that of the end, less that of the candidate [J].
double Solver::zone_work(double dt) {
  candidate_v_.resize(mesh_.cloth_vertices);
  for_each("step.candidate_velocities", mesh_.cloth_vertices,
           CandidateVelocity{state_.candidate.view(), state_.x1.view(), state_.v.view(),
                             candidate_v_.view(), real(1 / dt)});
  const auto energy = [&](View<const Vec3r> x, View<const Vec3r> v) {
    return statistics_of(implicit_.forces(), {mesh_, parameters_, x}, state_.mass.view(), v)
        .energy();
  };
  return energy(state_.x1.view(), state_.v.view()) -
         energy(state_.candidate.view(), candidate_v_.view());
}

void Solver::back_to_substep_start() { state_.x1.copy_from(state_.x0); }

/// Cloth without velocity, friction and past.
void Solver::rest_cloth() {
  for_each("step.rest", mesh_.cloth_vertices, Rest{state_.v.view()});
  state_.held.resize(0);
  state_.past.forget();
  disturb(state_);
  forget_measures();
}

double Solver::largest_speed() const {
  return static_cast<double>(
      reduce("step.speed", mesh_.vertices, Real(0), Speed{state_.v.view()}, Max{}));
}

int Solver::travel_level(StepReport& report) {
  fastest_ = largest_speed();
  const double reach = parameters_.step.max_travel * world_.median_edge;
  int level = 0;
  double travel = fastest_ * parameters_.step.time_step;
  for (; travel > reach && level < parameters_.step.max_substep_levels; travel *= 0.5) ++level;
  if (travel > reach) report.reach(Limit::substep_levels);
  return level;
}

void Solver::save_start() {
  start_.copy_from(state_);
  work_ = 0;
  if (reports_energies_ && !energy_)
    energy_ = statistics_of(implicit_.forces(), {mesh_, parameters_, state_.x1.view()},
                            state_.mass.view(), state_.v.view())
                  .energy();
}

void Solver::back_to_start() {
  static_cast<Memory&>(state_).copy_from(start_);
  broad_phase_.follow_memory();
}

void Solver::report_offending(StepReport& report) const {
  constexpr std::size_t kMost = 100;
  report.offending.clear();
  report.no_room = report.finite;
  if (!report.finite) return;

  // The obstacles leave the cloth no room when every pair that is left is with one of them.
  for (const Impact& impact : ccd_.impacts().download()) {
    const Index* v = impact.s.v;
    report.no_room =
        report.no_room && std::any_of(v, v + 4, [&](Index i) { return i >= mesh_.cloth_vertices; });
    if (report.offending.size() < kMost)
      report.offending.push_back({key_is_edge_edge(impact.key), {v[0], v[1], v[2], v[3]}});
  }
}

std::vector<Vec3d> Solver::cloth_positions() const {
  std::vector<Vec3r> x(static_cast<std::size_t>(mesh_.cloth_vertices));
  state_.x1.download_range(0, x);
  std::vector<Vec3d> out;
  out.reserve(x.size());
  for (const Vec3r& p : x) out.push_back(convert<double>(p));
  return out;
}

std::vector<Vec3d> Solver::watched_positions() const {
  watched_.upload(hands_.watched());
  watched_position_.resize(watched_.size());
  for_each("step.watched", watched_.size(),
           Gather{watched_.view(), state_.x1.view(), watched_position_.view()});
  std::vector<Vec3d> out;
  for (const Vec3r& p : watched_position_.download()) out.push_back(convert<double>(p));
  return out;
}

void Solver::use_hands(std::span<const InputEvent> events, StepReport& report) {
  state_.has_springs = false;
  if (events.empty() && hands_.empty()) return;

  // All positions come to the host only where a patch is grabbed; the corners of the faces that
  // are held tell the rest.
  const bool grabs = std::any_of(events.begin(), events.end(), [](const InputEvent& event) {
    return event.kind == InputEvent::Kind::grab;
  });
  hands_.apply(events, parameters_, grabs ? cloth_positions() : std::vector<Vec3d>{});
  if (hands_.empty()) return;
  report.limits |= hands_.advance(parameters_.step.time_step, parameters_, watched_positions());

  // The implicit step reads the springs of the patches, one at most for each vertex.
  upload_as(springs_, hands_.springs(), [](const HandSpring& s) {
    return Spring{s.vertex, real(s.stiffness), to_real(s.target)};
  });
  state_.spring_stiffness.resize(mesh_.cloth_vertices);
  state_.spring_target.resize(mesh_.cloth_vertices);
  state_.spring_stiffness.fill(Real(0));
  for_each(
      "step.springs", springs_.size(),
      SpreadSprings{springs_.view(), state_.spring_stiffness.view(), state_.spring_target.view()});
  state_.has_springs = true;
}

std::uint64_t Solver::state_hash() const {
  use_device();
  return hash_state(state_);
}

void Solver::positions(std::vector<Vec3f>& out) const {
  use_device();
  const std::vector<Vec3r> x = state_.x1.download();
  out.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = convert<float>(x[i]);
}

void Solver::positions_on_device(std::unique_ptr<DevicePositions>& slot) const {
  use_device();
  copy_to_device(state_.x1.view(), slot);
}

Snapshot Solver::snapshot() const {
  use_device();
  return download(state_);
}

void Solver::restore(const Snapshot& snapshot) {
  check_memory(snapshot, {.vertices = mesh_.vertices,
                          .cloth_vertices = mesh_.cloth_vertices,
                          .cloth_faces = mesh_.cloth_faces,
                          .objects = static_cast<Index>(world_.objects.size()),
                          .stitches = mesh_.stitches.size(),
                          .seams = static_cast<Index>(scene_->seams.size())});
  use_device();
  upload(snapshot, state_);
  broad_phase_.follow_memory();
  forget_measures();
}

std::vector<HandleState> Solver::handles() const {
  if (hands_.empty()) return {};
  use_device();
  return hands_.states(watched_positions());
}

std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world,
                                       int device) {
  select_device(device);  // the arrays of the members are made there
  return std::make_unique<Solver>(std::move(scene), std::move(world), device);
}

}  // namespace icloth::ICLOTH_BUILD
