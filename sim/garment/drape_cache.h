// Remembers how the garments of a scene hang on their bodies, so that they are dressed once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/scene/scene.h"

namespace icloth {

/// Garments as they hang: all that dressing changes in a scene, and what it told the user.
struct Drape {
  std::vector<std::vector<Vec3d>> positions;  ///< of the cloths of the garments [m], in their order
  std::vector<std::string> notes;
};

/// 32 hex digits that name the drape of a scene as it was loaded: they differ where a pattern, a
/// body, a fabric, a parameter or a source of the solver does. A drape of another solver would make
/// a run depend on what was run before.
std::string drape_key(const Scene& scene);

/// Folder of the cache, $XDG_CACHE_HOME/icloth or ~/.cache/icloth; empty where neither is known.
std::string drape_folder();

/// The drape of that key for this scene; none where the file is missing, damaged or of other sizes.
std::optional<Drape> load_drape(const std::string& folder, const std::string& key,
                                const Scene& scene);

/// Writes a drape and removes the oldest ones above 200. A folder that cannot be written is no
/// error, since the cache can be missing.
void save_drape(const std::string& folder, const std::string& key, const Drape& drape);

}  // namespace icloth
