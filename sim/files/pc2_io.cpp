// PC2 point caches: 32 bytes of header, then frames of single-precision positions, little endian.
#include <cstring>

#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

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

  // The counts have to be those of the mesh, and the file large enough for them.
  if (header.version != 1) refuse("version", header.version, "1");
  if (header.vertices < 1) refuse("vertices", header.vertices, "at least 1");
  if (header.vertices != vertices)
    refuse("vertices", header.vertices, std::to_string(vertices) + ", as in the mesh");
  if (header.frames < 1) refuse("frames", header.frames, "at least 1");
  const auto frame_bytes = static_cast<std::uint64_t>(vertices) * sizeof(Vec3f);
  const std::uint64_t available = (bytes - sizeof(Header)) / frame_bytes;
  if (static_cast<std::uint64_t>(header.frames) > available)
    refuse("frames", header.frames,
           std::to_string(available) + " at most, as many as the file's " + std::to_string(bytes) +
               " bytes hold");
}

}  // namespace

PointCache parse_pc2(std::string_view bytes, const std::string& path, Index vertices) {
  Header header;
  if (bytes.size() < sizeof header)
    throw InputError(path + ": value " + std::to_string(bytes.size()) +
                     " bytes, expected a header of 32");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.signature, "POINTCACHE2", 12) != 0)
    throw InputError(path + ": header: signature, expected POINTCACHE2");
  check(header, path, vertices, bytes.size());

  // The points follow the header, one frame after the other.
  PointCache cache;
  cache.frames.resize(static_cast<std::size_t>(header.frames));
  const char* data = bytes.data() + sizeof header;
  for (std::size_t f = 0; f < cache.frames.size(); ++f) {
    std::vector<Vec3f>& frame = cache.frames[f];
    frame.resize(static_cast<std::size_t>(vertices));
    std::memcpy(frame.data(), data, frame.size() * sizeof(Vec3f));
    data += frame.size() * sizeof(Vec3f);
    check_frame(frame, f, path);
  }

  // The header counts in frames of an animation whose rate it does not say. Blender starts at 1.
  if (header.sampling != 1)
    cache.unused.push_back("a sampling of " + rounded_text(double{header.sampling}, 4) +
                           " frames in its header, which is not used: frame_rate counts its own "
                           "frames");
  if (header.start != 0 && header.start != 1)
    cache.unused.push_back("a start at frame " + rounded_text(double{header.start}, 4) +
                           " in its header, which is not used: its first frame is at time 0");
  const auto rest = static_cast<std::size_t>(bytes.data() + bytes.size() - data);
  if (rest > 0)
    cache.unused.push_back(std::to_string(rest) + " bytes behind its " +
                           std::to_string(header.frames) + " frames, which are not used");
  return cache;
}

}  // namespace icloth
