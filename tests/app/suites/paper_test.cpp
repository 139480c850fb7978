// `icloth bench paper`: its table of stretches, its memory of finished measurements, and whole runs
// of one small scene.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <set>

#include "app/suites/bench/paper_figures.h"
#include "sim/scene/scene_io.h"
#include "tests/app/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace icloth::testing {
namespace {

using Json = nlohmann::ordered_json;

TEST(PaperStretches, HaveTwentyStepsAndTheirBaselinesFive) {
  std::set<std::string> names;
  for (const PaperScene& scene : paper_scenes()) {
    EXPECT_GE(scene.stretches.size(), 2u) << scene.name;
    for (const Stretch& stretch : scene.stretches) {
      EXPECT_GE(stretch.steps, 20) << scene.name;
      const auto modes = modes_of(scene, stretch);
      EXPECT_EQ(modes.back().name, kOwnMode);
      for (const PaperMode& mode : modes) {
        const bool baseline = mode.name == "pscc" || mode.name == "cama";
        EXPECT_GE(mode.steps, baseline ? 5 : 1) << mode.name;
        EXPECT_TRUE(names.insert(measurement_name(scene, stretch, mode.name)).second) << mode.name;
      }
    }
  }
}

TEST(PaperStretches, OfAQuickLookAreTheFirstOnes) {
  for (const PaperScene& scene : scenes_at(0.1)) {
    EXPECT_EQ(scene.stretches.size(), scene.is_garment() ? 1u : 2u) << scene.name;
    EXPECT_LT(scene.stretches.back().end(), 421) << scene.name;
  }
  EXPECT_EQ(scenes_at(1)[1].stretches.size(), 3u);
}

TEST(PaperStretches, OfGarmentsAreWhereTheirBodiesAreFastest) {
  for (const PaperScene& scene : paper_scenes()) {
    if (!scene.is_garment()) continue;
    const auto loaded =
        load_scene(std::string(scene.name), std::vector<std::string>{"triangles=1000"});
    ASSERT_EQ(loaded->parameters.step.time_step, 1.0 / scene.rate) << scene.name;
    const Obstacle& body = loaded->obstacles.at(0);
    ASSERT_NE(body.skinned(), nullptr);
    const double window = static_cast<double>(scene.stretches[0].steps) / scene.rate;
    const auto moments = fastest_moments(body, kBlendIn, body.skinned()->clip().duration, window,
                                         scene.stretches.size());
    ASSERT_EQ(moments.size(), scene.stretches.size());

    // The clip starts so early that the lead-in ends where the moment begins.
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const Stretch& stretch = scene.stretches[k];
      EXPECT_NEAR(stretch.clip_start + kFollowing, moments[k].begin, 1e-9) << scene.name << k;
      EXPECT_NEAR(static_cast<double>(stretch.first), (kBlendIn + kFollowing) * scene.rate, 1e-9);
    }
  }
}

TEST(PaperStore, KeepsResultsAndRefusesThoseOfAnotherKeyAndDamagedOnes) {
  const TemporaryFolder folder;
  {
    PaperStore store(folder.path(""), false);
    store.put("a", "key", {{"x", 0.1}});
    store.put("b", "key", {{"x", 2}});
  }
  {
    PaperStore store(folder.path(""), true);
    ASSERT_NE(store.find("a", "key"), nullptr);
    EXPECT_EQ(store.find("a", "key")->at("x"), 0.1);
    EXPECT_EQ(store.reused(), 1);
    EXPECT_EQ(store.find("b", "other key"), nullptr);
    EXPECT_EQ(store.find("b", "key"), nullptr) << "it is to be measured anew";
    EXPECT_EQ(store.notes().size(), 1u);
  }

  // One number is another now: only that entry is lost.
  std::string text = read(folder.path("progress.json"));
  text.replace(text.find("0.1"), 3, "0.2");
  folder.write("progress.json", text);
  {
    PaperStore store(folder.path(""), true);
    EXPECT_EQ(store.find("a", "key"), nullptr);
    EXPECT_NE(store.find("b", "key"), nullptr);
  }

  // Without going on, what is there is put aside.
  {
    PaperStore store(folder.path(""), false);
    EXPECT_EQ(store.find("b", "key"), nullptr);
    EXPECT_EQ(read(folder.path("progress.old.json")), text);
  }

  // Half a file, another file, and one of another version hold nothing.
  for (const std::string& bad :
       {text.substr(0, text.size() / 2), std::string("[1]"), std::string("{\"format\": 7}")}) {
    folder.write("progress.json", bad);
    PaperStore store(folder.path(""), true);
    EXPECT_EQ(store.find("b", "key"), nullptr);
    EXPECT_EQ(store.notes().size(), 1u) << bad;
  }
}

TEST(PaperRows, GoOnAndAreCutAtAStep) {
  StepReport report;
  report.ms_total = 2;
  PaperRows rows;
  for (int k = 0; k < 3; ++k) {
    report.state_hash = static_cast<std::uint64_t>(k);
    rows.add(report);
  }
  PaperRows more(rows.json());
  more.append(rows.json());
  EXPECT_EQ(more.size(), 6u);
  more.keep_first(4);
  EXPECT_EQ(more.size(), 4u);
  EXPECT_EQ(sum_of(more.json(), "ms_total"), 8);
  EXPECT_EQ(sum_of(more.json(), "ms_total", 3), 6);
  EXPECT_EQ(more.json().at("hash").at(3), hash_text(0));
}

/// The program on one scene with few triangles, in a folder of its own.
class PaperRunTest : public Cli {
 protected:
  static constexpr const char* kFunnel =
      "bench paper --scale 0.001 --case funnel --threads 1 --quiet --out here";
  static constexpr const char* kCommand =
      "bench paper --scale 0.001 --case sphere --threads 1 --quiet --out here";

  Json progress() const { return Json::parse(read(folder_ / "here/progress.json")); }

  /// Every hash of every measurement, by their names; times differ from run to run.
  std::map<std::string, Json> hashes() const {
    std::map<std::string, Json> found;
    const Json file = progress();
    for (const auto& [name, item] : file["measurements"].items())
      if (item["result"].contains("rows")) found[name] = item["result"]["rows"]["hash"];
    return found;
  }
};

TEST_F(PaperRunTest, WritesTheTablesWithFiniteNumbersFromEqualStartStates) {
  const Outcome outcome = icloth(kFunnel);
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const Json results = Json::parse(read(folder_ / "here/results.json"));
  for (const char* table : {"fig8_speed", "fig8_collisions", "stretches", "single_attempts",
                            "fig5_funnel", "fig10", "frames"}) {
    ASSERT_TRUE(results["tables"].contains(table)) << table;
    ASSERT_FALSE(results["tables"][table].empty()) << table;
    EXPECT_FALSE(read(folder_ / "here" / (std::string(table) + ".csv")).empty()) << table;
    for (const Json& row : results["tables"][table])
      for (const auto& [column, cell] : row.items())
        EXPECT_TRUE(cell != "nan" && cell != "inf" && cell != "-nan") << table << ": " << column;
  }
  const Json& speed = results["tables"]["fig8_speed"][0];
  for (const char* column : {"ours, whole run", "ours, worst stretch", "ours / PSCC-style"})
    EXPECT_GT(speed[column].get<double>(), 0) << column;
  EXPECT_EQ(speed["I-Cloth, GTX 1080"], 8.47);
  EXPECT_TRUE(contains(read(folder_ / "here/report.html"), "GeForce GTX 1080"));

  // All ways begin each stretch in one state, which is another one in each stretch.
  std::map<std::string, std::set<std::string>> starts;
  std::set<std::string> different;
  for (const Json& row : results["tables"]["stretches"]) {
    starts[row["steps"]].insert(row["start hash"].dump());
    different.insert(row["start hash"].dump());
  }
  EXPECT_EQ(starts.size(), 2u) << "a quick look";
  for (const auto& [steps, hash] : starts) EXPECT_EQ(hash.size(), 1u) << steps;
  EXPECT_EQ(different.size(), 2u);
}

TEST_F(PaperRunTest, GoesOnAfterAnInterruptionAndRepeatsNothing) {
  ASSERT_EQ(icloth(kCommand).code, 0);
  const auto expected = hashes();
  const Json before = progress();

  // Nothing is left to be done: all results are those of the first run, times included.
  ASSERT_EQ(icloth(std::string(kCommand) + " --continue").code, 0);
  EXPECT_EQ(progress(), before);

  // A run that is interrupted ends with the same hashes. A slow build may still be loading when the
  // signal comes, and is then given more time. Programs that were started in the background ignore
  // the signal, and their children would.
  std::signal(SIGINT, SIG_DFL);
  fs::remove_all(folder_ / "here");
  std::string err;
  for (int delay = 1; delay <= 32 && !contains(err, "interrupted by SIGINT"); delay *= 2)
    err = icloth(std::string(kCommand) + " --continue", "timeout -s INT " + std::to_string(delay))
              .err;
  EXPECT_TRUE(contains(err, "--out here --continue' with the same options goes on")) << err;
  const Json part = progress();
  ASSERT_EQ(icloth(std::string(kCommand) + " --continue").code, 0);
  EXPECT_EQ(hashes(), expected);

  // What was measured by then is still the same, to the last digit of its times.
  const Json whole = progress();
  for (const auto& [name, item] : part["measurements"].items())
    if (!name.ends_with("/run")) {
      EXPECT_EQ(whole["measurements"][name], item) << name;
    }
}

TEST_F(PaperRunTest, MeasuresDamagedResultsAndStatesAnew) {
  ASSERT_EQ(icloth(kCommand).code, 0);
  const auto expected = hashes();

  // A damaged result of the first stretch is measured from the saved state of that stretch.
  Json file = progress();
  const std::string damaged = "sphere/100/pscc";
  ASSERT_TRUE(file["measurements"].contains(damaged));
  file["measurements"][damaged]["result"]["seconds"] = 1e-9;
  write("here/progress.json", file.dump());
  Outcome outcome = icloth(std::string(kCommand) + " --continue");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "'" + damaged + "' is damaged")) << outcome.err;
  EXPECT_EQ(hashes(), expected);

  // Where that state is damaged too, the run begins anew.
  write("here/progress.json", file.dump());
  std::string state = read(folder_ / "here/checkpoints/sphere-100.checkpoint");
  state[state.size() / 2] ^= 1;
  write("here/checkpoints/sphere-100.checkpoint", state);
  outcome = icloth(std::string(kCommand) + " --continue");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "the run begins anew")) << outcome.err;
  EXPECT_EQ(hashes(), expected);
}

TEST_F(PaperRunTest, RefusesToGoOnFromNowhere) {
  expect_bad_input("bench paper --continue", "--out");
  expect_bad_input("bench paper --case nothing", "nothing");
  expect_bad_input("bench paper --scale 0", "--scale");
}

}  // namespace
}  // namespace icloth::testing
