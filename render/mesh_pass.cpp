#include "render/mesh_pass.h"

#include <glad/gl.h>

#include "render/material_coordinates.h"

namespace icloth {

namespace {

struct Tint {
  Vec3f front, back;  ///< linear albedo
};

// The colours of dyed fabrics, each clear against the others; the back of a cloth is paler. Red
// comes late, because markers are red.
constexpr Tint kFabrics[] = {
    {{0.045f, 0.17f, 0.33f}, {0.16f, 0.29f, 0.43f}},  // woad
    {{0.62f, 0.36f, 0.06f}, {0.66f, 0.47f, 0.20f}},   // weld
    {{0.07f, 0.22f, 0.14f}, {0.18f, 0.33f, 0.25f}},   // fir
    {{0.28f, 0.08f, 0.25f}, {0.38f, 0.20f, 0.35f}},   // plum
    {{0.60f, 0.53f, 0.44f}, {0.64f, 0.59f, 0.53f}},   // linen
    {{0.05f, 0.30f, 0.31f}, {0.17f, 0.40f, 0.41f}},   // teal
    {{0.40f, 0.035f, 0.05f}, {0.50f, 0.15f, 0.13f}},  // madder
    {{0.55f, 0.22f, 0.13f}, {0.60f, 0.34f, 0.26f}},   // terracotta
};
constexpr Vec3f kMannequin{0.68f, 0.63f, 0.57f};

/// A buffer that is never written again. It holds one element at least, as it cannot be empty.
template <class T>
GLuint constant_buffer(const std::vector<T>& data) {
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  const T one{};
  const bool empty = data.empty();
  glNamedBufferStorage(buffer, static_cast<GLsizeiptr>(sizeof(T) * (empty ? 1 : data.size())),
                       empty ? &one : data.data(), 0);
  return buffer;
}

}  // namespace

MeshPass::MeshPass(const World& world, const VertexBuffers& vertices)
    : world_(world),
      mesh_("mesh.vert.glsl", "mesh.frag.glsl"),
      draft_("mesh.vert.glsl", "mesh.frag.glsl", true),
      depth_("shadow.vert.glsl", ""),
      positions_(vertices.positions()),
      normals_(vertices.normals()) {
  upload_constants();

  // The picture reads vertices from storage buffers; only the shadow map needs an array of
  // attributes.
  glCreateVertexArrays(1, &empty_array_);
  glCreateVertexArrays(1, &vertex_array_);
  glVertexArrayVertexBuffer(vertex_array_, 0, positions_, 0, sizeof(Vec3f));
  glEnableVertexArrayAttrib(vertex_array_, 0);
  glVertexArrayAttribFormat(vertex_array_, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayElementBuffer(vertex_array_, faces_);
}

MeshPass::~MeshPass() {
  for (GLuint buffer : {faces_, inverses_, threads_}) glDeleteBuffers(1, &buffer);
  for (GLuint array : {vertex_array_, empty_array_}) glDeleteVertexArrays(1, &array);
}

/// The shaders read the faces, their rest frames and the directions of their threads.
void MeshPass::upload_constants() {
  using Float2 = std::array<float, 2>;
  using Float4 = std::array<float, 4>;
  std::vector<Float4> inverses;
  for (const auto& [a, b, c, d] : world_.face_inverse) {
    inverses.push_back({static_cast<float>(a), static_cast<float>(b), static_cast<float>(c),
                        static_cast<float>(d)});
  }

  // Each face has material coordinates of its own, as neighbours may differ at a seam.
  std::vector<Float2> threads;
  for (const auto& corners : material_coordinates(world_))
    for (const Vec2d at : corners)
      threads.push_back({static_cast<float>(at.x), static_cast<float>(at.y)});

  faces_ = constant_buffer(world_.face);
  inverses_ = constant_buffer(inverses);
  threads_ = constant_buffer(threads);
}

void MeshPass::draw(bool draft) const {
  const ShaderProgram& program = draft ? draft_ : mesh_;
  program.use();

  glBindVertexArray(empty_array_);
  const GLuint buffers[] = {positions_, normals_, faces_, inverses_, threads_};
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, 5, buffers);

  // Fabrics take turns; bodies have one colour.
  std::size_t fabric = 0;
  for (const WorldObject& object : world_.objects) {
    const Tint tint =
        object.cloth ? kFabrics[fabric++ % std::size(kFabrics)] : Tint{kMannequin, kMannequin};
    program.set("is_fabric", object.cloth ? 1 : 0);
    program.set("front_colour", tint.front);
    program.set("back_colour", tint.back);
    glDrawArrays(GL_TRIANGLES, 3 * object.first_face, 3 * object.face_count);
  }
}

void MeshPass::draw_depth(const Eigen::Matrix4d& matrix) const {
  const Eigen::Matrix4f elements = matrix.cast<float>();
  depth_.use();
  depth_.set_matrix("light_matrix", elements.data());
  glBindVertexArray(vertex_array_);
  glDrawElements(GL_TRIANGLES, 3 * world_.faces, GL_UNSIGNED_INT, nullptr);
}

}  // namespace icloth
