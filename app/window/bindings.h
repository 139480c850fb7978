// Keys and mouse: one table generates the handlers, the F1 overlay, the hint bar and docs/keys.md.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace icloth {

/// The codes are those of GLFW, so that its events need no translation (checked in the window).
namespace key {
inline constexpr int kSpace = 32, kPeriod = 46, kEscape = 256, kEnter = 257, kTab = 258,
                     kRight = 262, kLeft = 263, kHome = 268, kF1 = 290, kF5 = 294, kF9 = 298,
                     kF11 = 300, kF12 = 301, kF25 = 314, kKeypadEnter = 335;
}  // namespace key
namespace modifier {
inline constexpr int kNone = 0, kShift = 1, kControl = 2;
}  // namespace modifier
namespace button {
inline constexpr int kLeft = 0, kRight = 1, kMiddle = 2;
}  // namespace button

// clang-format off
enum class Action {
  none,
  // hands
  grab, grab_handle, add_handle, pin_point, unpin, park, cancel, release_selected, release_all,
  grab_depth, grab_radius, grab_stiffness,
  // camera
  orbit, pan, dolly_drag, dolly, set_pivot, frame_selection, frame_all, look_from_front,
  look_from_back, look_from_left, look_from_right, look_from_top, scene_camera, menu, copy_camera,
  paste_camera,
  // simulation
  play_pause, hold_bodies, step, step_back, step_forward, other_run, pass_over, reset, reload, undo, redo, save_session,
  // window
  view_shaded, view_wireframe, view_strain, toggle_panels, help, full_screen, screenshot, quit,
};

// clang-format on

/// The kinds of input.
enum class Trigger { key, press, click, double_click, wheel };
/// The state of the hand that a binding asks for.
enum class Hand { any, holds, free };
/// The element under the pointer when a button goes down.
enum class Under { any, cloth, handle, other };

/// One row of the table.
struct Binding {
  Trigger trigger;
  int code;       ///< key or button, 0 for the wheel
  int modifiers;  ///< exactly these
  Hand hand;
  Under under;
  Action action;
  std::string_view group;  ///< heading, the same for neighbours
  std::string_view input;  ///< in the user's words; empty: the row repeats the action above
  std::string_view text;   ///< its effect in the user's words
  std::string_view hint;   ///< few words for the hint bar; empty: not shown there
};

/// The table; the first row that fits counts.
std::span<const Binding> binding_table();

/// The circumstances of an input.
struct InputState {
  int modifiers = 0;
  bool hand_holds = false;
  Under under = Under::any;
};
/// The action of an input, Action::none where no row fits.
Action find_action(Trigger trigger, int code, const InputState& state);

/// Whether a text field that is being typed into takes this key. It leaves function keys and
/// Ctrl+letter, except those of the clipboard and of its own undo, to the table.
bool text_field_takes(int code, int modifiers);

/// The hints for the present actions: "Left drag grab · P park · …".
std::string hint_line(bool hand_holds);

/// The contents of docs/keys.md.
std::string bindings_markdown();

}  // namespace icloth
