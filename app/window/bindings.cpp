#include "app/window/bindings.h"

namespace icloth {

namespace {

using A = Action;
using T = Trigger;
using H = Hand;
using U = Under;
constexpr int kPlain = modifier::kNone, kShift = modifier::kShift, kCtrl = modifier::kControl;

constexpr std::string_view kHands = "Hands on the cloth", kCamera = "Camera", kTime = "Simulation",
                           kWindow = "Window";

// clang-format off
constexpr Binding kTable[] = {
    {T::press, button::kLeft, kPlain, H::any, U::handle, A::grab_handle, kHands, "Left drag on a handle", "take a parked handle and move it", ""},
    {T::press, button::kLeft, kPlain, H::any, U::cloth, A::grab, kHands, "Left drag on cloth", "grab it exactly there and pull; let go to release", "drag cloth: grab"},
    {T::key, 'P', kPlain, H::holds, U::any, A::park, kHands, "P, Enter, right click", "while grabbing: park it; it keeps pulling, the hand is free", "P: park"},
    {T::key, key::kEnter, kPlain, H::holds, U::any, A::park, kHands, "", "", ""},
    {T::key, key::kKeypadEnter, kPlain, H::holds, U::any, A::park, kHands, "", "", ""},
    {T::press, button::kRight, kPlain, H::holds, U::any, A::park, kHands, "", "", ""},
    {T::wheel, 0, kPlain, H::holds, U::any, A::grab_depth, kHands, "Wheel", "while grabbing: move the target away or nearer", "wheel: depth"},
    {T::wheel, 0, kCtrl, H::any, U::any, A::grab_radius, kHands, "Ctrl+wheel", "size of the grabbed patch", "Ctrl+wheel: size"},
    {T::wheel, 0, kShift, H::any, U::any, A::grab_stiffness, kHands, "Shift+wheel", "strength of the pull", "Shift+wheel: strength"},
    {T::press, button::kLeft, kShift, H::any, U::handle, A::add_handle, kHands, "Shift+left drag on handles", "select several and move them together", ""},
    {T::press, button::kLeft, kCtrl, H::any, U::handle, A::unpin, kHands, "Ctrl+click on a handle", "release it", ""},
    {T::press, button::kLeft, kCtrl, H::any, U::cloth, A::pin_point, kHands, "Ctrl+click on cloth", "pin it where it is", "Ctrl+click: pin"},
    {T::key, 'X', kPlain, H::any, U::any, A::release_selected, kHands, "X", "release the grab, the selected handles, or the last one", "X: release"},
    {T::key, 'X', kShift, H::any, U::any, A::release_all, kHands, "Shift+X", "release all handles", ""},
    {T::key, key::kEscape, kPlain, H::any, U::any, A::cancel, kHands, "Esc", "close the menu, else cancel the grab, deselect, close the help; it never quits", "Esc: cancel"},

    {T::press, button::kLeft, kPlain, H::any, U::other, A::orbit, kCamera, "Left drag beside the cloth", "orbit", "drag beside: orbit"},
    {T::press, button::kMiddle, kPlain, H::any, U::any, A::orbit, kCamera, "Middle drag", "orbit, also over cloth", ""},
    {T::press, button::kMiddle, kShift, H::any, U::any, A::pan, kCamera, "Right drag, Shift+middle drag", "pan", "right drag: pan"},
    {T::press, button::kRight, kPlain, H::free, U::any, A::pan, kCamera, "", "", ""},
    {T::press, button::kMiddle, kCtrl, H::any, U::any, A::dolly_drag, kCamera, "Ctrl+middle drag", "dolly", ""},
    {T::wheel, 0, kPlain, H::free, U::any, A::dolly, kCamera, "Wheel", "dolly towards the pointer", "wheel: zoom"},
    {T::double_click, button::kLeft, kPlain, H::any, U::any, A::set_pivot, kCamera, "Double click", "orbit around this point from now on", ""},
    {T::click, button::kRight, kPlain, H::free, U::any, A::menu, kCamera, "Right click", "menu: pin here, orbit around this, cameras", ""},
    {T::key, 'F', kPlain, H::any, U::any, A::frame_selection, kCamera, "F", "frame the selected handles, or the cloth", ""},
    {T::key, key::kHome, kPlain, H::any, U::any, A::frame_all, kCamera, "Home", "frame everything", ""},
    {T::key, key::kHome, kShift, H::any, U::any, A::scene_camera, kCamera, "Shift+Home", "the scene's own camera; again: its next one", ""},
    {T::key, key::kF5, kPlain, H::any, U::any, A::look_from_front, kCamera, "F5 to F9", "frame everything from the front, the back, the left, the right, the top", ""},
    {T::key, key::kF5 + 1, kPlain, H::any, U::any, A::look_from_back, kCamera, "", "", ""},
    {T::key, key::kF5 + 2, kPlain, H::any, U::any, A::look_from_left, kCamera, "", "", ""},
    {T::key, key::kF5 + 3, kPlain, H::any, U::any, A::look_from_right, kCamera, "", "", ""},
    {T::key, key::kF9, kPlain, H::any, U::any, A::look_from_top, kCamera, "", "", ""},
    {T::key, 'C', kCtrl, H::any, U::any, A::copy_camera, kCamera, "Ctrl+C, Ctrl+V", "copy and paste the camera as JSON", ""},
    {T::key, 'V', kCtrl, H::any, U::any, A::paste_camera, kCamera, "", "", ""},

    {T::key, key::kSpace, kPlain, H::any, U::any, A::play_pause, kTime, "Space", "play or pause", "Space: play"},
    {T::key, 'B', kPlain, H::any, U::any, A::hold_bodies, kTime, "B", "hold the bodies where they are, or let them go on; the cloth moves on", ""},
    {T::key, key::kRight, kPlain, H::any, U::any, A::step, kTime, "Right or .", "one step", ""},
    {T::key, key::kPeriod, kPlain, H::any, U::any, A::step, kTime, "", "", ""},
    {T::key, key::kLeft, kPlain, H::any, U::any, A::step_back, kTime, "Left", "one step back in the history", ""},
    {T::key, key::kRight, kShift, H::any, U::any, A::step_forward, kTime, "Shift+Right", "one step forward again, as it was recorded", ""},
    {T::key, key::kLeft, kShift, H::any, U::any, A::other_run, kTime, "Shift+Left", "the run that was left by going on from an older state or by a reset", ""},
    {T::key, 'O', kPlain, H::any, U::any, A::pass_over, kTime, "O", "go on over a refused step: the clock moves, the cloth rests where it is", ""},
    {T::key, 'R', kPlain, H::any, U::any, A::reset, kTime, "R", "reset to the start state; parameters stay", ""},
    {T::key, 'R', kCtrl, H::any, U::any, A::reload, kTime, "Ctrl+R", "open the scene again from its file; the camera stays", ""},
    {T::key, 'Z', kCtrl, H::any, U::any, A::undo, kTime, "Ctrl+Z, Ctrl+Shift+Z", "undo and redo changes of parameters", ""},
    {T::key, 'Z', kCtrl | kShift, H::any, U::any, A::redo, kTime, "", "", ""},
    {T::key, 'S', kCtrl, H::any, U::any, A::save_session, kTime, "Ctrl+S", "save the session; icloth replay runs it again", ""},

    {T::key, '1', kPlain, H::any, U::any, A::view_shaded, kWindow, "1, 2, 3", "view: shaded, wireframe, strain", ""},
    {T::key, '2', kPlain, H::any, U::any, A::view_wireframe, kWindow, "", "", ""},
    {T::key, '3', kPlain, H::any, U::any, A::view_strain, kWindow, "", "", ""},
    {T::key, key::kTab, kPlain, H::any, U::any, A::toggle_panels, kWindow, "Tab", "show or hide the panels", "Tab: panels"},
    {T::key, key::kF1, kPlain, H::any, U::any, A::help, kWindow, "F1", "show or hide this help", "F1: help"},
    {T::key, key::kF11, kPlain, H::any, U::any, A::full_screen, kWindow, "F11", "full screen", ""},
    {T::key, key::kF12, kPlain, H::any, U::any, A::screenshot, kWindow, "F12", "save a picture of the window", ""},
    {T::key, 'Q', kCtrl, H::any, U::any, A::quit, kWindow, "Ctrl+Q", "quit", ""},
};
// clang-format on

/// True where a row of the table counts for a hand that holds a grab, or for one that is free.
bool fits(Hand wanted, bool holds) {
  return wanted == Hand::any || (wanted == Hand::holds) == holds;
}

}  // namespace

std::span<const Binding> binding_table() { return kTable; }

Action find_action(Trigger trigger, int code, const InputState& state) {
  for (const Binding& row : kTable) {
    if (row.trigger == trigger && row.code == code && row.modifiers == state.modifiers &&
        fits(row.hand, state.hand_holds) && (row.under == Under::any || row.under == state.under)) {
      return row.action;
    }
  }
  return Action::none;
}

bool text_field_takes(int code, int modifiers) {
  if (code >= key::kF1 && code <= key::kF25) return false;
  constexpr std::string_view kOfTheField = "ACVXYZ";
  const bool letter = code >= 'A' && code <= 'Z';
  return !letter || (modifiers & modifier::kControl) == 0 ||
         kOfTheField.find(static_cast<char>(code)) != std::string_view::npos;
}

std::string hint_line(bool hand_holds) {
  std::string line;
  for (const Binding& row : kTable) {
    // While a grab is held only the rows about it matter.
    const bool matters = fits(row.hand, hand_holds) &&
                         (!hand_holds || row.hand == Hand::holds || row.trigger == Trigger::wheel ||
                          row.action == Action::release_selected || row.action == Action::cancel);
    if (row.hint.empty() || !matters) continue;

    // A free hand needs no hint for what a grab alone makes useful.
    if (!hand_holds &&
        (row.trigger == Trigger::wheel ? row.hand == Hand::any : row.action == Action::cancel)) {
      continue;
    }

    if (!line.empty()) line += "   ";
    line += row.hint;
  }
  return line;
}

std::string bindings_markdown() {
  std::string text =
      "# Keys and mouse\n\n"
      "This page is printed by the program from the table that the window works with\n"
      "(`icloth info --keys`); a test keeps the two equal. While a number is being typed its\n"
      "field takes the keys, except for F1 to F12 and Ctrl with a letter; Ctrl+A, C, V, X, Y and "
      "Z\n"
      "are those of the field.\n";

  // Each group has a heading and a table, in the order of the rows.
  std::string_view group;
  for (const Binding& row : kTable) {
    if (row.group != group) {
      group = row.group;
      text += "\n## " + std::string(group) + "\n\n| input | action |\n|---|---|\n";
    }

    // Rows without an input repeat the action above with another key.
    if (row.input.empty()) continue;
    text += "| " + std::string(row.input) + " | " + std::string(row.text) + " |\n";
  }
  return text;
}

}  // namespace icloth
