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

}  // namespace icloth
