// Functions that the cases of the stability and of the validation suite share.
#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <vector>

namespace icloth {

/// Notes a requirement that does not hold, each line once.
inline void note_failure(std::vector<std::string>& failures, bool holds, const std::string& what) {
  if (!holds && std::ranges::find(failures, what) == failures.end()) failures.push_back(what);
}

/// Runs a case. Its result is timed; anything that it throws is a failure.
template <class Case, class Run>
auto result_of(const Case& test, Run& run) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    test.run(run);
  } catch (const std::exception& error) {
    run.require(false, std::string("no exception (") + error.what() + ")");
  }
  auto result = run.finish();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  result.seconds = taken.count();
  return result;
}

}  // namespace icloth
