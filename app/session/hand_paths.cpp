#include "app/session/hand_paths.h"

#include <algorithm>
#include <utility>

namespace icloth {
namespace {

/// A hand that was seen to move longer ago rested meanwhile; it starts at the usual pace [s].
constexpr double kLongestSpan = 0.25;

}  // namespace

HandPaths::Path* HandPaths::find(int handle) {
  const auto path = std::ranges::find(paths_, handle, &Path::handle);
  return path == paths_.end() ? nullptr : &*path;
}

void HandPaths::post(const InputEvent& event, double time) {
  if (event.kind == InputEvent::Kind::move) return post_move(event, time);

  std::erase_if(paths_, [&](const Path& path) { return path.handle == event.handle; });
  queue_.push_back(event);
  if (event.kind == InputEvent::Kind::grab)
    paths_.push_back({event.handle, event.target, event.target, time, 0, time});
}

void HandPaths::post_move(const InputEvent& event, double time) {
  // A grab that no step has seen yet takes the cloth to the new place at once.
  Path* path = find(event.handle);
  const auto waiting = std::ranges::find_if(
      queue_.rbegin(), queue_.rend(), [&](const auto& e) { return e.handle == event.handle; });
  if (path && waiting != queue_.rend()) {
    waiting->target = path->at = path->goal = event.target;
    return;
  }

  // So does a hand that was held before a jump in time: nobody knows where it came from.
  if (!path) {
    paths_.push_back({event.handle, event.target, event.target, time, 0, time});
    queue_.push_back(event);
    return;
  }

  const double since = time - path->seen;
  if (since > 0) path->span = since < kLongestSpan ? since : pace_;
  if (since > 0 && since < kLongestSpan) pace_ = since;
  path->seen = time;
  path->goal = event.target;
  path->arrival = time + path->span;
}

std::vector<InputEvent> HandPaths::events(double time, double dt) {
  std::vector<InputEvent> events = std::exchange(queue_, {});
  for (Path& path : paths_) {
    if (path.at == path.goal) continue;

    // A step ends on the goal when less than a thousandth of it would be left.
    const double left = path.arrival - time;
    path.at = left > 1.001 * dt ? path.at + (dt / left) * (path.goal - path.at) : path.goal;
    InputEvent move;
    move.kind = InputEvent::Kind::move;
    move.handle = path.handle;
    move.target = path.at;
    events.push_back(move);
  }
  return events;
}

void HandPaths::apply_to(std::vector<HandleState>& handles) const {
  for (const InputEvent& event : queue_)
    apply_event(handles, event, [](const InputEvent& grab) {
      return HandleState{handle_of(grab), grab.target};
    });
  for (const Path& path : paths_) {
    const auto held = std::ranges::find(handles, path.handle, &HandleState::id);
    if (held != handles.end()) held->target = path.goal;
  }
}

void HandPaths::clear() {
  queue_.clear();
  paths_.clear();
}

}  // namespace icloth
