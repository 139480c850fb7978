#include "tests/fuzz/support.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace icloth::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr auto kEverything = fs::copy_options::recursive | fs::copy_options::overwrite_existing;

class ScratchFolder {
 public:
  ScratchFolder() {
    const std::string name = "icloth_fuzz_" + std::to_string(::getpid());
    std::error_code error;
    path_ = "/dev/shm/" + name;  // files on a disk are several times slower
    if (!fs::create_directory(path_, error)) path_ = fs::temp_directory_path() / name;
    fs::create_directories(path_ / "materials");
    fs::copy(ICLOTH_FUZZ_FOLDER "/beside", path_, kEverything);
    fs::copy(ICLOTH_FUZZ_FOLDER "/../../assets/materials", path_ / "materials", kEverything);
    name_ = path_.string();
    ::setenv("ICLOTH_ASSETS", name_.c_str(), 1);
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& name() const { return name_; }

 private:
  fs::path path_;
  std::string name_;
};

bool has_slash(const nlohmann::json& json) {
  if (json.is_string()) return json.get_ref<const std::string&>().find('/') != std::string::npos;
  if (!json.is_structured()) return false;
  return std::ranges::any_of(json, [](const auto& element) { return has_slash(element); });
}

}  // namespace

void require_finite(const std::vector<Vec3d>& positions) {
  for (Vec3d p : positions)  // the solver keeps them in single precision
    require(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e37,
            "positions that a float can hold");
}

void require_valid(const TriangleMesh& mesh) {
  require_finite(mesh.positions);
  const auto count = static_cast<Index>(mesh.positions.size());
  for (const Triangle& face : mesh.faces)
    for (Index v : face) require(v >= 0 && v < count, "indices of vertices");
  require(mesh.uv.empty() || mesh.uv.size() == mesh.faces.size(), "uv of every corner, or none");
  for (const auto& corners : mesh.uv)
    for (Vec2d uv : corners) require(std::isfinite(uv.x) && std::isfinite(uv.y), "finite uv");
}

const std::string& scratch_folder() {
  static const ScratchFolder folder;
  return folder.name();
}

std::string write_scratch(const std::string& name, std::string_view bytes) {
  const std::string path = scratch_folder() + "/" + name;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  require(file.good(), "a scratch folder that can be written");
  return path;
}

bool leaves_folder(std::string_view json) {
  const auto parsed = nlohmann::json::parse(json, nullptr, false, true);
  return !parsed.is_discarded() && has_slash(parsed);
}

}  // namespace icloth::fuzz
