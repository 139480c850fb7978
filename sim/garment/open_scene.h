// Scenes with garments: loads them and puts the garments on.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/garment/arrange.h"
#include "sim/garment/dressing.h"
#include "sim/scene/scene_io.h"

namespace icloth {

/// How one garment got onto its body.
struct GarmentReport {
  std::string garment;  ///< name of its cloth
  Arrangement arrangement;
  std::optional<DressingReport> dressing;  ///< none: it intersects, or it was not to be dressed
};

/// Puts all garments of a scene on, in the order of their layers. One that cannot start free of
/// intersections stays as it is sewn, and the garments after it too: the start check refuses the
/// scene, and a line in `notes` names the panels.
std::vector<GarmentReport> put_garments_on(Scene& scene, std::vector<std::string>& notes,
                                           const DressingWatch& watch = {});

/// load_scene, then put_garments_on where the scene has garments.
std::shared_ptr<const Scene> open_scene(const std::string& argument,
                                        std::span<const std::string> overrides,
                                        SceneOrigin* origin = nullptr,
                                        const DressingWatch& watch = {},
                                        const SceneLimits& limits = {});

}  // namespace icloth
