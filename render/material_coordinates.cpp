#include "render/material_coordinates.h"

namespace icloth {

namespace {

using Corners = std::array<Vec2d, 3>;

/// The corners in the face's own frame, the first one at the origin: the columns of Dm.
Corners own_corners(const std::array<double, 4>& inverse) {
  const auto [a, b, c, d] = inverse;
  const double determinant = a * d - b * c;
  if (determinant == 0) return {};
  const double s = 1 / determinant;
  return {Vec2d{0, 0}, Vec2d{s * d, -s * c}, Vec2d{-s * b, s * a}};
}

/// The faces around every cloth vertex, as one list with offsets.
struct Around {
  std::vector<Index> offset, face;

  explicit Around(const World& world)
      : offset(static_cast<std::size_t>(world.cloth_vertices) + 1, 0),
        face(3 * static_cast<std::size_t>(world.cloth_faces)) {
    for (Index f = 0; f < world.cloth_faces; ++f)
      for (Index v : world.face[static_cast<std::size_t>(f)])
        ++offset[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 1; v < offset.size(); ++v) offset[v] += offset[v - 1];

    std::vector<Index> next = offset;
    for (Index f = 0; f < world.cloth_faces; ++f)
      for (Index v : world.face[static_cast<std::size_t>(f)])
        face[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = f;
  }
};

}  // namespace

std::vector<Corners> material_coordinates(const World& world) {
  const auto faces = static_cast<std::size_t>(world.cloth_faces);
  const auto vertices = static_cast<std::size_t>(world.cloth_vertices);
  std::vector<Corners> result(faces);
  std::vector<std::uint8_t> face_done(faces, 0), known(vertices, 0);
  std::vector<Vec2d> at(vertices);
  const Around around(world);
  std::vector<Index> open;

  // Lays one face beside the faces that are already laid out; its first known corner decides the
  // place.
  const auto lay = [&](Index f) {
    const Triangle& t = world.face[static_cast<std::size_t>(f)];
    Corners corners = own_corners(world.face_inverse[static_cast<std::size_t>(f)]);
    Vec2d shift{};
    for (std::size_t k = 3; k-- > 0;)
      if (known[static_cast<std::size_t>(t[k])])
        shift = at[static_cast<std::size_t>(t[k])] - corners[k];

    // Corners that are new get their place, and their other faces come next.
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = corners[k] + shift;
      const auto v = static_cast<std::size_t>(t[k]);
      if (known[v]) continue;
      known[v] = 1;
      at[v] = corners[k];
      open.push_back(t[k]);
    }

    face_done[static_cast<std::size_t>(f)] = 1;
    result[static_cast<std::size_t>(f)] = corners;
  };

  // Each connected piece is laid out from its first face on, breadth first, so that errors of loops
  // stay short.
  for (Index f = 0; f < world.cloth_faces; ++f) {
    if (face_done[static_cast<std::size_t>(f)]) continue;
    open.clear();
    lay(f);
    for (std::size_t next = 0; next < open.size(); ++next) {
      const auto v = static_cast<std::size_t>(open[next]);
      for (Index k = around.offset[v]; k < around.offset[v + 1]; ++k) {
        const Index g = around.face[static_cast<std::size_t>(k)];
        if (!face_done[static_cast<std::size_t>(g)]) lay(g);
      }
    }
  }
  return result;
}

}  // namespace icloth
