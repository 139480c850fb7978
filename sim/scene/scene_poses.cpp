#include "sim/scene/scene_poses.h"

#include <algorithm>
#include <memory>

#include "sim/bodies/cached_poses.h"
#include "sim/bodies/offset.h"
#include "sim/files/box.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/scene/scene_motion.h"

namespace icloth {
namespace {

constexpr double kFrameRate = 25;  // [1/s] where neither file nor scene gives one

bool is_point_cache(const std::string& name) {
  const std::string extension = lower_extension(name);
  return extension == ".pc2" || extension == ".mdd";
}

/// The clips of a file for a message; the first few are named, each with its length.
std::string clip_names(const std::vector<Clip>& clips) {
  constexpr std::size_t kMostNamed = 8;
  std::vector<std::string> names;
  for (const Clip& clip : clips)
    names.push_back(
        (clip.name.empty() ? std::to_string(names.size()) + " (no name)" : in_quotes(clip.name)) +
        " (" + brief_number(clip.duration) + (clip.in_seconds ? " s)" : " frames)"));
  return first_items(names, kMostNamed);
}

/// The number of the clip that a scene names or counts.
std::size_t find_clip(const JsonValue& value, const std::vector<Clip>& clips,
                      const std::string& file) {
  if (value.is_string()) {
    const auto found = std::ranges::find(clips, value.text(), &Clip::name);
    if (found != clips.end()) return static_cast<std::size_t>(found - clips.begin());
  } else if (value.is_unsigned()) {
    const double number = value.number({0, 1e300});
    if (number < static_cast<double>(clips.size())) return static_cast<std::size_t>(number);
  }
  if (clips.empty()) value.refuse("no such key: " + file + " holds no clips");
  value.refuse("a clip of " + file + ", by its name or counted from 0: " + clip_names(clips));
}

Playback parse_playback(JsonObject& object, const SceneFolder& folder, bool plays) {
  if (!plays) {
    for (const char* key : {"start", "speed", "loop", "blend_in"})
      if (object.has(key))
        object[key].refuse("a key 'clip' or 'animation' beside it, which says what is played");
    return {};
  }
  Playback playback;
  playback.start = object.number("start", 0, {0, 1e6});
  playback.start = folder.clip_start.value_or(playback.start);
  playback.speed = object.number("speed", 1, {-100, 100});
  playback.loop = object.boolean("loop", false);
  playback.blend_in = object.number("blend_in", 0, {0, 1e3});
  return playback;
}

/// The largest distance between two poses, and the vertex that has it.
struct Distance {
  double metres = 0;
  std::size_t vertex = 0;
};

template <class P>
Distance largest_distance(const std::vector<P>& a, const std::vector<Vec3d>& b) {
  Distance largest;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const double distance = norm(convert<double>(a[v]) - b[v]);
    if (distance > largest.metres) largest = {distance, v};
  }
  return largest;
}

std::string millimetres(double metres) { return brief_number(1e3 * metres) + " mm"; }

/// What ends far from where it started jumps when it is repeated, and takes cloth with it.
void note_jump(const Distance& jump, const std::string& what, const std::string& object,
               const SceneFolder& folder) {
  constexpr double kVisible = 0.01;  // [m]
  if (jump.metres <= kVisible) return;
  folder.note(object + ": " + what + " ends up to " + millimetres(jump.metres) +
              " away from its start (vertex " + std::to_string(jump.vertex) +
              "): the body jumps wherever it is repeated");
}

/// A body starts where frame 0 of its cache is, which may be far from the mesh in the scene.
void note_distance(const std::vector<Vec3f>& frame, const std::vector<Vec3d>& mesh,
                   const std::string& file, const std::string& object, const SceneFolder& folder) {
  // Caches are in single precision, and meshes are written with few digits.
  const Distance farthest = largest_distance(frame, mesh);
  if (farthest.metres <= std::max(1e-5, 1e-4 * norm(box_around(mesh).size()))) return;
  folder.note(object + ": frame 0 of " + file + " is up to " + millimetres(farthest.metres) +
              " away from the mesh (vertex " + std::to_string(farthest.vertex) +
              "): the body starts at frame 0 of its animation");
}

/// What a body file holds and nobody asked for.
void note_unused(const Body& body, const PlacedBody& placed, const std::string& object,
                 const SceneFolder& folder) {
  const std::string subject = object + ": " + placed.file;
  if (body.morphs > 0)
    folder.note(subject + " has morph targets (" + std::to_string(body.morphs) +
                "), which keep the weights that the file gives them");
  if (!body.rig.clips.empty())
    folder.note(subject + " holds the clips " + clip_names(body.rig.clips) +
                ", of which \"clip\" plays one: none is chosen, and the body keeps its bind pose");
  else if (body.bones > 0)
    folder.note(subject + " has a skeleton of " + std::to_string(body.bones) +
                " bones but no clip: the body keeps its bind pose");
}

/// The pose of a clip that is held at one of its moments.
std::vector<Vec3d> pose_at(const std::shared_ptr<const Rig>& rig, double moment,
                           const Affine& place) {
  std::vector<Vec3d> positions;
  SkinnedPoses(rig, 0, {.start = moment, .speed = 0}, place).pose(0, positions);
  return positions;
}

/// A clip whose file counts frames, in seconds.
void use_frame_rate(Clip& clip, double frame_rate) {
  const auto scale = [&](auto& keys) {
    for (auto& key : keys) key.time /= frame_rate;
  };
  for (NodeChannel& channel : clip.channels) {
    scale(channel.translation);
    scale(channel.rotation);
    scale(channel.scale);
  }
  for (MorphChannel& channel : clip.morphs) scale(channel.weight);
  clip.duration /= frame_rate;
}

/// Plays the only clip of a rig, which is from `file`.
void play_clip(JsonObject& object, const SceneFolder& folder, const PlacedBody& placed,
               const std::string& file, const std::shared_ptr<Rig>& rig, const Body& body,
               Obstacle& obstacle) {
  const std::string name = "obstacle " + in_quotes(obstacle.name);
  Clip& clip = rig->clips[0];
  const double frame_rate = object.number("frame_rate", kFrameRate, {1e-3, 1e5});
  if (!clip.in_seconds)
    use_frame_rate(clip, frame_rate);
  else if (object.has("frame_rate") && frame_rate != kFrameRate)
    folder.note(name + ": \"frame_rate\" is not used: " + file +
                " gives the times of its clips in seconds");

  if (placed.offset > 0) offset_rig(*rig, placed.place, body.mesh.faces, placed.offset);
  const Playback playback = parse_playback(object, folder, true);
  obstacle.poses = std::make_shared<SkinnedPoses>(rig, 0, playback, placed.place);
  if (playback.loop)
    note_jump(
        largest_distance(pose_at(rig, 0, placed.place), pose_at(rig, clip.duration, placed.place)),
        "the clip", name, folder);
}

void parse_clip(JsonObject& object, std::string_view key, const SceneFolder& folder,
                const PlacedBody& placed, Body& body, Obstacle& obstacle) {
  // The rig keeps the clip that is played alone.
  auto rig = std::make_shared<Rig>(std::move(body.rig));
  const std::size_t number = find_clip(object[key], rig->clips, placed.file);
  rig->clips = {std::move(rig->clips[number])};
  play_clip(object, folder, placed, placed.file, rig, body, obstacle);
}

/// A motion of another skeleton becomes the only clip of the body.
void parse_motion_file(JsonObject& object, const SceneFolder& folder, const PlacedBody& placed,
                       Body& body, Obstacle& obstacle) {
  const std::string name = "obstacle " + in_quotes(obstacle.name);
  Clip clip = clip_of_motion(object, folder, {name, placed.file, placed.up}, body.rig);
  auto rig = std::make_shared<Rig>(std::move(body.rig));
  rig->clips = {std::move(clip)};
  play_clip(object, folder, placed, shown_path(object["animation"].text()), rig, body, obstacle);
}

void parse_point_cache(JsonObject& object, const SceneFolder& folder, const PlacedBody& placed,
                       const TriangleMesh& mesh, Obstacle& obstacle) {
  const std::string& file = object["animation"].text();
  const std::string name = "obstacle " + in_quotes(obstacle.name);
  const auto vertices = static_cast<Index>(mesh.positions.size());
  PointCache cache = read_point_cache(folder.find(object["animation"]), vertices);
  for (const std::string& unused : cache.unused)
    folder.note(name + ": " + shown_path(file) + " has " + unused);
  const double file_rate = cache.frame_rate > 0 ? cache.frame_rate : kFrameRate;
  const double frame_rate = object.number("frame_rate", file_rate, {1e-3, 1e5});

  // The frames are placed as the mesh is, and get the same skin.
  for (auto& frame : cache.frames)
    for (Vec3f& p : frame) p = convert<float>(placed.place(convert<double>(p)));
  const Playback playback = parse_playback(object, folder, true);
  if (playback.blend_in == 0 && playback.start == 0)
    note_distance(cache.frames.front(), mesh.positions, shown_path(file), name, folder);
  std::vector<Vec3d> first;
  for (const Vec3f& p : cache.frames.front()) first.push_back(convert<double>(p));
  if (playback.loop)
    note_jump(largest_distance(cache.frames.back(), first), shown_path(file), name, folder);

  std::vector<Vec3d> start = mesh.positions;
  if (placed.offset > 0) {
    for (auto& frame : cache.frames) offset_along_normals(frame, mesh.faces, placed.offset);
    offset_along_normals(start, mesh.faces, placed.offset);
  }
  obstacle.poses = std::make_shared<CachedPoses>(std::move(cache.frames), frame_rate, playback,
                                                 std::move(start));
}

}  // namespace

void parse_poses(JsonObject& object, const SceneFolder& folder, const PlacedBody& placed,
                 Body& body, Obstacle& obstacle) {
  const bool has_animation = object.has("animation"), has_clip = object.has("clip");
  const std::string name = "obstacle " + in_quotes(obstacle.name);
  if (has_animation && has_clip)
    object["clip"].refuse("no such key beside 'animation': a body plays one of them");

  // An animation is a file of its own, or by its older name a clip.
  if (has_animation && is_point_cache(object["animation"].text()))
    return parse_point_cache(object, folder, placed, body.mesh, obstacle);
  if (has_animation && lower_extension(object["animation"].text()) == ".bvh")
    return parse_motion_file(object, folder, placed, body, obstacle);
  if (has_animation && body.rig.clips.empty())
    object["animation"].refuse("a .pc2, .mdd or .bvh file, since " + placed.file +
                               " holds no clips");
  if (has_animation || has_clip)
    return parse_clip(object, has_clip ? "clip" : "animation", folder, placed, body, obstacle);

  parse_playback(object, folder, false);
  object.number("frame_rate", kFrameRate, {1e-3, 1e5});
  note_unused(body, placed, name, folder);
}

}  // namespace icloth
