// Power laws that are known, and the bytes and the report of `bench scaling`.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float
#include "app/suites/bench/scaling.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/suites/bench/power_fit.h"
#include "app/suites/bench/scaling_model.h"
#include "kernels/box.h"
#include "kernels/contact.h"
#include "kernels/impact.h"
#include "kernels/zones/zone_problem.h"
#include "sim/files/file_io.h"
#include "sim/mechanics/element_terms.h"
#include "sim/scene/scene_io.h"
#include "sim/state/topology.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

using Points = std::vector<std::pair<double, double>>;

TEST(PowerFit, FindsTheExponentOfAPowerLaw) {
  for (const double exponent : {-0.5, 0.0, 1.0, 1.25, 2.0}) {
    Points points;
    for (const double x : {1e4, 2e4, 5e4, 1e5, 1e6})
      points.emplace_back(x, 0.003 * std::pow(x, exponent));
    const PowerFit fit = fit_power(points);
    EXPECT_NEAR(fit.exponent, exponent, 1e-12);
    EXPECT_NEAR(fit.factor, 0.003, 1e-12);
    EXPECT_NEAR(fit.worst, 1, 1e-12);
    EXPECT_NEAR(fit.first, 1e4, 1e-6);
    EXPECT_NEAR(fit.last, 1e6, 1e-4);
    EXPECT_EQ(fit.points, 5u);
  }
}

TEST(PowerFit, IsTheLeastSquaresSolutionAndTellsItsWorstPoint) {
  // Logarithms 0, 1, 2 to 0, 2, 1: the slope is 1/2 and the line passes through (1, 1).
  const double e = std::exp(1.0);
  const PowerFit fit = fit_power(Points{{1, 1}, {e, e * e}, {e * e, e}});
  EXPECT_NEAR(fit.exponent, 0.5, 1e-12);
  EXPECT_NEAR(fit.factor, std::exp(0.5), 1e-12);
  EXPECT_NEAR(fit.worst, e, 1e-12);
}

TEST(PowerFit, LeavesOutWhatHasNoLogarithm) {
  const PowerFit fit = fit_power(Points{{1, 3}, {2, 0}, {-1, 3}, {4, NAN}, {10, 300}});
  EXPECT_NEAR(fit.exponent, 2, 1e-12);
  EXPECT_EQ(fit.points, 2u);
  EXPECT_FALSE(fit_power(Points{}).valid());
  EXPECT_FALSE(fit_power(Points{{1, 1}, {2, 0}}).valid());
  EXPECT_FALSE(fit_power(Points{{5, 1}, {5, 2}}).valid());
}

TEST(ScalingModel, CountsTheElementsOfAMesh) {
  // Two triangles with a common edge.
  Scene scene;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  cloth.mesh.faces = {{0, 1, 2}, {2, 1, 3}};
  const MeshCounts mesh = count_elements(scene);
  EXPECT_EQ(mesh.cloth_vertices, 4);
  EXPECT_EQ(mesh.cloth_edges, 5);
  EXPECT_EQ(mesh.hinges, 1);
  EXPECT_EQ(mesh.faces, 2);
}

TEST(ScalingModel, HasTheSizesOfTheArraysOfTheStages) {
  using namespace cpu32;
  using namespace array_entry;
  EXPECT_EQ(kPosition, sizeof(Vec3r));
  EXPECT_EQ(kIndex, sizeof(Index));
  EXPECT_EQ(kPair, sizeof(Pair));
  EXPECT_EQ(kBox, sizeof(Box));
  EXPECT_EQ(kBlock, sizeof(Mat3r));
  EXPECT_EQ(kFaceRest, sizeof(Int3) + sizeof(Topology::Inverse) + sizeof(Real) + sizeof(Index));
  EXPECT_EQ(kFaceTerm, sizeof(FaceTerm));
  EXPECT_EQ(kHingeRest, sizeof(HingeRest));
  EXPECT_EQ(kHingeTerm, sizeof(HingeTerm));
  EXPECT_EQ(kContact, sizeof(Contact));
  EXPECT_EQ(kContactTerm, sizeof(ContactTerm));
  EXPECT_EQ(kConstraint, sizeof(KeptImpact) + sizeof(ZoneConstraint));
}

TEST(ScalingModel, ChargesEachStageForItsOwnWork) {
  MeshCounts mesh;
  mesh.cloth_vertices = mesh.vertices = 100;
  StepReport report;
  const PerStage before = least_bytes(mesh, report);
  report.elementary_tests = 1000;
  const PerStage after = least_bytes(mesh, report);
  for (std::size_t s = 0; s < kStages; ++s)
    EXPECT_EQ(after[s] - before[s], s == static_cast<std::size_t>(Stage::ccd) ? 8000 : 0);
}

/// Every number of a JSON value is finite; texts are not read as numbers.
void expect_finite(const nlohmann::json& json, const std::string& where) {
  if (json.is_number()) {
    EXPECT_TRUE(std::isfinite(json.get<double>())) << where;
  } else if (json.is_string()) {
    const std::string text = json.get<std::string>();
    EXPECT_TRUE(text != "nan" && text != "inf" && text != "-nan" && text != "-inf") << where;
  } else {
    EXPECT_FALSE(json.is_null()) << where;
    for (const auto& [key, value] : json.items()) expect_finite(value, where + "/" + key);
  }
}

TEST(Scaling, TheReportOfTinySizesIsWholeAndFinite) {
  const TemporaryFolder folder;
  BenchOptions options;
  options.suite = "scaling";
  options.only = "0K";
  options.scale = 0.01;
  options.threads = 1;
  options.quiet = true;
  options.out = folder.path("out");
  EXPECT_EQ(run_scaling(options), 0);

  // Six sizes from 100 to 5000 triangles, and a floor for each stage of each.
  const auto results = nlohmann::json::parse(read_file(folder.path("out/results.json")));
  expect_finite(results, "");
  const auto& tables = results["tables"];
  EXPECT_EQ(tables["sizes"].size(), 6u);
  EXPECT_EQ(tables["floors"].size(), 6u * kStages);
  EXPECT_EQ(tables["exponents"][0]["quantity"], "ms_total");
  EXPECT_TRUE(tables["exponents"][0]["exponent"].is_number());
  for (const auto& row : tables["sizes"]) EXPECT_GT(row["pairs in proximity"].get<double>(), 0);
  for (const auto& row : tables["memory"]) EXPECT_GT(row["peak MB"].get<double>(), 1);

  // The report holds its plots, and every table is a file.
  const std::string html = read_file(folder.path("out/report.html"));
  EXPECT_NE(html.find("<svg"), std::string::npos);
  EXPECT_NE(html.find("floor"), std::string::npos);
  for (const char* name : {"sizes", "times", "exponents", "floors", "memory"})
    EXPECT_GT(read_file(folder.path("out/") + name + ".csv").size(), 20u) << name;
}

TEST(Scaling, ASignalEndsItWithAReport) {
  const TemporaryFolder folder;
  BenchOptions options;
  options.suite = "scaling";
  options.scale = 0.05;
  options.threads = 1;
  options.quiet = true;
  options.out = folder.path("out");

  // It is sent as soon as the suite listens, long before all sizes are done.
  std::signal(SIGINT, SIG_DFL);
  std::thread sender([] {
    struct sigaction action {};
    while (sigaction(SIGINT, nullptr, &action) == 0 && action.sa_handler == SIG_DFL)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(getpid(), SIGINT);
  });
  EXPECT_EQ(run_scaling(options), 1);
  sender.join();
  const std::string html = read_file(folder.path("out/report.html"));
  EXPECT_NE(html.find("Ended by SIGINT after "), std::string::npos);
  expect_finite(nlohmann::json::parse(read_file(folder.path("out/results.json"))), "");
}

}  // namespace
}  // namespace icloth
