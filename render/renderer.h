// Drawing a published state: fabric, bodies, ground, shadow, handles and markers. The renderer
// never writes the state, and knows nothing of windows.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "render/camera.h"
#include "render/image.h"
#include "render/shared_vertices.h"
#include "sim/scene/input.h"
#include "sim/scene/world.h"

namespace icloth {

/// The appearance of the fabric.
enum class ViewMode {
  shaded,     ///< fabric as the eye sees it
  wireframe,  ///< shaded, with the edges of the mesh
  strain,     ///< faces coloured by the largest principal strain
};

/// Reads the name of a view. Throws InputError that names it and the views that exist.
ViewMode parse_view_mode(std::string_view name);

/// The effort for a picture.
enum class Quality {
  draft,        ///< one sample a pixel, hard work avoided: software rendering while things move
  interactive,  ///< 2 × 2 samples a pixel, soft shadow from one map
  still,        ///< area light and sky sampled by many shadow maps; the same bits every time
};

/// A plumb line from a point to what lies below it.
struct DropLine {
  Vec3d from, to;  ///< [m]
};

struct LineSegment {
  Vec3d a, b;  ///< [m]
};

/// The content of a picture. The spans must stay valid during draw() only.
struct Frame {
  std::span<const Vec3f> positions;            ///< all vertices of the world [m]
  const DevicePositions* on_device = nullptr;  ///< the same on the solver's device; null: none
  std::span<const HandleState> handles{};      ///< line from hit to target, coloured by saturation
  std::span<const Index> marked_faces{};       ///< global faces shown in red, also when hidden
  std::span<const Index> marked_vertices{};    ///< global vertices shown as dots (pins)
  /// Global vertices that are stitched and not sewn yet: lines, coloured by their lengths.
  std::span<const std::array<Index, 2>> stitches{};
  std::span<const Vec3f> hover{};           ///< points under the pointer, drawn as rings [m]
  std::span<const Vec3d> pins{};            ///< where the user pinned the cloth [m]
  std::span<const LineSegment> outlines{};  ///< along the cloth, such as the rim of a held patch
  std::span<const DropLine> drop_lines{};   ///< of hands, which show how deep they are in the scene
  ViewMode view = ViewMode::shaded;
  double strain_range = 0.1;  ///< strain that gets the last colour of the scale
};

/// Draws the pictures of one world.
class Renderer {
 public:
  /// Needs a current context with its functions loaded, here and in every call, also to destroy.
  /// `world` must outlive the renderer. Throws DeviceError when a shader does not compile.
  explicit Renderer(const World& world, VertexOptions options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void set_quality(Quality quality);
  Quality quality() const;

  /// Fills `width` × `height` pixels of a framebuffer (0: the window's) with the finished picture
  /// in sRGB bytes; everything there is overwritten. Blending, depth test and face culling are off
  /// afterwards, the framebuffer is bound, and the viewport covers it.
  void draw(const Frame& frame, const Camera& camera, int width, int height,
            unsigned target_framebuffer);

  /// Height of the floor in the last picture [m].
  double floor() const;

  /// Draws into an image.
  Image picture(const Frame& frame, const Camera& camera, int width, int height);

  /// Tells how the vertices of the last picture reached the GPU and why, for example "host copy
  /// (built without CUDA)".
  std::string upload_path() const;
  /// True when they came by CUDA-OpenGL interop.
  bool shares_vertices() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace icloth
