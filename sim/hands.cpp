#include "sim/hands.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kernels/index.h"
#include "sim/state/limits.h"

namespace icloth {
namespace {

Vec3d interpolate(const Triangle& t, Vec3d b, std::span<const Vec3d> field) {
  return b.x * field[at(t[0])] + b.y * field[at(t[1])] + b.z * field[at(t[2])];
}

/// The point at which hand `k` holds the cloth; `corners` are those of all hands.
Vec3d hit(std::size_t k, Vec3d b, std::span<const Vec3d> corners) {
  return b.x * corners[3 * k] + b.y * corners[3 * k + 1] + b.z * corners[3 * k + 2];
}

bool finite(Vec3d a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

}  // namespace

HeldPatch Hands::grab(const InputEvent& event, const Parameters& parameters,
                      std::span<const Vec3d> positions) const {
  HeldPatch held{handle_of(event)};
  if (!(held.radius > 0)) held.radius = parameters.grab.radius;
  if (!(held.stiffness > 0)) held.stiffness = parameters.grab.stiffness;
  held.corners = world_->face[at(event.face)];

  // The patch is round in the rest shape, so that folds lying above are not caught; its pull
  // falls off smoothly, (1 − (d/r)²)². The face that was hit always takes part.
  const Vec3d centre = interpolate(held.corners, held.barycentric, world_->rest);
  const Vec3d start = interpolate(held.corners, held.barycentric, positions);
  const WorldObject& cloth = world_->objects[at(world_->object[at(held.corners[0])])];
  double total = 0;
  for (Index v = cloth.first_vertex; v < cloth.first_vertex + cloth.vertex_count; ++v) {
    const double d2 = norm2(world_->rest[at(v)] - centre) / (held.radius * held.radius);
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
  for (InputEvent event : events) {
    if (event.kind == InputEvent::Kind::move && !finite(event.target)) continue;
    // A grab that cannot be made still lets go of what its handle held.
    if (event.kind == InputEvent::Kind::grab &&
        (event.face < 0 || event.face >= world_->cloth_faces || !finite(event.target)))
      event.kind = InputEvent::Kind::release;
    apply_event(*held_, event, [&](const InputEvent& e) { return grab(e, parameters, positions); });
  }
}

std::vector<Index> Hands::watched() const {
  std::vector<Index> vertices;
  for (const HeldPatch& h : *held_)
    vertices.insert(vertices.end(), h.corners.begin(), h.corners.end());
  return vertices;
}

std::int64_t Hands::advance(double dt, const Parameters& parameters,
                            std::span<const Vec3d> corners) {
  std::int64_t limits = 0;
  const double reach = parameters.grab.max_speed * dt;
  for (std::size_t k = 0; k < held_->size(); ++k) {
    HeldPatch& h = (*held_)[k];
    const Vec3d lag = h.target - h.followed;
    const double distance = norm(lag);
    h.followed = distance > reach ? h.followed + (reach / distance) * lag : h.target;
    if (distance > reach) limits |= bit_of(Limit::hand_speed);

    // A pull beyond the largest force would only stretch the patch.
    const Vec3d here = hit(k, h.barycentric, corners), pull = h.followed - here;
    const double force = h.stiffness * norm(pull);
    h.saturation = std::min(force / parameters.grab.max_force, 1.0);
    const bool too_strong = force > parameters.grab.max_force;
    h.pulled_to = too_strong ? here + (parameters.grab.max_force / force) * pull : h.followed;
    if (too_strong) limits |= bit_of(Limit::hand_force);
  }
  return limits;
}

std::vector<HandSpring> Hands::springs() const {
  // When several hands hold a vertex, their stiffness adds up and the target is their weighted
  // mean.
  std::map<Index, HandSpring> by_vertex;
  for (const HeldPatch& h : *held_) {
    for (std::size_t k = 0; k < h.vertices.size(); ++k) {
      HandSpring& spring =
          by_vertex.try_emplace(h.vertices[k], HandSpring{h.vertices[k], 0.0, {}}).first->second;
      const double s = h.stiffness * h.share[k];
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
  for (std::size_t k = 0; k < held_->size(); ++k) {
    const HeldPatch& h = (*held_)[k];
    out.push_back({h, hit(k, h.barycentric, corners), h.saturation});
  }
  return out;
}

}  // namespace icloth
