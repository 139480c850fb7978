#include "app/common/cloth_place.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "kernels/index.h"
#include "sim/garment/face_strain.h"

namespace icloth {

std::string ClothPlace::text() const {
  char number[48];
  std::snprintf(number, sizeof number, ": strain %.1f %%", 100 * strain);
  return face + number;
}

std::string ClothPlace::json() const {
  const auto list = [](Vec3d v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); };
  nlohmann::ordered_json json;
  json["face"] = face;
  json["vertices"] = vertices;
  json["barycentric"] = list(barycentric);
  json["position"] = list(position);
  json["strain"] = strain;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

ClothPlace cloth_place(const World& world, const ElementNames& names,
                       std::span<const Vec3f> positions, Index face, Vec3d barycentric) {
  const Triangle& corners = world.face[at(face)];
  const double weights[] = {barycentric.x, barycentric.y, barycentric.z};
  ClothPlace place{.face = names.face(face),
                   .vertices = {},
                   .barycentric = barycentric,
                   .position = {},
                   .strain = 0};
  std::array<Vec3d, 3> x;
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = convert<double>(positions[at(corners[k])]);
    place.vertices[k] = names.vertex(corners[k]);
    place.position += weights[k] * x[k];
  }
  place.strain = face_strain(world, face, x);
  return place;
}

}  // namespace icloth
