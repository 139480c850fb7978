// MDD point caches, big endian: numbers of frames and points, the time of each frame [s], then
// frames of single-precision positions. The format has no signature.
#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::size_t kHeaderBytes = 8;

std::uint32_t load_big_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}

std::int32_t load_count(const char* bytes) {
  return static_cast<std::int32_t>(load_big_endian(bytes));
}

float load_float(const char* bytes) { return std::bit_cast<float>(load_big_endian(bytes)); }

/// Number of frames, checked together with the number of points against the size of the file.
std::size_t checked_frames(std::string_view bytes, const std::string& path, Index vertices) {
  if (bytes.size() < kHeaderBytes)
    throw InputError(path + ": value " + std::to_string(bytes.size()) +
                     " bytes, expected a header of 8");

  const auto refuse = [&](const char* element, std::int64_t value, const std::string& expected) {
    throw InputError(path + ": header: " + element + ": value " + std::to_string(value) +
                     ", expected " + expected);
  };
  const std::int32_t frames = load_count(bytes.data()), points = load_count(bytes.data() + 4);

  // The counts have to be those of the mesh, and the file large enough for them.
  if (points < 1) refuse("points", points, "at least 1");
  if (points != vertices) refuse("points", points, std::to_string(vertices) + ", as in the mesh");
  if (frames < 1) refuse("frames", frames, "at least 1");
  const std::uint64_t frame_bytes =
      sizeof(float) + static_cast<std::uint64_t>(points) * sizeof(Vec3f);
  const std::uint64_t available = (bytes.size() - kHeaderBytes) / frame_bytes;
  if (static_cast<std::uint64_t>(frames) > available)
    refuse("frames", frames,
           std::to_string(available) + " at most, as many as the file's " +
               std::to_string(bytes.size()) + " bytes hold");
  return static_cast<std::size_t>(frames);
}

std::vector<double> load_times(const char* data, std::size_t frames, const std::string& path) {
  std::vector<double> times(frames);
  for (std::size_t f = 0; f < frames; ++f, data += sizeof(float)) {
    times[f] = load_float(data);
    if (!std::isfinite(times[f]))
      throw InputError(path + ": frame " + std::to_string(f) + ": time: value " +
                       number_text(times[f]) + ", expected a finite number");
  }
  return times;
}

/// Frames a second where all times lie within a tenth of a frame of such a rate, else 0: not every
/// program fills the times in.
double even_rate(const std::vector<double>& times) {
  const double interval =
      (times.back() - times.front()) / std::max(static_cast<double>(times.size()) - 1, 1.0);
  if (!(interval >= 1e-5 && interval <= 1e3)) return 0;
  for (std::size_t f = 0; f < times.size(); ++f) {
    const double even = times.front() + static_cast<double>(f) * interval;
    if (std::abs(times[f] - even) > 0.1 * interval) return 0;
  }
  return 1 / interval;
}

}  // namespace

PointCache parse_mdd(std::string_view bytes, const std::string& path, Index vertices) {
  const std::size_t frames = checked_frames(bytes, path, vertices);
  const char* data = bytes.data() + kHeaderBytes;

  // The times of all frames come first, then the points of one frame after the other.
  PointCache cache;
  const std::vector<double> times = load_times(data, frames, path);
  cache.frame_rate = even_rate(times);
  if (cache.frame_rate == 0 && times.front() != times.back())
    cache.unused.emplace_back(
        "times of its frames that are not even, which are not used: frame_rate says how fast it is "
        "played");
  data += frames * sizeof(float);
  cache.frames.resize(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    cache.frames[f].reserve(static_cast<std::size_t>(vertices));
    for (Index v = 0; v < vertices; ++v, data += sizeof(Vec3f))
      cache.frames[f].push_back({load_float(data), load_float(data + 4), load_float(data + 8)});
    check_frame(cache.frames[f], f, path);
  }
  const auto rest = static_cast<std::size_t>(bytes.data() + bytes.size() - data);
  if (rest > 0)
    cache.unused.push_back(std::to_string(rest) + " bytes behind its " + std::to_string(frames) +
                           " frames, which are not used");
  return cache;
}

}  // namespace icloth
