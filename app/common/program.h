// The frame that every program of the project puts around its work.
#pragma once

#include <functional>
#include <string>

namespace icloth {

/// The text up to its first line break.
std::string first_line(const std::string& text);

/// Runs the work of a program and returns its exit code. An exception becomes one line on stderr
/// and a code: 2 bad usage or input (InputError, no memory) or standard output on a full disk, 3 a
/// device or display is missing (DeviceError), 1 everything else.
int run_program(const std::function<int()>& work);

}  // namespace icloth
