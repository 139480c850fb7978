// What the benchmark suites share.
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

/// The CPU and the usable CUDA device, or the one that was asked for.
std::vector<Build> chosen_builds(const std::string& device);

/// Program, processor, memory and measured bandwidth; those of the CUDA device too where it is
/// used.
nlohmann::ordered_json describe_machine(int threads, bool cuda);

/// Throws InputError when it cannot be made; does nothing for "". `option`: gave the folder.
void make_output_folder(const std::string& folder, const char* option = "--out");

/// Makes the folder, sets the threads; the head of results.json: suite and machine.
nlohmann::ordered_json begin_suite(const BenchOptions& options, const std::vector<Build>& builds);

/// Of a suite that runs on one build: the CPU's unless another device was asked for.
Build only_build(const BenchOptions& options);
/// Makes the folder, sets the threads; an empty report of the suite.
Report begin_report(const BenchOptions& options, Build build);
/// Writes it where --out says, if anywhere.
void finish_report(const BenchOptions& options, const Report& report);

/// Whether --case leaves this case in.
bool chosen(const BenchOptions& options, std::string_view name);
/// What to throw when it leaves none.
InputError no_such_case(const BenchOptions& options);

}  // namespace icloth
