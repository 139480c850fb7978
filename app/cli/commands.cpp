#include "app/cli/commands.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "app/cli/commands/bench.h"
#include "app/cli/commands/ccd.h"
#include "app/cli/commands/check.h"
#include "app/cli/commands/detect.h"
#include "app/cli/commands/export.h"
#include "app/cli/commands/info.h"
#include "app/cli/commands/pattern.h"
#include "app/cli/commands/render.h"
#include "app/cli/commands/replay.h"
#include "app/cli/commands/run.h"
#include "app/cli/commands/sew.h"
#include "app/cli/commands/view.h"
#include "app/common/command_options.h"
#include "app/common/frame_formats.h"
#include "app/common/machine.h"
#include "app/common/program.h"
#include "app/window/bindings.h"
#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/scene/scene_io.h"

namespace icloth {
namespace {

constexpr std::string_view kCommands[] = {"view", "run",    "render", "export",  "bench", "replay",
                                          "ccd",  "detect", "check",  "pattern", "sew",   "info"};

int print_keys() {
  std::fputs(bindings_markdown().c_str(), stdout);
  return 0;
}

/// The commands of the command line. The options of the chosen command live here until it has run.
struct Commands {
  CLI::App app{"icloth: interactive cloth simulation", "icloth"};
  std::function<int()> chosen;
  const SimulationOptions* simulation = nullptr;  ///< of the chosen command; null: it has none

  ViewOptions view;
  RunOptions run;
  RenderOptions render;
  ExportOptions exported;
  ReplayOptions replay;
  CheckOptions check;
  DetectOptions detect;
  PatternOptions pattern;
  SewOptions sew;
  std::string ccd_queries, ccd_predictions;
  bool list_keys = false;

  Commands();
  CLI::App* add_command(const char* name, const char* what, std::function<int()> action,
                        const SimulationOptions* options = nullptr);
  void add_view();
  void add_run();
  void add_render();
  void add_export();
  void add_bench();
  void add_replay();
  void add_ccd();
  void add_detect();
  void add_check();
  void add_pattern();
  void add_sew();
  void add_info();
};

/// Adds a command whose action is run when the whole line has been read. `options` are those that
/// add_simulation_options fills, where the command has them.
CLI::App* Commands::add_command(const char* name, const char* what, std::function<int()> action,
                                const SimulationOptions* options) {
  CLI::App* command = app.add_subcommand(name, what);
  command->callback([this, action = std::move(action), options] {
    chosen = action;
    simulation = options;
  });
  return command;
}

void Commands::add_view() {
  // Without a display the user learns of the commands that need none.
  const auto action = [this] {
#if defined(ICLOTH_HAS_WINDOW)
    view.choose = view.choose && app.get_subcommand("view")->count("SCENE") == 0;
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
      throw DeviceError("there is no display; without one use 'icloth run' or 'icloth render'");
    return run_view(view);
#else
    throw DeviceError("this program was built without the window (GLFW, Dear ImGui, OpenGL)");
    return 3;
#endif
  };
  CLI::App* command = add_command("view", "the window", action, &view.simulation);
  add_simulation_options(*command, view.simulation, false);
  command->add_flag("--choose", view.choose, "ask for a scene where none is named");

  // The window writes files, and the user chooses how it draws and starts.
  command->add_option("--record", view.record_file, "save the session as a recording at the end");
  command->add_option("--screenshots", view.screenshot_folder, "folder that F12 writes to");
  command
      ->add_option("--vertices", view.vertices,
                   "how they reach OpenGL: auto (on the GPU where that works) or host")
      ->check(CLI::IsMember({"auto", "host"}))
      ->capture_default_str();
  command->add_flag("!--paused", view.play, "start paused");
  command->add_flag("--script", view.play_script, "apply the scene's scripted grabs as well");
}

void Commands::add_run() {
  CLI::App* command = add_command(
      "run", "headless simulation", [this] { return run_run(run); }, &run.simulation);

  // The length of the run and its scene are common to all commands that simulate.
  add_simulation_options(*command, run.simulation, true);

  // The remaining options are outputs, inputs, and what to do after a refused step.
  command->add_option("--out", run.out, "folder of exported frames");
  command
      ->add_option("--export", run.exports,
                   "format of the frames: obj, ply, pc2, mdd or usda; repeatable")
      ->check(CLI::IsMember(kFrameFormats))
      ->allow_extra_args(false);
  command->add_option("--every", run.every, "export each K-th step")
      ->check(CLI::Range(1L, 1000000L));
  command->add_option("--stats", run.stats_file, "statistics of every step, FILE.csv or FILE.json");
  command->add_option("--input", run.input_file, "recording whose drags are applied");
  command->add_option("--record", run.record_file, "save the run as a recording");
  command->add_option("--checkpoint", run.checkpoint_file,
                      "save the state here now and then, and at the end");
  command->add_option("--checkpoint-every", run.checkpoint_every, "at each K-th step")
      ->check(CLI::Range(1L, 1000000L))
      ->capture_default_str();
  command
      ->add_option("--check-every", run.check_every,
                   "test each K-th state for faces that intersect, exactly")
      ->check(CLI::Range(1L, 1000000L));
  command->add_option("--garments", run.garments_file,
                      "strain of the garments, and how far they slide, FILE.csv");
  command->add_option("--resume", run.resume_file, "go on from this checkpoint")
      ->excludes("--garments");
  command->add_flag("--profile", run.profile, "print the time of every primitive; slower on CUDA");
  command
      ->add_option("--on-failure", run.on_failure,
                   "stop at a refused step, or continue with the clock going on over it")
      ->check(CLI::IsMember({"stop", "continue"}));
}

void Commands::add_render() {
  // A program without the renderer still has the command, which says why it cannot draw.
  const auto action = [this] {
#if defined(ICLOTH_HAS_RENDER)
    return run_render(render);
#else
    throw DeviceError("this program was built without the renderer (OpenGL, EGL, glad)");
    return 3;
#endif
  };
  CLI::App* command =
      add_command("render", "headless pictures and videos", action, &render.simulation);

  // The scene, the device and the length of the run before the picture.
  add_simulation_options(*command, render.simulation, true);

  // These options say where the picture goes, what it shows and how well.
  command->add_option("--out", render.out, "FILE.png, or FILE.mp4 for a video of the whole run")
      ->capture_default_str();
  command
      ->add_option("--fps", render.frames_per_second,
                   "frames per second of a video, which plays at the speed of the simulation")
      ->check(CLI::Range(1, 240))
      ->capture_default_str();
  command->add_option("--size", render.size,
                      "WIDTHxHEIGHT; default: 1280x720, or that of --compare");
  command->add_option("--camera", render.camera, "camera of the scene, or FILE.json");
  command->add_option("--view", render.view, "shaded, wireframe or strain")->capture_default_str();
  command->add_flag("!--no-legend", render.legend, "leave out what the colours of a view mean");
  command->add_option("--quality", render.quality,
                      "draft, interactive or still; default: still, for videos interactive");

  command
      ->add_option("--vertices", render.vertices,
                   "how they reach OpenGL: auto, interop (on the GPU, or fail) or host")
      ->check(CLI::IsMember({"auto", "interop", "host"}))
      ->capture_default_str();
  command->add_option("--stats", render.stats_file, "statistics of every step, FILE.csv or .json");

  // A picture can be held against the one that it was before.
  CLI::Option* compare = command->add_option(
      "--compare", render.golden,
      "GOLDEN.png: exit 1 where the picture differs, with difference and page beside --out");
  command->add_flag("--update", render.update, "write GOLDEN.png anew instead")->needs(compare);
  command->add_option("--tolerance", render.tolerance, "of --compare: exact, software or device")
      ->needs(compare)
      ->capture_default_str();
}

void Commands::add_export() {
  CLI::App* command =
      add_command("export", "formats of a run that was cut off, from its point caches",
                  [this] { return run_export(exported); });
  command->add_option("SPOOL", exported.spools, "folders of runs that export pc2, mdd or usda")
      ->required();
  command
      ->add_option("--format", exported.formats,
                   "obj, ply, pc2, mdd or usda; repeatable; default: mdd and usda")
      ->check(CLI::IsMember(kFrameFormats))
      ->allow_extra_args(false);
  command->add_option("--out", exported.out, "folder of the results; default: that of the spool");
}

void Commands::add_replay() {
  CLI::App* command = add_command("replay", "run recorded input again and compare the final state",
                                  [this] { return run_replay(replay); });
  command->add_option("RECORDING", replay.recording, "file of --record or of a session")
      ->required();
  command->add_option("--threads", replay.threads, "threads of the CPU solver")
      ->check(CLI::Range(1, 4096));
  add_device_option(*command, replay.device);
  add_outside_option(*command, replay.allow_outside);
  command->add_option("--stats", replay.stats_file, "statistics of every step, FILE.csv or .json");
  command->add_flag("--quiet", replay.quiet, "print errors only");
}

/// For the list of --help alone: run_words passes the command on to the program of the suites.
void Commands::add_bench() {
  app.add_subcommand("bench", "benchmark suites and reports (icloth bench --help)");
}

void Commands::add_ccd() {
  CLI::App* command = add_command("ccd", "elementary CCD over a file of queries",
                                  [this] { return run_ccd(ccd_queries, ccd_predictions); });
  command->add_option("QUERIES", ccd_queries, "CSV, plain or .gz")->required();
  command->add_option("--pred", ccd_predictions, "write one line a query here: 0 or 1 TOI");
}

void Commands::add_detect() {
  CLI::App* command = add_command("detect", "all collisions between two frames of a mesh",
                                  [this] { return run_detect(detect); });
  command->add_option("T0", detect.start, "OBJ or PLY file of the start")->required();
  command->add_option("T1", detect.end, "the same mesh at the end")->required();
  command->add_option("--csv", detect.csv, "prefix of the lists: PREFIX_vf.csv, PREFIX_ee.csv");
  command->add_option("--threads", detect.threads, "threads")->check(CLI::Range(1, 4096));
}

void Commands::add_check() {
  CLI::App* command = add_command("check", "exact self- and inter-mesh intersection test",
                                  [this] { return run_check(check); });
  command->add_option("MESH", check.meshes, "OBJ or PLY files, tested as one")->required();
  command->add_option("--list", check.list, "pairs that are printed")->capture_default_str();
}

void Commands::add_sew() {
  CLI::App* command =
      add_command("sew", "sew a pattern and put it on a body", [this] { return run_sew(sew); });
  command
      ->add_option("PATTERN", sew.pattern,
                   "NAME_specification.json of GarmentCode; with --within, a mesh of panels")
      ->required();
  CLI::Option* within =
      command->add_option("--within", sew.within, "sew the borders of a mesh that are so near: 4mm")
          ->transform(CLI::AsNumberWithUnit(
              std::map<std::string, double>{{"m", 1}, {"cm", 0.01}, {"mm", 0.001}}))
          ->check(CLI::Range(1e-9, 1.0));
  command->add_option("--rest", sew.rest, "the same panels at rest, with --within")
      ->needs("--within");
  command->add_option("--body", sew.body, "mesh that the garment is put on");
  command->add_option("--triangles", sew.triangles, "wanted number")
      ->excludes(within)
      ->check(CLI::Range(2, 4000000))
      ->capture_default_str();
  command->add_option("--out", sew.out,
                      "OBJ of the garment, its uv the pattern in metres; with "
                      "--within also a .json scene with open seams");
  command->add_option("--material", sew.material, "name or file of the fabric")
      ->capture_default_str();

  // How it is put on, and what is told of that. A mesh of panels is sewn where it lies.
  command
      ->add_option("--hold", sew.hold,
                   "label of edges that keep their height until the garment settles")
      ->excludes(within);
  command->add_option("--settling", sew.settling, "time with weight, in seconds")
      ->excludes(within)
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command->add_option("--threads", sew.threads, "threads")->check(CLI::Range(1, 4096));
  command->add_flag("--report", sew.report, "print panels, stitches, and how dressing went");
  command->add_flag("!--no-dress", sew.dress, "write the garment as it is sewn")->excludes(within);
  command->add_flag("--quiet", sew.quiet, "print errors only");
}

void Commands::add_pattern() {
  CLI::App* command = add_command("pattern", "panels and stitches of a sewing pattern",
                                  [this] { return run_pattern(pattern); });
  command->add_option("FILE", pattern.file, "pattern of GarmentCode (.json) or DXF")->required();
  command->add_option("--svg", pattern.svg, "draw the panels with the numbers of their edges here");
}

void Commands::add_info() {
  CLI::App* command = add_command("info", "version, machine, builds, renderer",
                                  [this] { return list_keys ? print_keys() : run_info(); });
  command->add_flag("--keys", list_keys, "print docs/keys.md: the keys and what the mouse does");
}

Commands::Commands() {
  app.set_version_flag("--version", "icloth " + program_version());
  app.require_subcommand(1);
  app.footer("Without a command the scene is opened in a window: icloth [SCENE].");

  // The help lists them in this order.
  add_view();
  add_run();
  add_render();
  add_export();
  add_bench();
  add_replay();
  add_ccd();
  add_detect();
  add_check();
  add_pattern();
  add_sew();
  add_info();
}

/// Completes `icloth [view] [SCENE]`: puts the command in where it was left out.
void complete_command(std::vector<std::string>& words) {
  if (words.empty()) {
    words = {"view"};
    return;
  }
  const std::string& first = words.front();

  // A name that is no command is a scene. One that looks like neither is probably misspelt.
  if (first == "-h" || first == "--help" || first == "--version") return;
  if (std::ranges::find(kCommands, first) != std::end(kCommands)) return;
  const bool word = !first.starts_with("-") && first.find_first_of("./") == std::string::npos;
  const std::string scenes = asset_names("scenes") + " ";
  if (word && scenes.find(" " + first + " ") == std::string::npos &&
      !std::filesystem::exists(first))
    throw InputError(in_quotes(first) +
                     " is neither a command nor a scene, the nearest command is " +
                     in_quotes(nearest_name(first, kCommands)) + " (see icloth --help)");
  words.insert(words.begin(), "view");
}

/// Prints all parameters of the scene as the options leave them.
int dump_config(const SimulationOptions& options) {
  const auto scene = load_scene(options.scene, scene_overrides(options), scene_limits(options));
  std::printf("%s\n", dump_parameters(scene->parameters).c_str());
  return 0;
}

int run_words(std::vector<std::string> words) {
  if (!words.empty() && words.front() == "bench")
    return run_bench_program({words.begin() + 1, words.end()});

  Commands commands;
  complete_command(words);

  // CLI11 wants the words in reverse order; --help and --version end here.
  std::ranges::reverse(words);
  try {
    commands.app.parse(words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return commands.app.exit(error);
    throw InputError(first_line(error.what()) + " (see icloth --help)");
  }

  // Every command that simulates can print its parameters instead.
  if (commands.simulation && commands.simulation->dump_config)
    return dump_config(*commands.simulation);
  return commands.chosen();
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  return run_program([&] { return run_words({argv + 1, argv + argc}); });
}

}  // namespace icloth
