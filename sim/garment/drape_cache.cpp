#include "sim/garment/drape_cache.h"

#include <icloth_solver_sum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <string_view>
#include <type_traits>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"

namespace icloth {
namespace {

constexpr std::string_view kMagic = "icloth drape 1\n";
constexpr const char* kExtension = ".drape";
constexpr std::size_t kMostDrapes = 200;  // in the folder
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;

/// 128 bits of what is added: two FNV-1a sums with different starts.
class Fingerprint {
 public:
  void add_bytes(const void* data, std::size_t count) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < count; ++i)
      for (std::uint64_t& sum : sums_) sum = (sum ^ bytes[i]) * 0x100000001b3;
  }
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
    add_bytes(&value, sizeof value);
  }
  void add(const std::string& text) {
    add(text.size());
    add_bytes(text.data(), text.size());
  }
  void add(Vec3d v) {
    for (double x : {v.x, v.y, v.z}) add(x);
  }
  void add(Vec2d v) {
    for (double x : {v.x, v.y}) add(x);
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& list) {
    for (const T& item : list) add(item);
  }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.size());
    for (const T& item : list) add(item);
  }

  std::string digits() const {
    char text[40];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(sums_[0]),
                  static_cast<unsigned long long>(sums_[1]));
    return text;
  }

 private:
  std::uint64_t sums_[2] = {0xcbf29ce484222325, 0x84222325cbf29ce4};
};

void add_material(Fingerprint& print, const Material& m) {
  print.add(m.law);
  print.add(m.stretching);
  print.add(m.bending);
  for (double value : {m.density, m.damping, m.bending_spacing, m.bending_poisson,
                       m.bending_friction, m.shear_friction})
    print.add(value);
}

void add_cloth(Fingerprint& print, const Cloth& cloth) {
  print.add(cloth.name);
  print.add(cloth.mesh.positions);
  print.add(cloth.mesh.faces);
  print.add(cloth.mesh.uv);
  print.add(cloth.rest);
  print.add(cloth.rest_in_uv);
  print.add(cloth.flat_angles);
  print.add(cloth.pins);
  print.add(cloth.friction.value_or(-1));
  add_material(print, cloth.material);
}

void add_garment(Fingerprint& print, const Garment& garment) {
  print.add(garment.cloth);
  print.add(garment.body);
  print.add(garment.layer);
  print.add(garment.plan.on);
  print.add(garment.plan.closing);
  print.add(garment.plan.settling);
  print.add(garment.plan.hold);

  // The pattern is known by its meshed panels and where they stand. What sews them together is in
  // the faces of the cloth.
  for (const PanelPlacement& p : garment.placements) {
    print.add(p.translation);
    print.add(p.rotation);
    print.add(p.bend_radius);
  }
  for (const PanelMesh& panel : garment.meshed->panels) print.add(panel.points);
  for (const LabelledEdge& edge : garment.sewn.labelled) {
    print.add(edge.label);
    print.add(edge.vertices);
  }
}

/// Numbers and texts one after the other, in the byte order of the machine.
class Writer {
 public:
  template <class T>
  void number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view text) {
    number(static_cast<std::uint64_t>(text.size()));
    bytes_ += text;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what Writer wrote; after the first thing that is missing, good() is false.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  T number() {
    T value{};
    if (bytes_.size() < sizeof value) {
      good_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::string text() {
    const auto size = number<std::uint64_t>();
    if (!good_ || size > bytes_.size()) {
      good_ = false;
      return "";
    }
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }
  bool good() const { return good_; }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

std::uint64_t sum_of(std::string_view bytes) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return sum;
}

std::string path_of(const std::string& folder, const std::string& key) {
  return folder + "/" + key + kExtension;
}

/// The positions of one garment; empty where the numbers are not those of this cloth.
std::vector<Vec3d> read_positions(Reader& reader, std::size_t expected) {
  if (reader.number<std::uint64_t>() != expected) return {};
  std::vector<Vec3d> positions(expected);
  for (Vec3d& p : positions) {
    p = {reader.number<double>(), reader.number<double>(), reader.number<double>()};
    if (!std::isfinite(p.x + p.y + p.z)) return {};
  }
  return reader.good() ? positions : std::vector<Vec3d>{};
}

/// Keeps the kMostDrapes files that were written last.
void remove_oldest_drapes(const std::string& folder) {
  std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> drapes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == kExtension)
      drapes.emplace_back(entry.last_write_time(error), entry.path());
  if (drapes.size() <= kMostDrapes) return;

  std::ranges::sort(drapes);
  drapes.resize(drapes.size() - kMostDrapes);
  for (const auto& [written, path] : drapes) std::filesystem::remove(path, error);
}

}  // namespace

std::string drape_key(const Scene& scene) {
  Fingerprint print;
  print.add(std::string(ICLOTH_SOLVER_SUM));
  Parameters parameters = scene.parameters;
  parameters.step.sleep = false;  // dressing does not sleep
  print.add(dump_parameters(parameters));
  for (const Cloth& cloth : scene.cloths) add_cloth(print, cloth);
  for (const Garment& garment : scene.garments) add_garment(print, garment);

  // Bodies count with where they are at time 0.
  std::vector<Vec3d> pose;
  for (const Obstacle& obstacle : scene.obstacles) {
    obstacle.pose(0, pose);
    print.add(obstacle.name);
    print.add(pose);
    print.add(obstacle.mesh.faces);
    print.add(obstacle.friction.value_or(-1));
  }
  return print.digits();
}

std::string drape_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') return std::string(cache) + "/icloth";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? std::string(home) + "/.cache/icloth" : "";
}

std::optional<Drape> load_drape(const std::string& folder, const std::string& key,
                                const Scene& scene) {
  if (folder.empty()) return std::nullopt;
  std::string bytes;
  try {
    bytes = read_file(path_of(folder, key), kMostBytes);
  } catch (const InputError&) {
    return std::nullopt;
  }

  // Magic, check sum, then the content; a file that was damaged is as good as none.
  std::string_view content(bytes);
  if (!content.starts_with(kMagic)) return std::nullopt;
  content.remove_prefix(kMagic.size());
  Reader reader(content);
  const auto sum = reader.number<std::uint64_t>();
  if (!reader.good() || sum != sum_of(content.substr(sizeof sum)) || reader.text() != key)
    return std::nullopt;

  Drape drape;
  const auto notes = reader.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < notes && reader.good(); ++i) drape.notes.push_back(reader.text());
  for (const Garment& garment : scene.garments) {
    const std::size_t expected = scene.cloths[at(garment.cloth)].mesh.positions.size();
    drape.positions.push_back(read_positions(reader, expected));
    if (drape.positions.back().empty()) return std::nullopt;
  }
  return reader.good() && reader.at_end() ? std::optional(drape) : std::nullopt;
}

void save_drape(const std::string& folder, const std::string& key, const Drape& drape) {
  if (folder.empty()) return;
  Writer writer;
  writer.text(key);
  writer.number(static_cast<std::uint64_t>(drape.notes.size()));
  for (const std::string& note : drape.notes) writer.text(note);
  for (const std::vector<Vec3d>& positions : drape.positions) {
    writer.number(static_cast<std::uint64_t>(positions.size()));
    for (Vec3d p : positions)
      for (double x : {p.x, p.y, p.z}) writer.number(x);
  }

  Writer file;
  file.number(sum_of(writer.bytes()));
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  try {
    write_file(path_of(folder, key), std::string(kMagic) + file.bytes() + writer.bytes());
    remove_oldest_drapes(folder);
  } catch (const InputError&) {
    // The next run dresses again.
  }
}

}  // namespace icloth
