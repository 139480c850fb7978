#include "app/suites/bench/suite.h"

#include <cstdio>
#include <filesystem>

#include "app/common/machine.h"
#include "app/common/options.h"
#include "kernels/parallel/device_problem.h"
#include "sim/cuda_devices.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;

/// The CUDA device that is used, as JSON.
Json describe_cuda() {
  Json json;
  const CudaSystem system = cuda_system();
  for (const CudaDevice& device : system.devices) {
    if (device.ordinal != cuda_device()) continue;

    // Results of one device mean nothing on another, so all that sets it apart is written down.
    json["device"] = device.name;
    json["compute_capability"] = capability_text(device.capability);
    json["memory_bytes"] = device.memory;
    json["multiprocessors"] = device.multiprocessors;
    json["l2_cache_bytes"] = device.l2_cache;
    json["driver_version"] = cuda_version_text(system.driver);
    json["runtime_version"] = cuda_version_text(system.runtime);
    json["copy_bandwidth"] = compute_device(Build::cuda32).copy_bandwidth;
  }
  return json;
}

}  // namespace

std::vector<Build> chosen_builds(const std::string& device) {
  SimulationOptions where;
  where.device = device;
  const Build build = choose_build(where);
  if (device.empty() && build != Build::cpu32) return {Build::cpu32, build};
  return {build};
}

Json describe_machine(int threads, bool cuda) {
  Json json;
  json["version"] = program_version();
  json["commit"] = program_commit();
  json["compiler"] = compiler_name();
  json["processor"] = processor_name();
  json["threads"] = threads > 0 ? threads : processor_threads();
  json["memory_bytes"] = memory_bytes();
  json["memory_bandwidth"] = measure_memory_bandwidth();
  if (cuda) json["cuda"] = describe_cuda();
  return json;
}

void make_output_folder(const std::string& folder, const char* option) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw InputError(std::string(option) + " " + folder + ": " + error.message());
}

Json begin_suite(const BenchOptions& options, const std::vector<Build>& builds) {
  make_output_folder(options.out);
  set_thread_count(options.threads);
  Json results;
  results["suite"] = options.suite;
  results["machine"] = describe_machine(options.threads, builds.back() == Build::cuda32);
  return results;
}

Build only_build(const BenchOptions& options) {
  return options.device.empty() ? Build::cpu32 : chosen_builds(options.device).front();
}

Report begin_report(const BenchOptions& options, Build build) {
  make_output_folder(options.out);
  set_thread_count(options.threads);
  return {"icloth bench " + options.suite,
          describe_machine(options.threads, build == Build::cuda32)};
}

void finish_report(const BenchOptions& options, const Report& report) {
  if (options.out.empty()) return;
  report.write(options.out);
  std::printf("%s/report.html\n", options.out.c_str());
}

bool chosen(const BenchOptions& options, std::string_view name) {
  return name.find(options.only) != std::string_view::npos;
}

InputError no_such_case(const BenchOptions& options) {
  return InputError("--case " + options.only + ": no such case, expected part of a case's name");
}

}  // namespace icloth
