// Start states and input that are at the limit of what can be simulated, or beyond it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/suites/stability/case_run.h"
#include "app/suites/stability/cases.h"
#include "app/suites/stability/scenes.h"
#include "sim/files/error.h"
#include "sim/scene/intersections.h"

namespace icloth::stability {
namespace {

/// The number of pairs that intersect at the start.
std::size_t start_pairs(const Scene& scene, const CaseRun& run) {
  return find_start_intersections(scene, run.settings().build != Build::cpu64).size();
}

/// The height of the highest of the first `count` points.
double highest(const std::vector<Vec3d>& points, std::size_t count) {
  double y = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) y = std::max(y, points[i].y);
  return y;
}

/// The mean height of the vertices of the first cloth.
double mean_height(const std::vector<Vec3d>& points, const Scene& scene) {
  const std::size_t count = scene.cloths[0].mesh.positions.size();
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += points[i].y;
  return sum / static_cast<double>(count);
}

std::string millimetres(double length) { return std::to_string(1e3 * length) + " mm"; }

}  // namespace

void start_intersection(CaseRun& run) {
  // Cloth goes through cloth.
  auto sheets = new_scene("crossing sheets", 0.03);
  sheets->cloths = {lying_sheet(0.3, 200, {}), hanging_sheet(0.3, 200, {0.01, 0.013, 0.007})};
  const std::size_t cloth = start_pairs(*sheets, run);
  run.require(cloth > 0, "crossing sheets are found");

  // Cloth goes through a body.
  auto ball = new_scene("sheet through a ball", 0.03);
  ball->cloths = {lying_sheet(0.3, 200, {})};
  ball->obstacles = {make_body(make_sphere(0.1, 320), {0, 0.03, 0})};
  const std::size_t body = start_pairs(*ball, run);
  run.require(body > 0, "a sheet through a ball is found");

  run.note(std::to_string(cloth) + " and " + std::to_string(body) + " pairs");
}

void start_below_offset(CaseRun& run) {
  // The layers are closer than the offset that impact zones keep.
  auto scene = new_scene("close sheets", 0.03);
  Parameters& p = scene->parameters;
  const double gap = 0.1 * p.impact_zones.offset;
  scene->cloths = {lying_sheet(0.3, 200, {}), lying_sheet(0.3, 200, {0.002, gap, 0.001}),
                   lying_sheet(0.3, 200, {0, 2 * gap, 0})};
  scene->obstacles = {make_body(make_box({0.5, 0.1, 0.5}, 0.1), {0, -0.05 - gap, 0})};

  run.start(scene);
  run.run_for(run.brief() ? 0.2 : 0.5);

  // The top has the height of three layers, and has not jumped.
  const double top = highest(run.positions(), 3 * scene->cloths[0].mesh.positions.size());
  run.require(top < 4 * p.proximity.thickness + 0.01, "the sheets stay on each other");
  run.note("gap " + millimetres(gap) + ", ends " + millimetres(top) + " high");

  auto touching = new_scene("coincident sheets", 0.03);
  touching->cloths = {lying_sheet(0.3, 200, {}), lying_sheet(0.3, 200, {})};
  run.require(start_pairs(*touching, run) > 0, "coincident sheets have no sides and are refused");
}

void start_inside_a_body(CaseRun& run) {
  auto scene = new_scene("sheet in a ball", 0.02);
  scene->cloths = {lying_sheet(0.2, 200, {})};
  scene->obstacles = {make_body(make_sphere(0.2, 720), {})};
  run.start(scene);
  run.run_for(run.brief() ? 0.3 : 1.0);

  double farthest = 0;
  const std::vector<Vec3d> x = run.positions();
  for (std::size_t i = 0; i < scene->cloths[0].mesh.positions.size(); ++i)
    farthest = std::max(farthest, norm(x[i]));
  run.require(farthest < 0.2, "the cloth stays inside");
}

void thin_gap(CaseRun& run) {
  // The gap is far below the thickness, which is far above the offset.
  auto scene = new_scene("sheet close over a box", 0.03);
  Parameters& p = scene->parameters;
  p.proximity.thickness = 8e-3;
  p.impact_zones.offset = 1e-4;
  const double gap = 2e-4;
  scene->cloths = {lying_sheet(0.3, 200, {0, gap, 0})};
  scene->obstacles = {make_body(make_box({0.5, 0.1, 0.5}, 0.05), {0, -0.05, 0})};

  run.start(scene);

  // The repulsion may lift the sheet by the thickness, but must not throw it.
  double top = 0, speed = 0;
  for (int k = 0; k < (run.brief() ? 30 : 100); ++k) {
    speed = std::max(speed, run.step().max_speed);
    top = std::max(top, highest(run.positions(), scene->cloths[0].mesh.positions.size()));
  }

  run.require(top < 2 * p.proximity.thickness,
              "the sheet is not thrown higher than twice the thickness");
  run.note("rises to " + millimetres(top) + ", " + std::to_string(speed) + " m/s");
}

void pinned_inside_a_body(CaseRun& run) {
  const GridShape shape = square(0.3, 200, true);
  auto crossing = new_scene("pinned inside a box", 0.03);
  crossing->cloths = {make_cloth(shape, {0, 0, 0})};
  pin(crossing->cloths[0], shape, "left");
  crossing->obstacles = {make_body(make_box({0.1, 0.1, 0.5}, 0.05), {-0.15, 0, 0})};
  run.require(start_pairs(*crossing, run) > 0, "a sheet pinned inside a box is refused");

  auto touching = new_scene("pinned close to a box", 0.03);
  touching->cloths = {make_cloth(shape, {0, 0, 0})};
  pin(touching->cloths[0], shape, "left");
  const double gap = 0.2 * touching->parameters.impact_zones.offset;
  touching->obstacles = {make_body(make_box({0.1, 0.1, 0.5}, 0.05), {-0.15, -0.05 - gap, 0})};
  run.start(touching);
  run.run_for(run.brief() ? 0.3 : 1.0);
}

void huge_coordinates(CaseRun& run) {
  // The same scene moves away from the origin, until single precision cannot hold it.
  double at_origin = 0;
  for (const double far : {0.0, 10.0, 100.0, 1e3, 1e4, 1e6}) {
    const Vec3d place{far, far, far};
    auto scene = new_scene("far from the origin", 0.03);
    scene->cloths = {lying_sheet(0.3, 200, place + Vec3d{0, 0.11, 0})};
    scene->obstacles = {make_body(make_sphere(0.1, 320), place)};
    const std::string where = " at " + std::to_string(std::lround(far)) + " m";

    // Either it is refused …
    try {
      make_simulator(run.settings().build, scene);
    } catch (const InputError&) {
      run.note("refused" + where);
      continue;
    }

    // … or it must come to rest as it does at the origin.
    run.start(scene);
    run.run_for(run.brief() ? 0.2 : 0.5);
    const double height = mean_height(run.positions(), *scene) - far;
    if (far == 0) at_origin = height;
    run.require(std::fabs(height - at_origin) < 0.01, "rests as at the origin" + where);
  }
}

void not_finite(CaseRun& run) {
  // One vertex of a cloth or a body is broken.
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto broken = [](double value, bool obstacle) {
    auto scene = new_scene("broken", 0.03);
    scene->cloths = {lying_sheet(0.3, 200, {0, 0.11, 0})};
    scene->obstacles = {make_body(make_sphere(0.1, 320), {})};
    (obstacle ? scene->obstacles[0].mesh : scene->cloths[0].mesh).positions[7].y = value;
    return scene;
  };

  for (const double value : {kNan, std::numeric_limits<double>::infinity()})
    for (const bool obstacle : {false, true})
      run.require_input_error(
          [&] { make_simulator(run.settings().build, broken(value, obstacle)); },
          {"vertex 7", "finite"});

  // A parameter that becomes NaN makes the step be refused, and nothing more.
  run.start(broken(0.11, false));
  run.steps(5);

  const Parameters sane = run.simulator().parameters();
  Parameters wrong = sane;
  wrong.gravity.y = kNan;
  run.allow_refusals();
  run.simulator().set_parameters(wrong);
  const StepReport refused = run.step();
  run.require(!refused.accepted && !refused.finite, "NaN gravity is refused");

  run.simulator().set_parameters(sane);
  run.require(run.steps(run.brief() ? 10 : 30), "the simulation goes on after NaN gravity");
}

}  // namespace icloth::stability
