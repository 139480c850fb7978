#include "app/cli/commands/render.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "app/cli/commands/golden_picture.h"
#include "app/common/camera_json.h"
#include "app/common/dressing_progress.h"
#include "app/common/element_names.h"
#include "app/common/headless.h"
#include "app/common/options.h"
#include "app/common/video_file.h"
#include "render/gl_context_egl.h"
#include "render/legend.h"
#include "render/renderer.h"
#include "sim/cuda_devices.h"
#include "sim/files/box.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {
namespace {

struct Size {
  int width = 0, height = 0;
};

/// Reads "WIDTHxHEIGHT", each from 16 to 16384 pixels.
Size parse_size(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  const bool cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
  const auto height = cross ? std::from_chars(width.ptr + 1, end, size.height) : width;

  if (!cross || height.ec != std::errc() || height.ptr != end ||
      !is_picture_size(size.width, size.height)) {
    throw InputError("--size " + excerpt(text) +
                     ": expected WIDTHxHEIGHT, both from 16 to 16384 pixels");
  }
  return size;
}

/// The quality that was asked for. Videos have too many frames for the best one.
Quality choose_quality(const std::string& name, bool video) {
  if (name.empty()) return video ? Quality::interactive : Quality::still;
  if (name == "draft") return Quality::draft;
  if (name == "interactive") return Quality::interactive;
  if (name == "still") return Quality::still;
  throw InputError("--quality " + name + ": expected draft, interactive or still");
}

/// The size that was asked for, else that of the golden picture.
Size choose_size(const RenderOptions& options, const std::optional<GoldenPicture>& golden) {
  if (!options.size.empty()) return parse_size(options.size);
  if (golden && golden->image) return {golden->image->width, golden->image->height};
  return {1280, 720};
}

/// The path by which vertices shall reach the GPU. Throws DeviceError when interop is demanded and
/// cannot be had; needs a current context.
VertexOptions choose_vertices(const RenderOptions& options, Build build) {
  if (options.vertices == "host") return {.on_device = false};
  if (options.vertices == "auto") return {};
  if (options.vertices != "interop")
    throw InputError("--vertices " + options.vertices + ": expected auto, interop or host");
  std::string reason = "the solver runs on the CPU";
  if (build != Build::cuda32 || !interop_works(cuda_device(), reason))
    throw DeviceError("--vertices interop: " + reason);
  return {};
}

bool is_video(const std::string& out) { return lower_extension(out) == ".mp4"; }

void check_out(const RenderOptions& options) {
  const std::string& out = options.out;
  if (!is_video(out) && lower_extension(out) != ".png")
    throw InputError("--out " + shown_path(out) + ": expected FILE.png or FILE.mp4");
  if (is_video(out) && !options.golden.empty())
    throw InputError("--compare: is for pictures, expected --out FILE.png");
  require_folder("--out", out);
}

/// Reads a camera from a JSON file.
Camera camera_from_file(const std::string& path) {
  constexpr std::uint64_t kMostBytes = 1 << 20;
  const auto pose = camera_from_json(read_file(path, kMostBytes));
  if (!pose) {
    throw InputError("--camera " + shown_path(path) +
                     ": no camera, expected an object with 'eye' and 'target' "
                     "of three numbers each");
  }
  return Camera(*pose);
}

/// A camera that sees the whole start state from the front, slightly from above.
Camera camera_on_everything(const World& world, double aspect) {
  Camera camera(CameraPose{"", {0.25, 0.22, 1}, {0, 0, 0}, {0, 1, 0}, 32});
  const Box box = box_around(world.position);
  camera.frame_box(box.low, box.high, aspect);
  return camera;
}

/// The camera that was asked for, else the first of the scene, else one that sees everything.
Camera choose_camera(const RenderOptions& options, const Scene& scene, const World& world,
                     double aspect) {
  if (options.camera.ends_with(".json")) return camera_from_file(options.camera);
  std::string names;
  for (const CameraPose& pose : scene.cameras) {
    if (options.camera.empty() || pose.name == options.camera) return Camera(pose);
    names += (names.empty() ? "" : ", ") + in_quotes(pose.name);
  }
  if (options.camera.empty()) return camera_on_everything(world, aspect);
  throw InputError("--camera " + excerpt(options.camera) + ": not in the scene, expected " +
                   (names.empty() ? "FILE.json" : names + " or FILE.json"));
}

/// The content of the picture: the last state that was reached.
struct Shown {
  std::vector<Vec3f> positions;
  std::unique_ptr<DevicePositions> on_device;  ///< the same on the solver's device, if it has one
  std::vector<HandleState> handles;
  std::vector<Index> marked_faces;
};

/// Marks the faces that intersect, or are too close, in a start state that cannot be simulated.
void mark_start_intersections(const Scene& scene, bool single_precision, const World& world,
                              const HeadlessResult& result, Shown& shown) {
  shown.positions.clear();
  for (const Vec3d p : world.position) shown.positions.push_back(convert<float>(p));
  for (const IntersectingFaces& pair : find_start_intersections(scene, single_precision)) {
    shown.marked_faces.push_back(pair.a);
    shown.marked_faces.push_back(pair.b);
  }
  const std::vector<Index> close = faces_of_pairs(world.face, result.start_contacts);
  shown.marked_faces.insert(shown.marked_faces.end(), close.begin(), close.end());
}

/// Draws states as the options ask for.
struct Painter {
  Renderer& renderer;
  const Camera& camera;
  Size size;
  ViewMode view;
  bool has_legend;

  Image draw(const Shown& shown) const {
    Frame frame;
    frame.positions = shown.positions;
    frame.on_device = shown.on_device.get();
    frame.handles = shown.handles;
    frame.marked_faces = shown.marked_faces;
    frame.view = view;
    Image image = renderer.picture(frame, camera, size.width, size.height);
    const std::optional<Legend> legend = legend_of(view, frame.strain_range);
    if (has_legend && legend) draw_legend(*legend, image);
    return image;
  }
};

/// A video of a run: each of its frames shows the first state at its time or after it.
class Film {
 public:
  Film(const RenderOptions& options, Size size)
      : file_(options.out, size.width, size.height, options.frames_per_second),
        per_second_(options.frames_per_second) {}

  /// Whether the state at this time is to be shown.
  bool wants(double time) const { return frames_due(time) > 0; }
  void add(const Image& picture, double time) {
    const int due = frames_due(time);
    file_.add(picture, due);
    frames_ += due;
  }

  /// Ends the video. Where the run failed, what is marked stays for a second.
  void finish(const Image& last, bool clean) {
    if (!clean) file_.add(last, per_second_);
    file_.finish();
  }

 private:
  /// The clock adds up steps, so that a frame may be met a little early.
  int frames_due(double time) const {
    return static_cast<int>(std::floor(time * per_second_ + 1e-6)) + 1 - frames_;
  }

  VideoFile file_;
  int per_second_, frames_ = 0;
};

}  // namespace

int run_render(const RenderOptions& options) {
  // Options are checked before anything takes time.
  const SimulationOptions& common = options.simulation;
  const Build build = choose_build(common);
  std::optional<GoldenPicture> golden;
  if (!options.golden.empty())
    golden = open_golden(options.golden, options.out, options.tolerance, options.update);
  const Size size = choose_size(options, golden);
  const ViewMode view = parse_view_mode(options.view);
  const bool video = is_video(options.out);
  const Quality quality = choose_quality(options.quality, video);
  check_out(options);

  // The scene, the camera and the renderer are made next, so that they fail before the long part.
  HeadlessJob job;
  job.scene = open_scene_showing(common.scene, scene_overrides(common), job.origin, common.quiet,
                                 scene_limits(common));
  const World world = make_world(*job.scene);
  const Camera camera =
      choose_camera(options, *job.scene, world, static_cast<double>(size.width) / size.height);
  const std::unique_ptr<GlContext> context =
      make_egl_context(build == Build::cuda32 ? cuda_device() : kNone);
  Renderer renderer(world, choose_vertices(options, build));
  renderer.set_quality(quality);

  // The length, the device and the outputs of the run.
  job.steps = step_count(common, *job.scene);
  job.build = build;
  job.quiet = common.quiet;
  set_thread_count(common.threads);
  StatisticsFile stats(options.stats_file);

  // The last accepted state is kept for the picture; a refused one adds its offending faces. A
  // video takes more of them.
  Shown shown;
  const Painter painter{renderer, camera, size, view, options.legend};
  std::optional<Film> film;
  if (video) film.emplace(options, size);
  job.interruptible = video;
  job.watch = [&](const Simulator& simulator, const StepReport* report, bool last) {
    if (report) stats.add(*report);
    if (report && !report->accepted)
      shown.marked_faces = faces_of_pairs(world.face, report->offending);
    const bool filmed = film && film->wants(simulator.time());
    if (!last && !filmed) return;
    simulator.positions_on_device(shown.on_device);
    simulator.positions(shown.positions);
    shown.handles = simulator.handles();
    if (filmed) film->add(painter.draw(shown), simulator.time());
  };

  const HeadlessResult result = run_headless(job);
  stats.finish(result.statistics);
  if (result.start_refused)
    mark_start_intersections(*job.scene, build != Build::cpu64, world, result, shown);

  // A picture without interop is no success when interop was demanded.
  const Image image = painter.draw(shown);
  if (options.vertices == "interop" && shown.on_device && !renderer.shares_vertices())
    throw DeviceError("--vertices interop: " + renderer.upload_path());
  if (film)
    film->finish(image, result.clean());
  else
    write_png(options.out, image);

  if (!common.quiet && !result.start_refused) {
    std::fputs(result.statistics.table(result.penetrations, result.state_hash).c_str(), stdout);
    std::printf("vertices by %s\n", renderer.upload_path().c_str());
  }
  if (!common.quiet) std::printf("%s\n", options.out.c_str());
  const bool good =
      !golden || check_golden(*golden, options.out, image, result.clean(), common.quiet);
  return good && result.clean() ? 0 : 1;
}

}  // namespace icloth
