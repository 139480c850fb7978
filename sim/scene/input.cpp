#include "sim/scene/input.h"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/json_reader.h"
#include "sim/files/text.h"

// A recording is JSON, one line a step:
//   {"icloth_recording": 1, "scene": …, "build": …, "overrides": […], "steps": [
//   {"events": […], "parameters": {…}},
//   …
//   ], "final_hash": "0123456789abcdef"}

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;

constexpr Index kLargestIndex = 2147483647;
constexpr std::string_view kKinds[] = {"grab", "move", "release"};

Json to_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

Json to_json(const InputEvent& event) {
  Json json;
  json["kind"] = kKinds[static_cast<int>(event.kind)];
  json["handle"] = event.handle;

  // Members that say nothing are left out: those of other kinds, and those that the parameters
  // give.
  if (event.kind == InputEvent::Kind::grab) {
    json["face"] = event.face;
    json["barycentric"] = to_json(event.barycentric);
    if (event.radius != 0) json["radius"] = event.radius;
    if (event.stiffness != 0) json["stiffness"] = event.stiffness;
  }
  if (event.kind != InputEvent::Kind::release) json["target"] = to_json(event.target);
  return json;
}

/// Weights of the corners at a point of a face; rays hit its border a little outside.
Vec3d barycentric_from(const JsonValue& value) {
  constexpr double kTolerance = 1e-3;
  const Vec3d b = value.vector();
  const bool inside = std::min({b.x, b.y, b.z}) >= -kTolerance &&
                      std::max({b.x, b.y, b.z}) <= 1 + kTolerance &&
                      std::abs(b.x + b.y + b.z - 1) <= kTolerance;
  if (!inside) value.refuse("three weights from 0 to 1 whose sum is 1");
  return b;
}

InputEvent event_from(const JsonValue& value) {
  JsonObject object(value);
  InputEvent event;
  const JsonValue kind = object.required("kind");
  const auto found = std::ranges::find(kKinds, kind.text());
  if (found == std::end(kKinds)) kind.refuse("grab, move or release");
  event.kind = static_cast<InputEvent::Kind>(found - std::begin(kKinds));
  event.handle = static_cast<int>(object.required("handle").integer(0, kLargestIndex));

  // Only a grab says where it holds the cloth and how firmly; a release has no target.
  if (event.kind == InputEvent::Kind::grab) {
    event.face = static_cast<Index>(object.required("face").integer(0, kLargestIndex));
    event.barycentric = barycentric_from(object.required("barycentric"));
    event.radius = object.number("radius", 0, kNotNegative);
    event.stiffness = object.number("stiffness", 0, kNotNegative);
  }
  if (event.kind != InputEvent::Kind::release) event.target = object.required("target").vector();
  object.finish();
  return event;
}

Recording::Step step_from(const JsonValue& value) {
  JsonObject object(value);
  Recording::Step step;
  if (object.has("events"))
    for (const JsonValue& event : object["events"].items())
      step.events.push_back(event_from(event));

  // Ranges are checked here already, where a message can name the file and the element.
  if (object.has("parameters")) {
    const JsonValue changes = JsonObject(object["parameters"]).value();
    for (const auto& [name, number] : changes.json().items()) {
      const ParameterInfo* info = find_parameter(name);
      if (!info) changes.refuse("names of parameters");
      const JsonValue change(number, changes.where() + "." + name);
      step.parameters.emplace_back(name, change.number({info->minimum, info->maximum}));
    }
  }
  step.passed_over = object.boolean("passed_over", false);
  object.finish();
  return step;
}

std::uint64_t hash_from(const JsonValue& value) {
  const std::string& text = value.text();
  std::uint64_t hash = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, hash, 16);
  if (text.size() != 16 || error != std::errc{} || rest != end) value.refuse("16 hex digits");
  return hash;
}

Recording recording_from(const nlohmann::json& json, const std::string& name) {
  JsonObject root(JsonValue(json, name));
  root.required("icloth_recording").integer(1, 1);
  Recording recording;

  // The scene, build and overrides say what to load before the steps can be run again.
  recording.scene = root.required("scene").text();
  recording.build = root.required("build").text();
  if (recording.build != "cpu32" && recording.build != "cpu64" && recording.build != "cuda32")
    root["build"].refuse("cpu32, cpu64 or cuda32");

  for (const JsonValue& item : root.required("overrides").items())
    recording.overrides.push_back(item.text());
  for (const JsonValue& step : root.required("steps").items())
    recording.steps.push_back(step_from(step));
  recording.final_hash = hash_from(root.required("final_hash"));
  root.finish();
  return recording;
}

}  // namespace

Recording load_recording(const std::string& path) {
  return recording_from(read_json(path), shown_path(path));
}

Recording parse_recording(std::string_view text, const std::string& name) {
  return recording_from(parse_json(text, name), name);
}

void check_recording(const Recording& recording, const Scene& scene, const std::string& path) {
  std::size_t faces = 0;
  for (const Cloth& cloth : scene.cloths) faces += cloth.mesh.faces.size();

  // Only grabs refer to faces; moves and releases name a handle.
  for (std::size_t s = 0; s < recording.steps.size(); ++s) {
    const std::vector<InputEvent>& events = recording.steps[s].events;
    for (std::size_t e = 0; e < events.size(); ++e) {
      const InputEvent& event = events[e];
      if (event.kind != InputEvent::Kind::grab) continue;
      if (event.face >= 0 && static_cast<std::size_t>(event.face) < faces) continue;
      throw InputError(shown_path(path) + ": steps[" + std::to_string(s) + "].events[" +
                       std::to_string(e) + "].face: value " + std::to_string(event.face) +
                       ", expected 0 to " + std::to_string(static_cast<long long>(faces) - 1) +
                       ", the faces of the cloths of scene " + in_quotes(scene.name));
    }
  }
}

std::string recording_text(const Recording& recording) {
  // The object is written by hand around its steps, to have one line for each of them.
  Json head;
  head["icloth_recording"] = 1;
  head["scene"] = recording.scene;
  head["build"] = recording.build;
  head["overrides"] = recording.overrides;
  std::string text = head.dump();
  text.back() = ',';  // the object goes on
  text += " \"steps\": [\n";

  // Empty members are left out, because most steps of a recording have no events.
  for (std::size_t i = 0; i < recording.steps.size(); ++i) {
    Json step = Json::object();
    for (const InputEvent& event : recording.steps[i].events)
      step["events"].push_back(to_json(event));
    for (const auto& [name, value] : recording.steps[i].parameters)
      step["parameters"][name] = value;
    if (recording.steps[i].passed_over) step["passed_over"] = true;
    text += step.dump() + (i + 1 < recording.steps.size() ? ",\n" : "\n");
  }

  // A 64-bit hash is a text, as a JSON number need not hold it exactly.
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016" PRIx64, recording.final_hash);
  text += "], \"final_hash\": \"" + std::string(hash) + "\"}\n";
  return text;
}

void save_recording(const Recording& recording, const std::string& path) {
  write_file(path, recording_text(recording));
}

namespace {

/// Lowest-numbered face of a cloth that contains the vertex; fills face and barycentric weights.
void hit_vertex(const Scene& scene, const ScriptedGrab& grab, InputEvent& event) {
  // Events count the faces of all cloths in scene order.
  Index first_face = 0;
  for (Index c = 0; c < grab.cloth; ++c)
    first_face += static_cast<Index>(scene.cloths[static_cast<std::size_t>(c)].mesh.faces.size());
  const auto& faces = scene.cloths[static_cast<std::size_t>(grab.cloth)].mesh.faces;

  // All of the weight is on the corner that is the vertex.
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corner = std::ranges::find(faces[f], grab.vertex);
    if (corner == faces[f].end()) continue;
    const auto k = corner - faces[f].begin();
    event.face = first_face + static_cast<Index>(f);
    event.barycentric = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
    return;
  }
  throw InputError("scene '" + scene.name + "': scripted grab of vertex " +
                   std::to_string(grab.vertex) + ", expected a vertex of a face of the cloth");
}

Vec3d path_target(const ScriptedGrab& grab, double time) {
  const auto& path = grab.path;
  const auto next =
      std::ranges::find_if(path, [&](const PathPoint& point) { return point.time >= time; });
  if (next == path.end()) return path.back().target;
  if (next == path.begin()) return next->target;
  const PathPoint& last = *(next - 1);
  const double s = (time - last.time) / (next->time - last.time);
  return last.target + s * (next->target - last.target);
}

}  // namespace

ScriptedInput::ScriptedInput(const Scene& scene)
    : scene_(&scene), held_(scene.input.size()), done_(scene.input.size()) {
  for (const ScriptedGrab& grab : scene.input) {
    // Faults are found when the scene is loaded, not in the step in which a grab begins.
    InputEvent probe;
    if (grab.cloth < 0 || static_cast<std::size_t>(grab.cloth) >= scene.cloths.size())
      throw InputError("scene '" + scene.name + "': scripted grab of cloth " +
                       std::to_string(grab.cloth) + ", expected one of " +
                       std::to_string(scene.cloths.size()));
    if (grab.path.empty())
      throw InputError("scene '" + scene.name + "': scripted grab without a path, expected points");
    hit_vertex(scene, grab, probe);
  }
}

void ScriptedInput::go_on_holding(int handle) {
  const auto i = static_cast<std::size_t>(handle) - kFirstScriptedHandle;
  if (handle >= kFirstScriptedHandle && i < held_.size()) held_[i] = true;
}

std::vector<InputEvent> ScriptedInput::events(double time, double dt) {
  std::vector<InputEvent> events;
  const double middle = time + 0.5 * dt;  // rounding of the time must not shift a grab by a step
  for (std::size_t i = 0; i < scene_->input.size(); ++i) {
    const ScriptedGrab& grab = scene_->input[i];
    if (done_[i] || middle < grab.start) continue;
    InputEvent event;
    event.handle = kFirstScriptedHandle + static_cast<int>(i);
    event.target = path_target(grab, time + dt);

    // A grab whose time passed before its first step is never made, and needs no release.
    if (middle >= grab.release) {
      done_[i] = true;
      if (!held_[i]) continue;
      held_[i] = false;
      event.kind = InputEvent::Kind::release;
    } else if (!held_[i]) {
      held_[i] = true;
      event.kind = InputEvent::Kind::grab;
      event.radius = grab.radius;
      event.stiffness = grab.stiffness;
      hit_vertex(*scene_, grab, event);
    } else {
      event.kind = InputEvent::Kind::move;
    }
    events.push_back(event);
  }
  return events;
}

}  // namespace icloth
