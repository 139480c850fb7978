// Hands on the cloth: they turn hits under the pointer into handles and their targets. This part
// knows nothing of windows, so that tests can drag.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/input.h"

namespace icloth {

/// The pointer's line of sight.
struct CursorRay {
  Vec3d origin;     ///< eye [m]
  Vec3d direction;  ///< through the pointer, any length
  Vec3d forward;    ///< unit viewing direction
};

/// The point at which the pointer meets the cloth.
struct ClothHit {
  Index face = 0;              ///< global cloth face
  Vec3d barycentric{1, 0, 0};  ///< weights of the face's vertices
  Vec3d point;                 ///< [m]
};

/// A held patch. It is in the hand or parked; a parked one keeps pulling by itself.
struct Handle : HeldHandle {
  bool parked = false, selected = false;
  bool pin = false;  ///< made by Drag::pin: drawn as a pin wherever it is
};

/// The hands of the user. Actions queue events for the session, which take_events() returns.
class Drag {
 public:
  /// Sets the values of the next grab [m], [N/m]; the wheel changes them.
  void set_defaults(double radius, double stiffness);
  double radius() const { return radius_; }
  double stiffness() const { return stiffness_; }

  /// Grabs the cloth at the exact hit. The target moves in the plane parallel to the screen.
  void begin(const CursorRay& ray, const ClothHit& hit);
  /// Takes a parked handle into the hand again. With `add` it joins the selection, and all selected
  /// handles move together. Without, it is the only selected one unless it was already.
  void begin_handle(int id, const CursorRay& ray, bool add);
  /// Pins the cloth where it is, by a parked handle at the hit.
  void pin(const ClothHit& hit);

  void move(const CursorRay& ray);
  /// Call it after the camera moved under the hand: the target stays in space.
  void follow_camera(const CursorRay& ray);
  /// Moves the target nearer (negative) or further away.
  void change_depth(double notches, const CursorRay& ray);
  void change_radius(double notches);
  void change_stiffness(double notches);

  /// Call it when the button went up: a fresh grab lets go, a handle that was parked before stays.
  void end();
  /// Leaves the grabbed handle where it is; the hand is free.
  void park();
  /// Undoes the grab: a fresh one lets go, a parked handle returns to its old place.
  void cancel();
  void deselect();
  /// Releases the handle in the hand, else the selected ones, else the one made last.
  void release_selected();
  void release(int id);
  void release_all();

  /// Call it after the state jumped back in time: only the handles that are held there remain,
  /// parked.
  void restore(std::span<const HandleState> held);

  bool grabbing() const { return active_ != 0; }
  int active() const { return active_; }  ///< id of the handle in the hand, 0: none
  const std::vector<Handle>& handles() const { return handles_; }
  const Handle* find(int id) const;
  std::vector<InputEvent> take_events();

 private:
  Handle* get(int id);
  int free_id() const;
  int add(const ClothHit& hit);
  void grasp(Handle& handle, const CursorRay& ray);
  void move_to(Vec3d target);
  void regrip(Handle& handle);
  void send(InputEvent::Kind kind, const Handle& handle);

  std::vector<Handle> handles_;  ///< in the order they were made
  std::vector<InputEvent> events_;
  double radius_ = 0.02, stiffness_ = 400;
  int active_ = 0;
  bool was_parked_ = false;
  double depth_ = 1;            ///< of the target along forward [m]
  Vec3d offset_;                ///< target − point under the pointer at that depth [m]
  std::vector<Handle> before_;  ///< handles when the grab began, for cancel()
};

/// The point of the ray at a depth along the viewing direction.
Vec3d point_at_depth(const CursorRay& ray, double depth);

}  // namespace icloth
