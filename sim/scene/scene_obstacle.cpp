// Obstacles of a scene file.
#include "sim/bodies/offset.h"
#include "sim/files/body_io.h"
#include "sim/files/box.h"
#include "sim/files/text.h"
#include "sim/scene/cloth_mesh.h"
#include "sim/scene/scene_json.h"
#include "sim/scene/scene_poses.h"
#include "sim/scene/transforms.h"

namespace icloth {
namespace {

std::vector<Keyframe> parse_motion(const JsonValue& value) {
  std::vector<Keyframe> motion;
  for (const JsonValue& item : value.items()) {
    JsonObject object(item);
    Keyframe key;

    // The order of the keyframes is that of their times, between which the body is interpolated.
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

/// "scale" and "up" of a body from a file: what turns its space into metres with Y up.
struct FileSpace {
  double scale = 1;
  bool z_up = false;

  Vec3d operator()(Vec3d p) const {
    const Vec3d q = scale * p;
    return z_up ? Vec3d{q.x, q.z, -q.y} : q;
  }
  Vec3d up() const { return z_up ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0}; }
  Affine affine() const {
    const double s = scale;
    if (z_up) return {{s, 0, 0, 0, 0, 0, s, 0, 0, -s, 0, 0}};
    return {{s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0}};
  }
};

FileSpace parse_space(JsonObject& object) {
  FileSpace space;
  space.scale = object.number("scale", 1, {1e-6, 1e6});
  const std::string up = object.text("up", "y");
  if (up != "y" && up != "z") object["up"].refuse("\"y\" or \"z\"");
  space.z_up = up == "z";
  return space;
}

/// The size of a body with a skeleton, and what may be wrong with it. `positions`: at time 0.
std::string size_note(const std::string& object, const std::vector<Vec3d>& positions,
                      const FileSpace& space) {
  constexpr double kSmallest = 0.5, kLargest = 3;  // of a person [m]
  const Vec3d size = box_around(positions).size();
  std::string line = object + ": " + rounded_text(size.y) + " m tall, Y up";
  if (size.y >= kSmallest && size.y <= kLargest) return line;

  // A person that lies is taller along z; one in other units has a likely height in metres.
  line += "; a person is " + rounded_text(kSmallest) + " to " + rounded_text(kLargest) + " m tall";
  if (!space.z_up && size.z > 2 * size.y)
    return line + ": it is " + rounded_text(size.z) + " m along z, and \"up\": \"z\" raises it";
  for (const double unit : {0.01, 0.001, 0.0254, 100.0, 1000.0})
    if (size.y * unit >= kSmallest && size.y * unit <= kLargest)
      return line + ": \"scale\": " + rounded_text(space.scale * unit, 6) + " makes it " +
             rounded_text(size.y * unit) + " m";
  return line;
}

}  // namespace

Obstacle parse_obstacle(JsonValue value, const SceneFolder& folder, std::size_t number) {
  JsonObject object(value);
  Obstacle obstacle;
  obstacle.name = object.text("name", "obstacle" + std::to_string(number));

  // The surface comes from a file, whose units and axes may differ, or from a simple shape.
  const JsonValue mesh = object.required("mesh");
  const bool is_file = mesh.is_string();
  Body body;
  FileSpace space;
  if (is_file) {
    body = read_body(folder.find(mesh));
    space = parse_space(object);
  } else {
    body.mesh = parse_body_shape(mesh, folder.limits.body_triangles);
  }

  // The transform is applied to the mesh at once, so that its size in metres can be judged.
  Placement place;
  if (object.has("transform")) place = parse_transform(object["transform"]);
  for (Vec3d& p : body.mesh.positions) p = place(space(p));
  const std::string title = "obstacle " + in_quotes(obstacle.name);
  const std::string unit =
      is_file ? unit_note(title, body.mesh.positions, space.scale * place.scale, false) : "";
  if (!unit.empty()) folder.note(unit);

  // Its motion may come from a clip, from a point cache, from keyframes, or from two of them.
  const double offset = object.number("offset", 0, {0, 0.1});
  const std::string file = is_file ? shown_path(mesh.text()) : "its mesh";
  parse_poses(object, folder, {file, place.affine() * space.affine(), offset, space.up()}, body,
              obstacle);
  if (object.has("motion")) obstacle.motion = parse_motion(object["motion"]);
  obstacle.mesh = std::move(body.mesh);
  if (offset > 0) offset_along_normals(obstacle.mesh.positions, obstacle.mesh.faces, offset);
  if (body.bones > 0 && unit.empty()) {
    std::vector<Vec3d> start;
    obstacle.pose(0, start);
    folder.note(size_note(title, start, space));
  }

  obstacle.friction = parse_friction(object);
  refuse_feature(object, "thickness", "see parameters: proximity.thickness, and \"offset\"");
  object.finish();
  return obstacle;
}

}  // namespace icloth
