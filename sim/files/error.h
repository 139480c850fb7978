// The errors that a user can cause.
#pragma once

#include <stdexcept>
#include <string>

namespace icloth {

/// The text as one line that a terminal can show: control characters are replaced, and words or
/// texts that are longer than in any message of ours lose their middle. Names and values in
/// messages come from files; what is repeated of them goes through excerpt (sim/files/text.h).
std::string one_line(std::string text);

/// Bad usage or bad input: one line naming file, element, value and what was expected. Exit code 2.
struct InputError : std::runtime_error {
  explicit InputError(std::string what) : std::runtime_error(one_line(std::move(what))) {}
};

/// The asked-for device or display is not there. Exit code 3.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace icloth
