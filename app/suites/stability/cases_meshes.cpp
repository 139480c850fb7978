// Meshes that a file can hold and that no weaver would make.
#include <cmath>

#include "app/suites/stability/case_run.h"
#include "app/suites/stability/cases.h"
#include "app/suites/stability/scenes.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/intersections.h"

namespace icloth::stability {
namespace {

/// A rectangle in the xz plane of columns × rows cells, each cut by a diagonal.
Cloth strip_mesh(Vec3d corner, double width, double depth, Index columns, Index rows) {
  std::vector<Vec3d> positions;
  std::vector<Triangle> faces;
  for (Index j = 0; j <= rows; ++j)
    for (Index i = 0; i <= columns; ++i)
      positions.push_back(corner + Vec3d{width * i / columns, 0, -depth * j / rows});
  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < columns; ++i) {
      const Index a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = a + columns + 1;
      faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
    }
  return cloth_of(std::move(positions), std::move(faces));
}

}  // namespace

void slivers(CaseRun& run) {
  // Cells 30 mm wide and 0.03 mm deep lie between ordinary ones: their aspect is 1000, their area
  // 5e-7 m².
  auto scene = new_scene("slivers", 0.03);
  Cloth cloth = strip_mesh({-0.15, 0.11, 0.15}, 0.3, 0.3, 10, 11);
  for (Vec3d& p : cloth.mesh.positions) {
    const auto row = std::lround((0.15 - p.z) / 0.3 * 11);
    p.z = row <= 5 ? 0.15 - 0.03 * static_cast<double>(row)
                   : -0.03e-3 - 0.03 * static_cast<double>(row - 6);
  }
  cloth.rest = cloth.mesh.positions;
  scene->cloths = {cloth};
  scene->obstacles = {make_body(make_sphere(0.1, 320), {})};
  run.start(scene);
  run.run_for(run.brief() ? 0.2 : 1.0);

  // Below 1e-12 m² there is nothing to compute a strain from.
  auto thin = new_scene("area below 1e-12", 0.03);
  thin->cloths = {cloth_of({{0, 0, 0}, {1e-6, 0, 0}, {0, 1e-7, 0}, {1, 1, 0}},
                           {{0, 1, 3}, {0, 1, 2}, {1, 3, 2}})};
  run.require_input_error([&] { make_simulator(run.settings().build, thin); }, {"face 1", "area"});
}

void bad_vertices(CaseRun& run) {
  const std::vector<Vec3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

  const auto refused = [&](std::vector<Vec3d> x, std::vector<Triangle> faces, const char* element,
                           const char* in_file) {
    auto scene = new_scene("bad vertices", 0.03);
    scene->cloths = {cloth_of(std::move(x), std::move(faces))};
    run.require_input_error([&] { make_simulator(run.settings().build, scene); }, {element});
    if (in_file)
      run.require_input_error([&] { check_cloth_mesh(scene->cloths[0].mesh, "mesh"); }, {in_file});
  };

  // Each mesh has one fault, which the message must name. Where a file is read, a vertex without a
  // face is left out when the mesh is made a cloth.
  refused(square, {{0, 1, 2}}, "vertex 3", nullptr);
  refused(square, {{0, 1, 2}, {0, 2, 2}, {0, 2, 3}}, "face 1", "triangle");
  refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 3}, {0, 1, 2}}, "face 1",
          "triangle");

  // A vertex that is given twice leaves a slit whose sides touch.
  auto twice = new_scene("vertex given twice", 0.03);
  std::vector<Vec3d> x = square;
  x.insert(x.end(), {square[0], square[2]});
  twice->cloths = {cloth_of(x, {{0, 1, 2}, {4, 5, 3}})};
  run.require(!find_start_intersections(*twice, true).empty(),
              "touching sides of a slit are refused");
}

void non_manifold(CaseRun& run) {
  // Three leaves share their middle edges, as in a book.
  auto scene = new_scene("three leaves", 0.03);

  Cloth book = strip_mesh({-0.15, 0.12, 0.15}, 0.3, 0.3, 10, 10);

  const auto first = static_cast<Index>(book.mesh.positions.size());
  for (Index j = 0; j <= 10; ++j)
    for (Index i = 1; i <= 5; ++i)
      book.mesh.positions.push_back({0.002 * i, 0.12 + 0.03 * i, 0.15 - 0.03 * j});

  const auto leaf = [&](Index i, Index j) { return i == 0 ? j * 11 + 5 : first + j * 5 + i - 1; };
  for (Index j = 0; j < 10; ++j)
    for (Index i = 0; i < 5; ++i) {
      const Index a = leaf(i, j), b = leaf(i + 1, j), c = leaf(i + 1, j + 1), d = leaf(i, j + 1);
      book.mesh.faces.insert(book.mesh.faces.end(), {{a, b, c}, {a, c, d}});
    }

  book.rest = book.mesh.positions;

  // The book falls open on a ball.
  scene->cloths = {book};
  scene->obstacles = {make_body(make_sphere(0.1, 320), {})};
  run.start(scene);
  run.run_for(run.brief() ? 0.2 : 1.0);
}

void t_junction(CaseRun& run) {
  // Vertex 4 lies on the edge 0 1 of the first face, which does not know of it.
  auto scene = new_scene("T-junction", 0.03);
  scene->cloths = {
      cloth_of({{0, 0, 0}, {1, 0, 0}, {0.5, 0, -1}, {0.2, 0, 1}, {0.5, 0, 0}, {0.9, 0, 1}},
               {{0, 1, 2}, {3, 5, 4}})};
  run.require(!find_start_intersections(*scene, true).empty(), "a vertex on an edge is refused");
}

void seam(CaseRun& run) {
  // The pattern of the tube is a rectangle: material coordinates jump by its width at the seam.
  auto scene = new_scene("tube with a seam", 0.02);
  Cloth tube = make_tube(0.1, 0.1, 0.3, run.brief() ? 300 : 1000);
  scene->cloths = {tube};
  run.start(scene);
  run.run_for(run.brief() ? 0.2 : 1.0);
  run.require(run.result().max_strain < 0.3, "the tube does not stretch at its seam");
}

}  // namespace icloth::stability
