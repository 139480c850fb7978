#include "sim/files/spool.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>

#include "sim/files/cache_frames.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::string_view kHead = "vertices,file,object\n";
constexpr std::uint64_t kMostListBytes = std::uint64_t{1} << 26;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(shown_path(path) + ": " + what);
}

std::string object_list(const std::string& folder) { return folder + "/objects.csv"; }

/// Whether a name is one that an export gives to a file, which lies in its own folder then.
bool is_file_name(std::string_view name) {
  return name.ends_with(".pc2") && std::ranges::all_of(name, [](unsigned char c) {
           return std::isalnum(c) || c == '_' || c == '-' || c == '.';
         });
}

/// Name, file and number of vertices of each object, as objects.csv lists them.
std::vector<CachedMesh> read_object_list(const std::string& folder) {
  const std::string path = object_list(folder);
  if (!std::filesystem::exists(path))
    refuse(folder, "there is no objects.csv, expected a folder of 'icloth run' with point caches");
  const std::string text = read_file(path, kMostListBytes);
  std::vector<CachedMesh> objects;
  const auto refuse_row = [&](const std::string& value) {
    refuse(path, "row " + std::to_string(objects.size()) + ": value " + in_quotes(value) +
                     ", expected vertices, file and name of an object");
  };
  if (!text.starts_with(kHead)) refuse_row(text.substr(0, text.find('\n')));

  // The name comes last, since it may hold commas.
  std::set<std::string> files;
  std::size_t begin = kHead.size();
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    const std::size_t first = line.find(','), second = line.find(',', first + 1);
    if (first == std::string::npos || second == std::string::npos) refuse_row(line);
    CachedMesh object;
    const auto [rest, error] = std::from_chars(line.data(), line.data() + first, object.vertices);
    const std::string file = line.substr(first + 1, second - first - 1);
    const bool is_count = error == std::errc{} && rest == line.data() + first;
    if (!is_count || object.vertices < 1 || object.vertices > kLargestCount) refuse_row(line);
    if (!is_file_name(file) || !files.insert(file).second) refuse_row(line);
    object.name = line.substr(second + 1);
    object.cache = (std::filesystem::path(folder) / file).string();
    objects.push_back(std::move(object));
  }
  if (objects.empty()) refuse(path, "0 objects, expected at least one");
  return objects;
}

/// Faces and texture coordinates, which the mesh beside a cache has.
void read_faces(CachedMesh& object) {
  const std::string path = std::filesystem::path(object.cache).replace_extension(".obj").string();
  MeshFile file = read_mesh(path);
  if (file.mesh.positions.size() != object.vertices)
    refuse(path, "value " + std::to_string(file.mesh.positions.size()) + " vertices, expected " +
                     std::to_string(object.vertices) + ", as objects.csv says");
  object.faces = std::move(file.mesh.faces);
  object.uv = std::move(file.mesh.uv);
}

/// The number of frames that a cache holds and counts. What a crash left behind them is noted.
std::size_t whole_frames(const CachedMesh& object, std::vector<std::string>& notes) {
  const std::string& path = object.cache;
  const std::uint64_t size = regular_file_size(path);
  const std::string head = read_head(path, kPc2HeadBytes);
  if (head.size() < kPc2HeadBytes)
    refuse(path, "value " + std::to_string(head.size()) + " bytes, expected a header of 32");
  if (std::memcmp(head.data(), "POINTCACHE2", 12) != 0)
    refuse(path, "header: signature, expected POINTCACHE2");

  // The header repeats the number of vertices, and counts the frames.
  std::int32_t version = 0, vertices = 0, frames = 0;
  std::memcpy(&version, head.data() + 12, sizeof version);
  std::memcpy(&vertices, head.data() + 16, sizeof vertices);
  std::memcpy(&frames, head.data() + 28, sizeof frames);
  if (version != 1)
    refuse(path, "header: version: value " + std::to_string(version) + ", expected 1");
  if (vertices < 0 || static_cast<std::size_t>(vertices) != object.vertices)
    refuse(path, "header: vertices: value " + std::to_string(vertices) + ", expected " +
                     std::to_string(object.vertices) + ", as objects.csv says");
  if (frames < 0)
    refuse(path, "header: frames: value " + std::to_string(frames) + ", expected at least 0");

  // A frame that was being appended is not whole.
  const std::uint64_t frame_bytes = object.vertices * sizeof(Vec3f);
  const std::uint64_t held = (size - kPc2HeadBytes) / frame_bytes,
                      rest = (size - kPc2HeadBytes) % frame_bytes;
  if (rest > 0)
    notes.push_back(shown_path(path) + ": its last " + std::to_string(rest) + " bytes are not a " +
                    "whole frame and are left out");
  return std::min<std::uint64_t>(held, static_cast<std::uint64_t>(frames));
}

/// The listed frames that caches have: evenly spaced ones, from the first on. The last state of a
/// run may be listed between two of them.
std::vector<ListedFrame> even_frames(const std::vector<ListedFrame>& listed) {
  std::size_t count = std::min<std::size_t>(listed.size(), 2);
  while (count >= 2 && count < listed.size() &&
         listed[count].step - listed[count - 1].step == listed[1].step - listed[0].step)
    ++count;
  return {listed.begin(), listed.begin() + static_cast<std::ptrdiff_t>(count)};
}

void check_frames(const CachedMesh& object, std::size_t frames) {
  CacheFrames cache(object.cache);
  std::vector<Vec3f> frame(object.vertices);
  for (std::size_t f = 0; f < frames; ++f) {
    cache.next(frame);
    check_frame(frame, f, shown_path(object.cache));
  }
}

}  // namespace

std::vector<double> Spool::times() const {
  std::vector<double> times;
  for (const ListedFrame& frame : frames) times.push_back(frame.time);
  return times;
}

void write_object_list(const std::string& folder, std::span<const CachedMesh> objects) {
  std::string text(kHead);
  for (const CachedMesh& object : objects)
    text += std::to_string(object.vertices) + "," +
            std::filesystem::path(object.cache).filename().string() + "," + file_line(object.name) +
            "\n";
  write_file(object_list(folder), text);
}

Spool read_spool(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    refuse(folder, "is no folder, expected that of a run with point caches");
  Spool spool;
  spool.objects = read_object_list(folder);
  const std::vector<ListedFrame> listed = read_frame_list(folder);
  spool.frames = even_frames(listed);

  // Frames count when all caches have them and the list says that they were finished.
  std::size_t most = 0, least = std::numeric_limits<std::size_t>::max();
  for (CachedMesh& object : spool.objects) {
    read_faces(object);
    const std::size_t frames = whole_frames(object, spool.notes);
    most = std::max(most, frames);
    least = std::min(least, frames);
  }
  const std::size_t count = std::min(least, spool.frames.size());
  if (count == 0) refuse(folder, "0 whole frames, expected at least one");
  if (most > count)
    spool.notes.push_back(shown_path(folder) + ": frame " + std::to_string(count) +
                          " was not finished and is left out");

  // A run that ended between two frames lists its last state, which no cache has.
  const std::size_t lost = spool.frames.size() - count;
  if (lost > 1 || (lost == 1 && spool.frames.size() > 2))
    spool.notes.push_back(shown_path(folder) + ": " + std::to_string(count) + " of the " +
                          std::to_string(spool.frames.size()) +
                          " frames of frames.csv are whole in all caches");
  spool.frames.resize(count);
  for (const CachedMesh& object : spool.objects) check_frames(object, count);
  return spool;
}

}  // namespace icloth
