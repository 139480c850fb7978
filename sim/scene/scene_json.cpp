// Top level of a scene file: settings, scripted grabs, cameras.
#include "sim/scene/scene_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr double kSmoothInterval = 0.02;  ///< of a smooth path's points [s] …
constexpr double kMaxPieces = 1000;       ///< … but where a piece of the path takes very long
constexpr double kMinInterval = 1e-6;     ///< of the points in the file: speeds must be finite [s]
constexpr double kMaxTime = 1e5;          ///< [s]
const NumberRange kTime{0, kMaxTime};

void set_from_json(Parameters& parameters, const std::string& name, const JsonValue& value) {
  const auto& json = value.json();
  if (!json.is_number() && !json.is_boolean() && !json.is_string())
    value.refuse("a number, true or false, or the name of a choice");

  // A number is set as it is; what does not fit the parameter's kind is refused by its text.
  const ParameterInfo* info = find_parameter(name);
  const bool is_switch = info && info->field.kind == ParameterInfo::Kind::boolean;
  const bool is_choice = info && info->field.kind == ParameterInfo::Kind::choice;
  try {
    if (info && json.is_number() && !is_choice) {
      set_parameter(parameters, *info, json.get<double>());
    } else if (is_switch && json.is_boolean()) {
      set_parameter(parameters, *info, json.get<bool>() ? 1 : 0);
    } else {
      set_parameter(parameters, name, json.is_string() ? json.get<std::string>() : json.dump());
    }
  } catch (const InputError& error) {
    throw InputError(value.where() + ": " + error.what());
  }
}

void set_vector(Parameters& parameters, const std::string& group, const JsonValue& value) {
  value.vector();  // throws unless it is three numbers
  const char* const axes[] = {".x", ".y", ".z"};
  for (std::size_t k = 0; k < 3; ++k)
    set_from_json(parameters, group + axes[k], {value.json()[k], value.where()});
}

void parse_wind(const JsonValue& value, Parameters& parameters) {
  if (value.is_array()) return set_vector(parameters, "wind", value);
  JsonObject wind(value);
  if (wind.has("velocity")) set_vector(parameters, "wind", wind["velocity"]);
  for (const char* key : {"air_density", "air_drag"})
    if (wind.has(key)) set_from_json(parameters, std::string("wind.") + key, wind[key]);
  wind.finish();
}

/// Position on the cubic through the path's points (Catmull–Rom with uneven times).
Vec3d smooth_position(const std::vector<PathPoint>& path, std::size_t i, double time) {
  const auto tangent = [&](std::size_t k) {
    const PathPoint &a = path[k == 0 ? 0 : k - 1], &b = path[std::min(k + 1, path.size() - 1)];
    // At rest at both ends: the hand starts and stops gently.
    if (k == 0 || k + 1 == path.size()) return Vec3d{};
    return (1 / (b.time - a.time)) * (b.target - a.target);
  };
  const double length = path[i + 1].time - path[i].time;
  const double s = (time - path[i].time) / length;
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * path[i].target + (s3 - 2 * s2 + s) * length * tangent(i) +
         (3 * s2 - 2 * s3) * path[i + 1].target + (s3 - s2) * length * tangent(i + 1);
}

std::vector<PathPoint> smoothed(const std::vector<PathPoint>& path) {
  std::vector<PathPoint> result;

  // Points are set so densely that straight lines between them are as good as the curve.
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double length = path[i + 1].time - path[i].time;
    const auto pieces =
        static_cast<std::size_t>(std::clamp(length / kSmoothInterval, 1.0, kMaxPieces));
    for (std::size_t k = 0; k < pieces; ++k) {
      const double time =
          path[i].time + length * static_cast<double>(k) / static_cast<double>(pieces);
      result.push_back({time, smooth_position(path, i, time)});
    }
  }
  result.push_back(path.back());
  return result;
}

std::vector<PathPoint> parse_path(const JsonValue& value) {
  std::vector<PathPoint> path;
  for (const JsonValue& item : value.items()) {
    const std::vector<double> numbers = item.numbers(4);

    // Times must be so far apart that the speed of the hand is finite.
    if (numbers[0] < 0 || numbers[0] > kMaxTime ||
        (!path.empty() && numbers[0] < path.back().time + kMinInterval))
      item.refuse("[time, x, y, z] with a time after the one before");
    path.push_back({numbers[0], {numbers[1], numbers[2], numbers[3]}});
  }
  if (path.empty()) value.refuse("at least one [time, x, y, z]");
  return path;
}

/// Objects are told apart by name in panels and exported files, where a name is one word.
template <class Object>
void check_name(const std::string& where, const Object& object, std::set<std::string>& names) {
  const bool is_word =
      !object.name.empty() &&
      std::ranges::all_of(object.name, [](unsigned char c) { return c > ' ' && c != 127; });
  if (!is_word || !names.insert(object.name).second)
    throw InputError(where + ".name: value \"" + excerpt(object.name) +
                     "\", expected one word that no other such object has");
}

void check_total(const std::string& where, double triangles, const SceneLimits& limits) {
  if (triangles > limits.triangles)
    throw InputError(where + ": value " + number_text(triangles) + " triangles, expected at most " +
                     std::to_string(limits.triangles));
}

/// Adds the triangles of the cloths that are no grids to the count.
std::vector<LoadedCloth> parse_cloths(const JsonValue& list, const SceneFolder& folder,
                                      double& triangles) {
  std::vector<LoadedCloth> cloths;
  std::set<std::string> names;
  for (const JsonValue& item : list.items()) {
    cloths.push_back(parse_cloth(item, folder, cloths.size()));
    const LoadedCloth& loaded = cloths.back();
    check_name(item.where(), loaded.cloth, names);
    if (!loaded.grid) triangles += static_cast<double>(loaded.cloth.mesh.faces.size());
    check_total(item.where() + " and the others", triangles, folder.limits);
  }
  return cloths;
}

/// Adds the triangles of the obstacles to the count.
std::vector<Obstacle> parse_obstacles(const JsonValue& list, const SceneFolder& folder,
                                      double& triangles) {
  std::vector<Obstacle> obstacles;
  std::set<std::string> names;
  for (const JsonValue& item : list.items()) {
    obstacles.push_back(parse_obstacle(item, folder, obstacles.size()));
    check_name(item.where(), obstacles.back(), names);
    triangles += static_cast<double>(obstacles.back().mesh.faces.size());
    check_total(item.where() + " and the others", triangles, folder.limits);
  }
  return obstacles;
}

void parse_settings(JsonObject& object, Scene& scene) {
  scene.name = excerpt(object.text("name", scene.source));
  object.text("description", "");
  scene.duration = object.number("duration", scene.duration, {1e-4, kMaxTime});
  if (object.has("time_step"))
    set_from_json(scene.parameters, "step.time_step", object["time_step"]);
  if (object.has("gravity")) set_vector(scene.parameters, "gravity", object["gravity"]);
  if (object.has("wind")) parse_wind(object["wind"], scene.parameters);
  if (object.has("parameters")) parse_parameters(object["parameters"], "", scene.parameters);
}

/// Refuses a garment that is worn on a body which is not there.
void check_wearers(const Scene& scene) {
  for (const Garment& garment : scene.garments) {
    const auto is_wearer = [&](const Obstacle& o) { return o.name == garment.body; };
    if (garment.body.empty() || std::ranges::any_of(scene.obstacles, is_wearer)) continue;
    throw InputError(scene.source + ": cloth " + in_quotes(scene.cloths[at(garment.cloth)].name) +
                     ": on: value " + in_quotes(garment.body) +
                     ", expected the name of an obstacle");
  }
}

}  // namespace

std::optional<double> parse_friction(JsonObject& object) {
  if (!object.has("friction")) return std::nullopt;
  return object["friction"].number({0, 2});
}

void refuse_feature(JsonObject& object, std::string_view key, const std::string& instead) {
  if (object.has(key)) object[key].refuse("no such key, it is not supported yet: " + instead);
}

void parse_parameters(JsonValue value, const std::string& group, Parameters& parameters) {
  JsonObject object(value);
  for (const auto& [key, member] : value.json().items()) {
    const std::string name = group + key;
    if (member.is_object() && group.empty()) {
      parse_parameters(object[key], name + ".", parameters);
    } else {
      set_from_json(parameters, name, object[key]);
    }
  }
}

Index find_cloth(const JsonValue& value, const std::vector<LoadedCloth>& cloths) {
  if (value.is_number())
    return static_cast<Index>(value.integer(0, static_cast<std::int64_t>(cloths.size()) - 1));
  for (std::size_t i = 0; i < cloths.size(); ++i)
    if (cloths[i].cloth.name == value.text()) return static_cast<Index>(i);
  value.refuse("the name or number of a cloth of the scene");
}

Index parse_vertex(JsonValue value, const LoadedCloth& cloth) {
  const FileLayout& layout = cloth.layout;
  const std::size_t vertices =
      layout.is_identity() ? cloth.cloth.mesh.positions.size() : layout.vertex.size();

  // Numbers are those of the vertices in the file, of which some may be welded or unused.
  if (value.is_number()) {
    const std::int64_t number = value.integer(0, static_cast<std::int64_t>(vertices) - 1);
    return layout.is_identity() ? static_cast<Index>(number)
                                : layout.vertex[static_cast<std::size_t>(number)];
  }

  // A name counts where it stands for one vertex; names of borders stand for many.
  const std::string& name = value.text();
  const std::vector<Index> found =
      cloth.grid ? grid_vertices(*cloth.grid, name) : std::vector<Index>{};
  if (found.size() == 1) return found.front();
  if (!cloth.grid) value.refuse("a vertex number (only grids have named vertices)");
  const auto names = grid_vertex_names();
  value.refuse("a vertex number or a name such as '" + std::string(nearest_name(name, names)) +
               "'");
}

ScriptedGrab parse_grab(JsonValue value, const std::vector<LoadedCloth>& cloths) {
  JsonObject object(value);
  if (cloths.empty()) value.refuse("a scene with a cloth to grab");
  ScriptedGrab grab;

  // A hand takes hold of one vertex, which a face has to contain.
  if (object.has("cloth")) grab.cloth = find_cloth(object["cloth"], cloths);
  grab.vertex =
      parse_vertex(object.required("vertex"), cloths[static_cast<std::size_t>(grab.cloth)]);
  if (grab.vertex == kNone) object["vertex"].refuse("a vertex that a face uses");

  // It holds on for as long as its path lasts, unless the scene gives other times.
  grab.path = parse_path(object.required("path"));
  if (object.boolean("smooth", false)) grab.path = smoothed(grab.path);
  grab.radius = object.number("radius", 0, {0, 10});
  grab.stiffness = object.number("stiffness", 0, {0, 1e6});
  grab.start = object.number("time", grab.path.front().time, kTime);
  grab.release = object.number("release", grab.path.back().time, kTime);
  if (grab.release < grab.start) object["release"].refuse("a time after the start of the grab");
  object.text("comment", "");
  object.finish();
  return grab;
}

CameraPose parse_camera(JsonValue value) {
  JsonObject object(value);
  CameraPose camera;
  camera.name = object.text("name", camera.name);
  camera.eye = object.required("eye").vector();
  camera.target = object.required("target").vector();
  camera.up = object.vector("up", camera.up);
  camera.fov = object.number("fov", camera.fov, {1, 170});

  // The view direction and the upward direction have to span a plane.
  const Vec3d across = cross(camera.target - camera.eye, camera.up);
  if (!(norm(across) > 0)) value.refuse("eye and target apart, and not along up");
  object.finish();
  return camera;
}

double total_grid_triangles(const nlohmann::json& scene) {
  double total = 0;
  if (!scene.is_object() || !scene.contains("cloths")) return 0;

  // Ill-formed entries are left to the parser, whose messages name them.
  for (const auto& cloth : scene["cloths"]) {
    const bool is_grid = cloth.is_object() && cloth.contains("mesh") && cloth["mesh"].is_object() &&
                         cloth["mesh"].contains("grid");
    const bool is_sewn = cloth.is_object() && cloth.contains("pattern");
    if (!is_grid && !is_sewn) continue;
    const bool chosen = cloth.contains("triangles") && cloth["triangles"].is_number();
    const double usual = is_sewn ? kPatternTriangles : kDefaultTriangles;
    total += chosen ? std::max(cloth["triangles"].get<double>(), 0.0) : usual;
  }
  return total;
}

bool sets_parameter(const nlohmann::json& scene, const std::string& group, const std::string& key) {
  const auto holds = [](const nlohmann::json& object, const std::string& name) {
    return object.is_object() && object.contains(name);
  };
  if (!scene.is_object()) return false;
  if (group == "wind" && scene.contains("wind") && holds(scene["wind"], key)) return true;
  if (!scene.contains("parameters")) return false;
  const nlohmann::json& parameters = scene["parameters"];
  return holds(parameters, group + "." + key) ||
         (holds(parameters, group) && holds(parameters[group], key));
}

Scene parse_scene(const nlohmann::json& json, const std::string& source,
                  const SceneFolder& scene_folder, SceneOrigin& origin) {
  JsonObject object(JsonValue(json, source));
  Scene scene;
  SceneFolder folder = scene_folder;
  folder.notes = &origin.notes;
  scene.source = source;
  parse_settings(object, scene);

  // Triangles are counted while objects are read, so that a small file cannot take all memory. The
  // grids are counted before any of them is made.
  double triangles = std::round(total_grid_triangles(json) * folder.triangle_scale);
  check_total(source + ": cloths", triangles, folder.limits);
  std::vector<LoadedCloth> cloths = parse_cloths(object.required("cloths"), folder, triangles);
  if (object.has("obstacles"))
    scene.obstacles = parse_obstacles(object["obstacles"], folder, triangles);

  // Seams and grabs name vertices of cloths, which are all known now.
  scene.seams = parse_seams(object["cloths"], cloths, folder);
  if (object.has("input"))
    for (const JsonValue& item : object["input"].items())
      scene.input.push_back(parse_grab(item, cloths));
  if (object.has("cameras"))
    for (const JsonValue& item : object["cameras"].items())
      scene.cameras.push_back(parse_camera(item));

  refuse_feature(object, "light", "the picture has its own");
  object.finish();
  if (cloths.empty()) object["cloths"].refuse("at least one cloth");

  for (LoadedCloth& loaded : cloths) {
    if (loaded.garment) {
      loaded.garment->cloth = static_cast<Index>(scene.cloths.size());
      scene.garments.push_back(std::move(*loaded.garment));
    }
    scene.cloths.push_back(std::move(loaded.cloth));
    origin.layouts.push_back(std::move(loaded.layout));
  }
  check_wearers(scene);
  return scene;
}

}  // namespace icloth
