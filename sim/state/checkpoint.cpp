#include "sim/state/checkpoint.h"

#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

// A checkpoint is one line of text, then the recording as its own file would be, then the memory:
//   icloth-checkpoint 1 START_HASH BYTES_OF_RECORDING BYTES_OF_MEMORY

namespace icloth {
namespace {

constexpr const char* kHeadFormat = "icloth-checkpoint 1 %016" PRIx64 " %" PRIu64 " %" PRIu64 "\n";
constexpr std::size_t kLongestHead = 100;

}  // namespace

void save_checkpoint(const Checkpoint& checkpoint, const std::string& path) {
  const std::string recording = recording_text(checkpoint.recording);
  const std::vector<std::byte> memory = memory_to_bytes(checkpoint.state);
  char head[kLongestHead];
  std::snprintf(head, sizeof head, kHeadFormat, checkpoint.start_hash,
                static_cast<std::uint64_t>(recording.size()),
                static_cast<std::uint64_t>(memory.size()));

  OutputFile file(path);
  file.write(head);
  file.write(recording);
  file.write({reinterpret_cast<const char*>(memory.data()), memory.size()});
  file.commit();
}

Checkpoint load_checkpoint(const std::string& path) {
  const std::string name = shown_path(path), bytes = read_file(path);
  const std::string_view all = bytes;

  // The head says how long the two parts are, and they have to fill the file.
  Checkpoint checkpoint;
  std::uint64_t recording = 0, memory = 0;
  const std::size_t end = all.substr(0, kLongestHead).find('\n');
  const std::string head(all.substr(0, end == std::string_view::npos ? 0 : end + 1));
  const int found =
      std::sscanf(head.c_str(), "icloth-checkpoint 1 %16" SCNx64 " %" SCNu64 " %" SCNu64,
                  &checkpoint.start_hash, &recording, &memory);
  if (found != 3)
    throw InputError(name + ": expected a checkpoint of this version, which begins with " +
                     "'icloth-checkpoint 1'");
  const std::uint64_t here = all.size() - head.size();
  if (recording > here || memory != here - recording)
    throw InputError(name + ": " + std::to_string(here) + " bytes after the first line, expected " +
                     std::to_string(recording) + " and " + std::to_string(memory) + " as it says");

  // Each part is checked by its own reader.
  checkpoint.recording = parse_recording(all.substr(head.size(), recording), name);
  const std::string_view rest = all.substr(head.size() + recording);
  checkpoint.state =
      memory_from_bytes({reinterpret_cast<const std::byte*>(rest.data()), rest.size()}, name);
  return checkpoint;
}

}  // namespace icloth
