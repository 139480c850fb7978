// The built program, run as a user runs it: exit codes, messages, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/app/cli/program.h"

namespace fs = std::filesystem;
using icloth::testing::Cli;
using icloth::testing::contains;
using icloth::testing::count_lines;
using icloth::testing::kDrop;
using icloth::testing::Outcome;
using icloth::testing::read;

namespace {

/// A front and a back, sewn at one side.
constexpr const char* kSack = R"({"pattern": {"panels": {
  "front": {"vertices": [[0, 0], [40, 0], [40, 60], [0, 60]], "edges": [{"endpoints": [0, 1]},
    {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]},
  "back": {"vertices": [[0, 0], [40, 0], [40, 50], [0, 50]], "edges": [{"endpoints": [0, 1]},
    {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}},
  "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}]]}})";

constexpr const char* kTwoTriangles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kCrossing =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.3 1\n";

}  // namespace

TEST_F(Cli, HelpAndVersionArePrinted) {
  EXPECT_EQ(icloth("--help").code, 0);
  EXPECT_TRUE(contains(icloth("--help").out, "check"));
  EXPECT_EQ(icloth("run --help").code, 0);
  const Outcome version = icloth("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(version.out.starts_with("icloth ")) << version.out;
}

TEST_F(Cli, BadUsageIsRefusedInOneLine) {
  expect_bad_input("rnu", "'run'");
  expect_bad_input("run", "SCENE");
  expect_bad_input("run scarf --nonsense", "--nonsense");
  expect_bad_input("run scarf --steps -1", "--steps");
  expect_bad_input("run scarf --steps many", "--steps");
  expect_bad_input("run scarf --steps 3 --time 1", "--");
  expect_bad_input("run scarf --time nan", "--time");
  expect_bad_input("run scarf --threads 0", "--threads");
  expect_bad_input("run scarf --device gpu", "cuda:N");
  expect_bad_input("run scarf --precision f16", "f16");
  expect_bad_input("run scarf --device cuda --precision f64", "cpu");
  expect_bad_input("run scarf --on-failure panic", "panic");
  expect_bad_input("run scarf --export obj", "--out");
  expect_bad_input("run scarf --export fbx --out frames", "fbx");
  expect_bad_input("run scarf --every 0 --out frames", "--every");
  expect_bad_input("export", "SPOOL");
  expect_bad_input("export a --format fbx", "fbx");
  expect_bad_input("export a b --out c", "2 spools");
  expect_bad_input("export a --format pc2", "--format pc2");
  expect_bad_input("check", "MESH");
  expect_bad_input("pattern", "FILE");
  expect_bad_input("bench fast", "quick");
  expect_bad_input("bench --threads x", "--threads");
}

TEST_F(Cli, AScenesFilesOutsideItsFolderNeedLeave) {
  fs::create_directory(folder_ / "sub");
  write("t.obj", kTwoTriangles);
  write("sub/a.json", R"({"cloths": [{"mesh": "../t.obj", "pins": [0]}]})");
  expect_bad_input("run sub/a.json --steps 1", "sub/a.json: cloths[0].mesh: value '../t.obj'");
  expect_bad_input("render sub/a.json --steps 1", "--allow-outside");
  expect_bad_input("run sub/a.json --dump-config", "--allow-outside");
  EXPECT_EQ(icloth("run sub/a.json --steps 1 --allow-outside --record r.json").code, 0);
  expect_bad_input("replay r.json", "--allow-outside");
  EXPECT_EQ(icloth("replay r.json --allow-outside").code, 0);
  EXPECT_EQ(icloth("run t.obj --steps 1").code, 0);
}

TEST_F(Cli, BadParametersAreRefusedInOneLine) {
  expect_bad_input("run scarf --set time_step=0", "step.time_step");
  expect_bad_input("run scarf --set time_step", "time_step");
  expect_bad_input("run scarf --set proximity.thicknes=0.001", "'proximity.thickness'");
  expect_bad_input("run scarf --set impact_zones.rho=1", "impact_zones.rho");
  expect_bad_input("run scarf --set mu=", "impact_zones.penalty");
}

TEST_F(Cli, BadFilesAreRefusedInOneLine) {
  write("broken.json", "{ \"cloths\": [");
  write("unknown.json", "{ \"cloth\": [] }");
  write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 x 0\nf 1 2 3\n");
  write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  write("empty.obj", "");
  expect_bad_input("run nosuch.json", "nosuch.json");
  expect_bad_input("run broken.json", "broken.json");
  expect_bad_input("run unknown.json", "'cloths'");
  expect_bad_input("run broken.obj", "broken.obj");
  expect_bad_input("run .", "");
  expect_bad_input("export nosuch", "nosuch");
  expect_bad_input("export .", "objects.csv");
  expect_bad_input("check nosuch.obj", "nosuch.obj");
  expect_bad_input("check broken.obj", "broken.obj");
  expect_bad_input("check range.obj", "4");
  expect_bad_input("check empty.obj", "empty.obj");
  expect_bad_input("pattern nosuch.json", "nosuch.json");
  expect_bad_input("pattern unknown.json", "'pattern'");
  expect_bad_input("replay nosuch.json", "nosuch.json");
  expect_bad_input("replay unknown.json", "icloth_recording");
  expect_bad_input("run scarf --input unknown.json", "icloth_recording");
  expect_bad_input("run scarf --stats steps.txt", ".csv");
  expect_bad_input("run scarf --stats no/such/steps.csv", "no/such");
  expect_bad_input("run scarf --record no/such/run.json", "no/such");
  expect_bad_input("ccd nosuch.csv", "nosuch.csv");
}

TEST_F(Cli, AMissingDisplayOrDeviceIsSaidInOneLine) {
  for (const char* arguments : {"", "view", "view scarf", "scarf"}) {
    const Outcome window = icloth(arguments, "-u DISPLAY -u WAYLAND_DISPLAY");
    EXPECT_EQ(window.code, 3) << arguments << window.err;
    EXPECT_EQ(count_lines(window.err), 1u) << window.err;
  }
  write("drop.json", kDrop);
  for (const char* verb : {"run drop.json", "bench"}) {
    for (const char* device : {"cuda", "cuda:0", "cuda:99"}) {
      const Outcome cuda =
          icloth(std::string(verb) + " --device " + device, "CUDA_VISIBLE_DEVICES=");
      EXPECT_EQ(cuda.code, 3) << cuda.err;
      EXPECT_EQ(count_lines(cuda.err), 1u) << cuda.err;
      EXPECT_TRUE(contains(cuda.err, std::string("--device ") + device + ": no device: "))
          << cuda.err;
      EXPECT_EQ(cuda.out, "");
    }
  }
  EXPECT_EQ(icloth("run drop.json --steps 1", "CUDA_VISIBLE_DEVICES=").code, 0);
}

TEST_F(Cli, CheckFindsWhatCrosses) {
  write("one.obj", kTwoTriangles);
  write("both.obj", std::string(kCrossing) + "g left\nf 1 2 3\ng right\nf 4 5 6\n");
  write("body.obj", std::string(kCrossing) + "g obstacle:a\nf 1 2 3\ng obstacle:b\nf 4 5 6\n");
  write("other.obj", "v 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.3 1\nf 1 2 3\n");
  EXPECT_EQ(icloth("check one.obj").code, 0);
  const Outcome self = icloth("check both.obj");
  EXPECT_EQ(self.code, 1);
  EXPECT_TRUE(contains(self.out, "left face 0 — ")) << self.out;
  EXPECT_TRUE(contains(self.out, "right face 0")) << self.out;
  EXPECT_TRUE(contains(self.out, "intersecting pairs 1")) << self.out;
  EXPECT_EQ(icloth("check body.obj").code, 0);
  const Outcome inter = icloth("check one.obj other.obj");
  EXPECT_EQ(inter.code, 1);
  EXPECT_TRUE(contains(inter.out, "one.obj")) << inter.out;
  EXPECT_TRUE(contains(inter.out, "other.obj")) << inter.out;
}

TEST_F(Cli, PatternPrintsPanelsAndStitchesAndDrawsThem) {
  write("sack.json", kSack);
  const Outcome outcome = icloth("pattern sack.json --svg sack.svg");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "stitch 0 (front:1 – back:3)")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "panels 2, edges 8, stitches 1, gathers 1")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "note: sack.json: units_in_meter is missing")) << outcome.out;
  const std::string svg = read(folder_ / "sack.svg");
  EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n")) << svg;
  EXPECT_TRUE(contains(svg, ">front<") && contains(svg, ">s0<")) << svg;
  expect_bad_input("pattern sack.json --svg no/such/sack.svg", "no/such");
}

TEST_F(Cli, DumpConfigShowsWhatIsInForce) {
  const Outcome outcome = icloth("run sphere --set mu=512 --set wind.x=3 --dump-config");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["impact_zones.penalty"], 512);
  EXPECT_EQ(json["wind.x"], 3);
  EXPECT_EQ(json["step.time_step"], 0.005);  // the scene's own

  // Every command that simulates prints the same, and needs no display for it.
  for (const std::string command : {"view", "render"})
    EXPECT_EQ(icloth(command + " sphere --set mu=512 --set wind.x=3 --dump-config").out,
              outcome.out)
        << command;
}

TEST_F(Cli, RunExportsFramesAndStatistics) {
  write("drop.json", kDrop);
  const Outcome run = icloth(
      "run drop.json --device cpu --steps 10 --out frames --export obj --every 5 --stats s.csv");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "penetrations left")) << run.out;
  EXPECT_EQ(run.err, "");  // no progress line: this is no terminal
  for (const char* name : {"frame_00000.obj", "frame_00001.obj", "frame_00002.obj"})
    EXPECT_TRUE(fs::exists(folder_ / "frames" / name)) << name;
  EXPECT_FALSE(fs::exists(folder_ / "frames" / "frame_00003.obj"));
  const std::string frame = read(folder_ / "frames" / "frame_00002.obj");
  EXPECT_TRUE(contains(frame, "g cloth:sheet") && contains(frame, "g obstacle:ball"));
  EXPECT_EQ(icloth("check frames/frame_00002.obj").code, 0);
  const std::string csv = read(folder_ / "s.csv");
  EXPECT_TRUE(csv.starts_with("step,time,dt,substeps,retries,ms_total,")) << csv.substr(0, 80);
  EXPECT_EQ(count_lines(csv), 11u);
  ASSERT_EQ(icloth("run drop.json --device cpu --steps 4 --stats s.json --quiet").code, 0);
  const auto json = nlohmann::json::parse(read(folder_ / "s.json"));
  ASSERT_EQ(json.size(), 4u);
  EXPECT_EQ(json[3]["impacts_left"], 0);
  EXPECT_EQ(json[3]["state_hash"].get<std::string>().size(), 16u);
}

TEST_F(Cli, TheLastStateIsExportedAndEveryFrameSaysItsTime) {
  write("drop.json", kDrop);
  ASSERT_EQ(icloth("run drop.json --device cpu --steps 25 --out f --export obj --every 10").code,
            0);
  EXPECT_EQ(read(folder_ / "f" / "frames.csv"),
            "frame,step,time\n0,0,0\n1,10,0.1\n2,20,0.2\n3,25,0.25\n");
  const std::string last = read(folder_ / "f" / "frame_00003.obj");
  EXPECT_TRUE(last.starts_with("# step 25, time 0.25 s\n")) << last.substr(0, 60);
  EXPECT_EQ(read(folder_ / "f" / "last.obj"), last);
  ASSERT_EQ(icloth("run drop.json --device cpu --steps 0 --out g --export obj").code, 0);
  EXPECT_EQ(read(folder_ / "g" / "last.obj"), read(folder_ / "g" / "frame_00000.obj"));
}

TEST_F(Cli, AFullDiskIsNoticedAndLeavesNoCutOffFile) {
  write("drop.json", kDrop);
  fs::create_symlink("/dev/full", folder_ / "full.csv");
  fs::create_symlink("/dev/full", folder_ / "full.json");
  fs::create_symlink("/dev/full", folder_ / "full.png");
  std::string query = "vf";
  for (int i = 0; i < 24; ++i) query.append(",").append(std::to_string(i % 5));
  write("queries.csv", query + "\n");
  const std::size_t before = files();
  for (const char* arguments : {
           "run scarf --dump-config > /dev/full",
           "run drop.json --device cpu --steps 1 > /dev/full",
           "info --keys > /dev/full",
           "--help > /dev/full",
           "run drop.json --device cpu --quiet --steps 2 --stats full.csv",
           "run drop.json --device cpu --quiet --steps 2 --stats full.json",
           "run drop.json --device cpu --quiet --steps 2 --record full.json",
           "ccd queries.csv --pred full.csv",
       }) {
    const Outcome outcome = icloth(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1u) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "cannot be written (No space left")) << outcome.err;
    EXPECT_EQ(files(), before) << arguments;
  }
  const Outcome picture = icloth("render drop.json --device cpu --quiet --steps 0 --out full.png");
  if (picture.code != 3) {
    EXPECT_EQ(picture.code, 2) << picture.err;
    EXPECT_TRUE(contains(picture.err, "full.png: cannot be written (No space left")) << picture.err;
  }
}

TEST_F(Cli, FramesThatNoLongerFitEndTheRun) {
  write("drop.json", kDrop);
  write("limited.sh", "ulimit -f 4\nexec \"$@\"\n");  // in KiB
  const std::string command = "cd '" + folder_.string() +
                              "' && bash limited.sh '" ICLOTH_PROGRAM
                              "' run drop.json --device cpu --quiet --steps 2 --out f --export obj"
                              " 2> err.txt";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  const std::string message = read(folder_ / "err.txt");
  EXPECT_TRUE(contains(message, "f/frame_00000.obj: cannot be written (File too large)"))
      << message;
  EXPECT_EQ(count_lines(message), 1u) << message;

  // Nothing is there but the list, which has no frame.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "f"), {}), 1);
  EXPECT_EQ(read(folder_ / "f" / "frames.csv"), "frame,step,time\n");
}

TEST_F(Cli, NotesAboutAMeshAreToldOnce) {
  write("sheet.obj",
        "v 0 0 0\nv 50 0 0\nv 50 50 0\nv 9 9 9\nv 0 50 0\nv 50 0 0\nv 90 0 0\nv 50 50 0\n"
        "f 1 2 3 5\nf 6 7 8\n");
  const Outcome run = icloth("run sheet.obj --device cpu --steps 1 --out f --export obj");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(count_lines(run.err), 3u) << run.err;
  EXPECT_TRUE(contains(run.err, "icloth: note: cloth 'sheet': 1 of 8 vertices belong to no face"));
  EXPECT_TRUE(contains(run.err, "2 of 8 vertices lie at the same place")) << run.err;
  EXPECT_TRUE(contains(run.err, "is 90 m large")) << run.err;
  const std::string last = read(folder_ / "f" / "last.obj");
  EXPECT_TRUE(contains(last, "\nv 9 9 9\n")) << last;
  EXPECT_TRUE(contains(last, "\nf 6 7 8\n")) << last;
  const Outcome check = icloth("check f/last.obj");
  EXPECT_EQ(check.code, 0) << check.out;
  EXPECT_TRUE(contains(check.out, "(taken as one) 2\n")) << check.out;
  EXPECT_EQ(icloth("run sheet.obj --device cpu --steps 1 --quiet").err, "");
}

TEST_F(Cli, DurationAndTimeGiveTheSteps) {
  write("drop.json", kDrop);
  EXPECT_EQ(icloth("run drop.json --device cpu --quiet --stats a.csv").code, 0);
  EXPECT_EQ(count_lines(read(folder_ / "a.csv")), 1u + 20);
  EXPECT_EQ(icloth("run drop.json --device cpu --quiet --time 0.05 --stats b.csv").code, 0);
  EXPECT_EQ(count_lines(read(folder_ / "b.csv")), 1u + 5);
}

TEST_F(Cli, RecordingReplaysOnAnyNumberOfThreads) {
  write("drop.json", kDrop);
  ASSERT_EQ(icloth("run drop.json --device cpu --threads 2 --steps 12 --record r.json").code, 0);
  for (const char* threads : {"1", "2"}) {
    const Outcome replay = icloth(std::string("replay r.json --threads ") + threads);
    EXPECT_EQ(replay.code, 0) << replay.err;
    EXPECT_TRUE(contains(replay.out, "as recorded")) << replay.out;
  }
  EXPECT_EQ(icloth("run drop.json --device cpu --input r.json --quiet").code, 0);
  std::string text = read(folder_ / "r.json");
  const std::size_t hash = text.find("final_hash") + 14;
  text[hash] = text[hash] == '0' ? '1' : '0';
  write("r.json", text);
  const Outcome changed = icloth("replay r.json");
  EXPECT_EQ(changed.code, 1);
  EXPECT_TRUE(contains(changed.err, "recorded was")) << changed.err;
}

TEST_F(Cli, PresetAndRepairStayWhereMoreIsSet) {
  write("drop.json", kDrop);
  const std::string command =
      "run drop.json --device cpu --quiet --steps 1 --set implicit.cg_tolerance=0.03"
      " --repair-start --preset fast ";
  ASSERT_EQ(icloth(command + "--record r.json").code, 0);
  const std::string recorded = read(folder_ / "r.json");
  for (const char* word : {"\"preset=fast\"", "\"repair_start=on\"", "cg_tolerance=0.03"})
    EXPECT_TRUE(contains(recorded, word)) << recorded;
  const auto config = nlohmann::json::parse(icloth(command + "--dump-config").out);
  EXPECT_EQ(config["implicit.cg_tolerance"], 0.03) << "a value that is set wins over the preset's";
  const auto fast = nlohmann::json::parse(icloth("run drop.json --preset fast --dump-config").out);
  EXPECT_EQ(config["step.time_step"], fast["step.time_step"]);
  const Outcome unknown = icloth("run drop.json --preset slow");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_TRUE(contains(unknown.err, "fast, normal, accurate")) << unknown.err;
}

TEST_F(Cli, BadStartIsRefusedWithItsPairs) {
  std::string scene = kDrop;
  scene.replace(scene.find("0.11"), 4, "0.05");
  write("inside.json", scene);
  const Outcome run = icloth("run inside.json --device cpu --out frames --stats s.csv");
  EXPECT_EQ(run.code, 1);
  EXPECT_TRUE(contains(run.err, "cloth:sheet face ")) << run.err;
  EXPECT_TRUE(contains(run.err, " — obstacle:ball face ")) << run.err;
  EXPECT_FALSE(fs::exists(folder_ / "frames"));
}

TEST_F(Cli, LayersTooCloseForSinglePrecisionAreRefusedAtTheStart) {
  // Two sheets 0.1 µm above each other, corner over corner: apart for the exact check, too close
  // for the collision test in single precision.
  const std::string sheet =
      R"("mesh": {"grid": {"size": [0.3, 0.3], "orientation": "horizontal"}}, "triangles": 72)";
  write("close.json", R"({"name": "close", "time_step": 0.01, "duration": 0.02, "cloths": [)"
                      R"({"name": "a", )" +
                          sheet + R"(}, {"name": "b", )" + sheet +
                          R"(, "transform": {"translate": [0, 1e-7, 0]}}]})");
  const Outcome single = icloth("run close.json --device cpu --quiet");
  EXPECT_EQ(single.code, 1) << single.err;
  EXPECT_TRUE(contains(single.err, "scene 'close' starts with ")) << single.err;
  EXPECT_TRUE(contains(single.err, "--precision f64")) << single.err;
  EXPECT_FALSE(contains(single.err, "step 0")) << single.err;
  const Outcome twice = icloth("run close.json --device cpu --quiet --precision f64");
  EXPECT_EQ(twice.code, 0) << twice.err;

  // Where rounding makes them touch, the start check itself says so.
  write("touch.json", R"({"name": "touch", "time_step": 0.01, "duration": 0.02, "cloths": [)"
                      R"({"name": "a", )" +
                          sheet +
                          R"(, "transform": {"translate": [0, 1, 0]}}, )"
                          R"({"name": "b", )" +
                          sheet + R"(, "transform": {"translate": [0.01, 1.00000001, 0.02]}}]})");
  const Outcome touching = icloth("run touch.json --device cpu --quiet");
  EXPECT_EQ(touching.code, 1) << touching.err;
  EXPECT_TRUE(contains(touching.err, "pairs of faces that intersect")) << touching.err;
  EXPECT_TRUE(contains(touching.err, "--precision f64")) << touching.err;
}

TEST_F(Cli, PenetrationsLeftAreAFailure) {
  write("drop.json", kDrop);
  const Outcome run = icloth(
      "run drop.json --device cpu --set impact_zones.enabled=off --set proximity.enabled=off "
      "--on-failure continue");
  EXPECT_EQ(run.code, 1) << run.out << run.err;
}

TEST_F(Cli, StatesOnTheWayAreCheckedWhereAsked) {
  write("drop.json", kDrop);
  const Outcome clean = icloth("run drop.json --device cpu --steps 7 --check-every 3");
  EXPECT_EQ(clean.code, 0) << clean.err;
  EXPECT_TRUE(contains(clean.out, " 2   of them with penetrations: 0\n")) << clean.out;

  // A ball that is moved through a sheet of pins intersects it on the way and not at the end.
  write("through.json", R"({"name": "Through", "time_step": 0.01, "duration": 0.6,
    "cloths": [ { "name": "sheet", "mesh": { "grid": { "size": [0.2, 0.2] } }, "triangles": 200,
                  "pins": [ { "box": [ [-1, -1, -1], [1, 1, 1] ] } ] } ],
    "obstacles": [ { "name": "ball", "mesh": { "sphere": { "radius": 0.03, "triangles": 100 } },
                     "motion": [ { "time": 0, "translate": [0.013, 0.017, -0.2] },
                                 { "time": 0.5, "translate": [0.013, 0.017, 0.2] } ] } ] })");
  const Outcome through =
      icloth("run through.json --device cpu --on-failure continue --check-every 1");
  EXPECT_EQ(through.code, 1);
  EXPECT_TRUE(contains(through.err, "icloth: after step ")) << through.err;
  EXPECT_TRUE(contains(through.err, " pairs of faces intersect\n")) << through.err;
  expect_bad_input("run drop.json --check-every 0", "--check-every");
}

TEST_F(Cli, InfoNamesTheBuilds) {
  const Outcome info = icloth("info");
  EXPECT_EQ(info.code, 0) << info.err;
  for (const char* part : {"cpu32", "cpu64", "cuda32", "GB/s", "compiler"})
    EXPECT_TRUE(contains(info.out, part)) << info.out;
}

TEST_F(Cli, RenderSaysHowVerticesReachOpenGL) {
  write("drop.json", kDrop);
  const std::string render = "render drop.json --steps 5 --size 160x120 --quality draft ";
  const Outcome chosen = icloth(render + "--device cpu --out auto.png");
  if (chosen.code == 3) GTEST_SKIP() << chosen.err;
  ASSERT_EQ(chosen.code, 0) << chosen.err;
  EXPECT_TRUE(contains(chosen.out, "vertices by host copy (the solver runs on the CPU)\n"))
      << chosen.out;
  const Outcome host = icloth(render + "--device cpu --vertices host --out host.png");
  EXPECT_EQ(host.code, 0) << host.err;
  EXPECT_TRUE(contains(host.out, "vertices by host copy (asked for)\n")) << host.out;
  EXPECT_EQ(read(folder_ / "auto.png"), read(folder_ / "host.png"));
  const Outcome shared = icloth(render + "--device cpu --vertices interop --out none.png");
  EXPECT_EQ(shared.code, 3);
  EXPECT_EQ(shared.err, "icloth: --vertices interop: the solver runs on the CPU\n");
  EXPECT_FALSE(fs::exists(folder_ / "none.png"));
  expect_bad_input(render + "--vertices both", "both");
}

TEST_F(Cli, RenderDrawsTheSameByInteropAndByHost) {
  const std::string info = icloth("info").out;
  if (!contains(info, "CUDA-OpenGL interop")) {
    const std::size_t at = std::min(info.find("vertices "), info.size());
    GTEST_SKIP() << "no device: " << info.substr(at, info.find('\n', at) - at);
  }
  write("drop.json", kDrop);
  for (const char* way : {"interop", "host"}) {
    const Outcome cuda = icloth("render drop.json --steps 12 --size 160x120 --device cuda --out " +
                                std::string(way) + ".png --vertices " + way);
    EXPECT_EQ(cuda.code, 0) << cuda.err;
  }
  EXPECT_EQ(read(folder_ / "interop.png"), read(folder_ / "host.png"));
}
