// Drawing the objects of a world, into the picture and into shadow maps.
#pragma once

#include <Eigen/Core>

#include "render/shader_program.h"
#include "render/vertex_buffers.h"
#include "sim/scene/world.h"

namespace icloth {

/// The constant buffers of a world's faces and the programs that draw them. Needs a current
/// context.
class MeshPass {
 public:
  MeshPass(const World& world, const VertexBuffers& vertices);
  ~MeshPass();
  MeshPass(const MeshPass&) = delete;
  MeshPass& operator=(const MeshPass&) = delete;

  /// Draws all objects, lit by the studio's uniform block, into the bound framebuffer.
  void draw(bool draft) const;
  /// Draws their depth as the light sees it. `matrix` leads from the world to the clip space of the
  /// light.
  void draw_depth(const Eigen::Matrix4d& matrix) const;

 private:
  void upload_constants();

  const World& world_;
  ShaderProgram mesh_, draft_, depth_;
  unsigned positions_, normals_;
  unsigned faces_ = 0, inverses_ = 0, threads_ = 0;
  unsigned vertex_array_ = 0, empty_array_ = 0;
};

}  // namespace icloth
