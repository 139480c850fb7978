// Fabrics, hands and settings.
#include <algorithm>
#include <cmath>
#include <random>

#include "app/suites/stability/case_run.h"
#include "app/suites/stability/cases.h"
#include "app/suites/stability/scenes.h"

namespace icloth::stability {
namespace {

/// A sheet that falls on a ball above a floor.
std::shared_ptr<Scene> sheet_on_ball(const char* name, double size, Index triangles) {
  auto scene = new_scene(name, size * std::sqrt(2.3 / triangles));
  scene->cloths = {lying_sheet(size, triangles, {0.01, 0.112, 0.02})};
  scene->obstacles = {make_body(make_sphere(0.1, 500), {}),
                      make_body(make_plane(3, 3, 0.3), {0, -0.15, 0})};
  scene->obstacles[1].name = "floor";
  return scene;
}

/// Numbers in [0, 1), the same on every machine.
class Dice {
 public:
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * (*this)(); }
  Vec3d point(Vec3d low, Vec3d high) {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return low + Vec3d{x * (high.x - low.x), y * (high.y - low.y), z * (high.z - low.z)};
  }

 private:
  std::mt19937_64 engine_{20181101};
};

/// A grab of a face of the first cloth, at the place where it is now.
InputEvent grab_of_face(const CaseRun& run, const Scene& scene, int handle, Index face) {
  InputEvent grab;
  grab.handle = handle;
  grab.face = face;
  grab.barycentric = {0.2, 0.3, 0.5};

  const std::vector<Vec3d> x = run.positions();
  const Triangle& t = scene.cloths[0].mesh.faces[static_cast<std::size_t>(face)];
  const auto corner = [&](std::size_t k) { return x[static_cast<std::size_t>(t[k])]; };
  grab.target = 0.2 * corner(0) + 0.3 * corner(1) + 0.5 * corner(2);
  return grab;
}

/// A move or a release of a handle.
InputEvent event(InputEvent::Kind kind, int handle, Vec3d target) {
  InputEvent move;
  move.kind = kind;
  move.handle = handle;
  move.target = target;
  return move;
}

/// A hand that holds, waits and goes to random places.
struct Hand {
  int handle = 0;
  bool holds = false;
  double until = 0;  ///< the present hold or pause ends [s]
  Vec3d target, velocity;
};

/// The events of one hand in one step.
void drag(Hand& hand, Dice& dice, const CaseRun& run, const Scene& scene, double time, double dt,
          std::vector<InputEvent>& events) {
  // A hold or a pause is over, so the other one begins.
  if (time >= hand.until) {
    if (hand.holds) events.push_back(event(InputEvent::Kind::release, hand.handle, {}));
    hand.holds = !hand.holds;
    hand.until = time + (hand.holds ? dice.between(0.3, 1.5) : dice.between(0.05, 0.4));

    // A new hold goes from a random face towards a random place.
    if (!hand.holds) return;
    const auto faces = static_cast<double>(scene.cloths[0].mesh.faces.size());
    events.push_back(grab_of_face(run, scene, hand.handle, static_cast<Index>(dice() * faces)));
    hand.target = events.back().target;
    const Vec3d goal = dice.point({-0.35, -0.3, -0.35}, {0.35, 0.4, 0.35});
    hand.velocity = (1 / (hand.until - time)) * (goal - hand.target);
  } else if (hand.holds) {
    hand.target += dt * hand.velocity + dt * dice.point({-1, -1, -1}, {1, 1, 1});
    events.push_back(event(InputEvent::Kind::move, hand.handle, hand.target));
  }
}

}  // namespace

template <int kExponent>
void stiff(CaseRun& run) {
  const double tensile = std::pow(10.0, kExponent);

  // A stiff sheet hangs by two corners while a ball swings into it.
  auto scene = new_scene("stiff sheet, swinging ball", 0.02);
  const GridShape shape = square(0.4, run.brief() ? 200 : 800, false);
  scene->cloths = {make_cloth(shape, {0, 0.2, 0})};
  scene->cloths[0].material = uniform_fabric(tensile, 0.2, 1e-5);
  pin(scene->cloths[0], shape, "top_left");
  pin(scene->cloths[0], shape, "top_right");

  scene->obstacles = {make_body(make_sphere(0.1, 320), {})};
  scene->obstacles[0].motion = {
      {0, {0.02, 0.1, -0.15}, {}}, {0.3, {0.02, 0.1, 0.1}, {}}, {0.6, {0.02, 0.1, -0.15}, {}}};

  // Cloth that the ball's friction carries along is stretched however stiff it is, so there is
  // none.
  scene->parameters.proximity.friction_obstacle = 0;

  run.start(scene);
  run.run_for(run.brief() ? 0.3 : 1.0);
  run.require(run.result().max_strain < (kExponent == 3 ? 0.1 : 0.05),
              "strain below " + std::string(kExponent == 3 ? "10 %" : "5 %"));
}

template void stiff<3>(CaseRun&);
template void stiff<4>(CaseRun&);
template void stiff<5>(CaseRun&);
template void stiff<6>(CaseRun&);

void huge_forces(CaseRun& run) {
  auto scene = sheet_on_ball("huge forces", 0.3, 200);
  run.start(scene);
  run.steps(5);

  // Each huge force acts for one step, after which the simulation has to go on as before.
  run.allow_refusals();
  const Parameters sane = run.simulator().parameters();
  for (const double gravity : {-1e4, -1e9}) {
    Parameters huge = sane;
    huge.gravity.y = gravity;
    run.simulator().set_parameters(huge);
    const StepReport report = run.step();
    run.note(report.accepted ? std::to_string(report.max_speed) + " m/s" : "refused");
    run.simulator().set_parameters(sane);
    run.require(run.steps(run.brief() ? 3 : 10), "the simulation goes on");
  }
}

void jerked_grab(CaseRun& run) {
  // The cloth lies on the ball before the hand comes.
  auto scene = sheet_on_ball("hand at 50 m/s", 0.4, run.brief() ? 200 : 600);
  scene->parameters.grab.max_speed = 50;
  run.start(scene);
  run.run_for(0.2);

  const InputEvent grab = grab_of_face(run, *scene, 1, 3);
  run.step(std::vector{grab});

  // The hand goes to random places at the speed limit, as a jerked mouse does.
  Dice dice;
  Vec3d goal = grab.target, target = goal;
  for (int k = 0; k < (run.brief() ? 30 : 200); ++k) {
    if (k % 4 == 0) goal = dice.point({-0.8, -0.14, -0.8}, {0.8, 0.8, 0.8});
    const Vec3d left = goal - target;
    const double reach = 50 * scene->parameters.step.time_step;
    target = norm(left) > reach ? target + (reach / norm(left)) * left : goal;
    run.step(std::vector{event(InputEvent::Kind::move, 1, target)});
  }
}

void changed_time_step(CaseRun& run) {
  auto scene = sheet_on_ball("changed time step", 0.4, run.brief() ? 200 : 400);
  run.start(scene);

  // The steps differ by up to three orders of magnitude from one to the next.
  constexpr double kSteps[] = {0.01, 1e-4, 0.1, 1e-3, 0.05, 1e-4, 0.02, 0.1, 0.005};
  for (int k = 0; k < (run.brief() ? 18 : 72); ++k) {
    Parameters p = run.simulator().parameters();
    p.step.time_step = kSteps[static_cast<std::size_t>(k) % std::size(kSteps)];
    run.simulator().set_parameters(p);
    run.step();
  }
}

void threads(CaseRun& run) {
  // The same run with one thread and with two.
  std::vector<std::uint64_t> hashes[2];
  for (const int count : {1, 2}) {
    set_thread_count(count);
    run.start(sheet_on_ball("threads", 0.4, 400));
    for (int k = 0; k < (run.brief() ? 30 : 80); ++k)
      hashes[count - 1].push_back(run.step().state_hash);
  }

  set_thread_count(run.settings().threads);
  run.require(hashes[0] == hashes[1], "equal states");
}

void soak(CaseRun& run) {
  auto scene = sheet_on_ball("random dragging", 0.45, run.brief() ? 200 : 500);
  run.start(scene);
  run.check_every(run.brief() ? 1 : 5);

  // Two hands drag at random for the whole time.
  Dice dice;
  Hand hands[2];
  hands[1].handle = 1;
  const double dt = scene->parameters.step.time_step;
  const double duration = run.brief() ? 2 : run.settings().soak_seconds;
  for (long k = 0; k < std::lround(duration / dt); ++k) {
    std::vector<InputEvent> events;
    for (Hand& hand : hands) drag(hand, dice, run, *scene, static_cast<double>(k) * dt, dt, events);
    run.step(events);
  }
}

}  // namespace icloth::stability
