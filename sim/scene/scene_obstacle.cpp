// Obstacles of a scene file.
#include "sim/files/assets.h"
#include "sim/files/body_io.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/cloth_mesh.h"
#include "sim/scene/scene_json.h"

namespace icloth {
namespace {

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
  const std::string extension = lower_extension(name);
  if (extension != ".pc2" && extension != ".mdd") object["animation"].refuse("a .pc2 or .mdd file");
  const auto vertices = static_cast<Index>(obstacle.mesh.positions.size());
  PointCache cache = read_point_cache(find_asset(name, folder.path), vertices);
  if (cache.frame_rate > 0) obstacle.frame_rate = cache.frame_rate;
  obstacle.frames = std::move(cache.frames);
  for (auto& frame : obstacle.frames)
    for (Vec3f& p : frame) p = convert<float>(place(convert<double>(p)));
}

}  // namespace

Obstacle parse_obstacle(JsonValue value, const SceneFolder& folder, std::size_t number) {
  JsonObject object(value);
  Obstacle obstacle;
  obstacle.name = object.text("name", "obstacle" + std::to_string(number));
  const JsonValue mesh = object.required("mesh");
  obstacle.mesh = mesh.json().is_string() ? read_body(find_asset(mesh.text(), folder.path))
                                          : parse_body_shape(mesh, folder.limits.body_triangles);
  Placement place;
  if (object.has("transform")) place = parse_transform(object["transform"]);
  for (Vec3d& p : obstacle.mesh.positions) p = place(p);
  if (mesh.json().is_string()) {
    const std::string note =
        unit_note("obstacle '" + obstacle.name + "'", obstacle.mesh.positions, place.scale, false);
    if (!note.empty()) folder.note(note);
  }
  if (object.has("animation")) parse_point_cache(object, folder, place, obstacle);
  obstacle.frame_rate = object.number("frame_rate", obstacle.frame_rate, {1e-3, 1e5});
  if (object.has("motion")) obstacle.motion = parse_motion(object["motion"]);
  obstacle.friction = parse_friction(object);
  refuse_feature(object, "thickness", "see parameters: proximity.thickness");
  object.finish();
  return obstacle;
}

}  // namespace icloth
