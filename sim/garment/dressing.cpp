#include "sim/garment/dressing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/index.h"
#include "sim/bodies/cached_poses.h"
#include "sim/bodies/contract.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/garment/face_strain.h"

namespace icloth {
namespace {

constexpr double kTimeStep = 0.005;     // [s]
constexpr int kStepsBetweenRests = 20;  // then the velocities are halved
constexpr int kStepsBetweenLooks = 10;  // at the strain
constexpr double kMostTravel = 2;  // in a substep [edges]: seams pull fast, and friction decides
constexpr double kClosingBending = 30;  // times as stiff, so that no hem flips or rolls up
constexpr double kClosedStrain = 0.05;  // of a garment whose seams are drawn together
constexpr double kWeightless = 0.1;     // time for the seams to meet [s]
constexpr double kLightWeight = 0.3;  // share of the weight after that, so that no wide skirt rises
constexpr int kStallSteps = 50;       // it is as closed as it gets when in so many steps …
constexpr double kStallChange = 0.01;  // … the strain changed by no more than this share
constexpr int kMostRefusals = 5;       // one after the other
constexpr double kGrowTime = 1;        // of bodies that start contracted [s]
constexpr double kHoldStiffness = 1;   // of a held vertex [N/m]
constexpr double kRefinedTime = 0.1;   // to settle after the triangles were divided [s]

/// Without weight, at first, and wind, stiffer in bending, and with the integrator that takes most
/// energy away.
Parameters dressing_parameters(const Parameters& own) {
  Parameters p = own;
  p.step.time_step = kTimeStep;
  p.step.max_travel = std::min(own.step.max_travel, kMostTravel);
  p.step.sleep = false;
  p.implicit.integrator = Integrator::backward_euler;
  p.gravity = {.x = 0, .y = 0, .z = 0};
  p.wind = {.x = 0, .y = 0, .z = 0, .air_density = 0, .air_drag = 0};
  p.material.strain_limit = 0;
  p.material.bend_scale *= kClosingBending;
  return p;
}

/// The scene in which one garment is put on.
struct DressingRoom {
  std::shared_ptr<Scene> scene;
  std::vector<std::size_t> cloths;  ///< their numbers in the scene that is dressed
  std::size_t garment = 0;          ///< number of the garment's cloth here
};

/// The body grows to its size within kGrowTime.
void let_grow(Obstacle& body, double contraction) {
  std::vector<Vec3d> slender = body.mesh.positions;
  contract(slender, body.mesh.faces, contraction);
  std::vector<std::vector<Vec3f>> frames;
  for (const std::vector<Vec3d>* positions : {&slender, &body.mesh.positions}) {
    std::vector<Vec3f>& frame = frames.emplace_back();
    for (Vec3d p : *positions) frame.push_back(convert<float>(p));
  }
  body.poses = std::make_shared<CachedPoses>(std::move(frames), 1 / kGrowTime);
}

/// The bodies as they stand at time 0, the cloths that are no garments, held where they are, the
/// garments that are on already, and the next one.
DressingRoom make_room(const Scene& scene, std::span<const std::size_t> on, std::size_t next,
                       double contraction) {
  DressingRoom room{std::make_shared<Scene>(), {}, 0};
  room.scene->name = scene.name;
  room.scene->cameras = scene.cameras;  // for whoever draws it
  room.scene->parameters = dressing_parameters(scene.parameters);
  for (const Obstacle& obstacle : scene.obstacles) {
    Obstacle still;
    still.name = obstacle.name;
    still.friction = obstacle.friction;
    still.mesh = obstacle.mesh;
    obstacle.pose(0, still.mesh.positions);
    if (contraction > 0) let_grow(still, contraction);
    room.scene->obstacles.push_back(std::move(still));
  }

  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const auto of_cloth = [&](std::size_t g) { return at(scene.garments[g].cloth) == c; };
    const bool is_next = of_cloth(next), is_on = std::ranges::any_of(on, of_cloth);
    const bool is_garment =
        std::ranges::any_of(scene.garments, [&](const Garment& g) { return at(g.cloth) == c; });
    if (is_garment && !is_next && !is_on) continue;

    Cloth cloth = scene.cloths[c];
    cloth.material.strain_limit = 0;  // it would multiply the stiffness of seams that are open yet
    if (!is_garment) {
      cloth.pins.resize(cloth.mesh.positions.size());
      std::iota(cloth.pins.begin(), cloth.pins.end(), Index{0});
    }
    if (is_next) room.garment = room.scene->cloths.size();
    room.cloths.push_back(c);
    room.scene->cloths.push_back(std::move(cloth));
  }
  return room;
}

/// Strains of one garment, without those of gathers.
class StrainGauge {
 public:
  /// `number` is that of its cloth in the room.
  StrainGauge(const World& world, const Scene& room, std::size_t number, const Garment& garment)
      : world_(world), first_face_(at(world.objects[number].first_face)) {
    const Cloth& cloth = room.cloths[number];
    gathered_ = gathered_faces(garment, cloth);

    std::vector<bool> sewn(cloth.mesh.positions.size());
    for (const SewnSeam& seam : garment.sewn.seams)
      for (const auto& pair : seam.points) sewn[at(garment.sewn.merged[at(pair[0])])] = true;
    for (const Triangle& t : cloth.mesh.faces)
      at_seam_.push_back(sewn[at(t[0])] || sewn[at(t[1])] || sewn[at(t[2])]);
  }

  std::vector<double> strains(const Snapshot& state, bool seams_alone) const {
    const std::vector<double> all = face_strains(world_, state.x1);
    std::vector<double> chosen;
    for (std::size_t f = 0; f < gathered_.size(); ++f)
      if (!gathered_[f] && (at_seam_[f] || !seams_alone)) chosen.push_back(all[first_face_ + f]);
    return chosen;
  }

  double largest(const Snapshot& state) const { return percentile(strains(state, false), 1); }

  /// Writes what the strains are into the garment's report.
  void measure(const Snapshot& state, DressingReport& report) const {
    report.gathered_share = static_cast<double>(std::ranges::count(gathered_, true)) /
                            static_cast<double>(gathered_.size());
    report.strain_p95 = percentile(strains(state, false), 0.95);
    report.largest_strain = largest(state);
    report.seam_strain_p95 = percentile(strains(state, true), 0.95);
  }

 private:
  const World& world_;
  std::size_t first_face_;
  std::vector<bool> gathered_, at_seam_;
};

/// Springs that keep labelled edges at their height: hands whose targets follow to the sides.
class Holds {
 public:
  Holds(const World& world, const DressingRoom& room, const Garment& garment) {
    const WorldObject& object = world.objects[room.garment];
    std::vector<bool> wanted(at(object.vertex_count));
    for (const LabelledEdge& edge : garment.sewn.labelled)
      if (std::ranges::find(garment.plan.hold, edge.label) != garment.plan.hold.end())
        for (Index v : edge.vertices) wanted[at(v)] = true;

    // A hand grabs a face, so each vertex is held by the first of its faces.
    for (Index f = object.first_face; f < object.first_face + object.face_count; ++f)
      for (std::size_t c = 0; c < 3; ++c) {
        const Index v = world.face[at(f)][c];
        if (!wanted[at(v - object.first_vertex)]) continue;
        wanted[at(v - object.first_vertex)] = false;
        held_.push_back({v, f, c, world.position[at(v)].y});
      }
  }

  std::vector<InputEvent> events(InputEvent::Kind kind, const Simulator& simulator) const {
    std::vector<InputEvent> events;
    if (held_.empty()) return events;
    const Snapshot state = simulator.snapshot();
    for (std::size_t k = 0; k < held_.size(); ++k) {
      // A patch of one vertex.
      InputEvent event;
      event.kind = kind;
      event.handle = static_cast<int>(k) + 1;
      event.face = held_[k].face;
      event.barycentric = {held_[k].corner == 0 ? 1.0 : 0.0, held_[k].corner == 1 ? 1.0 : 0.0,
                           held_[k].corner == 2 ? 1.0 : 0.0};
      event.radius = 1e-6;
      event.stiffness = kHoldStiffness;

      // It is free to go to the sides and is held at its height.
      event.target = state.x1[at(held_[k].vertex)];
      event.target.y = held_[k].height;
      events.push_back(event);
    }
    return events;
  }

 private:
  struct Held {
    Index vertex, face;
    std::size_t corner;
    double height;
  };
  std::vector<Held> held_;
};

/// Takes part of the motion away, so that the garment comes to rest.
void scale_velocities(Simulator& simulator, double factor) {
  Snapshot state = simulator.snapshot();
  for (Vec3d& v : state.v) v = factor * v;
  simulator.restore(state);
}

/// One garment that is being put on.
class Dressing {
 public:
  Dressing(const Scene& scene, std::span<const std::size_t> on, std::size_t next,
           double contraction, const DressingWatch& watch)
      : garment_(scene.garments[next]),
        room_(make_room(scene, on, next, contraction)),
        least_steps_(contraction > 0 ? static_cast<int>(std::lround(kGrowTime / kTimeStep)) + 1
                                     : 0),
        world_(make_world(*room_.scene)),
        gauge_(world_, *room_.scene, room_.garment, garment_),
        holds_(world_, room_, garment_),
        gravity_(scene.parameters.gravity),
        bend_scale_(scene.parameters.material.bend_scale),
        simulator_(make_simulator(Build::cpu32, room_.scene)),
        watch_(watch) {
    report_.garment = scene.cloths[at(garment_.cloth)].name;
  }

  DressingReport run() {
    close();
    settle(holds_.events(InputEvent::Kind::release, *simulator_), garment_.plan.settling);
    gauge_.measure(simulator_->snapshot(), report_);
    return report_;
  }

  /// Lets all garments of the room settle, which were refined where they hang. Adds the steps and
  /// the strains to their reports, of which `on` tells the order.
  void run_refined(const Scene& scene, std::span<const std::size_t> on,
                   std::span<DressingReport* const> reports) {
    settle({}, kRefinedTime);
    const Snapshot end = simulator_->snapshot();
    for (std::size_t k = 0; k < on.size(); ++k) {
      const Garment& garment = scene.garments[on[k]];
      const auto number = std::ranges::find(room_.cloths, at(garment.cloth)) - room_.cloths.begin();
      const StrainGauge gauge(world_, *room_.scene, static_cast<std::size_t>(number), garment);
      gauge.measure(end, *reports[k]);
      reports[k]->refined_steps += report_.settling_steps;
      reports[k]->refused_steps += report_.refused_steps;
    }
  }

  /// Writes where the garments are now into the scene; the next step starts at rest.
  void write(Scene& scene) const {
    const Snapshot end = simulator_->snapshot();
    for (std::size_t c = 0; c < room_.cloths.size(); ++c) {
      const WorldObject& object = world_.objects[c];
      const auto first = end.x1.begin() + object.first_vertex;
      scene.cloths[room_.cloths[c]].mesh.positions.assign(first, first + object.vertex_count);
    }
  }

 private:
  /// The seams draw together, first without weight and then with a part of it, until the strain is
  /// small or stays as it is.
  void close() {
    const int most = static_cast<int>(std::lround(garment_.plan.closing / kTimeStep));
    const int weightless = static_cast<int>(std::lround(kWeightless / kTimeStep));
    std::vector<InputEvent> events = holds_.events(InputEvent::Kind::grab, *simulator_);
    double before = strain_ = gauge_.largest(simulator_->snapshot());
    for (int k = 1; k <= most; ++k) {
      if (k == weightless + 1) set_weight(kLightWeight, kClosingBending);
      step(events, most, false);
      ++report_.closing_steps;
      if (k % kStepsBetweenLooks == 0) strain_ = gauge_.largest(simulator_->snapshot());

      // The phase ends early where the seams are closed, or where nothing changes any more.
      if (strain_ < kClosedStrain && k >= least_steps_) break;
      if (k % kStallSteps == 0) {
        if (std::fabs(strain_ - before) <= kStallChange * before && k >= least_steps_) break;
        before = strain_;
      }
      events = holds_.events(InputEvent::Kind::move, *simulator_);
    }
  }

  /// The whole weight comes on; the events of its first step let go of what is held.
  void settle(std::vector<InputEvent> events, double seconds) {
    set_weight(1, 1);
    const int most = static_cast<int>(std::lround(seconds / kTimeStep));
    for (int k = 1; k <= most; ++k) {
      step(events, most, true);
      ++report_.settling_steps;
      if (k % kStepsBetweenLooks == 0) strain_ = gauge_.largest(simulator_->snapshot());
      events.clear();
    }
  }

  /// From now on the garment has this share of its weight, and is so many times as stiff in bending
  /// as it will be.
  void set_weight(double share, double bending) {
    Parameters parameters = simulator_->parameters();
    parameters.gravity = {
        .x = share * gravity_.x, .y = share * gravity_.y, .z = share * gravity_.z};
    parameters.material.bend_scale = bend_scale_ * bending;
    simulator_->set_parameters(parameters);
  }

  void step(const std::vector<InputEvent>& events, int most, bool settling) {
    const StepReport report = simulator_->step(events);
    report_.impacts += report.impacts_first;
    ++steps_;
    if (report.accepted) {
      refusals_ = 0;
    } else {
      // From rest the same step asks for less.
      ++report_.refused_steps;
      scale_velocities(*simulator_, 0);
      if (++refusals_ == kMostRefusals)
        throw InputError("cloth " + in_quotes(report_.garment) + " cannot be put on: step " +
                         std::to_string(steps_) + " of dressing leaves " +
                         std::to_string(report.impacts_left) + " collisions, expected none");
    }
    if (steps_ % kStepsBetweenRests == 0) scale_velocities(*simulator_, 0.5);
    const int done = settling ? report_.settling_steps : report_.closing_steps;
    if (watch_ && !watch_(*simulator_, {report_.garment, settling, done + 1, most, strain_}))
      throw DressingCancelled{};
  }

  const Garment& garment_;
  DressingRoom room_;
  int least_steps_;  ///< until the bodies have grown
  World world_;
  StrainGauge gauge_;
  Holds holds_;
  GravityParameters gravity_;
  double bend_scale_;
  std::unique_ptr<Simulator> simulator_;
  const DressingWatch& watch_;
  DressingReport report_;
  double strain_ = 0;
  int steps_ = 0, refusals_ = 0;
};

}  // namespace

std::vector<std::size_t> dressing_order(const Scene& scene) {
  std::vector<std::size_t> order(scene.garments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t g) { return scene.garments[g].layer; });
  return order;
}

DressingReport dress_garment(Scene& scene, std::size_t garment, std::span<const std::size_t> on,
                             double contraction, const DressingWatch& watch) {
  Dressing dressing(scene, on, garment, contraction, watch);
  DressingReport report = dressing.run();
  dressing.write(scene);
  return report;
}

void settle_refined(Scene& scene, std::span<const std::size_t> on,
                    std::span<DressingReport* const> reports, const DressingWatch& watch) {
  Dressing dressing(scene, on.first(on.size() - 1), on.back(), 0, watch);
  dressing.run_refined(scene, on, reports);
  dressing.write(scene);
}

}  // namespace icloth
