// Mouse and keys: they find the element under the pointer, and the action that the table of
// bindings gives.
#include <algorithm>
#include <cmath>

#include "app/window/viewer.h"

namespace icloth {

namespace {

constexpr double kClickSlack = 4;          ///< a button that moved by less is a click [pixels]
constexpr double kHandleReach = 13;        ///< [pixels]
constexpr double kDoubleClickTime = 0.35;  ///< [s]

}  // namespace

bool Viewer::in_view(double x, double y) const {
  if (!view_.contains(x, y)) return false;
  return std::ranges::none_of(state_.overlays,
                              [&](const Rect& overlay) { return overlay.contains(x, y); });
}

Ray Viewer::ray(double x, double y) const {
  return camera_.ray(x - view_.x, y - view_.y, static_cast<int>(view_.width),
                     static_cast<int>(view_.height));
}

CursorRay Viewer::cursor_ray() const {
  const Ray sight = ray(x_, y_);
  return {sight.origin, sight.direction, camera_.forward()};
}

Pick Viewer::pick_at(double x, double y) const {
  return pick(world_, session_->state().positions, ray(x, y));
}

/// The parked handle whose target or hit is under the pointer, or 0.
int Viewer::handle_at(double x, double y) const {
  int nearest = 0;
  double reach = kHandleReach * static_cast<double>(ui_.scale());
  for (const Handle& handle : drag_.handles()) {
    if (!handle.parked) continue;

    // Both ends of its line can be taken.
    for (const Vec3d point : {handle.target, hit_point(handle)}) {
      const Projected at =
          camera_.project(point, static_cast<int>(view_.width), static_cast<int>(view_.height));
      const double distance = std::hypot(view_.x + at.x - x, view_.y + at.y - y);
      if (at.depth <= 0 || distance >= reach) continue;
      reach = distance;
      nearest = handle.id;
    }
  }
  return nearest;
}

/// Finds the point of the cloth under the pointer, for the ring that is drawn there.
void Viewer::update_hover() {
  const bool wanted = pointer_inside_ && in_view(x_, y_) && gesture_ == Gesture::none &&
                      !drag_.grabbing() && !ui_.popup_open();

  // Picking tests every face, so it happens only when something has changed.
  if (wanted && !hover_stale_) return;
  hover_stale_ = false;

  std::optional<Pick> hover;
  if (wanted) {
    if (const Pick under = pick_at(x_, y_); under.reachable()) hover = under;
  }
  if (hover || hover_) dirty_ = true;
  hover_ = hover;
}

/// Passes an event on. Events over the picture make it stale.
void Viewer::handle(const WindowEvent& event) {
  if (in_view(event.x, event.y) || in_view(x_, y_) || gesture_ != Gesture::none ||
      drag_.grabbing() || event.kind == WindowEvent::Kind::key) {
    dirty_ = hover_stale_ = true;
  }

  switch (event.kind) {
    case WindowEvent::Kind::press:
      press(event);
      break;
    case WindowEvent::Kind::release:
      release(event);
      break;
    case WindowEvent::Kind::move:
      move(event);
      break;
    case WindowEvent::Kind::wheel:
      wheel(event);
      break;

    case WindowEvent::Kind::leave:
      pointer_inside_ = false;
      break;

    // A text field takes the keys that it needs, and Esc closes what is open before it does more.
    case WindowEvent::Kind::key:
      if (ui_.wants_text() && text_field_takes(event.code, event.modifiers)) break;
      if (event.code == key::kEscape && ui_.popup_open()) {
        ui_.close_popups();
        break;
      }
      act(find_action(Trigger::key, event.code, {event.modifiers, drag_.grabbing(), Under::other}));
      break;
  }
}

/// A button went down: notes what is under it, and finds the action.
void Viewer::press(const WindowEvent& event) {
  move(event);
  if (!in_view(x_, y_) || ui_.popup_open()) return;

  // The wheel may have changed the parameters of a grab since.
  drag_.set_defaults(edits_.values().grab.radius, edits_.values().grab.stiffness);

  // Two presses of the left button at one place, shortly after each other, are a double click.
  const bool twice = event.code == button::kLeft && event.time - press_time_ < kDoubleClickTime &&
                     std::hypot(x_ - press_x_, y_ - press_y_) < kClickSlack;
  press_x_ = x_;
  press_y_ = y_;
  press_time_ = event.code == button::kLeft ? event.time : -1;

  // The element under the pointer decides what a press means.
  menu_handle_ = handle_at(x_, y_);
  menu_pick_ = pick_at(x_, y_);
  const Under under = menu_handle_             ? Under::handle
                      : menu_pick_.reachable() ? Under::cloth
                                               : Under::other;
  const InputState input{event.modifiers, drag_.grabbing(), under};

  gesture_button_ = event.code;
  if (twice) {
    const Action action = find_action(Trigger::double_click, event.code, input);
    if (action != Action::none) return act(action);
  }
  act(find_action(Trigger::press, event.code, input));
}

/// A button went up: ends grab and gesture, or completes a click.
void Viewer::release(const WindowEvent& event) {
  move(event);
  if (event.code == button::kLeft) drag_.end();

  if (gesture_ == Gesture::none || event.code != gesture_button_) return;
  gesture_ = Gesture::none;
  if (std::hypot(x_ - press_x_, y_ - press_y_) >= kClickSlack) return;
  act(find_action(Trigger::click, event.code, {event.modifiers, drag_.grabbing(), Under::any}));
}

/// The pointer moved: moves the grab or the camera.
void Viewer::move(const WindowEvent& event) {
  const double dx = event.x - x_, dy = event.y - y_;
  x_ = event.x;
  y_ = event.y;
  pointer_inside_ = true;
  if (dx == 0 && dy == 0) return;

  // Without a gesture of the camera the grab in the hand moves.
  const int height = static_cast<int>(view_.height);
  switch (gesture_) {
    case Gesture::none:
      if (drag_.grabbing()) drag_.move(cursor_ray());
      return;
    case Gesture::orbit:
      camera_.orbit(dx, dy, height, renderer_.floor());
      break;
    case Gesture::pan:
      camera_.pan(dx, dy, height);
      break;
    case Gesture::dolly:
      camera_.dolly(std::exp(2 * dy / height));
      break;
  }
  camera_.lift_above(renderer_.floor());

  // The camera moved under the hand.
  drag_.follow_camera(cursor_ray());
}

void Viewer::wheel(const WindowEvent& event) {
  if (!in_view(x_, y_) || ui_.popup_open()) return;
  act(find_action(Trigger::wheel, 0, {event.modifiers, drag_.grabbing(), Under::any}),
      event.amount);
}

}  // namespace icloth
