// Another program that is run to its end.
#pragma once

#include <string>
#include <vector>

namespace icloth {

/// Runs a program (its path, then its arguments) with its output and its messages in one file, and
/// waits for it. Returns its exit code, or 128 + the signal that ended it. Throws InputError where
/// it cannot be started.
int run_child(const std::vector<std::string>& words, const std::string& log);

}  // namespace icloth
