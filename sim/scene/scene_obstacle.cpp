// Obstacles of a scene file.
#include <algorithm>

#include "sim/files/assets.h"
#include "sim/files/body_io.h"
#include "sim/files/box.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/scene/cloth_mesh.h"
#include "sim/scene/scene_json.h"
#include "sim/scene/scene_meshes.h"
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

/// Clips and morph targets are not used yet; a user who brings some must hear of it.
void note_clips(const Body& body, const std::string& file, const std::string& object,
                const SceneFolder& folder) {
  constexpr std::size_t kMostNamed = 4;
  if (body.morphs > 0)
    folder.note(object + ": " + file + " has morph targets (" + std::to_string(body.morphs) +
                "), which are not applied: the body keeps its base shape");
  if (body.clips.empty()) {
    if (body.bones > 0)
      folder.note(object + ": " + file + " has a skeleton of " + std::to_string(body.bones) +
                  " bones but no animation: the body keeps its bind pose");
    return;
  }

  // The first few clips are named, each with its length.
  std::string names;
  for (std::size_t i = 0; i < std::min(body.clips.size(), kMostNamed); ++i) {
    const BodyClip& clip = body.clips[i];
    names += i > 0 ? ", " : "";
    names += clip.name.empty() ? "without a name" : in_quotes(clip.name);
    if (clip.duration > 0) names += " (" + brief_number(clip.duration) + " s)";
  }
  if (body.clips.size() > kMostNamed)
    names += " and " + std::to_string(body.clips.size() - kMostNamed) + " more";
  folder.note(object + ": " + file + " holds the animation " + names +
              ", which is not played: the body keeps its bind pose");
}

/// A body starts where frame 0 of its cache is, which may be far from the mesh in the scene.
void note_distance(const Obstacle& obstacle, const std::string& file, const SceneFolder& folder) {
  double farthest = 0;
  std::size_t vertex = 0;
  Box box;
  for (std::size_t v = 0; v < obstacle.mesh.positions.size(); ++v) {
    box.add(obstacle.mesh.positions[v]);
    const double distance =
        norm(convert<double>(obstacle.frames.front()[v]) - obstacle.mesh.positions[v]);
    if (distance > farthest) {
      farthest = distance;
      vertex = v;
    }
  }

  // Caches are in single precision, and meshes are written with few digits.
  if (farthest <= std::max(1e-5, 1e-4 * norm(box.size()))) return;
  folder.note("obstacle " + in_quotes(obstacle.name) + ": frame 0 of " + file + " is up to " +
              brief_number(1e3 * farthest) + " mm away from the mesh (vertex " +
              std::to_string(vertex) + "): the body starts at frame 0 of its animation");
}

void parse_point_cache(JsonObject& object, const SceneFolder& folder, const Placement& place,
                       Obstacle& obstacle) {
  const std::string& name = object["animation"].text();
  const std::string extension = lower_extension(name);
  if (extension != ".pc2" && extension != ".mdd") object["animation"].refuse("a .pc2 or .mdd file");
  const auto vertices = static_cast<Index>(obstacle.mesh.positions.size());
  PointCache cache = read_point_cache(find_asset(name, folder.path), vertices);
  for (const std::string& unused : cache.unused)
    folder.note("obstacle " + in_quotes(obstacle.name) + ": " + shown_path(name) + " has " +
                unused);
  if (cache.frame_rate > 0) obstacle.frame_rate = cache.frame_rate;
  obstacle.frames = std::move(cache.frames);
  for (auto& frame : obstacle.frames)
    for (Vec3f& p : frame) p = convert<float>(place(convert<double>(p)));
  note_distance(obstacle, shown_path(name), folder);
}

}  // namespace

Obstacle parse_obstacle(JsonValue value, const SceneFolder& folder, std::size_t number) {
  JsonObject object(value);
  Obstacle obstacle;
  obstacle.name = object.text("name", "obstacle" + std::to_string(number));

  // The surface comes from a file, of which not everything may be used, or from a simple shape.
  const JsonValue mesh = object.required("mesh");
  if (mesh.json().is_string()) {
    Body body = read_body(find_asset(mesh.text(), folder.path));
    obstacle.mesh = std::move(body.mesh);
    if (!object.has("animation"))
      note_clips(body, shown_path(mesh.text()), "obstacle " + in_quotes(obstacle.name), folder);
  } else {
    obstacle.mesh = parse_body_shape(mesh, folder.limits.body_triangles);
  }

  // The transform is applied to the mesh at once, so that its size in metres can be judged.
  Placement place;
  if (object.has("transform")) place = parse_transform(object["transform"]);
  for (Vec3d& p : obstacle.mesh.positions) p = place(p);
  if (mesh.json().is_string()) {
    const std::string note = unit_note("obstacle " + in_quotes(obstacle.name),
                                       obstacle.mesh.positions, place.scale, false);
    if (!note.empty()) folder.note(note);
  }

  // Its motion may come from a point cache, from keyframes, or from both.
  if (object.has("animation")) parse_point_cache(object, folder, place, obstacle);
  obstacle.frame_rate = object.number("frame_rate", obstacle.frame_rate, {1e-3, 1e5});
  if (object.has("motion")) obstacle.motion = parse_motion(object["motion"]);
  obstacle.friction = parse_friction(object);
  refuse_feature(object, "thickness", "see parameters: proximity.thickness");
  object.finish();
  return obstacle;
}

}  // namespace icloth
