// Shapes and places of a scene file's objects.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scene/scene_json.h"
#include "sim/scene/transforms.h"

namespace icloth {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Index kMaxRoundTriangles = 1'000'000;
const NumberRange kSize{1e-6, 1e6};

/// Rotation vector of a turn, which is at most half a circle long.
Vec3d rotation_vector(const Eigen::Quaterniond& turn) {
  const Eigen::AngleAxisd shortest(turn);
  const Vec3d rotation = shortest.angle() * from_eigen(shortest.axis());

  // Half a turn goes either way. Rounding must not choose which, since keyframes are interpolated:
  // the largest component is positive.
  if (shortest.angle() < std::numbers::pi - 1e-6) return rotation;
  Eigen::Index largest = 0;
  shortest.axis().cwiseAbs().maxCoeff(&largest);
  if (shortest.axis()[largest] > 0) return rotation;
  return (shortest.angle() - 2 * std::numbers::pi) * from_eigen(shortest.axis());
}

[[noreturn]] void refuse_cells(const JsonValue& value, Index most_triangles) {
  value.refuse("a coarser edge: at most " + std::to_string(most_triangles) + " triangles");
}

TriangleMesh parse_funnel(const JsonValue& value, Index most_triangles) {
  JsonObject object(value);
  FunnelShape shape;
  shape.top_radius = object.number("top_radius", shape.top_radius, kSize);
  shape.bottom_radius = object.number("bottom_radius", shape.bottom_radius, kSize);
  shape.cone_height = object.number("cone_height", shape.cone_height, kSize);
  shape.pipe_length = object.number("pipe_length", shape.pipe_length, {0, 1e6});
  shape.wall = object.number("wall", shape.wall, kSize);
  shape.edge = object.number("edge", shape.edge, kSize);
  object.finish();

  // Both sides of the cone and of the pipe and the two rims are meshed. Each of these pieces and
  // each ring is rounded to whole edges, a ring to six at least.
  const double slope = std::hypot(shape.top_radius - shape.bottom_radius, shape.cone_height);
  const double outline = 2 * (slope + shape.pipe_length + shape.wall);
  const double widest = std::max(shape.top_radius, shape.bottom_radius) + shape.wall;
  const double rings = 1.2 * outline / shape.edge + 6;
  const double around = 2 * std::numbers::pi * widest / shape.edge + 6;
  if (2 * rings * around > most_triangles) refuse_cells(value, most_triangles);
  return make_funnel(shape);
}

TriangleMesh parse_box(const JsonValue& value, Index most_triangles) {
  JsonObject object(value);
  const Vec3d size = object.required("size").vector(kSize);
  const double largest = norm_max(size), edge = object.number("edge", largest / 10, kSize);
  object.finish();
  if (6 * largest * largest / (edge * edge) > most_triangles / 2)
    refuse_cells(value, most_triangles);
  return make_box(size, edge);
}

TriangleMesh parse_plane(const JsonValue& value, Index most_triangles) {
  JsonObject object(value);
  const std::vector<double> size = object.required("size").numbers(2, kSize);
  const double edge = object.number("edge", std::max(size[0], size[1]) / 20, kSize);
  object.finish();
  if (std::max(size[0], edge) * std::max(size[1], edge) / (edge * edge) > most_triangles / 2)
    refuse_cells(value, most_triangles);
  return make_plane(size[0], size[1], edge);
}

TriangleMesh parse_round(const JsonValue& value, bool capsule, Index most_triangles) {
  JsonObject object(value);
  const double radius = object.required("radius").number(kSize);
  // Longer ones would be cut into rings without bound.
  const double length = capsule ? object.required("length").number({0, 1000 * radius}) : 0;
  Index triangles = kDefaultTriangles;
  if (object.has("triangles"))
    triangles = static_cast<Index>(
        object["triangles"].integer(20, std::min(kMaxRoundTriangles, most_triangles)));
  object.finish();
  return capsule ? make_capsule(radius, length, triangles) : make_sphere(radius, triangles);
}

}  // namespace

GridShape parse_grid(JsonValue value, Index triangles) {
  JsonObject object(value);
  GridShape shape;
  const std::vector<double> size = object.required("size").numbers(2, kSize);
  shape.width = size[0];
  shape.height = size[1];
  shape.triangles = triangles;

  const std::string orientation = object.text("orientation", "vertical");
  if (orientation != "vertical" && orientation != "horizontal")
    object["orientation"].refuse("\"vertical\" or \"horizontal\"");
  shape.horizontal = orientation == "horizontal";

  // A bend rolls the width around an arc; without one the sheet is flat.
  if (object.has("bend")) {
    JsonObject bend(object["bend"]);
    shape.bend_radius = bend.required("radius").number(kSize);
    shape.bend_angle = bend.number("angle", 180, {0, 350});
    bend.finish();
  }
  object.finish();
  return shape;
}

TriangleMesh parse_body_shape(JsonValue value, Index most_triangles) {
  JsonObject object(value);
  if (value.size() != 1) value.refuse("one of sphere, capsule, box, plane, funnel");

  // The only key names the shape; finish() refuses any that is not known.
  TriangleMesh mesh;
  if (object.has("sphere")) mesh = parse_round(object["sphere"], false, most_triangles);
  if (object.has("capsule")) mesh = parse_round(object["capsule"], true, most_triangles);
  if (object.has("box")) mesh = parse_box(object["box"], most_triangles);
  if (object.has("plane")) mesh = parse_plane(object["plane"], most_triangles);
  if (object.has("funnel")) mesh = parse_funnel(object["funnel"], most_triangles);
  object.finish();
  return mesh;
}

Vec3d parse_rotation(JsonValue value) {
  // An axis and an angle give the rotation vector directly.
  if (value.is_object()) {
    JsonObject object(value);
    const Vec3d axis = object.required("axis").vector();
    const double angle = object.required("angle").number({-1e6, 1e6});
    object.finish();
    if (!(norm(axis) > 0)) object["axis"].refuse("an axis longer than 0");
    return angle * kDegree * normalized(axis);
  }

  const Vec3d degrees = value.vector({-1e6, 1e6});
  // A turn about one axis keeps its full turns: keyframes may count beyond 360 degrees.
  const int axes = (degrees.x != 0) + (degrees.y != 0) + (degrees.z != 0);
  if (axes <= 1) return kDegree * degrees;

  // Turns about several axes are combined, x first.
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return rotation_vector(AngleAxisd(kDegree * degrees.z, Vector3d::UnitZ()) *
                         AngleAxisd(kDegree * degrees.y, Vector3d::UnitY()) *
                         AngleAxisd(kDegree * degrees.x, Vector3d::UnitX()));
}

Placement parse_transform(JsonValue value) {
  JsonObject object(value);
  Placement place;
  place.translation = to_eigen(object.vector("translate", {}));
  if (object.has("rotate"))
    place.rotation = angle_axis(parse_rotation(object["rotate"])).toRotationMatrix();

  // One number scales all axes alike, and three numbers scale each axis by itself.
  if (object.has("scale")) {
    const JsonValue scale = object["scale"];
    const double same = scale.is_number() ? scale.number(kSize) : 0;
    place.scale = same > 0 ? Vec3d{same, same, same} : scale.vector(kSize);
  }
  object.finish();
  return place;
}

}  // namespace icloth
