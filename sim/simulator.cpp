#include "sim/simulator.h"

#include <tbb/global_control.h>

#include <cstdio>

#include "sim/cuda_devices.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/scene/world.h"
#include "sim/sewing_simulator.h"

// One solver a build; each is compiled from sim/solver.cpp in its own namespace.
namespace icloth::cpu32 {
std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world, int device);
}
namespace icloth::cpu64 {
std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world, int device);
}
#if defined(ICLOTH_HAS_CUDA)
namespace icloth::cuda32 {
std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world, int device);
}
#endif

namespace icloth {
namespace {

/// Far from the origin single precision cannot tell layers apart. Up to half an offset, sheets on
/// a ball come to rest as they do at the origin, within a few millimetres.
void check_resolution(const Scene& scene, const World& world) {
  for (Index v = 0; v < world.cloth_vertices; ++v) {
    const auto i = static_cast<std::size_t>(v);
    const double far = norm_max(world.position[i]), resolution = far * 0x1p-23;
    if (resolution <= 0.5 * scene.parameters.impact_zones.offset) continue;

    // The message counts the vertices of the cloth by itself, as its file does.
    const WorldObject& object = world.objects[static_cast<std::size_t>(world.object[i])];
    char text[200];
    std::snprintf(text, sizeof text,
                  "', vertex %d: %g m from the origin, where single precision resolves %.1e m; "
                  "expected half of impact_zones.offset (%g m) or less, or --precision f64",
                  static_cast<int>(v - object.first_vertex), far, resolution,
                  scene.parameters.impact_zones.offset);
    throw InputError("cloth '" + object.name + text);
  }
}

/// Corners of a face, or layers, that are apart in the scene can be at one place in single
/// precision. Layers are found by the exact test of the start state; corners here.
void check_corners(const World& world) {
  const auto at = [&](Index v) {
    return convert<float>(world.position[static_cast<std::size_t>(v)]);
  };
  for (Index f = 0; f < world.cloth_faces; ++f) {
    const Triangle& face = world.face[static_cast<std::size_t>(f)];
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = face[c], b = face[(c + 1) % 3];
      if (!(at(a) == at(b))) continue;

      // The face is sound in double precision, so the message offers that build.
      const WorldObject& object =
          world.objects[static_cast<std::size_t>(world.object[static_cast<std::size_t>(a)])];
      throw InputError("cloth " + in_quotes(object.name) + ", face " +
                       std::to_string(f - object.first_face) + ": vertices " +
                       std::to_string(a - object.first_vertex) + " and " +
                       std::to_string(b - object.first_vertex) +
                       " are at one place in single precision; expected them apart, or "
                       "--precision f64");
    }
  }
}

/// A simulator of a scene in which seams are springs that nobody welds.
std::unique_ptr<Simulator> make_one_solver(Build build, std::shared_ptr<const Scene> scene);

}  // namespace

std::string_view build_name(Build build) {
  switch (build) {
    case Build::cpu32:
      return "cpu32";
    case Build::cpu64:
      return "cpu64";
    case Build::cuda32:
      return "cuda32";
  }
  return "";
}

bool build_available(Build build, std::string* reason) {
  return build != Build::cuda32 || cuda_device_usable(cuda_device(), reason);
}

std::unique_ptr<Simulator> make_simulator(Build build, std::shared_ptr<const Scene> scene) {
  // A missing device and an empty scene are refused before the work for the world is done.
  std::string reason;
  if (!build_available(build, &reason))
    throw DeviceError(std::string(build_name(build)) + ": " + reason);
  if (scene->cloths.empty())
    throw InputError("scene " + in_quotes(scene->name) + ": no cloths, expected at least one");
  if (!scene->seams.empty())
    return std::make_unique<SewingSimulator>(build, std::move(scene), &make_one_solver);
  return make_one_solver(build, std::move(scene));
}

namespace {

std::unique_ptr<Simulator> make_one_solver(Build build, std::shared_ptr<const Scene> scene) {
  World world = make_world(*scene);

  // Single precision may not tell places apart that differ in the scene.
  if (build != Build::cpu64) {
    check_resolution(*scene, world);
    check_corners(world);
  }

  // Each build has its own namespace, and only that of CUDA has a device to choose.
  switch (build) {
    case Build::cpu32:
      return cpu32::make_solver(std::move(scene), std::move(world), 0);
    case Build::cpu64:
      return cpu64::make_solver(std::move(scene), std::move(world), 0);
    case Build::cuda32:
#if defined(ICLOTH_HAS_CUDA)
      return cuda32::make_solver(std::move(scene), std::move(world), cuda_device());
#endif
      break;
  }
  throw DeviceError("no such build");
}

}  // namespace

void set_thread_count(int threads) {
  static std::unique_ptr<tbb::global_control> limit;
  limit.reset();  // the smallest of all living limits counts
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
}

}  // namespace icloth
