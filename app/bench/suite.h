// What the benchmark suites share.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth {

/// The CPU and the usable CUDA device, or the one that was asked for.
std::vector<Build> chosen_builds(const std::string& device);

/// Program, processor, memory and measured bandwidth; those of the CUDA device too where it is
/// used.
nlohmann::ordered_json describe_machine(int threads, bool cuda);

/// Throws InputError when it cannot be made; does nothing for "".
void make_output_folder(const std::string& folder);

}  // namespace icloth
