// Whole scenes, with the files that they name.
#include <algorithm>
#include <cmath>

#include "sim/scene/input.h"
#include "sim/scene/scene_io.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace icloth::fuzz {
namespace {

/// Small enough for thousands of scenes a second; the limits themselves are tested with them.
constexpr SceneLimits kLimits{2000, 1000};

bool is_finite(Vec3d a) { return std::isfinite(a.x + a.y + a.z); }

void require_valid(const Material& material) {
  require(material.density > 0 && std::isfinite(material.density), "a density");
  for (const auto& row : material.stretching)
    for (double c : row) require(std::isfinite(c), "finite stretching");
  for (const auto& row : material.bending)
    for (double c : row) require(c >= 0 && std::isfinite(c), "bending, at least 0");
}

void require_valid(const Cloth& cloth) {
  fuzz::require_valid(cloth.mesh);
  require(!cloth.mesh.faces.empty(), "a cloth with faces");
  require(cloth.rest.size() == cloth.mesh.positions.size(), "a rest shape of the same vertices");
  require_finite(cloth.rest);
  require_valid(cloth.material);
  require(std::ranges::is_sorted(cloth.pins), "sorted pins");
  require(std::ranges::adjacent_find(cloth.pins) == cloth.pins.end(), "every pin once");
  for (Index v : cloth.pins)
    require(v >= 0 && static_cast<std::size_t>(v) < cloth.rest.size(), "pins that are vertices");
}

void require_valid(const Obstacle& obstacle) {
  fuzz::require_valid(obstacle.mesh);
  std::vector<Vec3d> positions;
  for (double time : {0.0, 0.3, 1e9}) {
    obstacle.pose(time, positions);
    require(positions.size() == obstacle.mesh.positions.size(), "a pose of all vertices");
    require_finite(positions);
  }
}

void require_valid(const ScriptedGrab& grab) {
  require(!grab.path.empty() && grab.start <= grab.release, "a path and a time for it");
  for (std::size_t i = 0; i < grab.path.size(); ++i) {
    require(is_finite(grab.path[i].target), "a finite path");
    require(i == 0 || grab.path[i].time > grab.path[i - 1].time, "a path sorted by time");
  }
}

void require_valid(const Scene& scene) {
  require(!scene.cloths.empty() && !scene.cameras.empty(), "a cloth and a camera");
  for (const Cloth& cloth : scene.cloths) require_valid(cloth);
  for (const Obstacle& obstacle : scene.obstacles) require_valid(obstacle);
  for (const ScriptedGrab& grab : scene.input) require_valid(grab);
  for (const CameraPose& camera : scene.cameras)
    require(is_finite(camera.eye) && is_finite(camera.target) && is_finite(camera.up), "cameras");
  for (const ParameterInfo& info : parameter_table()) {
    const double value = get_parameter(scene.parameters, info);
    require(value >= info.minimum && value <= info.maximum, "parameters within their ranges");
  }
  ScriptedInput input(scene);
  for (double time : {0.0, 0.5, 1e4})
    for (const InputEvent& event : input.events(time, 0.01))
      require(is_finite(event.target), "finite targets");
}

}  // namespace

std::string read_scene(std::string_view bytes) {
  if (leaves_folder(bytes)) return kLeavesFolder;
  const std::string path = write_scratch("scene.json", bytes);
  std::shared_ptr<const Scene> scene;
  const std::string reason = refusal([&] { scene = load_scene(path, {}, kLimits); });
  if (!reason.empty()) return reason;
  require_valid(*scene);
  // With another size of the grids, as --set triangles asks for.
  const std::string finer[] = {"triangles=500"};
  if (refusal([&] { scene = load_scene(path, finer, kLimits); }).empty()) require_valid(*scene);
  return "";
}

}  // namespace icloth::fuzz
