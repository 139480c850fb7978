// The reasons why a CUDA device cannot be used, in one line each. They are apart from the calls
// that find them out, so that they can be tested where there is no device.
#pragma once

#include <algorithm>
#include <span>
#include <string>

namespace icloth {

/// Compute capability in words: 75 is "7.5", 120 is "12.0".
inline std::string capability_text(int capability) {
  return std::to_string(capability / 10) + "." + std::to_string(capability % 10);
}

/// CUDA's version numbers in words: 13000 is "13.0", 12040 is "12.4".
inline std::string cuda_version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

/// The text when there is no device at all. `driver` is the highest CUDA version that the driver
/// knows, 0 without a driver; `runtime` is the version that this program was built with; `error` is
/// the message of the runtime.
inline std::string no_device_problem(int driver, int runtime, const std::string& error) {
  if (driver <= 0) return "no device: there is no NVIDIA driver";
  if (driver / 1000 < runtime / 1000) {
    return "no device: the NVIDIA driver is for CUDA " + cuda_version_text(driver) +
           ", this program needs one for CUDA " + std::to_string(runtime / 1000) + ".0 or later";
  }
  return "no device: " + error;
}

/// The text when the driver shows `count` devices (at least 1) and the asked-for one is not among
/// them.
inline std::string no_such_device_problem(int ordinal, int count) {
  return "there is no CUDA device " + std::to_string(ordinal) + ", the driver shows " +
         (count == 1 ? "only cuda:0" : "cuda:0 to cuda:" + std::to_string(count - 1));
}

/// A device in words, such as "CUDA device 0 'NVIDIA H200'".
inline std::string device_text(int ordinal, const std::string& name) {
  return "CUDA device " + std::to_string(ordinal) + " '" + name + "'";
}

/// The text when the program holds no code for a device of this compute capability. `built` are the
/// capabilities that it was compiled for.
inline std::string no_code_problem(int ordinal, const std::string& name, int capability,
                                   std::span<const int> built, int runtime) {
  std::string text =
      device_text(ordinal, name) + " has compute capability " + capability_text(capability);

  // The device is older than all that the program was built for. Where CUDA 12 could still build
  // for it (5.0 to 7.2), the text says so.
  const int lowest = built.empty() ? 0 : *std::min_element(built.begin(), built.end());
  if (capability < lowest) {
    text += "; this program needs " + capability_text(lowest) + " or later";
    const bool cuda12 = capability >= 50 && capability < 75 && runtime >= 13000;
    return text + (cuda12 ? " (CUDA 12 builds can include it)" : "");
  }
  text += ", for which this program holds no code; it was built for";
  for (const int each : built) (text += ' ') += capability_text(each);
  return text;
}

}  // namespace icloth
