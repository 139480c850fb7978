#include "sim/scene/world.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/scene/edge_lengths.h"
#include "sim/scene/half_edges.h"
#include "sim/scene/material_space.h"

namespace icloth {
namespace {

constexpr double kSmallestArea = 1e-12;  // [m²]; below it Dm⁻¹ is noise
using Corners = std::array<Vec2d, 3>;    // material coordinates of a face [m]

std::string element(const Cloth& cloth, const char* kind, std::size_t number) {
  return "cloth " + in_quotes(cloth.name) + ", " + kind + " " + std::to_string(number);
}

const std::vector<Vec3d>& rest_positions(const Cloth& cloth) {
  return cloth.rest.empty() ? cloth.mesh.positions : cloth.rest;
}

double rest_area(const Cloth& cloth, const Triangle& t) {
  const auto& x = rest_positions(cloth);
  return 0.5 * norm(cross(x[at(t[1])] - x[at(t[0])], x[at(t[2])] - x[at(t[0])]));
}

double uv_area(const Corners& u) { return 0.5 * std::fabs(doubled_material_area(u)); }

/// A comparison with NaN is false: what is not finite would slip through every test there is.
void check_finite(const std::string& object, const std::vector<Vec3d>& positions) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3d p = positions[v];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      throw InputError(object + ", vertex " + std::to_string(v) +
                       ": a coordinate is not finite, expected three numbers");
  }
}

void check_cloth(const Cloth& cloth) {
  const std::size_t count = cloth.mesh.positions.size();

  // The arrays have to fit each other before their entries can be looked at.
  if (!cloth.rest.empty() && cloth.rest.size() != count)
    throw InputError("cloth " + in_quotes(cloth.name) + ": the rest shape has " +
                     std::to_string(cloth.rest.size()) + " vertices, expected " +
                     std::to_string(count));
  if (!cloth.mesh.uv.empty() && cloth.mesh.uv.size() != cloth.mesh.faces.size())
    throw InputError("cloth " + in_quotes(cloth.name) + ": uv of " +
                     std::to_string(cloth.mesh.uv.size()) + " faces, expected " +
                     std::to_string(cloth.mesh.faces.size()));
  if (cloth.rest_in_uv && cloth.mesh.uv.empty())
    throw InputError("cloth " + in_quotes(cloth.name) +
                     ": the rest shape is in uv, expected texture coordinates of every face");

  // Positions must be numbers, and indices must refer to vertices.
  check_finite("cloth " + in_quotes(cloth.name), cloth.mesh.positions);
  check_finite("cloth " + in_quotes(cloth.name) + " (rest shape)", cloth.rest);
  for (std::size_t f = 0; f < cloth.mesh.faces.size(); ++f)
    for (Index v : cloth.mesh.faces[f])
      if (v < 0 || at(v) >= count)
        throw InputError(element(cloth, "face", f) + ": vertex " + std::to_string(v) +
                         ", expected 0 to " + std::to_string(count - 1));

  for (Index v : cloth.pins)
    if (v < 0 || at(v) >= count)
      throw InputError("cloth " + in_quotes(cloth.name) + ": pinned vertex " + std::to_string(v) +
                       ", expected 0 to " + std::to_string(count - 1));
}

/// Texture coordinates that are not in metres (the unit square, say) tell the weft direction only.
bool uv_is_metric(const Cloth& cloth) {
  if (cloth.rest_in_uv) return true;
  double flat = 0, rest = 0;
  for (std::size_t f = 0; f < cloth.mesh.uv.size(); ++f) {
    flat += uv_area(cloth.mesh.uv[f]);
    rest += rest_area(cloth, cloth.mesh.faces[f]);
  }
  return flat > rest / 1.5 && flat < rest * 1.5;
}

/// Direction of weft in the plane of a rest triangle, before it is projected and normalized.
Vec3d weft_direction(const Cloth& cloth, std::size_t f, const std::array<Vec3d, 3>& x, Vec3d n) {
  if (!cloth.mesh.uv.empty()) {
    // Weft is the direction in which v stays and u grows.
    const Corners& u = cloth.mesh.uv[f];
    const Vec2d a = u[1] - u[0], b = u[2] - u[0];
    const double det = doubled_material_area(u);
    if (det != 0) return (1 / det) * (b.y * (x[1] - x[0]) - a.y * (x[2] - x[0]));
  }
  // Within 6° of the x axis the projection is mostly noise.
  return std::fabs(n.x) < 0.995 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
}

/// The rest triangle laid flat, weft along the first coordinate.
Corners flattened(const Cloth& cloth, std::size_t f) {
  const Triangle& t = cloth.mesh.faces[f];
  const auto& rest = rest_positions(cloth);
  const std::array<Vec3d, 3> x{rest[at(t[0])], rest[at(t[1])], rest[at(t[2])]};
  const Vec3d n = normalized(cross(x[1] - x[0], x[2] - x[0]));
  const Vec3d weft = weft_direction(cloth, f, x, n);
  const Vec3d u = normalized(weft - dot(weft, n) * n), v = cross(n, u);
  const auto flat = [&](Vec3d p) { return Vec2d{dot(p - x[0], u), dot(p - x[0], v)}; };
  return {flat(x[0]), flat(x[1]), flat(x[2])};
}

/// Material coordinates of every face of a cloth.
std::vector<Corners> material_corners(const Cloth& cloth) {
  if (uv_is_metric(cloth)) return cloth.mesh.uv;
  std::vector<Corners> corners(cloth.mesh.faces.size());
  for (std::size_t f = 0; f < corners.size(); ++f) corners[f] = flattened(cloth, f);
  return corners;
}

/// Signed dihedral angle of the rest shape; hinge roles as in world.h.
double rest_angle(const std::vector<Vec3d>& x, const std::array<Index, 4>& v) {
  const Vec3d edge = x[at(v[1])] - x[at(v[0])];
  const Vec3d n0 = normalized(cross(edge, x[at(v[2])] - x[at(v[0])]));
  const Vec3d n1 = normalized(cross(x[at(v[3])] - x[at(v[0])], edge));
  return std::atan2(dot(normalized(edge), cross(n0, n1)), dot(n0, n1));
}

void append_object(World& world, const std::string& name, bool cloth, std::size_t source,
                   const TriangleMesh& mesh, const std::vector<Vec3d>& positions,
                   std::optional<double> friction) {
  WorldObject object{name,
                     cloth,
                     static_cast<Index>(source),
                     world.vertices,
                     static_cast<Index>(positions.size()),
                     world.faces,
                     static_cast<Index>(mesh.faces.size()),
                     friction};
  world.position.insert(world.position.end(), positions.begin(), positions.end());
  world.object.resize(world.position.size(), static_cast<Index>(world.objects.size()));
  for (const Triangle& t : mesh.faces)
    world.face.push_back(
        {t[0] + object.first_vertex, t[1] + object.first_vertex, t[2] + object.first_vertex});
  world.vertices += object.vertex_count;
  world.faces += object.face_count;
  world.objects.push_back(std::move(object));
}

/// Where the vertices of a cloth lie at rest: in space, or flat in the pattern.
void append_rest_places(World& world, const Cloth& cloth) {
  if (!cloth.rest_in_uv) {
    const auto& rest = rest_positions(cloth);
    world.rest.insert(world.rest.end(), rest.begin(), rest.end());
    return;
  }

  // A vertex on a seam lies at several places, of which the last one stands here; distances at rest
  // are not taken from it (RestDistances).
  std::vector<Vec3d> flat(cloth.mesh.positions.size());
  for (std::size_t f = 0; f < cloth.mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c)
      flat[at(cloth.mesh.faces[f][c])] = {cloth.mesh.uv[f][c].x, cloth.mesh.uv[f][c].y, 0};
  world.rest.insert(world.rest.end(), flat.begin(), flat.end());
}

/// Areas, masses and material frames of a cloth that was appended last.
void append_rest_state(World& world, const Cloth& cloth, const std::vector<Corners>& corners) {
  const WorldObject& object = world.objects.back();
  append_rest_places(world, cloth);

  // Vertices gather their shares from the faces around them.
  world.area.resize(at(world.vertices), 0.0);
  world.mass.resize(at(world.vertices), 0.0);
  world.pinned.resize(at(world.vertices), 0);

  // The inverse of the edge matrix Dm exists only where a face has an area, in its material space
  // and in space.
  for (std::size_t f = 0; f < corners.size(); ++f) {
    const Vec2d a = corners[f][1] - corners[f][0], b = corners[f][2] - corners[f][0];
    const double det = doubled_material_area(corners[f]), area = 0.5 * std::fabs(det);
    const bool in_space =
        cloth.rest_in_uv || rest_area(cloth, cloth.mesh.faces[f]) >= kSmallestArea;
    if (!(area >= kSmallestArea && in_space))
      throw InputError(element(cloth, "face", f) + ": rest area " + number_text(area) +
                       " m², expected more than 1e-12");
    world.face_area.push_back(area);
    world.face_inverse.push_back({b.y / det, -b.x / det, -a.y / det, a.x / det});
    world.face_material.push_back(object.source);
    for (Index v : cloth.mesh.faces[f]) world.area[at(object.first_vertex + v)] += area / 3;
  }

  // A vertex without mass could not be accelerated, so it is refused here rather than in a step.
  for (Index v = 0; v < object.vertex_count; ++v) {
    const std::size_t i = at(object.first_vertex + v);
    world.mass[i] = cloth.material.density * world.area[i];
    if (!(world.mass[i] > 0 && std::isfinite(world.mass[i])))
      throw InputError(element(cloth, "vertex", at(v)) +
                       (world.area[i] > 0 ? ": density must be above 0"
                                          : ": used by no face, expected at least one"));
  }

  for (Index v : cloth.pins) world.pinned[at(object.first_vertex + v)] = 1;
}

/// Hinge between two faces of one edge; `first` gives the direction of the edge.
Hinge make_hinge(const World& world, const WorldObject& object, const std::vector<Corners>& corners,
                 bool has_uv, bool flat, const HalfEdge& first, const HalfEdge& second) {
  const Triangle& face0 = world.face[at(first.face)];
  const Triangle& face1 = world.face[at(second.face)];
  const Corners& u0 = corners[at(first.face - object.first_face)];
  const Corners& u1 = corners[at(second.face - object.first_face)];
  const std::size_t i = at(first.corner), j = at(second.corner);

  // Both faces bring their vertices; the first one also gives the direction of the edge.
  Hinge hinge;
  hinge.vertices = {face0[i], face0[(i + 1) % 3], face0[(i + 2) % 3], face1[(j + 2) % 3]};
  hinge.face0 = first.face;
  hinge.face1 = second.face;

  // Lengths and directions are those in the material space of the first face.
  const Vec2d edge = u0[(i + 1) % 3] - u0[i];
  hinge.rest_length = std::hypot(edge.x, edge.y);
  hinge.direction = std::atan2(std::fabs(edge.y), std::fabs(edge.x));
  hinge.rest_area = world.face_area[at(first.face)] + world.face_area[at(second.face)];

  // A seam joins two places of the pattern: its flaps were never one flat piece, and the fold of
  // the given shape is not a rest shape of theirs.
  const bool seam = has_uv && !joined_in_material(u0, i, u1, j, face1[j] == face0[i]);
  hinge.rest_angle = seam || flat ? 0.0 : rest_angle(world.rest, hinge.vertices);
  return hinge;
}

/// Length at rest of an edge, given by the sides of its faces; those of a gathered seam differ, and
/// count with their mean.
double rest_length(const World& world, const WorldObject& object, const Cloth& cloth,
                   std::span<const HalfEdge> sides) {
  if (!cloth.rest_in_uv)
    return norm(world.rest[at(sides[0].edge[1])] - world.rest[at(sides[0].edge[0])]);

  double sum = 0;
  for (const HalfEdge& side : sides) {
    const Corners& u = cloth.mesh.uv[at(side.face - object.first_face)];
    const Vec2d edge = u[at((side.corner + 1) % 3)] - u[at(side.corner)];
    sum += std::hypot(edge.x, edge.y);
  }
  return sum / static_cast<double>(sides.size());
}

/// Edges of an object; for a cloth also its hinges, one for every two faces of an edge, and the
/// lengths at rest of its edges.
void append_edges(World& world, const WorldObject& object, const Cloth* cloth,
                  const std::vector<Corners>& corners, std::vector<double>& lengths) {
  const std::span<const Triangle> faces(world.face);
  const std::vector<HalfEdge> half_edges = sorted_half_edges(
      faces.subspan(at(object.first_face), at(object.face_count)), object.first_face);
  const bool metric_uv = cloth && uv_is_metric(*cloth);
  const bool flat = cloth && (cloth->flat_angles || cloth->rest_in_uv);
  for (std::size_t begin = 0, end = 0; begin < half_edges.size(); begin = end) {
    while (end < half_edges.size() && half_edges[end].edge == half_edges[begin].edge) ++end;
    world.edge.push_back(half_edges[begin].edge);
    if (!cloth) continue;

    if (end - begin > kMostFacesOnEdge)
      throw InputError("cloth '" + cloth->name + "', edge between vertices " +
                       std::to_string(half_edges[begin].edge[0] - object.first_vertex) + " and " +
                       std::to_string(half_edges[begin].edge[1] - object.first_vertex) + ": " +
                       std::to_string(end - begin) + " faces, expected at most " +
                       std::to_string(kMostFacesOnEdge));

    const std::span<const HalfEdge> sides(half_edges.data() + begin, end - begin);
    lengths.push_back(rest_length(world, object, *cloth, sides));

    // Every two faces of an edge bend against each other. The weights of all pairs that one face
    // belongs to sum up to 1.
    double area = 0;
    for (std::size_t i = begin; i < end; ++i) {
      area += world.face_area[at(half_edges[i].face)];
      for (std::size_t j = i + 1; j < end; ++j) {
        world.hinges.push_back(
            make_hinge(world, object, corners, metric_uv, flat, half_edges[i], half_edges[j]));
        world.hinges.back().weight = 1.0 / static_cast<double>(end - begin - 1);
      }
    }
    world.edge_area.push_back(area / 3);
  }
  world.edges = static_cast<Index>(world.edge.size());
}

/// Distances at rest of all cloths, where any of them is sewn of panels; a scene without has none.
void append_rest_distances(World& world, const Scene& scene) {
  const auto sewn = [](const Cloth& cloth) { return cloth.rest_in_uv; };
  if (std::ranges::none_of(scene.cloths, sewn)) return;
  RestDistances& all = world.rest_distances;
  Index panels = 0;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    const auto vertices = cloth.mesh.positions.size();
    const auto before = static_cast<Index>(all.distances.size());

    // A cloth that is at rest in space counts as one panel.
    if (!sewn(cloth)) {
      all.panel.resize(all.panel.size() + vertices, panels++);
      all.first.resize(all.first.size() + vertices, before);
      continue;
    }

    // Numbers of panels, places in the list and vertices go on from those of the cloths before.
    const RestDistances own = rest_distances(cloth.mesh.faces, vertices, cloth.mesh.uv);
    const Index first_vertex = world.objects[c].first_vertex, first_panel = panels;
    for (Index panel : own.panel) {
      all.panel.push_back(panel == kNone ? kNone : first_panel + panel);
      panels = std::max(panels, all.panel.back() + 1);
    }
    for (std::size_t v = 0; v < vertices; ++v) all.first.push_back(before + own.first[v]);
    for (const RestDistance& d : own.distances)
      all.distances.push_back({first_vertex + d.vertex, d.squared});
  }
  all.first.push_back(static_cast<Index>(all.distances.size()));
}

}  // namespace

void add_rest_lengths(const Cloth& cloth, std::vector<double>& lengths) {
  if (!cloth.rest_in_uv) return add_side_lengths(cloth.mesh.faces, rest_positions(cloth), lengths);
  for (const Corners& u : cloth.mesh.uv)
    for (std::size_t c = 0; c < 3; ++c)
      lengths.push_back(std::hypot(u[(c + 1) % 3].x - u[c].x, u[(c + 1) % 3].y - u[c].y));
}

World make_world(const Scene& scene) {
  // Cloths come first, so that their elements have the same numbers with and without obstacles.
  World world;
  std::vector<double> lengths;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    check_cloth(cloth);
    const std::vector<Corners> corners = material_corners(cloth);
    append_object(world, cloth.name, true, c, cloth.mesh, cloth.mesh.positions, cloth.friction);
    append_rest_state(world, cloth, corners);
    append_edges(world, world.objects.back(), &cloth, corners, lengths);
  }

  world.cloth_vertices = world.vertices;
  world.cloth_edges = world.edges;
  world.cloth_faces = world.faces;

  // Obstacles start where they are at time 0, which may differ from their mesh.
  std::vector<Vec3d> pose;
  for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
    const Obstacle& obstacle = scene.obstacles[o];
    obstacle.pose(0.0, pose);
    check_finite("obstacle " + in_quotes(obstacle.name), pose);
    append_object(world, obstacle.name, false, o, obstacle.mesh, pose, obstacle.friction);
    append_edges(world, world.objects.back(), nullptr, {}, lengths);
  }
  append_rest_distances(world, scene);
  world.median_edge = median(std::move(lengths));
  return world;
}

}  // namespace icloth
