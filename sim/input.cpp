#include "sim/input.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sim/error.h"

// A recording is a JSON array of lines: a head, one object a step, and a foot with the hash:
//   {"icloth_recording": 1, "scene": …, "build": …, "overrides": [...], "steps": [
//   {"events": [...], "parameters": {...}},
//   …
//   ], "final_hash": "0123456789abcdef"}

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestRecording = std::uintmax_t{1} << 30;  // [bytes]
constexpr int kFirstScriptedHandle = 1000;
constexpr std::string_view kKinds[] = {"grab", "move", "release"};

/// Element of a recording with the words that name it in an error.
struct Element {
  const Json& json;
  std::string where;

  [[noreturn]] void refuse(const std::string& expected) const {
    std::string value = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (value.size() > 60) value = value.substr(0, 60) + "…";
    throw InputError(where + ": " + value + ", expected " + expected);
  }
  Element operator[](const char* key) const {
    if (!json.is_object() || !json.contains(key)) refuse(std::string("the key '") + key + "'");
    return {json[key], where + "." + key};
  }
  bool has(const char* key) const { return json.is_object() && json.contains(key); }
  std::string text() const {
    if (!json.is_string()) refuse("a text");
    return json.get<std::string>();
  }
  double number() const {
    if (!json.is_number()) refuse("a number");
    const double value = json.get<double>();
    if (!std::isfinite(value)) refuse("a finite number");
    return value;
  }
  Index index() const {
    const double value = number();
    if (!(value >= 0 && value <= 2147483647.0 && value == std::floor(value)))
      refuse("a whole number from 0");
    return static_cast<Index>(value);
  }
  Vec3d vector() const {
    if (!json.is_array() || json.size() != 3) refuse("three numbers");
    const auto part = [&](std::size_t k) { return Element{json[k], where}.number(); };
    return {part(0), part(1), part(2)};
  }
  void keys(std::initializer_list<std::string_view> known) const {
    if (!json.is_object()) refuse("an object");
    for (const auto& item : json.items())
      if (std::ranges::find(known, item.key()) == known.end())
        throw InputError(where + ": unknown key '" + item.key() + "', the nearest known one is '" +
                         std::string(nearest_name(item.key(), {known.begin(), known.size()})) +
                         "'");
  }
};

Json to_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

Json to_json(const InputEvent& event) {
  Json json;
  json["kind"] = kKinds[static_cast<int>(event.kind)];
  json["handle"] = event.handle;
  if (event.kind == InputEvent::Kind::grab) {
    json["face"] = event.face;
    json["barycentric"] = to_json(event.barycentric);
    if (event.radius != 0) json["radius"] = event.radius;
    if (event.stiffness != 0) json["stiffness"] = event.stiffness;
  }
  if (event.kind != InputEvent::Kind::release) json["target"] = to_json(event.target);
  return json;
}

InputEvent event_from(const Element& element) {
  element.keys({"kind", "handle", "face", "barycentric", "target", "radius", "stiffness"});
  InputEvent event;
  const std::string kind = element["kind"].text();
  const auto found = std::ranges::find(kKinds, kind);
  if (found == std::end(kKinds)) element["kind"].refuse("grab, move or release");
  event.kind = static_cast<InputEvent::Kind>(found - std::begin(kKinds));
  event.handle = element["handle"].index();
  if (event.kind == InputEvent::Kind::grab) {
    event.face = element["face"].index();
    event.barycentric = element["barycentric"].vector();
    if (element.has("radius")) event.radius = element["radius"].number();
    if (element.has("stiffness")) event.stiffness = element["stiffness"].number();
    if (event.radius < 0 || event.stiffness < 0) element.refuse("radius and stiffness from 0");
  }
  if (event.kind != InputEvent::Kind::release) event.target = element["target"].vector();
  return event;
}

Recording::Step step_from(const Element& element) {
  element.keys({"events", "parameters"});
  Recording::Step step;
  if (element.has("events")) {
    const Element events = element["events"];
    if (!events.json.is_array()) events.refuse("a list");
    for (std::size_t i = 0; i < events.json.size(); ++i)
      step.events.push_back(
          event_from({events.json[i], events.where + "[" + std::to_string(i) + "]"}));
  }
  if (!element.has("parameters")) return step;
  Parameters scratch;
  for (const auto& item : element["parameters"].json.items()) {
    const Element value{item.value(), element.where + ".parameters." + item.key()};
    const ParameterInfo* info = find_parameter(item.key());
    if (!info) value.refuse("the name of a parameter");
    try {
      set_parameter(scratch, *info, value.number());  // range check
    } catch (const InputError& error) {
      throw InputError(element.where + ": " + error.what());
    }
    step.parameters.emplace_back(item.key(), value.number());
  }
  return step;
}

std::uint64_t hash_from(const Element& element) {
  const std::string text = element.text();
  char* end = nullptr;
  const std::uint64_t hash = std::strtoull(text.c_str(), &end, 16);
  if (text.size() != 16 || end != text.c_str() + text.size()) element.refuse("16 hex digits");
  return hash;
}

Json parse_file(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path + ": cannot be read, expected a recording");
  if (size > kLargestRecording)
    throw InputError(path + ": " + std::to_string(size) + " bytes, expected at most 2^30");
  std::ifstream file(path);
  try {
    return Json::parse(file);
  } catch (const Json::exception& failure) {
    std::string what = failure.what();
    std::ranges::replace(what, '\n', ' ');
    throw InputError(path + ": not a recording, expected JSON: " + what);
  }
}

}  // namespace

Recording load_recording(const std::string& path) {
  const Json json = parse_file(path);
  const Element root{json, path};
  root.keys({"icloth_recording", "scene", "build", "overrides", "steps", "final_hash"});
  if (root["icloth_recording"].index() != 1) root["icloth_recording"].refuse("version 1");
  Recording recording;
  recording.scene = root["scene"].text();
  recording.build = root["build"].text();
  if (recording.build != "cpu32" && recording.build != "cpu64" && recording.build != "cuda32")
    root["build"].refuse("cpu32, cpu64 or cuda32");
  const Element overrides = root["overrides"], steps = root["steps"];
  if (!overrides.json.is_array()) overrides.refuse("a list");
  for (const Json& item : overrides.json)
    recording.overrides.push_back(Element{item, overrides.where}.text());
  if (!steps.json.is_array()) steps.refuse("a list");
  for (std::size_t i = 0; i < steps.json.size(); ++i)
    recording.steps.push_back(step_from({steps.json[i], path + ": step " + std::to_string(i)}));
  recording.final_hash = hash_from(root["final_hash"]);
  return recording;
}

void save_recording(const Recording& recording, const std::string& path) {
  Json head;
  head["icloth_recording"] = 1;
  head["scene"] = recording.scene;
  head["build"] = recording.build;
  head["overrides"] = recording.overrides;
  std::string text = head.dump();
  text.back() = ',';  // the object goes on
  text += " \"steps\": [\n";
  for (std::size_t i = 0; i < recording.steps.size(); ++i) {
    Json step = Json::object();
    for (const InputEvent& event : recording.steps[i].events)
      step["events"].push_back(to_json(event));
    for (const auto& [name, value] : recording.steps[i].parameters)
      step["parameters"][name] = value;
    text += step.dump() + (i + 1 < recording.steps.size() ? ",\n" : "\n");
  }
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016" PRIx64, recording.final_hash);
  text += "], \"final_hash\": \"" + std::string(hash) + "\"}\n";

  const std::string temporary = path + ".tmp";
  std::ofstream file(temporary, std::ios::binary);
  file << text << std::flush;
  std::error_code error;
  if (file) std::filesystem::rename(temporary, path, error);
  if (!file || error) {
    std::filesystem::remove(temporary, error);
    throw InputError(path + ": cannot be written");
  }
}

namespace {

/// Lowest-numbered face of a cloth that contains the vertex; fills face and barycentric weights.
void hit_vertex(const Scene& scene, const ScriptedGrab& grab, InputEvent& event) {
  Index first_face = 0;
  for (Index c = 0; c < grab.cloth; ++c)
    first_face += static_cast<Index>(scene.cloths[static_cast<std::size_t>(c)].mesh.faces.size());
  const auto& faces = scene.cloths[static_cast<std::size_t>(grab.cloth)].mesh.faces;
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

std::vector<InputEvent> ScriptedInput::events(double time, double dt) {
  std::vector<InputEvent> events;
  const double middle = time + 0.5 * dt;  // rounding of the time must not shift a grab by a step
  for (std::size_t i = 0; i < scene_->input.size(); ++i) {
    const ScriptedGrab& grab = scene_->input[i];
    if (done_[i] || middle < grab.start) continue;
    InputEvent event;
    event.handle = kFirstScriptedHandle + static_cast<int>(i);
    event.target = path_target(grab, time + dt);
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
