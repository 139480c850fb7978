// Functions that the benchmark suites share.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/suites/bench/bench_options.h"
#include "app/suites/report/report.h"
#include "sim/files/error.h"
#include "sim/simulator.h"

namespace icloth {

/// The CPU and the usable CUDA device, or the device that was asked for.
std::vector<Build> chosen_builds(const std::string& device);

/// The program, the processor, its memory and measured bandwidth; those of the CUDA device too
/// where it is used.
nlohmann::ordered_json describe_machine(int threads, bool cuda);

/// Makes a folder, or does nothing for "". Throws InputError, which names the `option` that gave
/// the folder.
void make_output_folder(const std::string& folder, const char* option = "--out");

/// Makes the folder and sets the threads. Returns the head of results.json: suite and machine.
nlohmann::ordered_json begin_suite(const BenchOptions& options, const std::vector<Build>& builds);

/// The build of a suite that runs on one build: the CPU's unless another device was asked for.
Build only_build(const BenchOptions& options);
/// Makes the folder and sets the threads. Returns an empty report of the suite.
Report begin_report(const BenchOptions& options, Build build);
/// Writes the report where --out says, if anywhere.
void finish_report(const BenchOptions& options, const Report& report);

/// True when --case leaves this case in.
bool chosen(const BenchOptions& options, std::string_view name);
/// The error to throw when it leaves none.
InputError no_such_case(const BenchOptions& options);

}  // namespace icloth
