// Materials, recordings and cameras.
#include <cmath>

#include "app/common/camera_json.h"
#include "sim/files/file_io.h"
#include "sim/scene/input.h"
#include "sim/scene/material_io.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace icloth::fuzz {

std::string read_material(std::string_view bytes) {
  if (leaves_folder(bytes)) return kLeavesFolder;
  write_scratch("material.json", bytes);
  return refusal([] {
    const Material material = load_material("material.json", "material", {scratch_folder()});
    require(std::isfinite(material.density + material.damping), "finite numbers");
    require(material.density > 0 && material.damping >= 0, "density and damping in their ranges");
  });
}

std::string read_recording(std::string_view bytes) {
  const std::string path = write_scratch("recording.json", bytes);
  Recording recording;
  const std::string reason = refusal([&] { recording = load_recording(path); });
  if (!reason.empty()) return reason;
  // A recording that was read can be written and read again, and is the same then.
  const std::string second = scratch_folder() + "/again.json", third = second + "2";
  save_recording(recording, second);
  save_recording(load_recording(second), third);
  require(read_file(second) == read_file(third), "the same recording again");
  return "";
}

std::string read_camera(std::string_view bytes) {
  const auto pose = camera_from_json(std::string(bytes));
  if (!pose) return "no camera";
  const Vec3d sum = pose->eye + pose->target + pose->up;
  require(std::isfinite(sum.x + sum.y + sum.z + pose->fov), "a finite camera");
  require(camera_from_json(camera_to_json(*pose)).has_value(), "the same camera again");
  return "";
}

}  // namespace icloth::fuzz
