#include "render/renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <utility>

#include "render/gl_context.h"
#include "render/gl_targets.h"
#include "render/lights.h"
#include "render/mesh_pass.h"
#include "render/overlay.h"
#include "render/shader_program.h"
#include "render/view_matrices.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/scene/parameters.h"

namespace icloth {

namespace {

constexpr int kGroundCorners = 64;  // as in ground.vert.glsl
constexpr std::string_view kViewNames[] = {"shaded", "wireframe", "strain"};

/// The cost of a quality.
struct Settings {
  int samples;       ///< pictures with lights of their own that are averaged
  int side;          ///< samples along one side of a pixel in each of them
  int shadow_size;   ///< texels along one side of the shadow map
  int taps;          ///< reads of the key light's map a pixel
  float tap_radius;  ///< [texels]
};

Settings settings_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 1, 1024, 1, 0};
    case Quality::interactive:
      return {1, 2, 2048, 8, 6};
    case Quality::still:
      break;
  }
  return {64, 1, 1024, 4, 1.5f};
}

/// The uniform block of lights.glsl, std140.
struct StudioBlock {
  float view_projection[16], key_matrix[16], dome_matrix[16];
  float eye[4], key[4], dome[4], ground[4], ray_centre[4], ray_right[4], ray_up[4], options[4];
};

/// These write a matrix or a vector as the uniform block holds it.
void store(float (&out)[16], const Eigen::Matrix4d& m) {
  Eigen::Map<Eigen::Matrix4f>{out} = m.cast<float>();
}

void store(float (&out)[4], Vec3d v, double w = 0) {
  const double values[] = {v.x, v.y, v.z, w};
  std::transform(values, values + 4, out, [](double e) { return static_cast<float>(e); });
}

/// The map from clip space (−1 … 1) to texture space (0 … 1).
Eigen::Affine3d to_texture() { return Eigen::Translation3d(0.5, 0.5, 0.5) * Eigen::Scaling(0.5); }

}  // namespace

ViewMode parse_view_mode(std::string_view name) {
  for (std::size_t k = 0; k < std::size(kViewNames); ++k)
    if (kViewNames[k] == name) return static_cast<ViewMode>(k);
  throw InputError("--view " + in_quotes(name) + ", expected shaded, wireframe or strain");
}

/// The state of the renderer: its programs, buffers and targets. Needs a current context.
struct Renderer::Parts {
  Parts(const World& the_world, VertexOptions options);
  ~Parts();

  void upload(const Frame& frame, const Camera& camera, int width, int height);
  void light(const Frame& frame, const Camera& camera, const LightSample& sample);
  void draw_depth(Target& map, const Eigen::Matrix4d& matrix) const;
  void draw_sample(bool floor) const;
  void draw_ground() const;
  void draw_overlay() const;
  void add_sample(int number) const;
  void finish(int width, int height, GLuint target) const;
  void cover(const ShaderProgram& program) const;

  const World& world;
  Settings settings = settings_of(Quality::interactive);
  Quality quality = Quality::interactive;
  double start_ground = 0;  ///< lowest vertex of the start state [m]
  double ground = 0;        ///< of the present frame [m]
  Bounds bounds;            ///< of the present frame
  int overlay_count = 0;    ///< vertices

  SharedVertices vertices;
  MeshPass meshes;
  ShaderProgram backdrop, ground_disc, draft_ground_disc, overlay, add, resolve;
  Target key_map{Target::Kind::shadow}, dome_map{Target::Kind::shadow};
  Target sample{Target::Kind::sample}, sum{Target::Kind::sum}, bytes{Target::Kind::bytes};
  GLuint studio = 0, overlay_buffer = 0, overlay_array = 0, empty_array = 0;
};

Renderer::Parts::Parts(const World& the_world, VertexOptions options)
    : world(the_world),
      vertices(the_world, std::move(options)),
      meshes(the_world, vertices.buffers()),
      backdrop("screen.vert.glsl", "backdrop.frag.glsl"),
      ground_disc("ground.vert.glsl", "ground.frag.glsl"),
      draft_ground_disc("ground.vert.glsl", "ground.frag.glsl", true),
      overlay("overlay.vert.glsl", "overlay.frag.glsl"),
      add("screen.vert.glsl", "add.frag.glsl"),
      resolve("screen.vert.glsl", "resolve.frag.glsl") {
  // The studio has a uniform block, and the overlay a layout of its vertices.
  glCreateBuffers(1, &studio);
  glNamedBufferStorage(studio, sizeof(StudioBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  glCreateBuffers(1, &overlay_buffer);
  glCreateVertexArrays(1, &empty_array);
  glCreateVertexArrays(1, &overlay_array);
  glVertexArrayVertexBuffer(overlay_array, 0, overlay_buffer, 0, sizeof(OverlayVertex));
  for (GLuint attribute : {0u, 1u}) {
    glEnableVertexArrayAttrib(overlay_array, attribute);
    glVertexArrayAttribBinding(overlay_array, attribute, 0);
    glVertexArrayAttribFormat(overlay_array, attribute, attribute == 0 ? 3 : 4, GL_FLOAT, GL_FALSE,
                              attribute * static_cast<GLuint>(sizeof(Vec3f)));
  }

  // The floor lies under the lowest vertex of the start state.
  if (!world.position.empty()) start_ground = world.position.front().y;
  for (const Vec3d p : world.position) start_ground = std::min(start_ground, p.y);
}

Renderer::Parts::~Parts() {
  for (GLuint buffer : {studio, overlay_buffer}) glDeleteBuffers(1, &buffer);
  for (GLuint array : {overlay_array, empty_array}) glDeleteVertexArrays(1, &array);
}

void Renderer::Parts::upload(const Frame& frame, const Camera& camera, int width, int height) {
  vertices.update(frame.positions, frame.on_device);

  // The bounds of the frame decide where the light looks, and where the floor is.
  bounds = bounds_of(frame.positions, static_cast<std::size_t>(world.cloth_vertices));
  ground = std::min(start_ground, bounds.lowest);

  // Markers change with the camera, so their triangles are made for every frame.
  const std::vector<OverlayVertex> list = overlay_triangles(world, frame, camera, height);
  overlay_count = static_cast<int>(list.size());
  glNamedBufferData(overlay_buffer, static_cast<GLsizeiptr>(list.size() * sizeof(OverlayVertex)),
                    list.data(), GL_STREAM_DRAW);

  // The targets follow the quality and the size of the picture.
  key_map.resize(settings.shadow_size, settings.shadow_size);
  sample.resize(settings.side * width, settings.side * height);
  if (settings.samples == 1) return;
  dome_map.resize(settings.shadow_size, settings.shadow_size);
  sum.resize(width, height);
}

void Renderer::Parts::light(const Frame& frame, const Camera& camera, const LightSample& light) {
  const bool dome = settings.samples > 1;
  const double width = sample.width(), height = sample.height(), aspect = width / height;
  const double texel = 2.04 * bounds.radius / settings.shadow_size;
  const Eigen::Matrix4d key_clip = light_matrix(bounds, light.key);
  const Eigen::Matrix4d dome_clip = light_matrix(bounds, light.dome);
  const double up = camera.half_height();

  // Each sample looks through another point of its pixel, in units of half the picture.
  Eigen::Matrix4d projection = projection_matrix(camera, aspect);
  projection.row(0) += 2 * light.pixel_x / width * projection.row(3);
  projection.row(1) += 2 * light.pixel_y / height * projection.row(3);

  StudioBlock block{};
  store(block.view_projection, projection * view_matrix(camera).matrix());
  store(block.key_matrix, to_texture() * key_clip);
  store(block.dome_matrix, to_texture() * dome_clip);
  store(block.eye, camera.eye());
  store(block.key, light.key, texel);
  store(block.dome, light.dome, dome ? texel : 0);

  // The floor lies a hair lower, so that an obstacle that is the floor wins.
  store(block.ground, {ground - 1e-3 * bounds.radius, bounds.centre.x, bounds.centre.z},
        bounds.radius);
  store(block.ray_centre, camera.forward());
  store(block.ray_right, (up * aspect) * camera.right());
  store(block.ray_up, up * camera.up());
  store(block.options,
        {static_cast<double>(frame.view), frame.strain_range, static_cast<double>(settings.taps)},
        settings.tap_radius);
  glNamedBufferSubData(studio, 0, sizeof block, &block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, studio);

  // A sample needs a shadow map for the key light, and one for the sky if that is sampled.
  draw_depth(key_map, key_clip);
  key_map.bind_texture(0);
  if (dome) draw_depth(dome_map, dome_clip);
  (dome ? dome_map : key_map).bind_texture(1);
}

void Renderer::Parts::draw_depth(Target& map, const Eigen::Matrix4d& matrix) const {
  map.bind();
  glEnable(GL_DEPTH_TEST);

  // Geometry that is nearer to the light than the map's range still casts a shadow.
  glEnable(GL_DEPTH_CLAMP);
  glClear(GL_DEPTH_BUFFER_BIT);

  // The offset keeps faces from shading themselves.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4);
  meshes.draw_depth(matrix);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
}

void Renderer::Parts::draw_sample(bool floor) const {
  sample.bind();
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  meshes.draw(quality == Quality::draft);

  // The backdrop lies at the far plane, so it shows only where no mesh is.
  cover(backdrop);

  if (floor) draw_ground();
  if (overlay_count > 0) draw_overlay();
  glDisable(GL_DEPTH_TEST);
}

// Multiplies the colours behind the floor and hides nothing, so that cloth that falls below it
// stays visible.
void Renderer::Parts::draw_ground() const {
  (quality == Quality::draft ? draft_ground_disc : ground_disc).use();
  glBindVertexArray(empty_array);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDrawArrays(GL_TRIANGLE_FAN, 0, kGroundCorners + 2);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
}

void Renderer::Parts::draw_overlay() const {
  overlay.use();
  glBindVertexArray(overlay_array);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);

  // A first pass without depth test gives a hint of markers behind the cloth.
  glDisable(GL_DEPTH_TEST);
  overlay.set("opacity", 0.35f);
  glDrawArrays(GL_TRIANGLES, 0, overlay_count);

  // The second pass draws them in full where they are visible.
  glEnable(GL_DEPTH_TEST);
  overlay.set("opacity", 1.0f);
  glDrawArrays(GL_TRIANGLES, 0, overlay_count);
  glDisable(GL_BLEND);
}

void Renderer::Parts::add_sample(int number) const {
  sum.bind();
  sample.bind_texture(2);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, number == 0 ? GL_ZERO : GL_ONE);
  add.set("weight", 1.0f / static_cast<float>(settings.samples));
  cover(add);
  glDisable(GL_BLEND);
}

void Renderer::Parts::finish(int width, int height, GLuint target) const {
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glViewport(0, 0, width, height);
  (settings.samples > 1 ? sum : sample).bind_texture(2);
  resolve.set("side", settings.side);
  cover(resolve);
}

void Renderer::Parts::cover(const ShaderProgram& program) const {
  program.use();
  glBindVertexArray(empty_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Renderer::Renderer(const World& world, VertexOptions options)
    : parts_(std::make_unique<Parts>(world, std::move(options))) {}
Renderer::~Renderer() = default;

void Renderer::set_quality(Quality quality) {
  parts_->quality = quality;
  parts_->settings = settings_of(quality);
}

Quality Renderer::quality() const { return parts_->quality; }

std::string Renderer::upload_path() const { return parts_->vertices.path_text(); }

bool Renderer::shares_vertices() const {
  return parts_->vertices.path() == SharedVertices::Path::interop;
}

void Renderer::draw(const Frame& frame, const Camera& camera, int width, int height,
                    unsigned target_framebuffer) {
  if (width < 1 || height < 1) return;

  // The state of OpenGL may have been changed by anybody since the last picture.
  for (GLenum off : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_FRAMEBUFFER_SRGB})
    glDisable(off);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

  // A picture is the mean of samples, each with light from another direction.
  parts_->upload(frame, camera, width, height);
  const int samples = parts_->settings.samples;
  for (int i = 0; i < samples; ++i) {
    parts_->light(frame, camera, light_sample(i, samples));
    parts_->draw_sample(camera.eye().y > parts_->ground);
    if (samples > 1) parts_->add_sample(i);
  }
  parts_->finish(width, height, target_framebuffer);
  check_gl("Renderer::draw");
}

double Renderer::floor() const { return parts_->ground; }

Image Renderer::picture(const Frame& frame, const Camera& camera, int width, int height) {
  parts_->bytes.resize(width, height);
  draw(frame, camera, width, height, parts_->bytes.framebuffer());

  // OpenGL counts rows from below.
  Image flipped(width, height), image(width, height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, flipped.pixels.data());
  for (int y = 0; y < height; ++y)
    std::copy_n(flipped.at(0, height - 1 - y), 4 * width, image.at(0, y));
  return image;
}

}  // namespace icloth
