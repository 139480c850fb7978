#include "app/common/camera_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace icloth {

namespace {

using Json = nlohmann::ordered_json;

/// Reads three numbers of reasonable size.
bool read(const Json& json, const char* key, Vec3d& out) {
  if (!json.contains(key) || !json[key].is_array() || json[key].size() != 3) return false;
  double* parts[] = {&out.x, &out.y, &out.z};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!json[key][k].is_number()) return false;
    *parts[k] = json[key][k].get<double>();
    if (!(std::abs(*parts[k]) < 1e6)) return false;
  }
  return true;
}

}  // namespace

std::string camera_to_json(const CameraPose& pose) {
  const auto list = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  Json json;
  json["name"] = pose.name;
  json["eye"] = list(pose.eye);
  json["target"] = list(pose.target);
  json["up"] = list(pose.up);
  json["fov"] = pose.fov;
  return json.dump();
}

std::optional<CameraPose> camera_from_json(const std::string& text) {
  // Eye and target are required and must differ; the field of view has a default.
  const Json json = Json::parse(text, nullptr, false);
  CameraPose pose;
  if (!json.is_object() || !read(json, "eye", pose.eye) || !read(json, "target", pose.target)) {
    return std::nullopt;
  }
  if (!(norm(pose.eye - pose.target) > 1e-6)) return std::nullopt;
  if (json.contains("fov") && json["fov"].is_number()) pose.fov = json["fov"].get<double>();
  if (!(pose.fov >= 1 && pose.fov <= 150)) return std::nullopt;
  return pose;
}

}  // namespace icloth
