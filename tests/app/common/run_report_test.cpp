// The report of a headless run to its user: names of elements, the table, the files of --stats.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/common/element_names.h"
#include "app/common/run_statistics.h"
#include "sim/files/error.h"

using namespace icloth;

namespace {

StepReport report_of(std::int64_t step, double ms) {
  StepReport report;
  report.step = step;
  report.ms_total = ms;
  report.impacts_first = 10 * step;
  report.state_hash = 0xfedcba9876543210ull + static_cast<std::uint64_t>(step);
  return report;
}

std::string scratch(const std::string& name) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "icloth_run_report_test";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

std::string read(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Two cloths of 4 vertices and 2 faces, a body of 3 and 1.
Scene named_scene() {
  Scene scene;
  scene.cloths.resize(2);
  for (Cloth& cloth : scene.cloths) {
    cloth.mesh.positions.resize(4);
    cloth.mesh.faces.resize(2);
  }
  scene.cloths[0].name = "shirt";
  scene.cloths[1].name = "skirt";
  scene.obstacles.resize(1);
  scene.obstacles[0].name = "body";
  scene.obstacles[0].mesh.positions.resize(3);
  scene.obstacles[0].mesh.faces.resize(1);
  return scene;
}

}  // namespace

TEST(ElementNames, NumbersCountWithinTheirObject) {
  const ElementNames names(named_scene());
  EXPECT_EQ(names.face(0), "cloth:shirt face 0");
  EXPECT_EQ(names.face(3), "cloth:skirt face 1");
  EXPECT_EQ(names.face(4), "obstacle:body face 0");
  EXPECT_EQ(names.vertex(7), "cloth:skirt vertex 3");
  EXPECT_EQ(names.pair(IntersectingFaces{1, 4}), "cloth:shirt face 1 — obstacle:body face 0");
}

TEST(ElementNames, OffendingPairsNameBothObjects) {
  const ElementNames names(named_scene());
  EXPECT_EQ(names.pair(OffendingPair{false, {5, 8, 9, 10}}),
            "vertex cloth:skirt 1 — face obstacle:body 0 1 2");
  EXPECT_EQ(names.pair(OffendingPair{true, {0, 3, 4, 6}}),
            "edge cloth:shirt 0 3 — edge cloth:skirt 0 2");
}

TEST(ElementNames, PinsThatABodyIsPushedIntoAreNamed) {
  Scene scene = named_scene();
  for (Cloth& cloth : scene.cloths) cloth.mesh.faces = {{0, 1, 2}, {1, 3, 2}};
  scene.cloths[1].pins = {1, 3};
  const ElementNames names(scene);
  StepReport report;
  report.accepted = false;
  EXPECT_EQ(pins_in_the_way(scene, names, report), "");

  // A pinned vertex collides, then one that shares a face with both pins, then the other cloth.
  report.offending = {{false, {5, 8, 9, 10}}};
  EXPECT_EQ(pins_in_the_way(scene, names, report),
            "obstacle:body is pushed into the pinned vertices 1 of cloth:skirt");
  report.offending = {{true, {6, 6, 8, 9}}};
  EXPECT_EQ(pins_in_the_way(scene, names, report),
            "obstacle:body is pushed into the pinned vertices 1 3 of cloth:skirt");
  report.offending = {{false, {0, 8, 9, 10}}};
  EXPECT_EQ(pins_in_the_way(scene, names, report), "");

  // Cloth against pinned cloth is no matter of bodies.
  report.offending = {{false, {0, 4, 5, 6}}};
  EXPECT_EQ(pins_in_the_way(scene, names, report), "");
}

TEST(RunStatistics, GivesMedianMeanLargestAndSum) {
  RunStatistics statistics;
  EXPECT_EQ(statistics.median("ms_total"), 0);
  EXPECT_EQ(statistics.steps_per_second(), 0);
  for (const double ms : {40.0, 10.0, 100.0, 20.0})
    statistics.add(report_of(static_cast<std::int64_t>(statistics.steps()), ms));
  EXPECT_EQ(statistics.median("ms_total"), 30);
  EXPECT_EQ(statistics.mean("ms_total"), 42.5);
  EXPECT_EQ(statistics.largest("ms_total"), 100);
  EXPECT_EQ(statistics.sum("impacts_first"), 60);
  statistics.add(report_of(4, 25));
  EXPECT_EQ(statistics.median("ms_total"), 25);
  EXPECT_EQ(statistics.steps_per_second(), 40);
  EXPECT_EQ(statistics.median("no such column"), 0);
}

TEST(RunStatistics, TableNamesWhatARunLeaves) {
  RunStatistics statistics;
  statistics.add(report_of(1, 5));
  const std::string table = statistics.table(3, 0xabcull);
  for (const char* part : {"ms_impact_zones", "steps/s (median)", "200.00", "peak memory",
                           "penetrations left                 3", "0000000000000abc"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
}

TEST(RunStatistics, TableNamesTheLimitsThatWereReached) {
  RunStatistics statistics;
  for (const std::int64_t step : {1, 2, 3}) {
    StepReport report = report_of(step, 5);
    if (step > 1) report.reach(Limit::cg_iterations);
    statistics.add(report);
  }
  const std::string table = statistics.table(0, 0);
  EXPECT_NE(table.find("limit reached                     2   steps: implicit.cg_max_iterations\n"),
            std::string::npos)
      << table;
  EXPECT_EQ(table.find("contact_passes"), std::string::npos);
}

TEST(StatisticsFile, CsvHasARowAsSoonAsAStepIsDone) {
  const std::string path = scratch("steps.csv");
  StatisticsFile file(path);
  file.add(report_of(1, 5));
  const std::string text = read(path);
  EXPECT_TRUE(text.starts_with("step,time,dt,")) << text;
  EXPECT_NE(text.find("\n1,0,0,1,0,5,"), std::string::npos) << text;
  EXPECT_NE(text.find(",fedcba9876543211,"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\n")) << text;
}

TEST(StatisticsFile, JsonKeepsTheNamesAndTheWholeHash) {
  const std::string path = scratch("steps.json");
  std::filesystem::remove(path);
  StatisticsFile file(path);
  RunStatistics statistics;
  for (std::int64_t step : {1, 2}) {
    statistics.add(report_of(step, 7.5));
    file.add(statistics.reports().back());
  }
  EXPECT_FALSE(std::filesystem::exists(path)) << "written at the end only";
  file.finish(statistics);
  const auto json = nlohmann::json::parse(read(path));
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[1].size(), report_columns().size());
  EXPECT_EQ(json[1]["step"], 2);
  EXPECT_EQ(json[1]["ms_total"], 7.5);
  EXPECT_EQ(json[1]["state_hash"], "fedcba9876543212");
}

TEST(StatisticsFile, RefusesBadPlacesBeforeTheRun) {
  EXPECT_THROW(StatisticsFile("steps.txt"), InputError);
  EXPECT_THROW(StatisticsFile(scratch("no/such/steps.csv")), InputError);
  EXPECT_THROW(StatisticsFile(scratch("no/such/steps.json")), InputError);
  StatisticsFile nothing("");
  nothing.add(StepReport{});
  nothing.finish(RunStatistics{});
}
