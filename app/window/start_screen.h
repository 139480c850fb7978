// The window before a simulation runs in it: a scene is being opened, or one is to be chosen.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "app/session/scene_opening.h"
#include "app/window/imgui_gl.h"
#include "app/window/test_status.h"
#include "app/window/window.h"
#include "render/camera.h"
#include "render/gl_targets.h"
#include "render/renderer.h"

namespace icloth {

class StartScreen {
 public:
  /// Both must outlive it. F12 writes pictures to the folder.
  StartScreen(Window& window, Ui& ui, std::string screenshot_folder)
      : window_(window), ui_(ui), screenshot_folder_(std::move(screenshot_folder)) {}

  /// Shows how a scene is opened, with its garments while they are put on. False: the user did not
  /// want to wait, or has closed the window.
  bool show(SceneOpening& opening, const std::string& name);

  /// The camera that the user turned meanwhile; null: it is still that of the scene.
  const Camera* chosen_camera() const { return camera_moved_ ? &camera_ : nullptr; }

  /// Asks for one of the built-in scenes; `problem`: why the last one is not there, may be empty;
  /// `again`: its name, so that it can be tried once more. None: the window was closed.
  std::optional<std::string> choose(const std::string& problem, const std::string& again = "");

 private:
  void take_picture(SceneOpening& opening);
  void handle(const std::vector<WindowEvent>& events);
  void draw_opening(const DressingPicture& picture, const std::string& name);
  void draw_choice(const std::string& problem, const std::string& again);
  void draw_scene(const DressingPicture& picture);
  void show_frame();
  void write_status(const char* phase, int dressing_step);

  Window& window_;
  Ui& ui_;
  std::string screenshot_folder_;
  std::shared_ptr<const World> world_;  ///< that is drawn
  std::unique_ptr<Renderer> renderer_;  ///< of that world
  Target picture_{Target::Kind::bytes};
  Camera camera_;
  bool has_camera_ = false, has_picture_ = false, dirty_ = false;
  bool want_screenshot_ = false;
  bool cancelled_ = false;  ///< by the button or by Esc
  bool camera_moved_ = false;
  bool orbits_ = false;   ///< a button is down over the picture
  double x_ = 0, y_ = 0;  ///< pointer
  double begin_ = 0, draw_seconds_ = 0, draw_end_ = 0, last_status_ = -1;
  std::deque<double> frame_times_;  ///< of the last second
  std::optional<std::string> chosen_;
  TestStatusFile test_file_;
};

}  // namespace icloth
