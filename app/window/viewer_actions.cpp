// The effects of the actions in the table of bindings.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/common/camera_json.h"
#include "app/window/screenshot.h"
#include "app/window/theme.h"
#include "app/window/viewer.h"
#include "sim/files/box.h"
#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {

namespace {

constexpr double kDollyPerNotch = 0.88;

/// A side from which everything can be looked at.
struct Side {
  const char *label, *key;  ///< of the menu
  Action action;
  Vec3d direction;  ///< of sight
};
constexpr Side kSides[] = {{"From the front", "F5", Action::look_from_front, {0, 0, -1}},
                           {"From the back", "F6", Action::look_from_back, {0, 0, 1}},
                           {"From the left", "F7", Action::look_from_left, {1, 0, 0}},
                           {"From the right", "F8", Action::look_from_right, {-1, 0, 0}},
                           {"From the top", "F9", Action::look_from_top, {0, -1, 0}}};

Vec3d picked_point(const Pick& pick) { return pick.reachable() ? pick.point : pick.obstacle_point; }

}  // namespace

/// Carries out an action; those of hands, camera and session have functions of their own.
void Viewer::act(Action action, double amount) {
  if (act_on_hands(action, amount) || act_on_camera(action, amount) || act_on_session(action)) {
    return;
  }
  switch (action) {
    case Action::view_shaded:
      state_.view = ViewMode::shaded;
      break;
    case Action::view_wireframe:
      state_.view = ViewMode::wireframe;
      break;
    case Action::view_strain:
      state_.view = ViewMode::strain;
      break;

    // These act on the window itself.
    case Action::toggle_panels:
      state_.panels = !state_.panels;
      break;

    case Action::help:
      state_.help = !state_.help;
      break;

    case Action::full_screen:
      window_.toggle_full_screen();
      break;
    case Action::screenshot:
      want_screenshot_ = true;
      break;
    case Action::quit:
      window_.request_close();
      break;
    default:
      break;
  }
}

/// Carries out an action of the hands; false when it is none. The hit is the one under the last
/// press.
bool Viewer::act_on_hands(Action action, double amount) {
  const ClothHit hit{menu_pick_.face, menu_pick_.barycentric, menu_pick_.point};
  switch (action) {
    // These act on what is under the pointer.
    case Action::grab:
      drag_.begin(cursor_ray(), hit);
      return true;
    case Action::grab_handle:
      drag_.begin_handle(menu_handle_, cursor_ray(), false);
      return true;

    case Action::add_handle:
      drag_.begin_handle(menu_handle_, cursor_ray(), true);
      return true;
    case Action::pin_point:
      drag_.pin(hit);
      return true;
    case Action::unpin:
      drag_.release(menu_handle_);
      return true;

    // These end the grab in the hand, or release handles.
    case Action::park:
      drag_.park();
      return true;
    case Action::cancel:
      cancel();
      return true;

    case Action::release_selected:
      drag_.release_selected();
      return true;
    case Action::release_all:
      drag_.release_all();
      return true;

    // The wheel changes the grab in the hand, and the parameters of the next one.
    case Action::grab_depth:
      drag_.change_depth(amount, cursor_ray());
      return true;

    case Action::grab_radius:
      drag_.set_defaults(edits_.values().grab.radius, edits_.values().grab.stiffness);
      drag_.change_radius(amount);
      edits_.set(*find_parameter("grab.radius"), drag_.radius(), true);
      tell("Radius of the patch: " + rounded_text(100 * drag_.radius()) + " cm");
      return true;
    case Action::grab_stiffness:
      drag_.set_defaults(edits_.values().grab.radius, edits_.values().grab.stiffness);
      drag_.change_stiffness(amount);
      edits_.set(*find_parameter("grab.stiffness"), drag_.stiffness(), true);
      tell("Strength of the pull: " + rounded_text(drag_.stiffness()) + " N/m");
      return true;
    default:
      return false;
  }
}

/// Carries out an action of the camera; false when it is none.
bool Viewer::act_on_camera(Action action, double amount) {
  // Looking from a side turns the camera and frames everything.
  const Side* side = std::ranges::find(kSides, action, &Side::action);
  if (side != std::end(kSides)) {
    camera_.look_along(side->direction);
    action = Action::frame_all;
  }
  switch (action) {
    // A gesture moves the camera until its button goes up.
    case Action::orbit:
      gesture_ = Gesture::orbit;
      break;
    case Action::pan:
      gesture_ = Gesture::pan;
      break;
    case Action::dolly_drag:
      gesture_ = Gesture::dolly;
      break;

    // The wheel goes towards the point under the pointer, where there is one.
    case Action::dolly: {
      const Pick under = pick_at(x_, y_);
      const double factor = std::pow(kDollyPerNotch, amount);
      if (under.hit_cloth() || under.hit_obstacle()) {
        camera_.dolly_to(factor, picked_point(under));
      } else {
        camera_.dolly(factor);
      }
      break;
    }

    // The press was at the new pivot.
    case Action::set_pivot:
      if (menu_pick_.hit_cloth() || menu_pick_.hit_obstacle()) {
        camera_.set_pivot(picked_point(menu_pick_));
      }
      break;

    // Framing shows all of something.
    case Action::frame_selection:
      frame_selection();
      break;
    case Action::frame_all: {
      std::vector<Vec3d> all;
      for (const Vec3f p : session_->state().positions) all.push_back(convert<double>(p));
      frame_box(all);
      break;
    }

    // The cameras of the scene follow each other.
    case Action::scene_camera:
      if (scene_->cameras.empty()) {
        tell("The scene has no camera of its own.");
      } else {
        choose_camera(next_camera_);
      }
      break;

    case Action::menu:
      open_menu_ = true;
      break;

    // The clipboard holds a camera as text, in the form of scene files.
    case Action::copy_camera:
      window_.set_clipboard(camera_to_json(camera_.pose()));
      tell("The camera is in the clipboard as JSON.");
      break;
    case Action::paste_camera:
      if (const auto pose = camera_from_json(window_.clipboard())) {
        camera_ = Camera(*pose);
      } else {
        tell("The clipboard holds no camera.");
      }
      break;
    default:
      return false;
  }

  // It stays above the floor, and a grab in the hand stays in space while the camera moves.
  camera_.lift_above(renderer_.floor());
  drag_.follow_camera(cursor_ray());
  return true;
}

/// Looks through a camera of the scene.
void Viewer::choose_camera(std::size_t number) {
  const CameraPose& pose = scene_->cameras[number];
  camera_ = Camera(pose);
  next_camera_ = (number + 1) % scene_->cameras.size();
  tell("Camera " + in_quotes(pose.name) + " of the scene");
}

/// Carries out an action of the simulation; false when it is none.
bool Viewer::act_on_session(Action action) {
  switch (action) {
    case Action::play_pause:
      session_->state().playing ? session_->pause() : session_->play();
      return true;

    case Action::hold_bodies: {
      const ParameterInfo& speed = *find_parameter("bodies.speed");
      edits_.set(speed, edits_.value(speed) > 0 ? 0 : 1);
      return true;
    }
    case Action::step:
      session_->step_once();
      return true;
    case Action::step_back:
      session_->step_back();
      return true;
    case Action::step_forward:
      session_->go(session_->state().history + 1);
      return true;
    case Action::other_run:
      session_->return_to_left_run();
      return true;
    case Action::pass_over:
      session_->pass_over();
      return true;
    case Action::reset:
      session_->reset();
      return true;

    // The program knows by what name the scene was opened.
    case Action::reload:
      state_.open_scene = options_.simulation.scene;
      return true;

    // Changes of parameters have a history of their own.
    case Action::undo:
      if (!edits_.undo()) tell("There is nothing to undo.");
      return true;
    case Action::redo:
      if (!edits_.redo()) tell("There is nothing to redo.");
      return true;

    case Action::save_session:
      save_session();
      return true;
    default:
      return false;
  }
}

/// Saves the recording where the options say, or beside the screenshots.
void Viewer::save_session() {
  if (!options_.record_file.empty()) return session_->save(options_.record_file);
  try {
    session_->save(free_name(options_.screenshot_folder, "session", ".json"));
  } catch (const InputError& error) {
    complain(error.what());
  }
}

/// Takes back the grab, else the selection, else the help. It never quits.
void Viewer::cancel() {
  const bool selected = std::ranges::any_of(drag_.handles(), &Handle::selected);
  if (drag_.grabbing()) {
    drag_.cancel();
  } else if (selected) {
    drag_.deselect();
  } else {
    state_.help = false;
  }
}

std::vector<Vec3d> Viewer::cloth_points() const {
  std::vector<Vec3d> points;
  const auto& positions = session_->state().positions;
  for (std::size_t v = 0; v < static_cast<std::size_t>(world_.cloth_vertices); ++v) {
    points.push_back(convert<double>(positions[v]));
  }
  return points;
}

void Viewer::frame_box(const std::vector<Vec3d>& points) {
  if (points.empty()) return;
  const Box box = box_around(points);
  camera_.frame_box(box.low, box.high,
                    static_cast<double>(view_.width) / static_cast<double>(view_.height));
}

/// Frames the targets of the selected handles with some space around them, else the cloth.
void Viewer::frame_selection() {
  std::vector<Vec3d> points;
  const Vec3d margin{0.15, 0.15, 0.15};
  for (const Handle& handle : drag_.handles()) {
    if (!handle.selected) continue;
    points.push_back(handle.target - margin);
    points.push_back(handle.target + margin);
  }
  frame_box(points.empty() ? cloth_points() : points);
}

/// Frames the faces that are marked after a failure.
void Viewer::look_at_failure() {
  std::vector<Vec3d> points;
  for (const Index f : marked_faces_) {
    for (const Index v : world_.face[static_cast<std::size_t>(f)]) {
      points.push_back(convert<double>(session_->state().positions[static_cast<std::size_t>(v)]));
    }
  }
  frame_box(points);
  dirty_ = true;
}

/// Draws the cameras that can be chosen: those of the scene, and one from each side.
void Viewer::draw_camera_menu() {
  if (!ImGui::BeginMenu("Cameras")) return;
  for (std::size_t k = 0; k < scene_->cameras.size(); ++k) {
    const std::string label = scene_->cameras[k].name + "##" + std::to_string(k);
    if (!ImGui::MenuItem(label.c_str(), k == next_camera_ ? "Shift+Home" : nullptr)) continue;
    choose_camera(k);
    drag_.follow_camera(cursor_ray());
  }

  // The sides follow.
  ImGui::Separator();
  for (const Side& side : kSides)
    if (ImGui::MenuItem(side.label, side.key)) act(side.action);
  ImGui::EndMenu();
}

/// Draws the menu of a right click, which is about the point under it.
void Viewer::draw_menu() {
  if (open_menu_) ImGui::OpenPopup("##menu");
  open_menu_ = false;
  if (!ImGui::BeginPopup("##menu")) return;

  // Entries that need a hit are disabled without one.
  const bool hit = menu_pick_.hit_cloth() || menu_pick_.hit_obstacle();
  if (menu_handle_ && ImGui::MenuItem("Release this handle")) drag_.release(menu_handle_);
  if (ImGui::MenuItem("Pin the cloth here", "Ctrl+click", false, menu_pick_.reachable())) {
    act(Action::pin_point);
  }
  if (ImGui::MenuItem("Orbit around this point", "double click", false, hit)) {
    act(Action::set_pivot);
  }
  if (ImGui::MenuItem("Frame the cloth", "F")) act(Action::frame_selection);
  if (ImGui::MenuItem("Frame everything", "Home")) act(Action::frame_all);
  draw_camera_menu();
  if (ImGui::MenuItem("Release all handles", "Shift+X", false, !drag_.handles().empty())) {
    drag_.release_all();
  }

  // Scripts and reports need the point in numbers.
  if (menu_pick_.reachable()) {
    ImGui::Separator();
    const ClothPlace place = place_of(menu_pick_);
    ImGui::TextDisabled("%s", shown(place.text()).c_str());
    ImGui::TextDisabled("%.3f, %.3f, %.3f m", place.position.x, place.position.y, place.position.z);
    if (ImGui::MenuItem("Copy this place as JSON")) window_.set_clipboard(place.json());
  }
  ImGui::EndPopup();
  dirty_ = true;
}

}  // namespace icloth
