#include "sim/files/cache_export.h"

#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>

#include "sim/files/cache_frames.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/spool.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::size_t kFramesAt = 28;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(shown_path(path) + ": " + what);
}

/// A name that every system takes for a file.
std::string file_name(const std::string& object) {
  std::string name;
  for (const char c : object)
    name += (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.') ? c : '_';
  return name;
}

/// Head of a cache without frames: a sampling of 1 counts in frames.
std::string pc2_head(std::size_t vertices) {
  struct Numbers {
    std::int32_t version = 1, vertices = 0;
    float start = 0, sampling = 1;
    std::int32_t frames = 0;
  } numbers;
  numbers.vertices = static_cast<std::int32_t>(vertices);
  std::string head(kPc2HeadBytes, '\0');
  std::memcpy(head.data(), "POINTCACHE2", 11);
  std::memcpy(head.data() + 12, &numbers, sizeof numbers);
  return head;
}

/// Counts the frames of a cache in its head.
void set_frames(const std::string& path, std::int64_t frames) {
  const auto count = static_cast<std::int32_t>(frames);
  const File file(std::fopen(path.c_str(), "r+b"), std::fclose);
  const bool written = file && std::fseek(file.get(), kFramesAt, SEEK_SET) == 0 &&
                       std::fwrite(&count, sizeof count, 1, file.get()) == 1 &&
                       std::fflush(file.get()) == 0;
  if (!written) refuse(path, "cannot be written");
}

/// Leaves the first frames of a cache that is there, and takes away what is behind them.
void keep_frames(const std::string& path, std::size_t vertices, std::int64_t frames) {
  const std::uint64_t size = regular_file_size(path);
  const std::uint64_t expected =
      kPc2HeadBytes + static_cast<std::uint64_t>(frames) * vertices * sizeof(Vec3f);
  const std::string here = read_head(path, kPc2HeadBytes);
  const std::string_view same = std::string_view(here).substr(0, kFramesAt);
  if (!pc2_head(vertices).starts_with(same) || same.size() < kFramesAt || size < expected)
    refuse(path, "expected " + std::to_string(frames) + " frames of " + std::to_string(vertices) +
                     " vertices, those of the run that is resumed");
  set_frames(path, frames);
  std::error_code error;
  std::filesystem::resize_file(path, expected, error);
  if (error) refuse(path, "cannot be written (" + error.message() + ")");
}

void append_big_endian(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
}

}  // namespace

void CacheExport::begin(std::span<const NamedMesh> meshes, std::int64_t kept) {
  std::map<std::string, int> names;
  for (const NamedMesh& mesh : meshes) {
    std::string name = folder_ + "/" + file_name(mesh.name);
    const int number = ++names[name];
    if (number > 1) name.append("_").append(std::to_string(number));
    const std::string path = name + ".pc2";
    const CachedMesh cache{mesh.name,
                           path,
                           mesh.positions.size(),
                           {mesh.faces.begin(), mesh.faces.end()},
                           {mesh.uv.begin(), mesh.uv.end()}};
    if (cache.vertices * sizeof(Vec3f) > std::numeric_limits<std::int32_t>::max())
      refuse(path, std::to_string(cache.vertices) + " vertices, expected fewer in a point cache");

    // The faces are in a file of their own, since a cache has positions alone.
    if (kept > 0) {
      keep_frames(path, cache.vertices, kept);
    } else {
      write_obj(name + ".obj", std::span(&mesh, 1), "faces of the point cache", ObjUv::written);
      write_file(path, pc2_head(cache.vertices));
    }
    caches_.push_back(cache);
  }
  frames_ = kept;
  write_object_list(folder_, caches_);
}

void CacheExport::append(std::span<const NamedMesh> meshes) {
  if (frames_ >= std::numeric_limits<std::int32_t>::max())
    refuse(folder_, "too many frames for a point cache");

  // All files have the frame before one of them counts it.
  for (std::size_t i = 0; i < caches_.size(); ++i)
    append_file(caches_[i].cache, {reinterpret_cast<const char*>(meshes[i].positions.data()),
                                   meshes[i].positions.size_bytes()});
  ++frames_;
  for (const CachedMesh& cache : caches_) set_frames(cache.cache, frames_);
}

void write_mdd(const std::string& folder, std::span<const CachedMesh> caches,
               std::span<const double> times) {
  for (const CachedMesh& cache : caches) {
    // The head has the time of every frame, which is why this file cannot grow.
    std::string bytes;
    append_big_endian(bytes, static_cast<std::uint32_t>(times.size()));
    append_big_endian(bytes, static_cast<std::uint32_t>(cache.vertices));
    for (const double time : times)
      append_big_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(time)));
    const std::string name = std::filesystem::path(cache.cache).stem().string();
    OutputFile file(folder + "/" + name + ".mdd");
    file.write(bytes);

    // Frames are turned one after the other, so that a long run takes no more memory.
    CacheFrames frames(cache.cache);
    std::vector<std::uint32_t> numbers(3 * cache.vertices);
    for (std::size_t f = 0; f < times.size(); ++f) {
      frames.next(numbers);
      bytes.clear();
      for (const std::uint32_t number : numbers) append_big_endian(bytes, number);
      file.write(bytes);
    }
    file.commit();
  }
}

void write_usda_scene(const std::string& folder, std::span<const CachedMesh> caches,
                      std::span<const double> times) {
  write_usda(folder + "/scene.usda", caches, times);
}

}  // namespace icloth
