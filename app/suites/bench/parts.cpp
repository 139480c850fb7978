#include "app/suites/bench/parts.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "app/common/headless.h"
#include "sim/scene/scene_io.h"

namespace icloth {
namespace {

/// One part of a scene, and how it is added.
struct Part {
  const char* name;
  std::function<void(Scene&)> add;
};

/// The parts, from a hanging sheet to the whole scene; each is added to all those before it.
std::vector<Part> parts(const Scene& whole) {
  const Obstacle ball = whole.obstacles.at(0);
  const std::vector<Cloth> cloths = whole.cloths;
  return {
      {"one sheet: stretching, gravity, collision detection", [](Scene&) {}},
      {"bending", [](Scene& s) { s.parameters.material.bend_scale = 1; }},
      {"wind", [](Scene& s) { s.parameters.wind.z = 0.5, s.parameters.wind.air_density = 1; }},
      // The body comes in two steps, first at rest and then in motion, and friction with it.
      {"repulsion, without friction", [](Scene& s) { s.parameters.proximity.enabled = true; }},
      {"ball at rest before the sheet",
       [ball](Scene& s) {
         s.obstacles = {ball};
         s.obstacles[0].motion.clear();
         for (Vec3d& p : s.obstacles[0].mesh.positions) p += Vec3d{0, 1.3, -0.4};
       }},
      {"ball moves and pushes the sheet", [ball](Scene& s) { s.obstacles = {ball}; }},
      {"friction",
       [](Scene& s) {
         s.parameters.proximity.friction_cloth = 0.6;
         s.parameters.proximity.friction_obstacle = 0.3;
       }},

      // More layers follow, and at last the friction inside the fabric.
      {"second sheet",
       [cloths](Scene& s) {
         s.cloths = {cloths[2], cloths[1]};
       }},
      {"third sheet", [cloths](Scene& s) { s.cloths = cloths; }},
      {"friction of yarns, like denim's",
       [](Scene& s) {
         for (Cloth& cloth : s.cloths)
           cloth.material.bending_friction = 1e-3, cloth.material.shear_friction = 3;
       }},
  };
}

/// The scene with nothing but one hanging sheet.
Scene bare(const Scene& whole) {
  Scene scene = whole;
  scene.cloths = {whole.cloths.at(2)};
  scene.obstacles.clear();
  Parameters& p = scene.parameters;
  p.material.bend_scale = 0;
  p.proximity.enabled = false;
  p.proximity.friction_cloth = p.proximity.friction_obstacle = 0;
  p.wind.air_density = p.wind.air_drag = 0;
  return scene;
}

}  // namespace

void show_parts(Build build, Report& report) {
  constexpr long kSteps = 80;  // the ball touches the first sheet at step 24
  constexpr int kRounds = 3;
  const std::shared_ptr<const Scene> whole =
      load_scene("sphere", std::vector<std::string>{"triangles=30000", "step.time_step=0.01"});

  report.heading("What each part of a scene costs");
  report.text(
      "The sphere scene with 10,000 triangles a sheet for 0.8 s, from one hanging sheet on; every "
      "row has what the rows above it have. Means over the steps of the fastest of three runs.");
  Table table("parts", "Each part switched on in turn",
              {"with", "ms a step", "change", "proximity", "implicit", "broad phase", "ccd",
               "impact zones", "other", "contacts", "impacts"});

  const std::vector<Part> list = parts(*whole);
  std::vector<RunStatistics> fastest(list.size());

  // The parts are measured in turns, so that a slow hour of the machine slows all rows or none.
  for (int round = 0; round < kRounds; ++round) {
    Scene scene = bare(*whole);
    for (std::size_t k = 0; k < list.size(); ++k) {
      list[k].add(scene);

      // The fastest of several runs counts.
      HeadlessJob job;
      job.scene = std::make_shared<const Scene>(scene);
      job.build = build;
      job.steps = kSteps;
      job.energies = false;
      job.quiet = true;
      RunStatistics now = run_headless(job).statistics;
      if (round == 0 || now.mean("ms_total") < fastest[k].mean("ms_total"))
        fastest[k] = std::move(now);
    }
  }

  // The change is the time against the row above, which has one part less.
  for (std::size_t k = 0; k < list.size(); ++k) {
    const auto value = [&](const char* column) { return fastest[k].mean(column); };
    const auto mean = [&](const char* column) { return format_number(value(column), 3); };
    const double change = k == 0 ? 0 : value("ms_total") - fastest[k - 1].mean("ms_total");
    table.add({list[k].name, mean("ms_total"), k == 0 ? "" : format_number(change, 2),
               mean("ms_proximity"), mean("ms_implicit"), mean("ms_broad_phase"), mean("ms_ccd"),
               mean("ms_impact_zones"), mean("ms_other"), mean("proximity_pairs"),
               mean("impacts_first")});
  }

  report.add(table);
}

}  // namespace icloth
