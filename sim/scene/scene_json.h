// The pieces of a scene file, one function each. Included by the scene loader only.
#pragma once

#include <optional>

#include "sim/files/assets.h"
#include "sim/files/json_reader.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/shapes.h"

namespace icloth {

struct Placement;  // sim/scene/transforms.h, which reads Eigen

/// A cloth of the scene and, for a grid, the names of its vertices.
struct LoadedCloth {
  Cloth cloth;
  FileLayout layout;  ///< of its mesh file
  std::optional<GridMesh> grid;
  std::optional<Garment> garment;  ///< where it is sewn from a pattern
};

struct SceneFolder {
  FileScope files;            ///< they are looked for in its folder, then in the assets folder
  double triangle_scale = 1;  ///< factor on the triangles of every grid
  std::optional<double> clip_start;  ///< in place of "start" of what bodies play [s]
  SceneLimits limits;
  /// Lines that the user should read go here; null: they are dropped.
  std::vector<std::string>* notes = nullptr;

  void note(std::string line) const {
    if (notes) notes->push_back(std::move(line));
  }

  /// Path of a file that the scene names. Throws InputError where the scene may not open it.
  std::string find(const JsonValue& name) const {
    std::string path = find_asset(name.text(), files.folder);
    require_in_scope(path, name.text(), name.where(), files);
    return path;
  }
};

/// {"translate": [3], "rotate": [3 degrees, about x, then y, then z] or {"axis", "angle"}, "scale"}
Placement parse_transform(JsonValue value);
/// Rotation vector [rad] from degrees about x, y, z in turn, or from {"axis": [3], "angle":
/// degrees}.
Vec3d parse_rotation(JsonValue value);

/// Grid of about `triangles` triangles from {"size", "orientation", "bend"}.
GridShape parse_grid(JsonValue value, Index triangles);
/// Body of at most about so many triangles from {"sphere" | "capsule" | "box" | "plane" |
/// "funnel": {…}}.
TriangleMesh parse_body_shape(JsonValue value, Index most_triangles);

/// Coulomb coefficient of an object, from 0 to 2; none where it has no "friction".
std::optional<double> parse_friction(JsonObject& object);

/// Refuses a key of the format that this version does not act on.
void refuse_feature(JsonObject& object, std::string_view key, const std::string& instead);

/// Sum of the wanted triangles of all grids and patterns; ill-formed entries count as none.
double total_grid_triangles(const nlohmann::json& scene);

/// Sews a cloth from its pattern: "pattern", "triangles", "dress", "on", "layer", "transform".
void sew_cloth(JsonObject& object, const SceneFolder& folder, LoadedCloth& loaded);
/// Triangles of a cloth or a shape that does not say how many, and of a cloth that is sewn.
inline constexpr Index kDefaultTriangles = 2000;
inline constexpr double kPatternTriangles = 4000;

LoadedCloth parse_cloth(JsonValue value, const SceneFolder& folder, std::size_t number);
Obstacle parse_obstacle(JsonValue value, const SceneFolder& folder, std::size_t number);
/// The open seams of all cloths (key "seams" of a cloth); `list` is the list of the cloths.
std::vector<Seam> parse_seams(const JsonValue& list, const std::vector<LoadedCloth>& cloths,
                              const SceneFolder& folder);
ScriptedGrab parse_grab(JsonValue value, const std::vector<LoadedCloth>& cloths);
CameraPose parse_camera(JsonValue value);
/// Sets parameters that are given by dotted names or in nested groups.
void parse_parameters(JsonValue value, const std::string& group, Parameters& parameters);

/// Number of a cloth of the scene by its name or number.
Index find_cloth(const JsonValue& value, const std::vector<LoadedCloth>& cloths);

/// Vertex of a cloth by its number in the file, or by its name on a grid. kNone where no face uses
/// the vertex.
Index parse_vertex(JsonValue value, const LoadedCloth& cloth);

/// Whether a scene file sets a parameter, by its dotted name or in a group; wind also in "wind".
bool sets_parameter(const nlohmann::json& scene, const std::string& group, const std::string& key);

/// Parses a whole scene. `source` is its name in messages.
Scene parse_scene(const nlohmann::json& json, const std::string& source, const SceneFolder& folder,
                  SceneOrigin& origin);

}  // namespace icloth
