// Cloths of a scene file.
#include <algorithm>
#include <cmath>

#include "sim/files/mesh_io.h"
#include "sim/files/polygon.h"
#include "sim/files/text.h"
#include "sim/scene/cloth_mesh.h"
#include "sim/scene/material_io.h"
#include "sim/scene/material_space.h"
#include "sim/scene/scene_json.h"
#include "sim/scene/transforms.h"

namespace icloth {
namespace {

constexpr int kMaxSubdivisions = 6;

/// A distance in metres; 0 or true: exact doubles alone, false: nothing is welded.
WeldChoice parse_weld(const JsonValue& value) {
  constexpr double kSmallestDistance = 1e-9;  // below it nothing but exact doubles is near
  WeldChoice choice;
  choice.asked = true;

  // A truth value switches welding, and a number is its distance.
  if (value.is_boolean()) {
    choice.on = value.boolean();
    return choice;
  }
  choice.distance = value.number({0, 1});
  if (choice.distance < kSmallestDistance) choice.distance = 0;
  return choice;
}

/// Metres for one unit of the texture coordinates that are a rest shape.
double parse_uv_scale(JsonObject& object) {
  struct Unit {
    const char* name;
    double metres;
  };
  constexpr Unit kUnits[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}};

  if (object.has("uv_scale")) {
    if (object.has("uv_unit")) object["uv_unit"].refuse("either \"uv_unit\" or \"uv_scale\"");
    return object["uv_scale"].number({1e-6, 1e6});
  }
  if (!object.has("uv_unit")) return 1;
  const std::string& unit = object["uv_unit"].text();
  for (const Unit& known : kUnits)
    if (unit == known.name) return known.metres;
  object["uv_unit"].refuse("\"m\", \"cm\" or \"mm\"");
}

/// Whether the rest shape is the texture coordinates.
bool rests_in_uv(JsonObject& object) {
  const bool in_uv = object.has("rest") && object["rest"].text() == "uv";
  for (const char* key : {"uv_unit", "uv_scale"})
    if (!in_uv && object.has(key)) object[key].refuse("no such key: only with \"rest\": \"uv\"");
  return in_uv;
}

/// Makes the texture coordinates of a mesh file, in metres and with their face up, its rest shape.
void take_rest_from_uv(JsonObject& object, Cloth& cloth) {
  if (cloth.mesh.uv.empty())
    object["rest"].refuse("a mesh with texture coordinates at every corner of its faces");
  const double scale = parse_uv_scale(object);
  for (auto& corners : cloth.mesh.uv)
    for (Vec2d& corner : corners) corner = scale * corner;

  // Pieces that are cut from mirrored patterns are turned over, and single faces are not.
  turn_mirrored_panels(cloth.mesh);
  const std::string problem = rest_shape_problem(cloth.mesh);
  if (!problem.empty()) object["rest"].refuse("texture coordinates that lie flat: " + problem);
  cloth.rest_in_uv = true;
}

/// Says when a pattern and its mesh are so different in size that the unit is probably another.
void note_uv_size(const SceneFolder& folder, const Cloth& cloth) {
  constexpr double kUsualShare = 4;  // garments are stretched or folded by less than this
  const double share = material_share(cloth.mesh, cloth.mesh.positions);
  if (share < 1 / kUsualShare || share > kUsualShare)
    folder.note("cloth " + in_quotes(cloth.name) + ": its area in uv is " + rounded_text(share) +
                " times that of the mesh: are its texture coordinates in metres? \"uv_unit\" and "
                "\"uv_scale\" change their size");
}

/// Keeps texture coordinates as material coordinates where they have the size of the rest shape,
/// and says why where they have not.
void judge_uv(const SceneFolder& folder, Cloth& cloth) {
  if (cloth.mesh.uv.empty()) return;
  turn_mirrored_panels(cloth.mesh);
  const std::string problem = size_problem(cloth.mesh, cloth.rest);
  if (problem.empty()) return;
  folder.note("cloth " + in_quotes(cloth.name) +
              ": the texture coordinates are not used as material coordinates: " + problem +
              "; where they are a flat pattern, \"rest\": \"uv\" takes them as the rest shape");
  cloth.mesh.uv.clear();
}

/// Reads the mesh of a cloth and its rest shape, a second mesh of the same topology or its texture
/// coordinates.
void read_shapes(JsonObject& object, const SceneFolder& folder, Cloth& cloth) {
  MeshFile file = read_mesh(folder.find(object["mesh"]));

  // The material coordinates of the rest shape win over those of the mesh.
  const bool in_uv = rests_in_uv(object);
  if (object.has("rest") && !in_uv) {
    MeshFile rest = read_mesh(folder.find(object["rest"]));
    if (!same_faces(file, rest))
      object["rest"].refuse("a mesh with the same vertices and faces as \"mesh\"");
    cut_like(rest, file);  // polygons are cut where they are not bent
    cloth.rest = std::move(rest.mesh.positions);
    if (!rest.mesh.uv.empty()) file.mesh.uv = std::move(rest.mesh.uv);
  }

  // Without a rest shape of its own, cloth is at rest as it is in its file.
  cloth.mesh = std::move(file.mesh);
  if (cloth.rest.empty()) cloth.rest = cloth.mesh.positions;
}

/// Parses how a mesh of so many faces is to be welded and subdivided.
ClothMeshOptions parse_mesh_options(JsonObject& object, const SceneFolder& folder,
                                    std::size_t faces) {
  ClothMeshOptions options;

  // Welding precedes the transform, but its distance is one in metres of the scene.
  if (object.has("weld")) options.weld = parse_weld(object["weld"]);
  if (object.has("transform")) options.scale = parse_transform(object["transform"]).scale;
  if (object.has("subdivide"))
    options.subdivisions = static_cast<int>(object["subdivide"].integer(0, kMaxSubdivisions));

  // The limit is checked before the triangles exist, each subdivision making four of one.
  const std::size_t most = static_cast<std::size_t>(folder.limits.triangles);
  if (options.subdivisions > 0 && faces > most >> (2 * options.subdivisions))
    object["subdivide"].refuse("at most " + std::to_string(most) + " triangles");
  return options;
}

/// Reads the mesh of a cloth and makes of it the one that is simulated.
void read_cloth_mesh(JsonObject& object, const SceneFolder& folder, LoadedCloth& loaded) {
  if (object.has("triangles"))
    object["triangles"].refuse(
        "no such key: only grids choose their triangles (see \"subdivide\")");
  Cloth& cloth = loaded.cloth;
  read_shapes(object, folder, cloth);
  const std::string file = shown_path(object["mesh"].text());
  check_cloth_mesh(cloth.mesh, file);
  check_cloth_mesh({cloth.rest, cloth.mesh.faces, {}}, file + " (rest shape)");
  if (rests_in_uv(object)) {
    take_rest_from_uv(object, cloth);
  } else {
    judge_uv(folder, cloth);
  }

  // Every change of the mesh that users should know of is noted.
  ClothMeshOptions options = parse_mesh_options(object, folder, cloth.mesh.faces.size());
  options.object = "cloth " + in_quotes(cloth.name);
  options.file = file;
  std::vector<std::string> notes;
  loaded.layout = prepare_cloth_mesh(cloth, options, notes);
  for (std::string& note : notes) folder.note(std::move(note));
}

void make_cloth_grid(JsonObject& object, const SceneFolder& folder, LoadedCloth& loaded) {
  JsonObject mesh(object["mesh"]);
  const Index most = folder.limits.triangles;

  // The count is scaled for `--set triangles`, which changes all grids of a scene alike.
  double triangles = kDefaultTriangles;
  if (object.has("triangles"))
    triangles = static_cast<double>(object["triangles"].integer(2, most));
  const double scaled = std::clamp<double>(std::round(triangles * folder.triangle_scale), 2, most);
  const GridShape shape = parse_grid(mesh.required("grid"), static_cast<Index>(scaled));
  mesh.finish();

  // Keys that change a mesh file make no sense for a grid, which is made as it is wanted.
  for (const char* key : {"rest", "uv_unit", "uv_scale", "subdivide", "weld"})
    if (object.has(key))
      object[key].refuse("no such key: only for mesh files, a grid is flat at rest");
  loaded.grid = make_grid(shape);
  loaded.cloth.mesh = std::move(loaded.grid->mesh);
  loaded.cloth.rest = loaded.grid->rest;
}

/// Applies the transform of a cloth and returns its scale.
Vec3d place_cloth(JsonObject& object, LoadedCloth& loaded) {
  Cloth& cloth = loaded.cloth;
  Vec3d scale{1, 1, 1};
  if (object.has("transform")) {
    const Placement place = parse_transform(object["transform"]);
    const Vec3d s = scale = place.scale;

    // Positions are placed, whereas the rest shape and the material space only change their size.
    // A pattern has its own unit, and keeps its size.
    if (!cloth.rest_in_uv && !cloth.mesh.uv.empty() && (s.x != s.y || s.y != s.z))
      object["transform"].refuse("one scale for all axes on a cloth with material coordinates");
    for (Vec3d& p : cloth.mesh.positions) p = place(p);
    for (Vec3d& p : loaded.layout.positions) p = place(p);
    for (Vec3d& p : cloth.rest) p = {s.x * p.x, s.y * p.y, s.z * p.z};
    if (!cloth.rest_in_uv)
      for (auto& corners : cloth.mesh.uv)
        for (Vec2d& corner : corners) corner = s.x * corner;
  }
  return scale;
}

void pin_box(const JsonValue& value, const LoadedCloth& loaded, std::vector<bool>& pinned) {
  const std::vector<JsonValue> corners = value.items();
  if (corners.size() != 2) value.refuse("two corners: [[x, y, z], [x, y, z]]");
  const Vec3d low = corners[0].vector(), high = corners[1].vector();

  const auto inside = [&](Vec3d p) {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
           p.z <= high.z;
  };

  // A box that holds no vertex is most likely misplaced. One of vertices without a face is not:
  // they stay where they are.
  const std::vector<Vec3d>& positions = loaded.cloth.mesh.positions;
  bool found = std::ranges::any_of(loaded.layout.positions, inside);
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (inside(positions[v])) found = pinned[v] = true;
  if (!found) value.refuse("a box with at least one vertex of the cloth in it");
}

void parse_pins(const JsonValue& value, LoadedCloth& loaded) {
  std::vector<bool> pinned(loaded.cloth.mesh.positions.size());  // each once, however often named

  // An item is a box of vertices, the name of a place on a grid, or one vertex.
  for (const JsonValue& item : value.items()) {
    if (item.is_object()) {
      JsonObject object(item);
      pin_box(object.required("box"), loaded, pinned);
      object.finish();
      continue;
    }
    std::vector<Index> named;
    if (item.is_string() && loaded.grid) named = grid_vertices(*loaded.grid, item.text());
    if (named.empty()) named = {parse_vertex(item, loaded)};
    for (Index v : named)
      if (v != kNone) pinned[static_cast<std::size_t>(v)] = true;  // without a face it stays anyway
  }

  for (std::size_t v = 0; v < pinned.size(); ++v)
    if (pinned[v]) loaded.cloth.pins.push_back(static_cast<Index>(v));
}

}  // namespace

LoadedCloth parse_cloth(JsonValue value, const SceneFolder& folder, std::size_t number) {
  JsonObject object(value);
  LoadedCloth loaded;
  loaded.cloth.name = object.text("name", "cloth" + std::to_string(number));

  // A pattern, a file or a grid gives the mesh before its transform, with the rest shape beside it.
  Vec3d scale{1, 1, 1};
  if (object.has("pattern")) {
    sew_cloth(object, folder, loaded);
  } else {
    for (const char* key : {"dress", "on", "layer"})
      if (object.has(key)) object[key].refuse("no such key: only with \"pattern\"");
    if (object.required("mesh").is_string()) {
      read_cloth_mesh(object, folder, loaded);
    } else {
      make_cloth_grid(object, folder, loaded);
    }
    scale = place_cloth(object, loaded);
  }

  // Mesh files hold no unit, so sizes that garments do not have get a note.
  if (!loaded.grid && !loaded.garment) {
    const std::string note =
        unit_note("cloth '" + loaded.cloth.name + "'", loaded.cloth.mesh.positions, scale, true);
    if (!note.empty()) folder.note(note);
  }

  if (loaded.cloth.rest_in_uv && !loaded.garment) note_uv_size(folder, loaded.cloth);

  // Pins follow the transform, since their boxes are given in the coordinates of the scene.
  if (object.has("pins")) parse_pins(object["pins"], loaded);
  const JsonValue material = object["material"];
  loaded.cloth.material =
      material.is_object()
          ? parse_material(material.json(), material.where(), folder.files)
          : load_material(object.text("material", "default"), material.where(), folder.files);

  // The folds of the rest shape are its rest angles unless the scene wants them flat.
  if (object.has("rest_angles")) {
    const std::string& angles = object["rest_angles"].text();
    if (angles != "mesh" && angles != "flat") object["rest_angles"].refuse("\"mesh\" or \"flat\"");
    if (angles == "mesh" && loaded.cloth.rest_in_uv)
      object["rest_angles"].refuse("\"flat\": a rest shape in uv has no folds");
    loaded.cloth.flat_angles = angles == "flat";
  }
  loaded.cloth.friction = parse_friction(object);
  if (object.has("seams") && loaded.garment)  // parse_seams reads them when all cloths are known
    object["seams"].refuse("no such key: a pattern has its own stitches");
  object.finish();
  return loaded;
}

}  // namespace icloth
