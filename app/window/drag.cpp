#include "app/window/drag.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace icloth {

namespace {

constexpr double kMinDepth = 0.01, kMaxDepth = 1000;  ///< [m]
constexpr double kDepthPerNotch = 1.04, kRadiusPerNotch = 1.15, kStiffnessPerNotch = 1.25;

/// A value that the wheel changed, within the range of its parameter.
double scaled(const char* parameter, double value, double factor) {
  const ParameterInfo* info = find_parameter(parameter);
  return std::clamp(value * factor, info ? info->minimum : 0, info ? info->maximum : 1e9);
}

}  // namespace

Vec3d point_at_depth(const CursorRay& ray, double depth) {
  const double slope = dot(ray.direction, ray.forward);
  return ray.origin + (depth / std::max(slope, 1e-6)) * ray.direction;
}

void Drag::set_defaults(double radius, double stiffness) {
  radius_ = radius;
  stiffness_ = stiffness;
}

Handle* Drag::get(int id) {
  const auto it = std::ranges::find(handles_, id, &Handle::id);
  return it == handles_.end() ? nullptr : &*it;
}

const Handle* Drag::find(int id) const { return const_cast<Drag*>(this)->get(id); }

int Drag::free_id() const {
  int id = 1;
  while (find(id)) ++id;
  return id;
}

/// Queues an event about a handle for the session.
void Drag::send(InputEvent::Kind kind, const Handle& handle) {
  events_.push_back(event_of(kind, handle));
}

/// Makes a handle at a hit. Returns its id, or 0 when all ids are taken.
int Drag::add(const ClothHit& hit) {
  const int id = free_id();
  if (id >= kFirstScriptedHandle) return 0;
  const HeldHandle held{.id = id,
                        .face = hit.face,
                        .barycentric = hit.barycentric,
                        .target = hit.point,
                        .radius = radius_,
                        .stiffness = stiffness_};
  handles_.push_back({held});
  send(InputEvent::Kind::grab, handles_.back());
  return id;
}

/// Takes a handle into the hand.
void Drag::grasp(Handle& handle, const CursorRay& ray) {
  active_ = handle.id;
  was_parked_ = handle.parked;
  handle.parked = false;
  handle.selected = true;
  follow_camera(ray);
}

void Drag::begin(const CursorRay& ray, const ClothHit& hit) {
  end();
  before_ = handles_;
  deselect();
  if (Handle* handle = get(add(hit))) grasp(*handle, ray);
}

void Drag::begin_handle(int id, const CursorRay& ray, bool add_to_selection) {
  end();
  Handle* handle = get(id);
  if (!handle) return;
  before_ = handles_;
  if (!add_to_selection && !handle->selected) deselect();
  grasp(*handle, ray);
}

void Drag::pin(const ClothHit& hit) {
  if (Handle* handle = get(add(hit))) handle->parked = handle->pin = true;
}

void Drag::follow_camera(const CursorRay& ray) {
  const Handle* handle = find(active_);
  if (!handle) return;
  depth_ = std::clamp(dot(handle->target - ray.origin, ray.forward), kMinDepth, kMaxDepth);
  offset_ = handle->target - point_at_depth(ray, depth_);
}

/// Moves the handle in the hand, and with it all parked ones that are selected.
void Drag::move_to(Vec3d target) {
  const Handle* active = find(active_);
  if (!active || active->target == target) return;
  const Vec3d delta = target - active->target;
  for (Handle& handle : handles_) {
    if (handle.id != active_ && !(handle.selected && handle.parked)) continue;
    handle.target = handle.id == active_ ? target : handle.target + delta;
    send(InputEvent::Kind::move, handle);
  }
}

void Drag::move(const CursorRay& ray) { move_to(point_at_depth(ray, depth_) + offset_); }

void Drag::change_depth(double notches, const CursorRay& ray) {
  if (!grabbing()) return;
  depth_ = std::clamp(depth_ * std::pow(kDepthPerNotch, notches), kMinDepth, kMaxDepth);
  move(ray);
}

/// Gives the solver a new radius and stiffness. They belong to a grab, so the handle is released
/// and grabbed again.
void Drag::regrip(Handle& handle) {
  handle.radius = radius_;
  handle.stiffness = stiffness_;
  send(InputEvent::Kind::release, handle);
  send(InputEvent::Kind::grab, handle);
}

void Drag::change_radius(double notches) {
  radius_ = scaled("grab.radius", radius_, std::pow(kRadiusPerNotch, notches));
  if (Handle* handle = get(active_)) regrip(*handle);
}

void Drag::change_stiffness(double notches) {
  stiffness_ = scaled("grab.stiffness", stiffness_, std::pow(kStiffnessPerNotch, notches));
  if (Handle* handle = get(active_)) regrip(*handle);
}

void Drag::end() {
  if (Handle* handle = get(active_)) {
    if (was_parked_) {
      handle->parked = true;
    } else {
      release(active_);
    }
  }
  active_ = 0;
}

void Drag::park() {
  Handle* handle = get(active_);
  if (!handle) return;
  handle->parked = true;
  active_ = 0;
}

void Drag::cancel() {
  // A fresh grab just ends.
  if (!grabbing()) return;
  if (!was_parked_) return end();

  active_ = 0;

  // Handles that had been parked go back to where they were before, and to their old strength.
  for (const Handle& old : before_) {
    Handle* handle = get(old.id);
    if (!handle) continue;
    const bool regrip_needed = handle->radius != old.radius || handle->stiffness != old.stiffness;
    const bool moved = !(handle->target == old.target);
    *handle = old;
    if (regrip_needed) {
      send(InputEvent::Kind::release, old);
      send(InputEvent::Kind::grab, old);
    } else if (moved) {
      send(InputEvent::Kind::move, old);
    }
  }
}

void Drag::deselect() {
  for (Handle& handle : handles_) handle.selected = false;
}

void Drag::release(int id) {
  const auto it = std::ranges::find(handles_, id, &Handle::id);
  if (it == handles_.end()) return;
  send(InputEvent::Kind::release, *it);
  handles_.erase(it);
  if (active_ == id) active_ = 0;
}

void Drag::release_selected() {
  // The handle in the hand comes first, then the selection, then the handle that was made last.
  if (grabbing()) return release(active_);
  std::vector<int> ids;
  for (const Handle& handle : handles_) {
    if (handle.selected) ids.push_back(handle.id);
  }
  if (ids.empty() && !handles_.empty()) ids.push_back(handles_.back().id);
  for (const int id : ids) release(id);
}

void Drag::release_all() {
  while (!handles_.empty()) release(handles_.back().id);
}

void Drag::restore(std::span<const HandleState> held) {
  // Only grabs of the user are handles here; scripted ones belong to the scene.
  const std::vector<Handle> had = std::exchange(handles_, {});
  active_ = 0;
  events_.clear();
  for (const HandleState& handle : held) {
    if (handle.id >= kFirstScriptedHandle) continue;
    const auto before = std::ranges::find(had, handle.id, &Handle::id);
    handles_.push_back({handle, true, false, before != had.end() && before->pin});
  }

  // A grab may be on its way to the solver while the news of the jump is on its way here, so
  // handles that are unknown there are released.
  for (const Handle& handle : had) {
    if (!find(handle.id)) send(InputEvent::Kind::release, handle);
  }
}

std::vector<InputEvent> Drag::take_events() { return std::exchange(events_, {}); }

}  // namespace icloth
