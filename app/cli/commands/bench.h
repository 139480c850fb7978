// icloth bench: the suites are a program of their own, icloth-bench, beside this one. They take as
// long to compile as the rest, and most people never run them.
#pragma once

#include <string>
#include <vector>

namespace icloth {

/// Replaces this process by icloth-bench with these words. Throws InputError where it is not
/// built.
int run_bench_program(const std::vector<std::string>& words);

}  // namespace icloth
