#include "app/cli/commands/render.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "app/common/camera_json.h"
#include "app/common/dressing_progress.h"
#include "app/common/element_names.h"
#include "app/common/headless.h"
#include "app/common/options.h"
#include "render/gl_context_egl.h"
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

  const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 16384; };
  if (!cross || height.ec != std::errc() || height.ptr != end || !fits(size.width) ||
      !fits(size.height)) {
    throw InputError("--size " + excerpt(text) +
                     ": expected WIDTHxHEIGHT, both from 16 to 16384 pixels");
  }
  return size;
}

Quality parse_quality(const std::string& name) {
  if (name == "draft") return Quality::draft;
  if (name == "interactive") return Quality::interactive;
  if (name == "still") return Quality::still;
  throw InputError("--quality " + name + ": expected draft, interactive or still");
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

void check_out(const std::string& out) {
  const std::filesystem::path path(out);
  if (path.extension() == ".mp4")
    throw InputError("--out " + shown_path(out) + ": videos are not supported, expected FILE.png");
  if (path.extension() != ".png")
    throw InputError("--out " + shown_path(out) + ": expected FILE.png");
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path()))
    throw InputError("--out " + shown_path(out) + ": there is no folder " +
                     in_quotes(path.parent_path().string()));
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

Image draw(Renderer& renderer, const Shown& shown, const Camera& camera, Size size, ViewMode view) {
  Frame frame;
  frame.positions = shown.positions;
  frame.on_device = shown.on_device.get();
  frame.handles = shown.handles;
  frame.marked_faces = shown.marked_faces;
  frame.view = view;
  return renderer.picture(frame, camera, size.width, size.height);
}

}  // namespace

int run_render(const RenderOptions& options) {
  // Options are checked before anything takes time.
  const SimulationOptions& common = options.simulation;
  const Build build = choose_build(common);
  const Size size = parse_size(options.size);
  const ViewMode view = parse_view_mode(options.view);
  const Quality quality = parse_quality(options.quality);
  check_out(options.out);

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

  // The last accepted state is kept for the picture; a refused one adds its offending faces.
  Shown shown;
  job.watch = [&](const Simulator& simulator, const StepReport* report, bool) {
    if (report) stats.add(*report);
    if (report && !report->accepted)
      shown.marked_faces = faces_of_pairs(world.face, report->offending);
    if (simulator.step_index() < job.steps && (!report || report->accepted)) return;
    simulator.positions_on_device(shown.on_device);
    simulator.positions(shown.positions);
    shown.handles = simulator.handles();
  };

  const HeadlessResult result = run_headless(job);
  stats.finish(result.statistics);
  if (result.start_refused)
    mark_start_intersections(*job.scene, build != Build::cpu64, world, result, shown);

  // A picture without interop is no success when interop was demanded.
  const Image image = draw(renderer, shown, camera, size, view);
  if (options.vertices == "interop" && shown.on_device && !renderer.shares_vertices())
    throw DeviceError("--vertices interop: " + renderer.upload_path());
  write_png(options.out, image);

  if (!common.quiet && !result.start_refused) {
    std::fputs(result.statistics.table(result.penetrations, result.state_hash).c_str(), stdout);
    std::printf("vertices by %s\n", renderer.upload_path().c_str());
  }
  if (!common.quiet) std::printf("%s\n", options.out.c_str());
  return result.clean() ? 0 : 1;
}

}  // namespace icloth
