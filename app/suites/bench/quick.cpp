#include "app/suites/bench/quick.h"

#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/common/headless.h"
#include "app/common/machine.h"
#include "app/suites/bench/suite.h"
#include "sim/cuda_devices.h"
#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/scene/scene_io.h"

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;

/// One case of the quick suite.
struct BenchCase {
  const char* name;
  const char* scene;  ///< a name, or a file below the assets
  std::vector<std::string> overrides;
  long steps;
};

const std::vector<BenchCase>& quick_suite() {
  static const std::vector<BenchCase> cases = {
      {"scarf, scripted drag", "scarf", {}, 600},
      {"sphere, 200K triangles", "sphere", {"triangles=200000"}, 40},
      {"two sheets on a ball", "bench/two_sheets.json", {}, 60},
      {"ball into curtains", "bench/three_curtains.json", {}, 16},
  };
  return cases;
}

std::shared_ptr<const Scene> scene_of(const BenchCase& test) {
  const std::string name = test.scene;
  return load_scene(name.ends_with(".json") ? assets_folder() + "/" + name : name, test.overrides);
}

/// The result of one case as JSON.
Json describe(const BenchCase& test, Build build, const Scene& scene,
              const HeadlessResult& result) {
  // The hash does not fit into a JSON number, so it is text.
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016" PRIx64, result.state_hash);
  std::size_t triangles = 0;
  for (const Cloth& cloth : scene.cloths) triangles += cloth.mesh.faces.size();

  // The case itself comes first, so that a result can be repeated.
  Json json;
  json["name"] = test.name;
  json["scene"] = test.scene;
  json["overrides"] = test.overrides;
  json["build"] = build_name(build);
  json["triangles"] = triangles;
  json["time_step"] = scene.parameters.step.time_step;
  json["steps"] = result.statistics.steps();

  // The numbers of the run follow.
  json["steps_per_second"] = result.statistics.steps_per_second();
  for (const ReportColumn& column : report_columns()) {
    if (!column.name.starts_with("ms_")) continue;
    const std::string name(column.name);
    json[name] = {{"median", result.statistics.median(column.name)},
                  {"mean", result.statistics.mean(column.name)}};
  }

  json["impacts"] = result.statistics.sum("impacts_first");
  json["retries"] = result.statistics.sum("retries");
  json["penetrations"] = result.penetrations;
  json["refused_steps"] = result.refused.size();
  json["peak_memory_bytes"] = peak_memory_bytes();
  json["state_hash"] = hash;
  return json;
}

void print_row(const Json& row) {
  std::printf("%-24s %-7s %9zu %6zu %9.2f %10.2f %12zu %9.0f\n",
              row["name"].get<std::string>().c_str(), row["build"].get<std::string>().c_str(),
              row["triangles"].get<std::size_t>(), row["steps"].get<std::size_t>(),
              row["steps_per_second"].get<double>(), row["ms_total"]["median"].get<double>(),
              row["penetrations"].get<std::size_t>(), row["peak_memory_bytes"].get<double>() / 1e6);
  std::fflush(stdout);
}

}  // namespace

int run_quick(const BenchOptions& options) {
  const std::vector<Build> builds = chosen_builds(options.device);
  Json results = begin_suite(options, builds);

  // The head names the machine, since times mean little without it.
  std::printf("%s, %d threads, %.1f GB/s, %s, commit %s\n", processor_name().c_str(),
              results["machine"]["threads"].get<int>(),
              results["machine"]["memory_bandwidth"].get<double>() / 1e9, compiler_name().c_str(),
              program_commit().c_str());
  if (results["machine"].contains("cuda")) {
    const Json& cuda = results["machine"]["cuda"];
    std::printf("cuda:%d, %s, %.1f GB/s\n", cuda_device(),
                cuda["device"].get<std::string>().c_str(),
                cuda["copy_bandwidth"].get<double>() / 1e9);
  }

  std::printf("%-24s %-7s %9s %6s %9s %10s %12s %9s\n", "test", "build", "triangles", "steps",
              "steps/s", "ms median", "penetrations", "peak MB");

  // Every case runs on every build, in the same order on every machine.
  bool clean = true;
  for (const BenchCase& test : quick_suite()) {
    for (const Build build : builds) {
      reset_peak_memory();
      HeadlessJob job;
      job.scene = scene_of(test);
      job.build = build;
      job.steps = test.steps;
      job.energies = false;
      job.quiet = options.quiet;
      const HeadlessResult result = run_headless(job);
      clean = clean && result.clean();
      results["results"].push_back(describe(test, build, *job.scene, result));
      print_row(results["results"].back());
    }
  }

  // The table is on the terminal; the file is for comparisons.
  if (!options.out.empty()) write_file(options.out + "/results.json", results.dump(1) + "\n");
  return clean ? 0 : 1;
}

}  // namespace icloth
