// Cloths and obstacles of a scene file.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/assets.h"
#include "sim/body_io.h"
#include "sim/error.h"
#include "sim/material_io.h"
#include "sim/mesh_io.h"
#include "sim/rotation.h"
#include "sim/scene_json.h"

namespace icloth {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Index kDefaultTriangles = 2000;
constexpr int kMaxSubdivisions = 6;
constexpr double kMaxCells = 4e6;  ///< of a box, a plane or a funnel
const NumberRange kSize{1e-6, 1e6};

/// Rotation vector of a rotation matrix; near half a turn the axis comes from the symmetric part.
Vec3d rotation_vector(const Mat3<double>& r) {
  const Vec3d twice_axis{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
  const double sine = norm(twice_axis) / 2, cosine = (r(0, 0) + r(1, 1) + r(2, 2) - 1) / 2;
  const double angle = std::atan2(sine, cosine);
  if (sine > 1e-6) return angle * normalized(twice_axis);
  if (cosine > 0) return 0.5 * twice_axis;
  int k = 0;
  for (int i = 1; i < 3; ++i)
    if (r(i, i) > r(k, k)) k = i;
  return angle * normalized(Vec3d{r(0, k) + (k == 0), r(1, k) + (k == 1), r(2, k) + (k == 2)});
}

void no_such_feature(JsonObject& object, std::string_view key, const std::string& instead) {
  if (object.has(key)) object[key].refuse("no such key: not supported yet, " + instead);
}

// --- shapes ---------------------------------------------------------------------------------

GridShape parse_grid(const JsonValue& value, double triangles) {
  JsonObject object(value);
  GridShape shape;
  const std::vector<double> size = object.required("size").numbers(2, kSize);
  shape.width = size[0];
  shape.height = size[1];
  shape.triangles = static_cast<Index>(std::clamp<double>(std::round(triangles), 2, kMaxTriangles));
  const std::string orientation = object.text("orientation", "vertical");
  if (orientation != "vertical" && orientation != "horizontal")
    object["orientation"].refuse("\"vertical\" or \"horizontal\"");
  shape.horizontal = orientation == "horizontal";
  if (object.has("bend")) {
    JsonObject bend(object["bend"]);
    shape.bend_radius = bend.required("radius").number(kSize);
    shape.bend_angle = bend.number("angle", 180, {0, 350});
    bend.finish();
  }
  object.finish();
  return shape;
}

TriangleMesh parse_funnel(const JsonValue& value) {
  JsonObject object(value);
  FunnelShape shape;
  shape.top_radius = object.number("top_radius", shape.top_radius, kSize);
  shape.bottom_radius = object.number("bottom_radius", shape.bottom_radius, kSize);
  shape.cone_height = object.number("cone_height", shape.cone_height, kSize);
  shape.pipe_length = object.number("pipe_length", shape.pipe_length, {0, 1e6});
  shape.wall = object.number("wall", shape.wall, kSize);
  shape.edge = object.number("edge", shape.edge, kSize);
  object.finish();
  const double outline = 2 * (shape.top_radius + shape.cone_height + shape.pipe_length);
  const double around = std::numbers::pi * (shape.top_radius + shape.bottom_radius);
  if (outline * around / (shape.edge * shape.edge) > kMaxCells)
    value.refuse("a coarser edge: at most 4 million cells");
  return make_funnel(shape);
}

TriangleMesh parse_box(const JsonValue& value) {
  JsonObject object(value);
  const Vec3d size = object.required("size").vector(kSize);
  const double largest = norm_max(size), edge = object.number("edge", largest / 10, kSize);
  object.finish();
  if (6 * largest * largest / (edge * edge) > kMaxCells)
    value.refuse("a coarser edge: at most 4 million cells");
  return make_box(size, edge);
}

TriangleMesh parse_plane(const JsonValue& value) {
  JsonObject object(value);
  const std::vector<double> size = object.required("size").numbers(2, kSize);
  const double edge = object.number("edge", std::max(size[0], size[1]) / 20, kSize);
  object.finish();
  if (size[0] * size[1] / (edge * edge) > kMaxCells)
    value.refuse("a coarser edge: at most 4 million cells");
  return make_plane(size[0], size[1], edge);
}

TriangleMesh parse_round(const JsonValue& value, bool capsule) {
  JsonObject object(value);
  const double radius = object.required("radius").number(kSize);
  const double length = capsule ? object.required("length").number({0, 1e6}) : 0;
  Index triangles = kDefaultTriangles;
  if (object.has("triangles"))
    triangles = static_cast<Index>(object["triangles"].integer(20, 4'000'000));
  object.finish();
  return capsule ? make_capsule(radius, length, triangles) : make_sphere(radius, triangles);
}

TriangleMesh parse_body_shape(const JsonValue& value) {
  JsonObject object(value);
  if (value.json().size() != 1) value.refuse("one of sphere, capsule, box, plane, funnel");
  TriangleMesh mesh;
  if (object.has("sphere")) mesh = parse_round(object["sphere"], false);
  if (object.has("capsule")) mesh = parse_round(object["capsule"], true);
  if (object.has("box")) mesh = parse_box(object["box"]);
  if (object.has("plane")) mesh = parse_plane(object["plane"]);
  if (object.has("funnel")) mesh = parse_funnel(object["funnel"]);
  object.finish();
  return mesh;
}

// --- cloths ---------------------------------------------------------------------------------

/// Texture coordinates are no material coordinates: kept only where they have the rest shape's
/// size.
bool is_material_space(const std::vector<std::array<Vec2d, 3>>& uv, const std::vector<Vec3d>& rest,
                       const std::vector<Triangle>& faces) {
  double uv_area = 0, rest_area = 0;
  for (std::size_t f = 0; f < uv.size(); ++f) {
    const auto at = [&](std::size_t c) { return rest[static_cast<std::size_t>(faces[f][c])]; };
    const Vec2d a = uv[f][1] - uv[f][0], b = uv[f][2] - uv[f][0];
    const double area = (a.x * b.y - a.y * b.x) / 2;
    const double real = norm(cross(at(1) - at(0), at(2) - at(0))) / 2;
    if (area < 0.5 * real || area > 2 * real) return false;
    uv_area += area;
    rest_area += real;
  }
  return std::abs(uv_area - rest_area) < 0.1 * rest_area;
}

void read_cloth_mesh(JsonObject& object, const SceneFolder& folder, Cloth& cloth) {
  const JsonValue name = object["mesh"];
  cloth.mesh = read_mesh(find_asset(name.text(), folder.path)).mesh;
  if (object.has("triangles"))
    object["triangles"].refuse(
        "no such key: only grids choose their triangles (see \"subdivide\")");
  cloth.rest = cloth.mesh.positions;
  if (object.has("rest")) {
    const TriangleMesh rest = read_mesh(find_asset(object["rest"].text(), folder.path)).mesh;
    if (rest.positions.size() != cloth.mesh.positions.size() || rest.faces != cloth.mesh.faces)
      object["rest"].refuse("a mesh with the same vertices and faces as \"mesh\"");
    cloth.rest = rest.positions;
    if (!rest.uv.empty()) cloth.mesh.uv = rest.uv;
  }
  check_cloth_mesh(cloth.mesh, name.text());
  check_cloth_mesh({cloth.rest, cloth.mesh.faces, {}}, name.text() + " (rest shape)");
  int levels = 0;
  if (object.has("subdivide"))
    levels = static_cast<int>(object["subdivide"].integer(0, kMaxSubdivisions));
  for (int i = 0; i < levels; ++i) {
    if (cloth.mesh.faces.size() * 4 > static_cast<std::size_t>(kMaxTriangles))
      object["subdivide"].refuse("at most 50 million triangles");
    subdivide(cloth.mesh, cloth.rest);
  }
}

void make_cloth_grid(JsonObject& object, const SceneFolder& folder, LoadedCloth& loaded) {
  JsonObject mesh(object["mesh"]);
  double triangles = kDefaultTriangles;
  if (object.has("triangles"))
    triangles = static_cast<double>(object["triangles"].integer(2, kMaxTriangles));
  const GridShape shape = parse_grid(mesh.required("grid"), triangles * folder.triangle_scale);
  mesh.finish();
  for (const char* key : {"rest", "subdivide"})
    if (object.has(key))
      object[key].refuse("no such key: only for mesh files, a grid is flat at rest");
  loaded.grid = make_grid(shape);
  loaded.cloth.mesh = std::move(loaded.grid->mesh);
  loaded.cloth.rest = loaded.grid->rest;
}

void place_cloth(JsonObject& object, LoadedCloth& loaded) {
  Cloth& cloth = loaded.cloth;
  if (object.has("transform")) {
    const Placement place = parse_transform(object["transform"]);
    const Vec3d s = place.scale;
    if (!cloth.mesh.uv.empty() && (s.x != s.y || s.y != s.z))
      object["transform"].refuse("one scale for all axes on a cloth with material coordinates");
    for (Vec3d& p : cloth.mesh.positions) p = place(p);
    for (Vec3d& p : cloth.rest) p = {s.x * p.x, s.y * p.y, s.z * p.z};
    for (auto& corners : cloth.mesh.uv)
      for (Vec2d& corner : corners) corner = s.x * corner;
  }
  if (!loaded.grid && !is_material_space(cloth.mesh.uv, cloth.rest, cloth.mesh.faces))
    cloth.mesh.uv.clear();
}

void pin_box(const JsonValue& value, Cloth& cloth) {
  const std::vector<JsonValue> corners = value.items();
  if (corners.size() != 2) value.refuse("two corners: [[x, y, z], [x, y, z]]");
  const Vec3d low = corners[0].vector(), high = corners[1].vector();
  const std::size_t before = cloth.pins.size();
  for (std::size_t v = 0; v < cloth.mesh.positions.size(); ++v) {
    const Vec3d p = cloth.mesh.positions[v];
    const bool inside = p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y &&
                        p.z >= low.z && p.z <= high.z;
    if (inside) cloth.pins.push_back(static_cast<Index>(v));
  }
  if (cloth.pins.size() == before)
    value.refuse("a box with at least one vertex of the cloth in it");
}

void parse_pins(const JsonValue& value, LoadedCloth& loaded) {
  std::vector<Index>& pins = loaded.cloth.pins;
  for (const JsonValue& item : value.items()) {
    if (item.json().is_object()) {
      JsonObject object(item);
      pin_box(object.required("box"), loaded.cloth);
      object.finish();
      continue;
    }
    std::vector<Index> named;
    if (item.json().is_string() && loaded.grid) named = grid_vertices(*loaded.grid, item.text());
    if (named.empty()) named = {parse_vertex(item, loaded)};
    pins.insert(pins.end(), named.begin(), named.end());
  }
  std::ranges::sort(pins);
  pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
}

// --- obstacles ------------------------------------------------------------------------------

std::vector<Keyframe> parse_motion(const JsonValue& value) {
  std::vector<Keyframe> motion;
  for (const JsonValue& item : value.items()) {
    JsonObject object(item);
    Keyframe key;
    key.time = object.required("time").number({0, 1e6});
    if (!motion.empty() && key.time <= motion.back().time)
      object["time"].refuse("a time after that of the keyframe before");
    key.translation = object.vector("translate", {});
    if (object.has("rotate")) key.rotation = parse_rotation(object["rotate"]);
    object.finish();
    motion.push_back(key);
  }
  if (motion.empty()) value.refuse("at least one keyframe");
  return motion;
}

void parse_point_cache(JsonObject& object, const SceneFolder& folder, const Placement& place,
                       Obstacle& obstacle) {
  const std::string& name = object["animation"].text();
  if (!name.ends_with(".pc2")) object["animation"].refuse("a .pc2 file");
  obstacle.frames =
      read_pc2(find_asset(name, folder.path), static_cast<Index>(obstacle.mesh.positions.size()));
  for (auto& frame : obstacle.frames)
    for (Vec3f& p : frame) p = convert<float>(place(convert<double>(p)));
}

}  // namespace

Vec3d parse_rotation(JsonValue value) {
  if (value.json().is_object()) {
    JsonObject object(value);
    const Vec3d axis = object.required("axis").vector();
    const double angle = object.required("angle").number({-1e6, 1e6});
    object.finish();
    if (!(norm(axis) > 0)) object["axis"].refuse("an axis longer than 0");
    return angle * kDegree * normalized(axis);
  }
  const Vec3d degrees = value.vector({-1e6, 1e6});
  const auto about = [](Vec3d axis) { return rotation_matrix(kDegree * axis); };
  // A turn about one axis keeps its full turns: keyframes may count beyond 360 degrees.
  const int axes = (degrees.x != 0) + (degrees.y != 0) + (degrees.z != 0);
  if (axes <= 1) return kDegree * degrees;
  const Mat3<double> x = about({degrees.x, 0, 0}), y = about({0, degrees.y, 0}),
                     z = about({0, 0, degrees.z});
  Mat3<double> result;
  for (int c = 0; c < 3; ++c) {
    const Vec3d column = z * (y * Vec3d{x(0, c), x(1, c), x(2, c)});
    result(0, c) = column.x;
    result(1, c) = column.y;
    result(2, c) = column.z;
  }
  return rotation_vector(result);
}

Placement parse_transform(JsonValue value) {
  JsonObject object(value);
  Placement place;
  place.translation = object.vector("translate", {});
  if (object.has("rotate")) place.rotation = rotation_matrix(parse_rotation(object["rotate"]));
  if (object.has("scale")) {
    const JsonValue scale = object["scale"];
    const double same = scale.json().is_number() ? scale.number(kSize) : 0;
    place.scale = same > 0 ? Vec3d{same, same, same} : scale.vector(kSize);
  }
  object.finish();
  return place;
}

double total_grid_triangles(const nlohmann::json& scene) {
  double total = 0;
  if (!scene.is_object() || !scene.contains("cloths")) return 0;
  for (const auto& cloth : scene["cloths"]) {
    const bool is_grid = cloth.is_object() && cloth.contains("mesh") && cloth["mesh"].is_object() &&
                         cloth["mesh"].contains("grid");
    if (!is_grid) continue;
    const bool chosen = cloth.contains("triangles") && cloth["triangles"].is_number();
    total += chosen ? cloth["triangles"].get<double>() : kDefaultTriangles;
  }
  return total;
}

LoadedCloth parse_cloth(JsonValue value, const SceneFolder& folder, std::size_t number) {
  JsonObject object(value);
  LoadedCloth loaded;
  loaded.cloth.name = object.text("name", "cloth" + std::to_string(number));
  const JsonValue mesh = object.required("mesh");
  if (mesh.json().is_string()) {
    read_cloth_mesh(object, folder, loaded.cloth);
  } else {
    make_cloth_grid(object, folder, loaded);
  }
  place_cloth(object, loaded);
  if (object.has("pins")) parse_pins(object["pins"], loaded);
  const JsonValue material = object["material"];
  loaded.cloth.material = material.json().is_object()
                              ? parse_material(material.json(), material.where(), folder.path)
                              : load_material(object.text("material", "default"), folder.path);
  no_such_feature(object, "seams", "use one mesh whose panels share vertices");
  object.finish();
  return loaded;
}

Obstacle parse_obstacle(JsonValue value, const SceneFolder& folder, std::size_t number) {
  JsonObject object(value);
  Obstacle obstacle;
  obstacle.name = object.text("name", "obstacle" + std::to_string(number));
  const JsonValue mesh = object.required("mesh");
  obstacle.mesh = mesh.json().is_string() ? read_body(find_asset(mesh.text(), folder.path))
                                          : parse_body_shape(mesh);
  Placement place;
  if (object.has("transform")) place = parse_transform(object["transform"]);
  for (Vec3d& p : obstacle.mesh.positions) p = place(p);
  obstacle.frame_rate = object.number("frame_rate", obstacle.frame_rate, {1e-3, 1e5});
  if (object.has("animation")) parse_point_cache(object, folder, place, obstacle);
  if (object.has("motion")) obstacle.motion = parse_motion(object["motion"]);
  no_such_feature(object, "friction", "see parameters: proximity.friction_obstacle");
  no_such_feature(object, "thickness", "see parameters: proximity.thickness");
  object.finish();
  return obstacle;
}

}  // namespace icloth
