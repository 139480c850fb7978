// Cloths of a scene file that are sewn from patterns.
#include <algorithm>
#include <cmath>

#include "sim/files/text.h"
#include "sim/scene/scene_json.h"
#include "sim/scene/transforms.h"

namespace icloth {
namespace {

/// Parses how the garment is put on: false, true, or an object with times and held labels.
DressPlan parse_dress(const JsonValue& value) {
  DressPlan plan;
  if (value.is_boolean()) {
    plan.on = value.boolean();
    return plan;
  }

  JsonObject object(value);
  plan.closing = object.number("closing", plan.closing, {0, 60});
  plan.settling = object.number("settling", plan.settling, {0, 60});
  if (object.has("hold"))
    for (const JsonValue& label : object["hold"].items()) plan.hold.push_back(label.text());
  object.finish();
  return plan;
}

/// Where the garment as a whole stands; a pattern has its size in it.
void parse_place(const JsonValue& value, Garment& garment) {
  const Placement place = parse_transform(value);
  if (place.scale.x != 1 || place.scale.y != 1 || place.scale.z != 1)
    value.refuse("no \"scale\": the unit of a pattern is in its file");
  const Eigen::AngleAxisd turn(place.rotation);
  garment.rotation = from_eigen(turn.angle() * turn.axis());
  garment.translation = from_eigen(place.translation);
}

}  // namespace

void sew_cloth(JsonObject& object, const SceneFolder& folder, LoadedCloth& loaded) {
  for (const char* key :
       {"mesh", "rest", "uv_unit", "uv_scale", "subdivide", "weld", "rest_angles"})
    if (object.has(key)) object[key].refuse("no such key: not with \"pattern\"");
  const Index most = folder.limits.triangles;

  // The count is scaled for `--set triangles`, which changes grids and patterns alike.
  double triangles = kPatternTriangles;
  if (object.has("triangles"))
    triangles = static_cast<double>(object["triangles"].integer(2, most));
  const double scaled = std::clamp<double>(std::round(triangles * folder.triangle_scale), 2, most);
  std::vector<std::string> notes;
  Garment garment = read_garment(folder.find(object["pattern"]), static_cast<Index>(scaled), notes);
  if (object.has("dress")) garment.plan = parse_dress(object["dress"]);
  if (object.has("on")) garment.body = object["on"].text();
  if (object.has("layer")) garment.layer = static_cast<Index>(object["layer"].integer(0, 100));
  if (object.has("transform")) parse_place(object["transform"], garment);

  sew_garment(garment, loaded.cloth);
  notes.insert(notes.end(), garment.sewn.notes.begin(), garment.sewn.notes.end());
  for (const std::string& note : notes)
    folder.note("cloth " + in_quotes(loaded.cloth.name) + ": " + note);
  loaded.garment = std::move(garment);
}

}  // namespace icloth
