// The interactive window. Input goes to camera, hands and session; the states that the session
// publishes are drawn. One frame of the screen is one call of frame().
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/common/cloth_place.h"
#include "app/session/garment_gauge.h"
#include "app/session/session.h"
#include "app/window/bindings.h"
#include "app/window/drag.h"
#include "app/window/imgui_gl.h"
#include "app/window/panels/panel.h"
#include "app/window/parameter_edits.h"
#include "app/window/test_status.h"
#include "app/window/view_options.h"
#include "app/window/window.h"
#include "render/camera.h"
#include "render/gl_targets.h"
#include "render/pick.h"
#include "render/renderer.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/world.h"

namespace icloth {

/// Owns the renderer and the session of one scene, and connects them with the window.
class Viewer {
 public:
  /// Makes the solver of a build. The window and its interface must outlive it. `origin` is that of
  /// the scene: its notes are shown, and its numbers name vertices. Throws DeviceError and
  /// InputError.
  Viewer(Window& window, Ui& ui, const ViewOptions& options, Build build,
         std::shared_ptr<const Scene> scene, SceneOrigin origin);

  void look_from(const Camera& camera) { camera_ = camera; }
  const Camera& camera() const { return camera_; }

  /// Runs until the window is closed or another scene is chosen, whose name it returns. Writes the
  /// recording when the options ask for it.
  std::optional<std::string> run();

 private:
  /// The motion of the camera while a button is held.
  enum class Gesture { none, orbit, pan, dolly };

  // One frame, in this order (viewer.cpp).
  void frame();
  double time_to_wait() const;
  void count_frames();
  void take_state();
  void measure_garments();
  void hand_over();
  void draw_scene();
  bool time_to_draw();
  void draw_panels();
  void show_frame();

  // Input (viewer_input.cpp).
  void handle(const WindowEvent& event);
  void press(const WindowEvent& event);
  void release(const WindowEvent& event);
  void move(const WindowEvent& event);
  void wheel(const WindowEvent& event);

  // Actions (viewer_actions.cpp).
  void act(Action action, double amount = 0);
  bool act_on_camera(Action action, double amount);
  bool act_on_hands(Action action, double amount);
  bool act_on_session(Action action);
  void cancel();
  void frame_box(const std::vector<Vec3d>& points);
  void frame_selection();
  void look_at_failure();
  void choose_camera(std::size_t number);
  void save_session();
  void draw_camera_menu();
  void draw_menu();

  // Positions on the window, and what lies there.
  bool in_view(double x, double y) const;
  Ray ray(double x, double y) const;
  CursorRay cursor_ray() const;
  Pick pick_at(double x, double y) const;
  int handle_at(double x, double y) const;
  std::vector<HandleState> handle_states() const;
  Vec3d hit_point(const Handle& handle) const;
  std::optional<DropLine> drop_line() const;
  std::string depth_text() const;
  ClothPlace place_of(const Pick& hit) const;
  std::vector<Vec3d> cloth_points() const;
  std::vector<Index> failing_faces() const;
  void update_hover();

  void tell(const std::string& note);
  void complain(const std::string& note);  ///< the same, of what went wrong
  std::optional<Vec3d> graspable_point() const;
  StatusTexts status_texts() const;
  TestStatus test_status() const;

  Window& window_;
  Ui& ui_;
  ViewOptions options_;
  Build build_;
  std::shared_ptr<const Scene> scene_;
  World world_;
  SceneOrigin origin_;
  ElementNames names_;  ///< of its elements
  StartConflicts start_conflicts_;
  std::vector<std::string> start_remedies_;
  std::vector<IntersectingFaces> start_intersections_;  ///< the faces of the conflicts
  GarmentGauge gauge_;
  std::vector<GarmentState> garments_;  ///< measured now and then
  double last_measured_ = -1;
  std::vector<std::array<Index, 2>> stitches_;  ///< pairs of open seams, vertices of the world
  Renderer renderer_;
  Target picture_{Target::Kind::bytes};
  bool software_;  ///< OpenGL runs on the processor
  int threads_;
  std::unique_ptr<Session> session_;
  ParameterEdits edits_;
  StageHistory stages_;
  Drag drag_;
  Camera camera_;
  std::size_t next_camera_ = 0;  ///< of the scene, scene_camera
  UiState state_;
  TestStatusFile test_file_;

  Rect view_;               ///< of the 3D picture [logical pixels]
  double x_ = -1, y_ = -1;  ///< pointer
  bool pointer_inside_ = false;
  Gesture gesture_ = Gesture::none;
  int gesture_button_ = 0;
  double press_x_ = 0, press_y_ = 0, press_time_ = -1;
  std::optional<Pick> hover_;  ///< cloth under the pointer
  Pick menu_pick_;
  int menu_handle_ = 0;
  bool open_menu_ = false, want_screenshot_ = false;
  bool dirty_ = true, hover_stale_ = true;
  double draw_seconds_ = 0, draw_end_ = 0;     ///< cost and end of the last drawing of the scene
  double last_change_ = 0;                     ///< when the scene last had to be drawn anew
  bool sharp_ = false;                         ///< the picture has the full resolution
  bool shows_state_ = false;                   ///< the last frame is of the present state
  double last_frame_ = 0, frame_seconds_ = 0;  ///< end and cost of the last frame
  std::uint64_t seen_rewinds_ = 0, seen_notes_ = 0;
  bool seen_failure_ = false;
  std::vector<Index> marked_faces_;
  std::string note_;
  bool note_is_bad_ = false;
  double note_end_ = 0, last_status_ = -1;
  std::deque<double> frame_times_;  ///< of the last second
};

}  // namespace icloth
