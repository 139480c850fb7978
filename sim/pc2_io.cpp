// PC2 point caches: 32 bytes of header, then frames of single-precision positions, little endian.
#include <cmath>
#include <cstring>
#include <limits>

#include "sim/error.h"
#include "sim/file_io.h"
#include "sim/mesh_io.h"

namespace icloth {
namespace {

struct Header {
  char signature[12];  ///< "POINTCACHE2" and a zero
  std::int32_t version, vertices;
  float start, sampling;
  std::int32_t frames;
};
static_assert(sizeof(Header) == 32);

void check(const Header& header, const std::string& path, Index vertices, std::size_t bytes) {
  const auto refuse = [&](const std::string& element, std::int64_t value,
                          const std::string& expected) {
    throw InputError(path + ": header: " + element + ": value " + std::to_string(value) +
                     ", expected " + expected);
  };
  if (header.version != 1) refuse("version", header.version, "1");
  if (header.vertices != vertices)
    refuse("vertices", header.vertices, std::to_string(vertices) + ", as in the mesh");
  if (header.frames < 1) refuse("frames", header.frames, "at least 1");
  const auto frame_bytes = static_cast<std::uint64_t>(vertices) * sizeof(Vec3f);
  const std::uint64_t available =
      (bytes - sizeof(Header)) / std::max<std::uint64_t>(frame_bytes, 1);
  if (static_cast<std::uint64_t>(header.frames) > available)
    refuse("frames", header.frames,
           std::to_string(available) + " at most, as many as the file's " + std::to_string(bytes) +
               " bytes hold");
}

}  // namespace

std::vector<std::vector<Vec3f>> read_pc2(const std::string& path, Index vertices) {
  const std::string bytes = read_file(path);
  Header header;
  if (bytes.size() < sizeof header)
    throw InputError(path + ": value " + std::to_string(bytes.size()) +
                     " bytes, expected a header of 32");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.signature, "POINTCACHE2", 12) != 0)
    throw InputError(path + ": header: signature, expected POINTCACHE2");
  check(header, path, vertices, bytes.size());

  std::vector<std::vector<Vec3f>> frames(static_cast<std::size_t>(header.frames));
  const char* data = bytes.data() + sizeof header;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    frames[f].resize(static_cast<std::size_t>(vertices));
    const std::size_t frame_bytes = frames[f].size() * sizeof(Vec3f);
    std::memcpy(frames[f].data(), data, frame_bytes);
    data += frame_bytes;
    for (std::size_t v = 0; v < frames[f].size(); ++v)
      if (!std::isfinite(norm_max(frames[f][v])) || !std::isfinite(frames[f][v].y + frames[f][v].z))
        throw InputError(path + ": frame " + std::to_string(f) + ": vertex " + std::to_string(v) +
                         ": value is not finite, expected three finite coordinates");
  }
  return frames;
}

}  // namespace icloth
