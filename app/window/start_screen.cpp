#include "app/window/start_screen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/window/bindings.h"
#include "app/window/scene_list.h"
#include "app/window/screenshot.h"
#include "app/window/theme.h"
#include "render/ui_painter.h"
#include "sim/files/box.h"

namespace icloth {
namespace {

constexpr double kLongestPause = 0.2;  // between two pictures [s]
constexpr double kStrainRange = 0.1;   // strain that gets the last colour
constexpr double kDollyPerNotch = 0.88;
constexpr double kChoiceWait = 0.1;  // for input while a scene is chosen [s]
constexpr float kPanelWidth = 380;   // at scale 1

/// A panel without decoration: in the middle of an empty window, else in the corner at the bottom,
/// where it hides little of the figure.
void begin_panel(const Window& window, const char* id, float scale, bool in_corner) {
  const auto wide = static_cast<float>(window.width()), high = static_cast<float>(window.height());
  const float margin = 16 * scale;
  if (in_corner)
    ImGui::SetNextWindowPos({margin, high - margin}, ImGuiCond_Always, {0, 1});
  else
    ImGui::SetNextWindowPos({0.5f * wide, 0.5f * high}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({kPanelWidth * scale, 0});
  ImGui::Begin(id, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
}

/// What is going on, in words.
std::string stage_of(const DressingPicture& picture, const std::string& name) {
  if (!picture.world)
    return "Reading " + shown(name) + " and looking for a start without intersections";
  return shown(picture.garment) +
         (picture.settling ? " settles under its weight" : ": its seams are drawn together");
}

}  // namespace

bool StartScreen::show(SceneOpening& opening, const std::string& name) {
  begin_ = window_.seconds();
  cancelled_ = has_camera_ = has_picture_ = camera_moved_ = orbits_ = false;
  while (!opening.done()) {
    handle(window_.poll());
    if (window_.should_close() || cancelled_) break;
    take_picture(opening);

    // The panel is drawn in every frame, so that its button answers at once.
    ui_.begin_frame();
    draw_opening(opening.picture(), name);
    ui_.end_frame();
    draw_scene(opening.picture());
    show_frame();
    write_status("opening", opening.picture().step);
  }

  // The next picture is drawn by somebody else.
  renderer_.reset();
  world_.reset();
  if (opening.done() && !cancelled_ && !window_.should_close()) return true;
  opening.cancel();
  return false;
}

std::optional<std::string> StartScreen::choose(const std::string& problem,
                                               const std::string& again) {
  chosen_.reset();
  has_picture_ = false;
  while (!chosen_ && !window_.should_close()) {
    handle(window_.poll(kChoiceWait));
    for (const std::string& file : window_.take_dropped()) chosen_ = file;
    ui_.begin_frame();
    draw_choice(problem, again);
    ui_.end_frame();
    show_frame();
    write_status("choosing", 0);
  }
  return chosen_;
}

/// Takes the newest picture. Each garment is put on in a world of its own.
void StartScreen::take_picture(SceneOpening& opening) {
  if (!opening.take()) return;
  const DressingPicture& picture = opening.picture();
  dirty_ = true;
  if (world_ == picture.world) return;

  // A renderer belongs to one world, and goes before it.
  renderer_.reset();
  world_ = picture.world;
  renderer_ = std::make_unique<Renderer>(*world_, VertexOptions{.on_device = false});
  renderer_->set_quality(Quality::draft);

  // The camera is that of the scene, so that nothing jumps when the scene starts.
  if (has_camera_) return;
  has_camera_ = true;
  camera_ = picture.cameras.empty() ? Camera() : Camera(picture.cameras.front());
  if (!picture.cameras.empty()) return;
  std::vector<Vec3d> points;
  for (const Vec3f& p : picture.positions) points.push_back(convert<double>(p));
  const Box box = box_around(points);
  camera_.frame_box(box.low, box.high, static_cast<double>(window_.width()) / window_.height());
}

/// Esc cancels, Ctrl+Q quits, a drag turns the camera, and the wheel moves it.
void StartScreen::handle(const std::vector<WindowEvent>& events) {
  using Kind = WindowEvent::Kind;
  for (const WindowEvent& event : events) {
    // A press on the panel is for its button.
    const bool is_over_panel = ImGui::GetIO().WantCaptureMouse;
    if (event.kind == Kind::key) {
      const Action action =
          find_action(Trigger::key, event.code, {event.modifiers, false, Under::other});
      cancelled_ = cancelled_ || action == Action::cancel;
      want_screenshot_ = want_screenshot_ || action == Action::screenshot;
      if (action == Action::quit) window_.request_close();
    } else if (event.kind == Kind::press && has_camera_ && !is_over_panel) {
      orbits_ = true;
    } else if (event.kind == Kind::release) {
      orbits_ = false;
    } else if (event.kind == Kind::move && orbits_) {
      camera_.orbit(event.x - x_, event.y - y_, window_.height(), renderer_->floor());
      dirty_ = camera_moved_ = true;
    } else if (event.kind == Kind::wheel && has_camera_ && !is_over_panel) {
      camera_.dolly(std::pow(kDollyPerNotch, event.amount));
      dirty_ = camera_moved_ = true;
    }

    // Drags are measured from one event to the next.
    x_ = event.x;
    y_ = event.y;
  }
}

void StartScreen::draw_opening(const DressingPicture& picture, const std::string& name) {
  begin_panel(window_, "##opening", ui_.scale(), has_picture_);
  ImGui::PushTextWrapPos();
  ImGui::TextUnformatted(stage_of(picture, name).c_str());
  ImGui::PopTextWrapPos();

  // A garment may be ready before the most steps are made, and then the bar jumps to its end.
  char text[96] = "";
  float share = 0;
  if (picture.world) {
    share = static_cast<float>(picture.step) / static_cast<float>(std::max(picture.most_steps, 1));
    std::snprintf(text, sizeof text, "step %d of at most %d", picture.step, picture.most_steps);
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colour::kLit);
    ImGui::ProgressBar(share, {-1, 0}, text);
    ImGui::PopStyleColor();
    std::snprintf(text, sizeof text, "largest strain %.1f %%   %.0f s",
                  100 * picture.largest_strain, window_.seconds() - begin_);
  } else {
    std::snprintf(text, sizeof text, "%.0f s", window_.seconds() - begin_);
  }
  ImGui::TextDisabled("%s", text);
  if (ImGui::Button("Cancel")) cancelled_ = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Esc: choose another scene");
  ImGui::End();
}

void StartScreen::draw_choice(const std::string& problem, const std::string& again) {
  begin_panel(window_, "##choice", ui_.scale(), false);
  if (!problem.empty()) {
    ImGui::PushTextWrapPos();
    ImGui::TextColored(vec4(colour::kBad), "%s", shown(problem).c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
  }
  if (!again.empty() && ImGui::Button(("Try " + shown(again) + " again").c_str(), {-1, 0}))
    chosen_ = again;
  ImGui::TextUnformatted("Open a scene");
  for (const std::string& name : suggested_scenes())
    if (ImGui::Button(name.c_str(), {-1, 0})) chosen_ = name;
  ImGui::TextDisabled("or drop a scene or a mesh onto this window");
  ImGui::End();
}

/// Drawing on the processor takes the time of dressing, so panels and dressing get as much.
void StartScreen::draw_scene(const DressingPicture& picture) {
  const double now = window_.seconds();
  if (!renderer_ || !dirty_ || now - draw_end_ < std::min(draw_seconds_, kLongestPause)) return;
  dirty_ = false;
  const int width = window_.framebuffer_width(), height = window_.framebuffer_height();
  picture_.resize(std::max(8, width), std::max(8, height));

  // Where seams pull, the cloth is stretched, and the view of the strain shows it.
  Frame frame;
  frame.positions = picture.positions;
  frame.view = ViewMode::strain;
  frame.strain_range = kStrainRange;
  renderer_->draw(frame, camera_, picture_.width(), picture_.height(), picture_.framebuffer());
  finish_drawing();
  draw_end_ = window_.seconds();
  draw_seconds_ = draw_end_ - now;
  has_picture_ = true;
}

void StartScreen::show_frame() {
  const int width = window_.framebuffer_width(), height = window_.framebuffer_height();
  if (want_screenshot_)
    save_screenshot(window_, ui_, has_picture_ ? &picture_ : nullptr, 0,
                    static_cast<float>(window_.height()), screenshot_folder_);
  want_screenshot_ = false;
  clear_picture(0, 0.09f, 0.1f, 0.12f);
  if (has_picture_) show_picture(picture_, 0, height, 0, 0, width, height);
  ui_.paint(width, height, 0);
  window_.show();

  const double now = window_.seconds();
  frame_times_.push_back(now);
  while (now - frame_times_.front() > 1) frame_times_.pop_front();
}

/// One line a second for the tests of the window.
void StartScreen::write_status(const char* phase, int dressing_step) {
  const double now = window_.seconds();
  if (!test_file_.wanted() || now - last_status_ < 0.2) return;
  last_status_ = now;
  TestStatus status;
  status.phase = phase;
  status.clock = now;
  status.dressing_step = dressing_step;
  status.ui_fps = static_cast<double>(frame_times_.size());
  test_file_.write(status);
}

}  // namespace icloth
