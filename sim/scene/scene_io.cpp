#include "sim/scene/scene_io.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "sim/files/assets.h"
#include "sim/files/box.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/scene/cloth_mesh.h"
#include "sim/scene/edge_lengths.h"
#include "sim/scene/material_io.h"
#include "sim/scene/presets.h"
#include "sim/scene/repair.h"
#include "sim/scene/scene_json.h"
#include "sim/scene/scene_meshes.h"
#include "sim/scene/world.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

struct Overrides {
  bool repair_start = false;
  std::vector<std::pair<std::string_view, std::string_view>> parameters;
  double triangles = 0;              ///< 0: as the scene says
  std::optional<double> clip_start;  ///< [s]; none: as the scene says
};

double parse_triangles(std::string_view text, Index most) {
  Index number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || rest != text.data() + text.size() || number < 2 || number > most)
    throw InputError("--set triangles: value " + in_quotes(text) +
                     ", expected a whole number from 2 to " + std::to_string(most));
  return number;
}

double parse_clip_start(std::string_view text) {
  double start = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), start);
  if (error != std::errc{} || rest != text.data() + text.size() || !(start >= 0 && start <= 1e6))
    throw InputError("--set clip_start: value " + in_quotes(text) +
                     ", expected seconds from 0 to 1e6");
  return start;
}

bool parse_switch(std::string_view key, std::string_view value) {
  if (value == "on" || value == "true" || value == "1") return true;
  if (value == "off" || value == "false" || value == "0") return false;
  throw InputError("--set " + excerpt(key) + ": value " + in_quotes(value) +
                   ", expected on or off");
}

Overrides split_overrides(std::span<const std::string> arguments, const SceneLimits& limits) {
  Overrides overrides;
  for (std::string_view argument : arguments) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw InputError("--set: value " + in_quotes(argument) + ", expected KEY=VALUE");
    const std::string_view key = argument.substr(0, equals), value = argument.substr(equals + 1);

    // A preset or a mode stands for several parameters; they keep their place in the order of
    // arguments, so that later ones override it.
    if (key == "preset" || key == "mode") {
      const auto settings =
          (key == "mode" ? find_collision_mode(value) : find_preset(value)).settings;
      overrides.parameters.insert(overrides.parameters.end(), settings.begin(), settings.end());
    } else if (key == "triangles") {
      overrides.triangles = parse_triangles(value, limits.triangles);
    } else if (key == "clip_start") {
      overrides.clip_start = parse_clip_start(value);
    } else if (key == "repair_start") {
      overrides.repair_start = parse_switch(key, value);
    } else {
      overrides.parameters.emplace_back(key, value);
    }
  }
  return overrides;
}

void hang_by_highest(Cloth& cloth) {
  const std::vector<Vec3d>& x = cloth.mesh.positions;
  const auto [low, high] = std::ranges::minmax_element(x, {}, &Vec3d::y);
  const double limit = high->y - 0.01 * (high->y - low->y);
  for (std::size_t v = 0; v < x.size(); ++v)
    if (x[v].y >= limit) cloth.pins.push_back(static_cast<Index>(v));
  if (cloth.pins.size() * 2 <= x.size()) return;

  // A sheet that lies flat has no top: two far corners hold it.
  const auto along = [](Vec3d p) { return p.x + p.z; };
  const auto [a, b] = std::ranges::minmax_element(x, {}, along);
  cloth.pins = {static_cast<Index>(a - x.begin()), static_cast<Index>(b - x.begin())};
}

/// Adds a camera that sees all cloths at their start.
void add_framing_camera(Scene& scene) {
  if (scene.cloths.empty()) return;
  Box box;
  for (const Cloth& cloth : scene.cloths)
    for (Vec3d p : cloth.mesh.positions) box.add(p);
  const auto [low, high] = box;

  // The sphere around the cloths fills most of the picture.
  CameraPose camera;
  const double radius = std::max(0.5 * norm(high - low), 1e-3);
  camera.target = 0.5 * (low + high);
  const double distance = 1.15 * radius / std::sin(camera.fov * std::numbers::pi / 360);
  camera.eye = camera.target + distance * normalized(Vec3d{0.35, 0.3, 1});
  scene.cameras.push_back(camera);
}

/// The parameters of the air that the scene file or the command line sets.
struct AirSettings {
  bool drag = false, density = false;
};

/// A scene as its file gives it.
struct FileScene {
  Scene scene;
  AirSettings air;
};

/// The mesh is the cloth, at rest as it is in the file.
Cloth cloth_of_mesh(const std::string& path, SceneOrigin& origin) {
  Cloth cloth;
  cloth.name = fs::path(path).stem().string();
  cloth.mesh = read_mesh(path).mesh;
  check_cloth_mesh(cloth.mesh, shown_path(path));
  cloth.mesh.uv.clear();  // may be texture coordinates of any size
  cloth.rest = cloth.mesh.positions;

  ClothMeshOptions options;
  options.object = "cloth " + in_quotes(cloth.name);
  options.file = path;
  origin.layouts.push_back(prepare_cloth_mesh(cloth, options, origin.notes));
  const std::string note = unit_note(options.object, cloth.mesh.positions, {1, 1, 1}, true);
  if (!note.empty()) origin.notes.push_back(note + " (in a scene file)");

  // Without a scene file nothing says what the cloth is made of or how it is held.
  cloth.material = load_material("default", "");
  hang_by_highest(cloth);
  return cloth;
}

FileScene scene_of_mesh(const std::string& path, SceneOrigin& origin) {
  Scene scene;
  scene.cloths.push_back(cloth_of_mesh(path, origin));
  scene.name = scene.cloths.front().name;
  return {std::move(scene), {}};
}

bool is_mesh_name(const std::string& argument) {
  const std::string extension = lower_extension(argument);
  return extension == ".obj" || extension == ".ply";
}

std::string scene_path(const std::string& argument) {
  const bool is_name = argument.find_first_of("./") == std::string::npos;
  if (!is_name) return argument;
  std::string path = assets_folder() + "/scenes/" + argument + ".json";
  std::error_code error;
  if (!fs::exists(path, error))
    throw InputError(
        "scene " + in_quotes(argument) +
        " is not known, expected a .json, .obj or .ply file or one of:" + asset_names("scenes"));
  return path;
}

/// Whether an obstacle plays a clip or a cache; ill-formed entries are left to the parser.
bool has_played_body(const nlohmann::json& scene) {
  if (!scene.is_object() || !scene.contains("obstacles")) return false;
  return std::ranges::any_of(scene["obstacles"], [](const nlohmann::json& obstacle) {
    return obstacle.is_object() && (obstacle.contains("clip") || obstacle.contains("animation"));
  });
}

FileScene scene_of_json(const std::string& argument, const Overrides& set,
                        const SceneLimits& limits, SceneOrigin& origin) {
  const std::string path = scene_path(argument);
  const nlohmann::json json = read_json(path);
  SceneFolder folder{
      {fs::path(path).parent_path().string(), limits.allow_outside}, 1, {}, limits, nullptr};

  // The number of triangles is that of all grids and patterns together, which keep their
  // proportions.
  if (set.triangles > 0) {
    const double own = total_grid_triangles(json);
    if (!(own > 0))
      throw InputError(shown_path(path) +
                       ": --set triangles: no cloth of the scene is a grid or a pattern");
    folder.triangle_scale = set.triangles / own;
  }

  // All bodies that play something start at the same moment, so that they stay together.
  folder.clip_start = set.clip_start;
  if (set.clip_start && !has_played_body(json))
    throw InputError(shown_path(path) + ": --set clip_start: no body of the scene plays a clip");
  const AirSettings air{.drag = sets_parameter(json, "wind", "air_drag"),
                        .density = sets_parameter(json, "wind", "air_density")};
  return {parse_scene(json, shown_path(path), folder, origin), air};
}

FileScene read_scene(const std::string& argument, const Overrides& set, const SceneLimits& limits,
                     SceneOrigin& origin) {
  const bool is_mesh = is_mesh_name(argument);
  if (is_mesh && set.triangles > 0)
    throw InputError(shown_path(argument) + ": --set triangles: a mesh file has no grid");
  if (is_mesh && set.clip_start)
    throw InputError(shown_path(argument) + ": --set clip_start: a mesh file plays no clip");
  FileScene file =
      is_mesh ? scene_of_mesh(argument, origin) : scene_of_json(argument, set, limits, origin);
  file.scene.source = argument;

  // Thicknesses that a scene gives for its own mesh do not suit a coarser or finer one.
  // The mesh of a pattern is made here, so a scene has no numbers for it.
  if (is_mesh || set.triangles > 0 || !file.scene.garments.empty()) fit_thickness(file.scene);
  return file;
}

/// Sets parameters in the order of the command line.
void set_parameters(FileScene& file, const Overrides& overrides) {
  for (const auto& [key, value] : overrides.parameters) {
    set_parameter(file.scene.parameters, key, value);
    file.air.drag = file.air.drag || key == "wind.air_drag";
    file.air.density = file.air.density || key == "wind.air_density";
  }
}

/// In still air the pressure on a moving cloth brakes it as drag does, and it depends on the
/// density. Whoever sets the drag to 0 and says nothing about the density wants no air.
void still_air_without_drag(FileScene& file, SceneOrigin& origin) {
  const AirSettings& set = file.air;
  WindParameters& wind = file.scene.parameters.wind;
  const bool is_still = wind.x == 0 && wind.y == 0 && wind.z == 0;
  if (!set.drag || set.density || wind.air_drag != 0 || !is_still || wind.air_density == 0) return;
  wind.air_density = 0;
  origin.notes.emplace_back(
      "wind.air_drag is 0 in still air: wind.air_density is set to 0 too, so that nothing brakes "
      "the cloth; set it to keep the pressure");
}

}  // namespace

double median_edge(const Scene& scene) {
  std::vector<double> lengths;
  for (const Cloth& cloth : scene.cloths) add_rest_lengths(cloth, lengths);
  return median(std::move(lengths));
}

void fit_thickness(Scene& scene) {
  const double edge = median_edge(scene);
  if (!(edge > 0)) return;
  Parameters& p = scene.parameters;
  p.proximity.thickness = std::max(std::min(p.proximity.thickness, 0.3 * edge),
                                   find_parameter("proximity.thickness")->minimum);
  p.impact_zones.offset = std::max(std::min(p.impact_zones.offset, 0.05 * edge),
                                   find_parameter("impact_zones.offset")->minimum);
}

std::shared_ptr<const Scene> load_scene(const std::string& argument,
                                        std::span<const std::string> overrides,
                                        const SceneLimits& limits, SceneOrigin* origin) {
  // Callers that do not ask where the parts came from still need a place for the answer.
  SceneOrigin own;
  if (!origin) origin = &own;
  const Overrides set = split_overrides(overrides, limits);

  // The command line wins over the scene file, so it comes after it.
  FileScene file = read_scene(argument, set, limits, *origin);
  set_parameters(file, set);
  still_air_without_drag(file, *origin);

  // The repair depends on the thickness, hence on all parameters. The camera looks at the cloth as
  // the scene has it.
  auto scene = std::make_shared<Scene>(std::move(file.scene));
  if (scene->cameras.empty()) add_framing_camera(*scene);
  if (set.repair_start) {
    // Garments are not where they start before they are put on (sim/garment/open_scene.h).
    scene->repair.emplace();
    if (scene->garments.empty()) repair_start(*scene, median_edge(*scene));
  }
  return scene;
}

}  // namespace icloth
