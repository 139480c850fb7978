// The JSON of GarmentCode and its predecessor (github.com/maria-korosteleva/GarmentCode), as far as
// it describes panels and stitches. Keys that are not known are passed over: the files carry the
// parameters of the programs that made them.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/json_reader.h"
#include "sim/files/text.h"
#include "sim/pattern/outline.h"
#include "sim/pattern/pattern.h"
#include "sim/pattern/pattern_checks.h"

namespace icloth {
namespace {

constexpr std::uint64_t kMaxBytes = 64u << 20;
constexpr NumberRange kCoordinate{-1e6, 1e6};  ///< in units of the file
constexpr double kDefaultUnits = 100;          ///< a metre has so many, where the file does not say

struct Units {
  double per_metre = kDefaultUnits;
  bool absolute_curves = false;  ///< control points are in panel coordinates
  bool centre_panels = false;    ///< the mean of the corners moves into the translation
};

Vec2d point_of(const JsonValue& value) {
  const std::vector<double> xy = value.numbers(2, kCoordinate);
  return {xy[0], xy[1]};
}

double norm_of(Vec2d a) { return std::sqrt(a.x * a.x + a.y * a.y); }

/// The elements of an array that is not longer than a limit.
std::vector<JsonValue> limited_items(const JsonValue& value, std::size_t most) {
  if (value.is_array() && value.json().size() > most)
    value.refuse("an array of at most " + std::to_string(most) + " elements");
  return value.items();
}

/// True for true and for numbers other than 0, as the files have both.
bool flag_of(const JsonValue& value) {
  return value.is_boolean() ? value.boolean() : value.integer(0, 1) != 0;
}

class PatternReader {
 public:
  PatternReader(const nlohmann::json& json, const std::string& name) : json_(json) {
    pattern_.file = name;
  }

  Pattern read() {
    JsonObject file(JsonValue(json_, pattern_.file));
    if (!file.has("pattern"))
      throw InputError(pattern_.file + ": has no key 'pattern', expected a sewing pattern");
    read_properties(file);
    JsonObject content(file["pattern"]);

    // Panels are kept in an order of their own, which the file may give.
    JsonObject panels(content.required("panels"));
    const std::size_t count = panels.value().json().size();
    if (count == 0 || count > kMostPanels)
      panels.value().refuse("1 to " + std::to_string(kMostPanels) + " panels, not " +
                            std::to_string(count));
    for (const std::string& name : panel_names(content, panels)) read_panel(name, panels);
    if (content.has("stitches")) read_stitches(content["stitches"]);

    check_pattern(pattern_);
    return std::move(pattern_);
  }

 private:
  std::string panel_place(const std::string& name) const {
    return pattern_.file + ": panel " + in_quotes(name);
  }
  void note(const std::string& text) { pattern_.notes.push_back(pattern_.file + ": " + text); }

  void read_properties(JsonObject& file);
  std::vector<std::string> panel_names(JsonObject& content, const JsonObject& panels);
  void read_panel(const std::string& name, JsonObject& panels);
  void read_corners(Panel& panel, JsonObject& object);
  void read_edges(Panel& panel, JsonObject& object);
  void read_curve(const Panel& panel, PanelEdge& edge, const JsonValue& curvature);
  void read_circle(const Panel& panel, PanelEdge& edge, const JsonValue& params);
  Vec2d control_point(const Panel& panel, const PanelEdge& edge, const JsonValue& value) const;
  void read_stitches(const JsonValue& stitches);
  PanelSide read_side(const JsonValue& value) const;

  const nlohmann::json& json_;
  Pattern pattern_;
  Units units_;
  std::size_t edges_ = 0;                 ///< of all panels so far
  std::map<std::string, Index> numbers_;  ///< of the panels
};

void PatternReader::read_properties(JsonObject& file) {
  const bool has_properties = file.has("properties");
  static const nlohmann::json kEmpty = nlohmann::json::object();
  JsonObject properties(has_properties ? file["properties"]
                                       : JsonValue(kEmpty, file.value().where() + ": properties"));
  if (properties.has("units_in_meter"))
    units_.per_metre = properties.number("units_in_meter", kDefaultUnits, {1e-3, 1e6});
  else
    note("units_in_meter is missing, 100 (centimetres) is assumed");

  const std::string curves = properties.text("curvature_coords", "relative");
  if (curves != "relative" && curves != "absolute")
    properties["curvature_coords"].refuse("\"relative\" or \"absolute\"");
  units_.absolute_curves = curves == "absolute";
  units_.centre_panels = properties.boolean("normalize_panel_translation", false);
}

/// The names in the order that the file gives, then all others by the alphabet.
std::vector<std::string> PatternReader::panel_names(JsonObject& content, const JsonObject& panels) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (numbers_.emplace(name, static_cast<Index>(names.size())).second) names.push_back(name);
  };
  const nlohmann::json& known = panels.value().json();
  if (content.has("panel_order") && content["panel_order"].is_array())
    for (const auto& name : content["panel_order"].json())
      if (name.is_string() && known.contains(name.get_ref<const std::string&>()))
        add(name.get<std::string>());
  for (const auto& [name, unused] : known.items()) add(name);
  return names;
}

void PatternReader::read_panel(const std::string& name, JsonObject& panels) {
  JsonObject object(JsonValue(panels[name].json(), panel_place(name)));
  Panel panel;
  panel.name = name;
  if (object.has("label") && object["label"].is_string()) panel.label = object.text("label", "");
  read_corners(panel, object);
  read_edges(panel, object);

  // The placement is optional: patterns from drawing programs have none.
  const double metre = 1 / units_.per_metre;
  const auto vector = [&](const char* key) {
    return object.has(key) ? object[key].vector(kCoordinate) : Vec3d{};
  };
  panel.placement.translation += metre * vector("translation");
  panel.placement.rotation = vector("rotation");
  panel.placement.bend_radius = metre * object.number("bend_radius", 0, kCoordinate);
  if (panel.placement.bend_radius != 0 && std::fabs(panel.placement.bend_radius) < 1e-3)
    object["bend_radius"].refuse("a radius of at least 1 mm, or 0 for a flat panel");
  pattern_.panels.push_back(std::move(panel));
}

void PatternReader::read_corners(Panel& panel, JsonObject& object) {
  const double metre = 1 / units_.per_metre;
  for (const JsonValue& value : limited_items(object.required("vertices"), kMostPanelEdges)) {
    panel.corners.push_back(metre * point_of(value));
    const Vec2d p = panel.corners.back();
    if (std::max(std::fabs(p.x), std::fabs(p.y)) > kLargestReach)
      value.refuse("coordinates of at most " + number_text(kLargestReach) + " m, with " +
                   number_text(units_.per_metre) + " units a metre");
  }
  if (!units_.centre_panels || panel.corners.empty()) return;

  // The mean of the corners becomes the origin of the panel.
  Vec2d mean;
  for (const Vec2d& p : panel.corners) mean = mean + p;
  mean = (1.0 / static_cast<double>(panel.corners.size())) * mean;
  for (Vec2d& p : panel.corners) p = p - mean;
  panel.placement.translation = {mean.x, mean.y, 0};
}

void PatternReader::read_edges(Panel& panel, JsonObject& object) {
  const std::vector<JsonValue> items = limited_items(object.required("edges"), kMostPanelEdges);
  edges_ += items.size();
  if (edges_ > kMostPanelEdges)
    throw InputError(panel_place(panel.name) + ": value " + std::to_string(edges_) +
                     " edges up to this panel, expected at most " +
                     std::to_string(kMostPanelEdges));
  if (items.size() < 2) object["edges"].refuse("a loop of at least 2 edges");

  const auto last_corner = static_cast<std::int64_t>(panel.corners.size()) - 1;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string where = panel_place(panel.name) + ": edge " + std::to_string(i);
    JsonObject item(JsonValue(items[i].json(), where));

    // The ends are corners of the panel, and not at one place.
    PanelEdge edge;
    const JsonValue ends = item.required("endpoints");
    const std::vector<JsonValue> pair = limited_items(ends, 2);
    if (pair.size() != 2) ends.refuse("the numbers of two corners");
    edge.start = static_cast<Index>(pair[0].integer(0, last_corner));
    edge.end = static_cast<Index>(pair[1].integer(0, last_corner));
    const Vec2d a = panel.corners[static_cast<std::size_t>(edge.start)];
    const Vec2d b = panel.corners[static_cast<std::size_t>(edge.end)];
    if (!(norm_of(b - a) > 2 * kPanelGrid))
      ends.refuse("two corners that are apart: the edge has no length");

    if (item.has("curvature") && !item["curvature"].json().is_null())
      read_curve(panel, edge, item["curvature"]);
    if (item.has("label") && item["label"].is_string()) edge.label = item.text("label", "");
    panel.edges.push_back(std::move(edge));
  }
}

/// A control point in the frame of the edge: along it, and to its left, both in lengths of the
/// edge.
Vec2d PatternReader::control_point(const Panel& panel, const PanelEdge& edge,
                                   const JsonValue& value) const {
  const Vec2d c = point_of(value);
  const Vec2d start = panel.corners[static_cast<std::size_t>(edge.start)];
  const Vec2d along = panel.corners[static_cast<std::size_t>(edge.end)] - start;
  Vec2d point = start + c.x * along + c.y * Vec2d{-along.y, along.x};

  // The mean of the corners, where it was taken away, counts for absolute points as well.
  if (units_.absolute_curves) {
    const Vec3d moved = panel.placement.translation;
    point = (1 / units_.per_metre) * c - Vec2d{moved.x, moved.y};
  }
  if (std::max(std::fabs(point.x), std::fabs(point.y)) > 2 * kLargestReach)
    value.refuse("a control point near the panel");
  return point;
}

void PatternReader::read_curve(const Panel& panel, PanelEdge& edge, const JsonValue& curvature) {
  // A bare pair is the older form of a quadratic curve.
  if (curvature.is_array()) {
    edge.curve = EdgeCurve::quadratic;
    edge.control[0] = control_point(panel, edge, curvature);
    return;
  }

  JsonObject object(curvature);
  const std::string& type = object.required("type").text();
  const JsonValue params = object.required("params");
  if (type == "circle") {
    read_circle(panel, edge, params);
    return;
  }
  if (type != "quadratic" && type != "cubic")
    object["type"].refuse("\"quadratic\", \"cubic\" or \"circle\"");

  const std::size_t count = type == "cubic" ? 2 : 1;
  const std::vector<JsonValue> points = limited_items(params, 2);
  if (points.size() != count)
    params.refuse(count == 2 ? "two control points" : "one control point");
  edge.curve = count == 2 ? EdgeCurve::cubic : EdgeCurve::quadratic;
  for (std::size_t k = 0; k < count; ++k) edge.control[k] = control_point(panel, edge, points[k]);
}

void PatternReader::read_circle(const Panel& panel, PanelEdge& edge, const JsonValue& params) {
  const std::vector<JsonValue> values = limited_items(params, 3);
  if (values.size() != 3) params.refuse("radius, large arc and direction: [r, 0 or 1, 0 or 1]");
  edge.curve = EdgeCurve::circle;
  edge.radius = values[0].number({1e-9, 1e6}) / units_.per_metre;
  edge.large_arc = flag_of(values[1]);
  edge.counter_clockwise = flag_of(values[2]);
  if (edge.radius > 1e3) values[0].refuse("a radius of at most 1000 m");

  // Rounding leaves half circles a little too small. More than that is told.
  const double half = 0.5 * norm_of(panel.corners[static_cast<std::size_t>(edge.end)] -
                                    panel.corners[static_cast<std::size_t>(edge.start)]);
  if (edge.radius < half * (1 - 1e-3))
    pattern_.notes.push_back(params.where() + ": the radius " + rounded_text(100 * edge.radius) +
                             " cm does not reach over the edge, " + rounded_text(100 * half) +
                             " cm is taken");
  edge.radius = std::max(edge.radius, half);
}

PanelSide PatternReader::read_side(const JsonValue& value) const {
  // The panel, by its name.
  JsonObject object(value);
  const std::string& name = object.required("panel").text();
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) {
    std::vector<std::string_view> names;
    for (const auto& [known, unused] : numbers_) names.push_back(known);
    object["panel"].refuse("the name of a panel, the nearest is " +
                           in_quotes(nearest_name(name, names)));
  }

  // The edge, by its number.
  const Panel& panel = pattern_.panels[static_cast<std::size_t>(found->second)];
  const auto last = static_cast<std::int64_t>(panel.edges.size()) - 1;
  const JsonValue edge = object.required("edge");
  if (!edge.is_number() || edge.json().get<double>() < 0 ||
      edge.json().get<double>() > static_cast<double>(last))
    edge.refuse("an edge of panel " + in_quotes(name) + ", from 0 to " + std::to_string(last));
  return {found->second, static_cast<Index>(edge.integer(0, last))};
}

void PatternReader::read_stitches(const JsonValue& stitches) {
  std::map<std::pair<Index, Index>, std::size_t> sewn;  // edge → its stitch
  for (const JsonValue& item : limited_items(stitches, kMostPanelEdges)) {
    const std::size_t number = pattern_.stitches.size();
    const JsonValue value(item.json(), pattern_.file + ": stitch " + std::to_string(number));
    const std::vector<JsonValue> parts = limited_items(value, 3);
    if (parts.size() < 2) value.refuse("two edges, each with panel and edge");
    Stitch stitch;
    for (std::size_t k = 0; k < 2; ++k) stitch.sides[k] = read_side(parts[k]);
    if (parts.size() == 3 && (!parts[2].is_string() || parts[2].text() != "right_wrong"))
      parts[2].refuse("\"right_wrong\" or nothing");
    stitch.right_wrong = parts.size() == 3;

    // An edge is sewn once; branches are made by dividing edges.
    for (const PanelSide& side : stitch.sides) {
      const auto [first, is_new] = sewn.emplace(std::pair{side.panel, side.edge}, number);
      if (!is_new)
        throw InputError(value.where() + ": edge " + std::to_string(side.edge) + " of panel " +
                         in_quotes(pattern_.panels[static_cast<std::size_t>(side.panel)].name) +
                         (first->second == number
                              ? " is sewn to itself, expected two edges"
                              : " is sewn twice (in stitch " + std::to_string(first->second) +
                                    " as well), expected every edge in one stitch at most"));
    }
    pattern_.stitches.push_back(stitch);
  }
}

}  // namespace

Pattern parse_pattern(std::string_view text, const std::string& name) {
  return PatternReader(parse_json(text, name), name).read();
}

Pattern read_pattern(const std::string& path) {
  if (lower_extension(path) == ".dxf")
    return parse_pattern_dxf(read_file(path, kMaxBytes), shown_path(path));
  return parse_pattern(read_file(path, kMaxBytes), shown_path(path));
}

}  // namespace icloth
