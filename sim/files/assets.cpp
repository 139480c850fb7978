#include "sim/files/assets.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {

namespace fs = std::filesystem;

std::string assets_folder() {
  if (const char* chosen = std::getenv("ICLOTH_ASSETS"); chosen && *chosen) return chosen;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path folder = program.parent_path();
    for (const fs::path& candidate : {folder / "assets", folder.parent_path() / "share" / "icloth"})
      if (fs::is_directory(candidate / "scenes", error)) return candidate.string();
  }
  return ICLOTH_SOURCE_ASSETS;
}

std::string find_asset(const std::string& name, const std::string& folder) {
  std::error_code error;
  const fs::path beside = fs::path(folder) / name;  // an absolute name replaces the folder
  if (fs::exists(beside, error)) return beside.lexically_normal().string();
  const fs::path shipped = fs::path(assets_folder()) / name;
  return (fs::exists(shipped, error) ? shipped : beside).lexically_normal().string();
}

void require_in_scope(const std::string& path, const std::string& name, const std::string& where,
                      const FileScope& scope) {
  if (scope.anywhere) return;
  if (lies_below(path, scope.folder) || lies_below(path, assets_folder())) return;
  throw InputError(where + ": value " + in_quotes(name) +
                   ", expected a file below the scene's folder (" +
                   shown_path(scope.folder.empty() ? "." : scope.folder) +
                   ") or the program's assets; --allow-outside opens files anywhere");
}

std::string asset_names(const std::string& kind) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(assets_folder() + "/" + kind, error))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  std::string list;
  for (const std::string& name : names) list += " " + name;
  return list;
}

}  // namespace icloth
