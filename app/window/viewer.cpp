#include "app/window/viewer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/common/element_names.h"
#include "app/window/patch_outline.h"
#include "app/window/screenshot.h"
#include "app/window/theme.h"
#include "render/ui_painter.h"
#include "sim/files/error.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {

namespace {

constexpr double kNoteSeconds = 8, kStatusSeconds = 1;
constexpr double kStrainRange = 0.1;
constexpr double kRestSeconds = 0.3, kLongestPause = 0.2, kMovingSharpness = 0.5;
constexpr Index kGraspSamples = 97;

/// Explains why a start state that intersects is refused, and what helps where that is known.
std::string start_sentence(std::size_t pairs, const std::vector<std::string>& remedies) {
  if (pairs == 0) return {};
  std::string text = "In the start state " + std::to_string(pairs) +
                     (pairs == 1 ? " pair" : " pairs") +
                     " of faces cross or touch each other (red). A solver that keeps layers apart "
                     "cannot start from there: move the objects apart in the scene file, or repair "
                     "the mesh.";
  for (const std::string& remedy : remedies) text += " " + remedy;
  return text;
}

std::unique_ptr<Session> make_session(const ViewOptions& view, Build build,
                                      const std::shared_ptr<const Scene>& scene,
                                      const SceneOrigin& origin, const std::string& refusal) {
  const SimulationOptions& options = view.simulation;
  SessionOptions session;
  session.ahead = view.recorded;
  session.scene = scene->source.empty() ? options.scene : scene->source;
  session.overrides = scene_overrides(options);
  session.layouts = origin.layouts;
  session.refusal = refusal;
  session.published = [] { Window::wake(); };
  return std::make_unique<Session>(make_simulator(build, scene), session);
}

/// The vertices that open seams pull together, by their numbers in the world.
std::vector<std::array<Index, 2>> stitched_vertices(const Scene& scene, const World& world) {
  std::vector<Index> first(scene.cloths.size());
  for (const WorldObject& object : world.objects)
    if (object.cloth) first[static_cast<std::size_t>(object.source)] = object.first_vertex;
  std::vector<std::array<Index, 2>> pairs;
  for (const Seam& seam : scene.seams)
    for (const auto& [a, b] : seam.pairs)
      pairs.push_back({first[static_cast<std::size_t>(seam.from)] + a,
                       first[static_cast<std::size_t>(seam.to)] + b});
  return pairs;
}

}  // namespace

Viewer::Viewer(Window& window, Ui& ui, const ViewOptions& options, Build build,
               std::shared_ptr<const Scene> scene, SceneOrigin origin)
    : window_(window),
      ui_(ui),
      options_(options),
      build_(build),
      scene_(std::move(scene)),
      world_(make_world(*scene_)),
      origin_(std::move(origin)),
      names_(*scene_, origin_.layouts),
      start_conflicts_(find_start_conflicts(*scene_, build != Build::cpu64)),
      start_remedies_(start_remedies(*scene_, start_conflicts_, build != Build::cpu64)),
      start_intersections_(face_pairs(start_conflicts_)),
      gauge_(*scene_, world_),
      stitches_(stitched_vertices(*scene_, world_)),
      renderer_(world_, {.on_device = options.vertices != "host"}),
      software_(gl_is_software()),
      threads_(solver_threads(options.simulation)),
      edits_(scene_->parameters) {
  window_.set_title("icloth - " + scene_->name);

  // The parts follow the machine, then the scene and the options.
  set_thread_count(threads_);
  renderer_.set_quality(software_ ? Quality::draft : Quality::interactive);
  session_ = make_session(options_, build_, scene_, origin_,
                          start_sentence(start_intersections_.size(), start_remedies_));
  if (!scene_->cameras.empty()) camera_ = Camera(scene_->cameras.front());
  if (options_.play_script) session_->set_scripted(true);
  if (!options_.play) return;
  if (options_.recorded.empty())
    session_->play();
  else
    session_->go(options_.recorded.size());
}

std::optional<std::string> Viewer::run() {
  while (!window_.should_close() && state_.open_scene.empty()) frame();

  // The window goes first, since the step in progress may take a while.
  if (window_.should_close()) window_.hide();
  session_->stop();
  if (!options_.record_file.empty()) save_recording(session_->recording(), options_.record_file);
  if (window_.should_close()) return std::nullopt;
  return state_.open_scene;
}

void Viewer::frame() {
  const std::vector<WindowEvent> events = window_.poll(time_to_wait());

  // Newly published states come first, then input, so that hands act on what the user saw.
  take_state();
  for (const WindowEvent& event : events) handle(event);
  hand_over();
  for (const std::string& file : window_.take_dropped()) state_.open_scene = file;

  // A window that is not seen, or that shows all there is, draws nothing.
  if (test_file_.wanted() && window_.seconds() - last_status_ >= kStatusSeconds) {
    test_file_.write(test_status());
    last_status_ = window_.seconds();
  }
  count_frames();
  if (window_.minimised() || time_to_wait() > 0) return;
  const double begin = window_.seconds();
  shows_state_ = true;
  measure_garments();

  // The panels may change parameters, which reach the solver with the same frame.
  ui_.begin_frame();
  draw_panels();
  ui_.end_frame();
  update_hover();
  hand_over();
  draw_scene();
  show_frame();
  last_frame_ = window_.seconds();
  frame_seconds_ = window_.last_swap() - begin;

  frame_times_.push_back(last_frame_);
}

/// Keeps the frames of the last second.
void Viewer::count_frames() {
  while (!frame_times_.empty() && window_.seconds() - frame_times_.front() > 1)
    frame_times_.pop_front();
}

/// How long the next frame may wait for input [s]. While the user does something there is a frame
/// as soon as possible. Otherwise it takes something new to show, and drawing on the processor
/// leaves the solver most of the time.
double Viewer::time_to_wait() const {
  constexpr double kActive = 0.5, kRest = 0.25, kLongest = 1, kShortest = 0.1, kShare = 0.5;
  const double now = window_.seconds();
  if (window_.minimised()) return kRest;
  if (now - window_.last_input() < kActive) return 0;

  // A step in progress counts its seconds, a text field has a cursor that blinks, and a message
  // goes away.
  const bool playing = session_->state().playing;
  const bool ages = playing || ui_.wants_text() || (last_frame_ < note_end_ && now >= note_end_);
  const bool has_news =
      !shows_state_ || dirty_ || (!sharp_ && !playing) || (ages && now - last_frame_ > kActive);
  if (!has_news) return kRest;
  const double pause = software_ ? std::clamp(frame_seconds_ / kShare, kShortest, kLongest) : 0;
  return std::clamp(last_frame_ + pause - now, 0., kRest);
}

/// Takes the newest published state, and notes what has changed with it.
void Viewer::take_state() {
  stages_.add(session_->take_reports());
  if (!session_->take()) return;
  const PublishedState& state = session_->state();
  dirty_ = hover_stale_ = true;
  shows_state_ = false;

  // After a jump back in time the handles and the plots are those of that time.
  if (state.rewinds != seen_rewinds_) {
    seen_rewinds_ = state.rewinds;
    drag_.restore(state.handles);
    if (!options_.recorded.empty()) edits_.follow(state.parameters);
    stages_.cut(state.step);
  }

  // News are numbered, so that each of them is shown once.
  if (state.notes != seen_notes_) {
    seen_notes_ = state.notes;
    state.note_is_bad ? complain(state.note) : tell(state.note);
  }

  if (state.failed != seen_failure_) {
    seen_failure_ = state.failed;
    marked_faces_ = failing_faces();
  }
}

/// Measures seams and strains of garments twice a second.
void Viewer::measure_garments() {
  constexpr double kInterval = 0.5;  // [s]
  const double now = window_.seconds();
  if (now - last_measured_ < kInterval) return;
  last_measured_ = now;
  garments_ = gauge_.measure(session_->state().positions);
}

/// Sends the changes that hands and panels made to the solver.
void Viewer::hand_over() {
  for (const InputEvent& event : drag_.take_events()) session_->post(event);
  for (const auto& [name, value] : edits_.take_changes()) session_->set(name, value);
}

void Viewer::draw_panels() {
  // The column on the left and the bar below leave the rest of the window to the picture.
  const float scale = ui_.scale();
  const float wide = static_cast<float>(window_.width()),
              high = static_cast<float>(window_.height());
  const float bar = kBarHeight * scale, side = state_.panels ? kPanelWidth * scale : 0;
  const Rect view{side, 0, wide - side, high - bar};
  if (view.x != view_.x || view.width != view_.width || view.height != view_.height) dirty_ = true;
  view_ = view;

  // Every panel draws itself; floating ones report their place.
  state_.overlays.clear();
  PanelContext context{.session = *session_,
                       .state = session_->state(),
                       .edits = edits_,
                       .stages = stages_,
                       .drag = drag_,
                       .scene = *scene_,
                       .world = world_,
                       .origin = origin_,
                       .start_conflicts = start_conflicts_,
                       .start_intersections = start_intersections_,
                       .garments = garments_,
                       .ui = state_,
                       .scale = scale};
  if (state_.panels) draw_side_panel(context, {0, 0, side, high - bar});
  draw_status_bar(context, status_texts(), {0, high - bar, wide, bar});
  draw_legend(context, view_, kStrainRange);
  draw_failure(context, view_);
  draw_help(context, view_);
  draw_menu();

  // Requests of the panels are carried out after all of them are drawn.
  if (hover_ && !drag_.grabbing()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  if (state_.show_failure) look_at_failure();
  if (state_.save_session) act(Action::save_session);
  state_.show_failure = state_.save_session = false;
}

/// Decides whether the scene is drawn in this frame. Drawing on the processor takes tens of
/// milliseconds and the solver's cores. Panels and pointer then get at least as much time, a moving
/// scene is drawn at half the resolution, and one that has come to rest once more at the full one.
bool Viewer::time_to_draw() {
  const double now = window_.seconds();
  if (dirty_) last_change_ = now;
  if (!software_ || want_screenshot_) return dirty_ || !sharp_;

  // While steps are made, what is drawn at half the resolution is soon old.
  if (!dirty_) return !sharp_ && !session_->state().playing && now - last_change_ > kRestSeconds;
  return now - draw_end_ >= std::min(draw_seconds_, kLongestPause);
}

void Viewer::draw_scene() {
  if (!time_to_draw()) return;

  // The picture is sharp unless the processor draws something that moves.
  const double begin = window_.seconds();
  sharp_ = !software_ || !dirty_ || want_screenshot_;
  dirty_ = false;
  const double sharpness = sharp_ ? 1 : kMovingSharpness;
  const double factor =
      sharpness * static_cast<double>(window_.framebuffer_width()) / window_.width();
  const int width = std::max(8, static_cast<int>(view_.width * factor));
  const int height = std::max(8, static_cast<int>(view_.height * factor));
  picture_.resize(width, height);

  // The picture shows the published state, and the user's marks on it.
  const std::vector<HandleState> handles = handle_states();
  std::vector<Index> pins;
  for (Index v = 0; v < world_.cloth_vertices; ++v) {
    if (world_.pinned[static_cast<std::size_t>(v)]) pins.push_back(v);
  }
  std::vector<Vec3f> hover;
  if (hover_ && !drag_.grabbing()) hover.push_back(convert<float>(hover_->point));
  Frame scene_frame;
  scene_frame.positions = session_->state().positions;
  scene_frame.on_device = session_->state().on_device.get();
  scene_frame.handles = handles;
  scene_frame.marked_faces = marked_faces_;
  scene_frame.marked_vertices = pins;
  scene_frame.hover = hover;
  scene_frame.stitches = stitches_;

  // The patch in the hand has its rim and, within, where the pull is half of that at the hit.
  constexpr double kShares[] = {0, 0.5};
  std::vector<LineSegment> patch;
  if (const Handle* held = drag_.find(drag_.active()))
    patch = patch_outline(world_, session_->state().positions, *held, kShares);
  scene_frame.outlines = patch;

  std::vector<Vec3d> user_pins;
  for (const Handle& handle : drag_.handles())
    if (handle.pin && handle.parked) user_pins.push_back(hit_point(handle));
  scene_frame.pins = user_pins;
  const std::optional<DropLine> drop = drop_line();
  if (drop) scene_frame.drop_lines = {&*drop, 1};
  scene_frame.view = state_.view;
  scene_frame.strain_range = kStrainRange;

  // The time is that of finished drawing, which the next frames are paced by.
  renderer_.draw(scene_frame, camera_, width, height, picture_.framebuffer());
  if (software_) finish_drawing();
  draw_end_ = window_.seconds();
  draw_seconds_ = draw_end_ - begin;
}

void Viewer::show_frame() {
  const int width = window_.framebuffer_width(), height = window_.framebuffer_height();
  const double factor = static_cast<double>(width) / window_.width();
  if (want_screenshot_) {
    const SaveResult saved =
        save_screenshot(window_, ui_, &picture_, view_.x, view_.height, options_.screenshot_folder);
    saved.failed ? complain(saved.sentence) : tell(saved.sentence);
  }
  want_screenshot_ = false;
  show_picture(picture_, 0, height, static_cast<int>(view_.x * factor), 0,
               static_cast<int>(view_.width * factor), static_cast<int>(view_.height * factor));
  ui_.paint(width, height, 0);
  window_.show();
}

/// The handles as they are drawn: the user's at their present hit, and those of the script.
std::vector<HandleState> Viewer::handle_states() const {
  const PublishedState& state = session_->state();
  std::vector<HandleState> list;
  for (const Handle& handle : drag_.handles()) {
    if (handle.pin && handle.parked) continue;  // drawn as a pin
    HandleState shown_handle{handle, hit_point(handle)};
    for (const HandleState& held : state.handles) {
      if (held.id == handle.id) shown_handle.saturation = held.saturation;
    }
    list.push_back(shown_handle);
  }

  for (const HandleState& held : state.handles) {
    if (held.id >= kFirstScriptedHandle) list.push_back(held);
  }
  return list;
}

/// From the target in the hand down to the body or the floor below it.
std::optional<DropLine> Viewer::drop_line() const {
  const Handle* held = drag_.find(drag_.active());
  if (!held) return std::nullopt;
  const Ray down{held->target, {0, -1, 0}};
  const Pick below = pick(world_, session_->state().positions, down);
  if (below.hit_obstacle()) return DropLine{held->target, below.obstacle_point};
  const double floor = std::min(renderer_.floor(), held->target.y);
  return DropLine{held->target, {held->target.x, floor, held->target.z}};
}

ClothPlace Viewer::place_of(const Pick& hit) const {
  return cloth_place(world_, names_, session_->state().positions, hit.face, hit.barycentric);
}

/// Where the hand is in depth: before or behind which body, as the eye sees it.
std::string Viewer::depth_text() const {
  const Handle* held = drag_.find(drag_.active());
  if (!held) return {};

  // Without a body behind or before the hand there is the distance alone.
  const Vec3d eye = camera_.eye();
  const double away = norm(held->target - eye);
  const Pick seen =
      pick(world_, session_->state().positions, {eye, (1 / away) * (held->target - eye)});
  char text[120];
  if (!seen.hit_obstacle()) {
    std::snprintf(text, sizeof text, "hand %.2f m away", away);
    return text;
  }

  // The body is named as the scene names it.
  const double behind = away - seen.obstacle_distance;
  std::snprintf(text, sizeof text, "hand %.1f cm %s ", 100 * std::fabs(behind),
                behind > 0 ? "behind" : "in front of");
  const Index vertex = world_.face[static_cast<std::size_t>(seen.obstacle_face)][0];
  const Index object = world_.object[static_cast<std::size_t>(vertex)];
  return text + world_.objects[static_cast<std::size_t>(object)].name;
}

/// The held point of the cloth, where it is now.
Vec3d Viewer::hit_point(const Handle& handle) const {
  const auto& positions = session_->state().positions;
  const Triangle& face = world_.face[static_cast<std::size_t>(handle.face)];
  const double weights[] = {handle.barycentric.x, handle.barycentric.y, handle.barycentric.z};
  Vec3d point{};
  for (std::size_t k = 0; k < 3; ++k) {
    point += weights[k] * convert<double>(positions[static_cast<std::size_t>(face[k])]);
  }
  return point;
}

/// The faces to show in red: those that cross at the start, or those around the offending elements.
std::vector<Index> Viewer::failing_faces() const {
  std::vector<Index> faces;
  if (!session_->state().failed) return faces;
  for (const IntersectingFaces& pair : start_intersections_) {
    faces.push_back(pair.a);
    faces.push_back(pair.b);
  }

  // Those around an element hold all of its vertices.
  const auto around = faces_of_pairs(world_.face, session_->state().report.offending);
  faces.insert(faces.end(), around.begin(), around.end());

  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

void Viewer::tell(const std::string& note) {
  note_ = note;
  note_is_bad_ = false;
  note_end_ = window_.seconds() + kNoteSeconds;
}

void Viewer::complain(const std::string& note) {
  tell(note);
  note_is_bad_ = true;
}

/// The texts of the status bar.
StatusTexts Viewer::status_texts() const {
  StatusTexts texts;
  texts.device = std::string(build_name(build_));
  if (build_ != Build::cuda32) {
    texts.device += threads_ == 1 ? ", 1 thread" : ", " + std::to_string(threads_) + " threads";
  }
  texts.upload_path = renderer_.upload_path();
  texts.ui_fps = static_cast<double>(frame_times_.size());
  if (window_.seconds() < note_end_) texts.note = note_;
  texts.note_is_bad = note_is_bad_;
  texts.pointer = depth_text();
  if (hover_ && texts.pointer.empty() && state_.view == ViewMode::strain)
    texts.pointer = place_of(*hover_).text();
  return texts;
}

/// A point of the cloth that is in view and that nothing hides, for tests. Of some faces it is the
/// lowest one, because hanging ends follow a hand best.
std::optional<Vec3d> Viewer::graspable_point() const {
  const auto& positions = session_->state().positions;
  const int width = static_cast<int>(view_.width), height = static_cast<int>(view_.height);
  std::optional<Vec3d> best;

  // A sample of faces is enough. Those above the best one so far need no test.
  for (Index k = 0; k < kGraspSamples; ++k) {
    const auto f =
        static_cast<std::size_t>(static_cast<std::int64_t>(k) * world_.cloth_faces / kGraspSamples);
    Vec3d centre{};
    for (const Index v : world_.face[f]) {
      centre += (1.0 / 3) * convert<double>(positions[static_cast<std::size_t>(v)]);
    }

    if (best && centre.y >= best->y) continue;

    // The centre has to be in view and to be the first hit of its ray.
    const Projected at = camera_.project(centre, width, height);
    if (at.depth <= 0 || !in_view(view_.x + at.x, view_.y + at.y)) continue;
    const Pick under = pick_at(view_.x + at.x, view_.y + at.y);
    if (!under.reachable() || norm(under.point - centre) > 0.02) continue;

    // The point has to be well inside, as the cloth may have swung a little by the time the mouse
    // gets there.
    constexpr double kMargin = 14;  // pixels
    bool inside = true;
    for (const auto& [dx, dy] :
         {std::pair{-kMargin, 0.0}, {kMargin, 0.0}, {0.0, -kMargin}, {0.0, kMargin}})
      inside = inside && pick_at(view_.x + at.x + dx, view_.y + at.y + dy).reachable();
    if (inside) best = centre;
  }
  return best;
}

TestStatus Viewer::test_status() const {
  const PublishedState& state = session_->state();

  // Numbers of the run, of the window and of the hands.
  TestStatus status;
  status.clock = window_.seconds();
  status.step = state.step;
  status.time = state.time;
  status.penetrations =
      state.report.impacts_left + static_cast<std::int64_t>(start_intersections_.size());
  status.max_speed = state.report.max_speed;
  status.ui_fps = static_cast<double>(frame_times_.size());
  status.steps_per_second = state.steps_per_second;
  status.handles = static_cast<int>(drag_.handles().size());
  for (const Handle& handle : drag_.handles()) status.parked += handle.parked;
  status.playing = state.playing;
  status.failed = state.failed;
  status.body_speed = edits_.values().bodies.speed;
  if (!garments_.empty()) status.garments = garment_text(total(garments_));
  status.notes = static_cast<int>(origin_.notes.size());
  status.panels = state_.panels;
  status.eye = camera_.eye();

  // Tests that drag the cloth need to know where it is on the screen.
  status.view = {view_.x, view_.y, view_.width, view_.height};
  const std::vector<Vec3d> points = cloth_points();
  for (const Vec3d p : points) status.mean += (1.0 / static_cast<double>(points.size())) * p;
  const std::optional<Vec3d> grasp = graspable_point();
  status.cloth_visible = grasp.has_value();
  const Projected at = camera_.project(grasp.value_or(status.mean), static_cast<int>(view_.width),
                                       static_cast<int>(view_.height));
  status.cloth_x = view_.x + at.x;
  status.cloth_y = view_.y + at.y;
  return status;
}

}  // namespace icloth
