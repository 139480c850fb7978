#include "app/common/recording_file.h"

#include "sim/files/error.h"
#include "sim/files/file_io.h"

namespace icloth {

bool is_recording(const std::string& path) {
  // The key is among the first, whoever has formatted the file since.
  try {
    constexpr std::size_t kHead = 256;
    return read_head(path, kHead).find("\"icloth_recording\"") != std::string::npos;
  } catch (const InputError&) {
    return false;
  }
}

Build recorded_build(const Recording& recording) {
  for (const Build build : {Build::cpu64, Build::cuda32})
    if (build_name(build) == recording.build) return build;
  return Build::cpu32;  // no other name is read
}

}  // namespace icloth
