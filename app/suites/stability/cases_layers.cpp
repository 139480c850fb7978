// Cloth against itself.
#include <algorithm>
#include <cmath>

#include "app/suites/stability/case_run.h"
#include "app/suites/stability/cases.h"
#include "app/suites/stability/scenes.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/transforms.h"

namespace icloth::stability {
namespace {

/// Two sheets lie side by side in one plane, and the second one flies into the first.
void run_coplanar(CaseRun& run, Vec3d rotation, bool proximity) {
  auto scene = new_scene("two sheets in one plane", 0.03);
  scene->parameters.gravity.y = 0;
  scene->parameters.proximity.enabled = proximity;

  scene->cloths = {lying_sheet(0.2, 100, {}), lying_sheet(0.2, 100, {0.206, 0, 0.011})};

  // The plane is turned, since planes along the axes are special to boxes.
  const Eigen::Matrix3d turn = angle_axis(rotation).toRotationMatrix();
  for (Cloth& cloth : scene->cloths)
    for (Vec3d& p : cloth.mesh.positions) p = from_eigen(turn * to_eigen(p));

  run.start(scene);
  run.throw_cloth(1, from_eigen(-turn.col(0)));
  run.run_for(run.brief() ? 0.1 : 0.3);
}

/// A strip folded to a zigzag of layers `gap` apart, on a box.
Cloth zigzag(Index layers, Index columns, Index rows, double edge, double gap) {
  std::vector<Vec3d> folded, flat;
  std::vector<Triangle> faces;
  const Index total = layers * columns;

  // Vertices go to and fro; the folds lie halfway between the layers that they join.
  for (Index j = 0; j <= rows; ++j)
    for (Index i = 0; i <= total; ++i) {
      const Index layer = std::min(i / columns, layers - 1), in_layer = i - layer * columns;
      const bool back = layer % 2 == 1;
      const double x = edge * (back ? columns - in_layer : in_layer);
      const double half = in_layer == 0 && layer > 0                  ? -0.5
                          : in_layer == columns && layer < layers - 1 ? 0.5
                                                                      : 0;
      folded.push_back({x, gap * (1 + layer + half), -edge * j});
      flat.push_back({edge * i, 0, -edge * j});
    }

  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < total; ++i) {
      const Index a = j * (total + 1) + i, b = a + 1, c = b + total + 1, d = a + total + 1;
      faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
    }

  Cloth cloth = cloth_of(std::move(folded), std::move(faces));
  cloth.rest = std::move(flat);
  return cloth;
}

/// Runs a built-in scene at another size.
void run_built_in(CaseRun& run, const char* name, int triangles, double seconds) {
  const std::vector<std::string> overrides = {"triangles=" + std::to_string(triangles)};
  run.check_every(run.brief() ? 5 : 10);
  run.start(load_scene(name, overrides));
  run.run_for(seconds);
}

}  // namespace

void coplanar_edges(CaseRun& run) {
  for (const bool proximity : {true, false})
    for (const Vec3d rotation : {Vec3d{}, Vec3d{0.4, 0.7, -0.3}})
      run_coplanar(run, rotation, proximity);
}

void folded_flat(CaseRun& run) {
  auto scene = new_scene("zigzag of 6 layers", 0.02);
  const double gap = 1.2 * scene->parameters.impact_zones.offset;
  scene->cloths = {zigzag(6, 8, 8, 0.02, gap)};
  scene->obstacles = {make_body(make_box({0.5, 0.1, 0.5}, 0.1), {0.08, -0.05, -0.08})};
  run.start(scene);
  run.run_for(run.brief() ? 0.2 : 1.0);
}

void twisting(CaseRun& run) {
  run_built_in(run, "twisting", run.brief() ? 1000 : 2000, run.brief() ? 0.5 : 3.5);
}

void funnel(CaseRun& run) {
  run_built_in(run, "funnel", run.brief() ? 1000 : 2000, run.brief() ? 0.5 : 2);
}

void heavy_on_light(CaseRun& run) {
  auto scene = new_scene("20 layers", 0.03);
  const double gap = 1.5 * scene->parameters.proximity.thickness;

  // Light layers lie on each other, a little shifted, with a heavy one on top.
  for (int layer = 0; layer < 20; ++layer) {
    const bool heavy = layer == 19;
    const double shift = 0.002 * (layer % 3);
    scene->cloths.push_back(lying_sheet(0.2, 90, {shift, gap * (layer + 1), -shift}));
    scene->cloths.back().material.density = heavy ? 50 : 0.05;
  }
  scene->obstacles = {make_body(make_box({0.4, 0.1, 0.4}, 0.1), {0, -0.05, 0})};
  run.start(scene);
  run.run_for(run.brief() ? 0.2 : 0.5);
}

void limp_heap(CaseRun& run) {
  auto scene = new_scene("limp sheet on a floor", 0.02);
  scene->parameters.material.bend_scale = 0;
  scene->cloths = {hanging_sheet(0.3, run.brief() ? 300 : 1000, {0, 0.16, 0})};
  scene->obstacles = {make_body(make_plane(0.8, 0.8, 0.1), {})};
  run.start(scene);
  run.throw_cloth(0, {0, 0, 0.3});
  run.run_for(run.brief() ? 0.4 : 1.5);
}

}  // namespace icloth::stability
