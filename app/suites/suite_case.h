// What the cases of the stability and the validation suite have in common.
#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <vector>

namespace icloth {

/// Notes what was required and is not so, each line once.
inline void note_failure(std::vector<std::string>& failures, bool holds, const std::string& what) {
  if (!holds && std::ranges::find(failures, what) == failures.end()) failures.push_back(what);
}

/// The result of a case, timed; anything that it throws is a failure.
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
