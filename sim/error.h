// The errors that a user can cause.
#pragma once

#include <stdexcept>
#include <string>

namespace icloth {

/// Bad usage or bad input: one line naming file, element, value and what was expected. Exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The asked-for device or display is not there. Exit code 3.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace icloth
