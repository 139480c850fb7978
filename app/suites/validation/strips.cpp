#include "app/suites/validation/strips.h"

#include <cmath>
#include <numbers>

namespace icloth::validation {
namespace {

Index vertices_before(Index row, Index columns) { return row * (columns + 1) + row / 2; }

/// The places of the vertices of a row across the strip, in edges from the left border.
std::vector<double> places(Index row, Index columns) {
  std::vector<double> list;
  if (row % 2 == 0) {
    for (Index i = 0; i <= columns; ++i) list.push_back(i);
  } else {
    list.push_back(0);
    for (Index i = 0; i < columns; ++i) list.push_back(i + 0.5);
    list.push_back(columns);
  }
  return list;
}

}  // namespace

std::shared_ptr<Scene> exact_scene(const char* name) {
  auto scene = std::make_shared<Scene>();
  scene->name = scene->source = name;
  Parameters& p = scene->parameters;

  // Weight and elasticity act alone, and the errors of solving are far below the targets.
  p.wind.air_density = 0;
  p.proximity.enabled = false;
  p.implicit.cg_tolerance = 1e-10;
  p.implicit.cg_max_iterations = 20000;
  p.implicit.newton_iterations = 20;
  p.implicit.newton_tolerance = 1e-10;
  p.step.max_travel = 1e9;
  p.step.max_substep_levels = 0;
  return scene;
}

Material plain_fabric(double tensile, double poisson, double density, double modulus) {
  Material material;
  material.name = "plain";
  material.law = Material::Law::orthotropic;
  material.density = density;
  // The stiffness on Green strain is twice the table. In plane stress k11 = E/(1 − ν²), k12 = ν
  // k11, and k33 = E/(1 + ν), since S_uv = k33 G_uv.
  const double k = tensile / (1 - poisson * poisson);
  for (auto& row : material.stretching)
    row = {k / 2, poisson * k / 2, k / 2, (1 - poisson) * k / 2};

  // A hinge coefficient k_e makes D = k_e/4 on equilateral triangles.
  for (auto& row : material.bending) row.fill(4 * modulus);
  return material;
}

double Strip::edge() const { return 2 / std::numbers::sqrt3 * row_height(); }
double Strip::width() const { return columns * edge(); }

std::vector<Index> Strip::row(Index r) const {
  std::vector<Index> list;
  for (Index v = vertices_before(r, columns); v < vertices_before(r + 1, columns); ++v)
    list.push_back(v);
  return list;
}

Index Strip::vertices() const { return vertices_before(rows + 1, columns); }

Cloth strip_cloth(const Strip& strip, const std::function<Vec3d(double, double)>& place,
                  const Material& material) {
  Cloth cloth;
  cloth.name = "strip";
  cloth.material = material;

  // The vertices are placed row by row, and `place` gives the start shape.
  std::vector<Vec2d> flat;
  for (Index r = 0; r <= strip.rows; ++r)
    for (const double at : places(r, strip.columns))
      flat.push_back({at * strip.edge() - strip.width() / 2, r * strip.row_height()});
  for (const Vec2d p : flat) {
    cloth.mesh.positions.push_back(place(p.x, p.y));
    cloth.rest.push_back({p.x, p.y, 0});
  }

  // The material coordinates are the flat ones.
  const auto add = [&](Index a, Index b, Index c) {
    const auto uv = [&](Index v) { return flat[static_cast<std::size_t>(v)]; };
    cloth.mesh.faces.push_back({a, b, c});
    cloth.mesh.uv.push_back({uv(a), uv(b), uv(c)});
  };

  for (Index r = 0; r < strip.rows; ++r) {
    const Index low = vertices_before(r, strip.columns);
    const Index high = vertices_before(r + 1, strip.columns);
    const bool shifted = r % 2 == 1;  // the lower row
    const Index few = shifted ? high : low, many = shifted ? low : high;

    // Triangles stand on the row of n + 1 vertices, and others on the row of n + 2.
    for (Index i = 0; i < strip.columns; ++i) {
      if (shifted)
        add(few + i + 1, few + i, many + i + 1);
      else
        add(few + i, few + i + 1, many + i + 1);
    }
    for (Index i = 0; i <= strip.columns; ++i) {
      if (shifted)
        add(many + i, many + i + 1, few + i);
      else
        add(many + i + 1, many + i, few + i);
    }
  }
  return cloth;
}

void pin_row(Cloth& cloth, const Strip& strip, Index row) {
  for (const Index v : strip.row(row)) cloth.pins.push_back(v);
}

Vec3d row_mean(const Strip& strip, const std::vector<Vec3d>& positions, Index row) {
  Vec3d sum;
  const std::vector<Index> list = strip.row(row);
  for (const Index v : list) sum += positions[static_cast<std::size_t>(v)];
  return (1.0 / static_cast<double>(list.size())) * sum;
}

std::vector<double> lumped_mass(const Cloth& cloth) {
  // A third of each face's mass goes to each of its corners.
  std::vector<double> mass(cloth.mesh.positions.size());
  for (const Triangle& t : cloth.mesh.faces) {
    const auto at = [&](std::size_t k) { return cloth.rest[static_cast<std::size_t>(t[k])]; };
    const double area = 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
    for (const Index v : t) mass[static_cast<std::size_t>(v)] += cloth.material.density * area / 3;
  }
  return mass;
}

}  // namespace icloth::validation
