#include "app/suites/stability/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scene/material_io.h"

namespace icloth::stability {
std::shared_ptr<Scene> new_scene(const char* name, double edge) {
  auto scene = std::make_shared<Scene>();
  scene->name = scene->source = name;
  scene->parameters.wind.air_density = 0;
  scene->parameters.proximity.thickness = std::min(2e-3, 0.2 * edge);
  scene->parameters.impact_zones.offset = 0.1 * scene->parameters.proximity.thickness;
  return scene;
}

GridShape square(double size, Index triangles, bool lying) {
  GridShape shape;
  shape.width = shape.height = size;
  shape.triangles = triangles;
  shape.horizontal = lying;
  return shape;
}

Cloth make_cloth(const GridShape& shape, Vec3d centre) {
  GridMesh grid = make_grid(shape);
  Cloth cloth;
  cloth.name = "sheet";
  cloth.mesh = std::move(grid.mesh);
  for (Vec3d& p : cloth.mesh.positions) p += centre;
  cloth.rest = std::move(grid.rest);
  cloth.material = load_material("default", "");
  return cloth;
}

Cloth lying_sheet(double size, Index triangles, Vec3d centre) {
  return make_cloth(square(size, triangles, true), centre);
}

Cloth hanging_sheet(double size, Index triangles, Vec3d centre) {
  return make_cloth(square(size, triangles, false), centre);
}

void pin(Cloth& cloth, const GridShape& shape, const char* name) {
  const std::vector<Index> pins = grid_vertices(make_grid(shape), name);
  cloth.pins.insert(cloth.pins.end(), pins.begin(), pins.end());
}

Cloth make_tube(double top, double bottom, double length, Index triangles) {
  // The columns and rows make triangles that are nearly equilateral.
  const double around = std::numbers::pi * (top + bottom);
  const double edge = std::sqrt(4 / std::numbers::sqrt3 * around * length / triangles);
  const auto columns = static_cast<Index>(std::max(6.0, std::round(around / edge)));
  const auto rows =
      static_cast<Index>(std::max(1.0, std::round(length / (edge * std::numbers::sqrt3 / 2))));

  Cloth cloth;
  cloth.name = "tube";
  const auto flat = [&](double turn, Index row) {
    return Vec2d{turn * around, -length * row / rows};
  };

  // Every second ring of vertices is turned by half a column, and the first ring is pinned.
  for (Index row = 0; row <= rows; ++row) {
    const double s = static_cast<double>(row) / rows, radius = top + s * (bottom - top);
    for (Index i = 0; i < columns; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (row % 2)) / columns;
      cloth.mesh.positions.push_back(
          {radius * std::cos(angle), -length * s, radius * std::sin(angle)});
    }
    if (row == 0)
      for (Index i = 0; i < columns; ++i) cloth.pins.push_back(i);
  }

  // Every vertex of a row has two triangles, whose material coordinates do not wrap round.
  for (Index row = 0; row < rows; ++row) {
    const Index upper = row * columns, lower = upper + columns, odd = row % 2;
    for (Index i = 0; i < columns; ++i) {
      const Index next = (i + 1) % columns;
      const auto uv = [&](double column, Index r) { return flat(column / columns, r); };
      const double a = i + 0.5 * odd, b = i + 0.5 * (1 - odd);

      // The two kinds of rows are turned against each other.
      if (odd == 0) {
        cloth.mesh.faces.push_back({upper + i, upper + next, lower + i});
        cloth.mesh.uv.push_back({uv(a, row), uv(a + 1, row), uv(b, row + 1)});
        cloth.mesh.faces.push_back({upper + next, lower + next, lower + i});
        cloth.mesh.uv.push_back({uv(a + 1, row), uv(b + 1, row + 1), uv(b, row + 1)});
      } else {
        cloth.mesh.faces.push_back({upper + i, lower + next, lower + i});
        cloth.mesh.uv.push_back({uv(a, row), uv(b + 1, row + 1), uv(b, row + 1)});
        cloth.mesh.faces.push_back({upper + i, upper + next, lower + next});
        cloth.mesh.uv.push_back({uv(a, row), uv(a + 1, row), uv(b + 1, row + 1)});
      }
    }
  }

  // A cone is no rectangle, so each of its triangles is laid flat by itself.
  if (top != bottom) cloth.mesh.uv.clear();
  cloth.rest = cloth.mesh.positions;
  cloth.material = load_material("default", "");
  return cloth;
}

Cloth cloth_of(std::vector<Vec3d> positions, std::vector<Triangle> faces) {
  Cloth cloth;
  cloth.name = "mesh";
  cloth.mesh.positions = std::move(positions);
  cloth.mesh.faces = std::move(faces);
  cloth.rest = cloth.mesh.positions;
  cloth.material = load_material("default", "");
  return cloth;
}

Material uniform_fabric(double tensile, double density, double bending) {
  Material material;
  material.name = "uniform";
  material.law = Material::Law::orthotropic;
  material.density = density;
  // The stiffness on Green strain is twice the table: E = k11 (1 − ν²) with ν = 0.25.
  const double k = tensile / (1 - 0.25 * 0.25);
  for (auto& row : material.stretching) row = {k / 2, 0.25 * k / 2, k / 2, 0.75 * k / 2};
  for (auto& row : material.bending) row.fill(bending);
  return material;
}

Obstacle make_body(TriangleMesh mesh, Vec3d centre) {
  Obstacle obstacle;
  obstacle.name = "body";
  for (Vec3d& p : mesh.positions) p += centre;
  obstacle.mesh = std::move(mesh);
  return obstacle;
}

TriangleMesh make_spike(double radius, double length, Index sides) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, -length, 0}};

  for (Index i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    mesh.positions.push_back({radius * std::cos(angle), -length, -radius * std::sin(angle)});
  }

  for (Index i = 0; i < sides; ++i) {
    const Index a = 2 + i, b = 2 + (i + 1) % sides;
    mesh.faces.push_back({0, a, b});
    mesh.faces.push_back({1, b, a});
  }
  return mesh;
}

}  // namespace icloth::stability
