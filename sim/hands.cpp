#include "sim/hands.h"

#include <algorithm>
#include <cmath>

namespace icloth {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

Vec3d interpolate(const Triangle& t, Vec3d b, std::span<const Vec3d> field) {
  return b.x * field[at(t[0])] + b.y * field[at(t[1])] + b.z * field[at(t[2])];
}

bool finite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

}  // namespace

Vec3d Hands::hit(const Held& held, std::span<const Vec3d> positions) const {
  return interpolate(held.corners, held.barycentric, positions);
}

Hands::Held Hands::grab(const InputEvent& event, const Parameters& parameters,
                        std::span<const Vec3d> positions) const {
  Held held;
  held.handle = event.handle;
  held.corners = world_->face[at(event.face)];
  held.barycentric = event.barycentric;
  held.target = event.target;
  held.stiffness = event.stiffness > 0 ? event.stiffness : parameters.grab_stiffness;
  const double radius = event.radius > 0 ? event.radius : parameters.grab_radius;
  const Vec3d centre = interpolate(held.corners, held.barycentric, world_->rest);
  const Vec3d start = hit(held, positions);
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

void Hands::advance(double dt, const Parameters& parameters, std::span<const Vec3d> positions) {
  const double reach = parameters.grab_max_speed * dt;
  for (Held& h : held_) {
    const Vec3d way = h.target - h.followed;
    const double distance = norm(way);
    h.followed = distance > reach ? h.followed + (reach / distance) * way : h.target;
    // A pull beyond the largest force would only stretch the patch.
    const Vec3d here = hit(h, positions), pull = h.followed - here;
    const double force = h.stiffness * norm(pull);
    h.saturation = std::min(force / parameters.grab_max_force, 1.0);
    h.pulled_to = force > parameters.grab_max_force
                      ? here + (parameters.grab_max_force / force) * pull
                      : h.followed;
  }
}

void Hands::springs(std::vector<double>& stiffness, std::vector<Vec3d>& target) const {
  stiffness.assign(at(world_->cloth_vertices), 0.0);
  target.assign(at(world_->cloth_vertices), Vec3d{});
  for (const Held& h : held_) {
    for (std::size_t k = 0; k < h.vertices.size(); ++k) {
      const std::size_t v = at(h.vertices[k]);
      const double s = h.stiffness * h.share[k];
      // Several hands on one vertex: the stiffness adds up, the target is their weighted mean.
      const double sum = stiffness[v] + s;
      if (!(sum > 0)) continue;
      target[v] = (stiffness[v] / sum) * target[v] + (s / sum) * (h.pulled_to + h.offset[k]);
      stiffness[v] = sum;
    }
  }
}

std::vector<HandleState> Hands::states(std::span<const Vec3d> positions) const {
  std::vector<HandleState> out;
  for (const Held& h : held_) out.push_back({h.handle, hit(h, positions), h.target, h.saturation});
  return out;
}

}  // namespace icloth
