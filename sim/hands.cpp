#include "sim/hands.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace icloth {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

Vec3d interpolate(const Triangle& t, Vec3d b, std::span<const Vec3d> field) {
  return b.x * field[at(t[0])] + b.y * field[at(t[1])] + b.z * field[at(t[2])];
}

/// Where hand `k` holds the cloth, by the corners of all hands.
Vec3d hit(std::size_t k, Vec3d b, std::span<const Vec3d> corners) {
  return b.x * corners[3 * k] + b.y * corners[3 * k + 1] + b.z * corners[3 * k + 2];
}

bool finite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

}  // namespace

Hands::Held Hands::grab(const InputEvent& event, const Parameters& parameters,
                        std::span<const Vec3d> positions) const {
  Held held;
  held.handle = event.handle;
  held.corners = world_->face[at(event.face)];
  held.barycentric = event.barycentric;
  held.target = event.target;
  held.stiffness = event.stiffness > 0 ? event.stiffness : parameters.grab.stiffness;
  const double radius = event.radius > 0 ? event.radius : parameters.grab.radius;
  const Vec3d centre = interpolate(held.corners, held.barycentric, world_->rest);
  const Vec3d start = interpolate(held.corners, held.barycentric, positions);
  const Index object = world_->object[at(held.corners[0])];
  const WorldObject& cloth = world_->objects[at(object)];
  double total = 0;
  // The patch is round in the rest shape, so that folds lying above are not caught; its pull
  // falls off smoothly, (1 − (d/r)²)². The face that was hit always takes part.
  for (Index v = cloth.first_vertex; v < cloth.first_vertex + cloth.vertex_count; ++v) {
    const double d2 = norm2(world_->rest[at(v)] - centre) / (radius * radius);
    const bool corner =
        std::find(held.corners.begin(), held.corners.end(), v) != held.corners.end();
    if ((d2 >= 1 && !corner) || world_->pinned[at(v)] != 0) continue;
    const double falloff = std::max(1 - d2, 0.0);
    const double weight = std::max(falloff * falloff, corner ? 0.1 : 0.0);
    held.vertices.push_back(v);
    held.share.push_back(weight);
    held.offset.push_back(positions[at(v)] - start);
    total += weight;
  }
  for (double& s : held.share) s /= total;
  held.followed = held.pulled_to = start;
  return held;
}

void Hands::apply(std::span<const InputEvent> events, const Parameters& parameters,
                  std::span<const Vec3d> positions) {
  for (const InputEvent& event : events) {
    const auto old = std::find_if(held_.begin(), held_.end(),
                                  [&](const Held& h) { return h.handle == event.handle; });
    switch (event.kind) {
      case InputEvent::Kind::grab:
        if (old != held_.end()) held_.erase(old);
        if (event.face >= 0 && event.face < world_->cloth_faces && finite(event.target))
          held_.push_back(grab(event, parameters, positions));
        break;
      case InputEvent::Kind::move:
        if (old != held_.end() && finite(event.target)) old->target = event.target;
        break;
      case InputEvent::Kind::release:
        if (old != held_.end()) held_.erase(old);
        break;
    }
  }
}

std::vector<Index> Hands::watched() const {
  std::vector<Index> vertices;
  for (const Held& h : held_) vertices.insert(vertices.end(), h.corners.begin(), h.corners.end());
  return vertices;
}

void Hands::advance(double dt, const Parameters& parameters, std::span<const Vec3d> corners) {
  const double reach = parameters.grab.max_speed * dt;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    Held& h = held_[k];
    const Vec3d way = h.target - h.followed;
    const double distance = norm(way);
    h.followed = distance > reach ? h.followed + (reach / distance) * way : h.target;
    // A pull beyond the largest force would only stretch the patch.
    const Vec3d here = hit(k, h.barycentric, corners), pull = h.followed - here;
    const double force = h.stiffness * norm(pull);
    h.saturation = std::min(force / parameters.grab.max_force, 1.0);
    h.pulled_to = force > parameters.grab.max_force
                      ? here + (parameters.grab.max_force / force) * pull
                      : h.followed;
  }
}

std::vector<HandSpring> Hands::springs() const {
  std::map<Index, HandSpring> by_vertex;
  for (const Held& h : held_) {
    for (std::size_t k = 0; k < h.vertices.size(); ++k) {
      HandSpring& spring =
          by_vertex.try_emplace(h.vertices[k], HandSpring{h.vertices[k], 0.0, {}}).first->second;
      const double s = h.stiffness * h.share[k];
      // Several hands on one vertex: the stiffness adds up, the target is their weighted mean.
      const double sum = spring.stiffness + s;
      if (!(sum > 0)) continue;
      spring.target =
          (spring.stiffness / sum) * spring.target + (s / sum) * (h.pulled_to + h.offset[k]);
      spring.stiffness = sum;
    }
  }
  std::vector<HandSpring> springs;
  for (const auto& [vertex, spring] : by_vertex) springs.push_back(spring);
  return springs;
}

std::vector<HandleState> Hands::states(std::span<const Vec3d> corners) const {
  std::vector<HandleState> out;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Held& h = held_[k];
    out.push_back({h.handle, hit(k, h.barycentric, corners), h.target, h.saturation});
  }
  return out;
}

}  // namespace icloth
