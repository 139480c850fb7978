#include "app/common/element_names.h"

#include <algorithm>
#include <cstdio>

namespace icloth {

ElementNames::ElementNames(const Scene& scene, std::span<const FileLayout> layouts) {
  const auto count = [](const auto& list) { return static_cast<Index>(list.size()); };
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    add("cloth:" + cloth.name, count(cloth.mesh.positions), count(cloth.mesh.faces));
    if (!layouts.empty()) objects_.back().file_numbers = file_numbers(layouts[c]);
  }
  for (const Obstacle& obstacle : scene.obstacles)
    add("obstacle:" + obstacle.name, count(obstacle.mesh.positions), count(obstacle.mesh.faces));
}

void ElementNames::add(std::string name, Index vertices, Index faces) {
  objects_.push_back({std::move(name), vertices_, faces_, {}});
  vertices_ += vertices;
  faces_ += faces;
}

const ElementNames::Object& ElementNames::at_face(Index global) const {
  return *(std::ranges::upper_bound(objects_, global, {}, &Object::first_face) - 1);
}

const ElementNames::Object& ElementNames::at_vertex(Index global) const {
  return *(std::ranges::upper_bound(objects_, global, {}, &Object::first_vertex) - 1);
}

std::string ElementNames::number(const Object& object, Index vertex) {
  const Index local = vertex - object.first_vertex;
  return std::to_string(
      object.file_numbers.empty() ? local : object.file_numbers[static_cast<std::size_t>(local)]);
}

std::string ElementNames::face(Index global) const {
  const Object& object = at_face(global);
  return object.name + " face " + std::to_string(global - object.first_face);
}

std::string ElementNames::vertex(Index global) const {
  const Object& object = at_vertex(global);
  return object.name + " vertex " + number(object, global);
}

/// The vertices of one element, which lie in one object.
std::string ElementNames::vertices(std::span<const Index> globals) const {
  const Object& object = at_vertex(globals.front());
  std::string text = object.name;
  for (const Index v : globals) text += " " + number(object, v);
  return text;
}

std::string ElementNames::pair(const IntersectingFaces& pair) const {
  return face(pair.a) + " — " + face(pair.b);
}

std::string ElementNames::touch(const Touch& touch) const {
  const std::span<const Index> v = touch.v;
  const std::string first = vertices(v.first(1));
  switch (touch.kind) {
    case Touch::Kind::vertex_vertex:
      return "vertex " + first + " lies on vertex " + vertices(v.subspan(1, 1));
    case Touch::Kind::vertex_edge:
      return "vertex " + first + " lies on edge " + vertices(v.subspan(1, 2));
    case Touch::Kind::vertex_face:
      return "vertex " + first + " lies on face " + vertices(v.last(3));
    case Touch::Kind::edge_edge:
      break;
  }
  return "edge " + vertices(v.first(2)) + " touches edge " + vertices(v.last(2));
}

std::string ElementNames::pair(const OffendingPair& pair) const {
  const std::span<const Index> v = pair.vertices;
  if (pair.edge_edge) return "edge " + vertices(v.first(2)) + " — edge " + vertices(v.last(2));
  return "vertex " + vertices(v.first(1)) + " — face " + vertices(v.last(3));
}

int report_start_intersections(const Scene& scene, bool single_precision,
                               std::span<const FileLayout> layouts) {
  constexpr std::size_t shown = 10;

  // A repair that was asked for tells how much it changed.
  if (scene.repair)
    std::fprintf(
        stderr,
        "icloth: start repaired: of %zu pairs of faces %zu are left, %zu vertices moved by "
        "at most %.3g mm\n",
        scene.repair->pairs_before, scene.repair->pairs_left, scene.repair->moved,
        1e3 * scene.repair->largest_move);

  // The remaining pairs are listed by name, up to a limit.
  const auto [pairs, touches] = find_start_conflicts(scene, single_precision);
  const ElementNames names(scene, layouts);
  const auto list = [&](const char* what, const auto& conflicts, const auto& name) {
    if (conflicts.empty()) return;
    std::fprintf(stderr, "icloth: scene '%s' starts with %zu %s:\n", scene.name.c_str(),
                 conflicts.size(), what);
    for (std::size_t i = 0; i < std::min(conflicts.size(), shown); ++i)
      std::fprintf(stderr, "  %s\n", name(conflicts[i]).c_str());
    if (conflicts.size() > shown)
      std::fprintf(stderr, "  … and %zu more\n", conflicts.size() - shown);
  };
  list("pairs of faces that intersect", pairs,
       [&](const IntersectingFaces& pair) { return names.pair(pair); });
  list("places where neighbouring faces touch beside their common vertices", touches,
       [&](const Touch& touch) { return names.touch(touch); });

  // Two of the causes have a remedy that can be named.
  const auto of_kind = [&](Touch::Kind kind) {
    return std::ranges::any_of(touches, [&](const Touch& t) { return t.kind == kind; });
  };
  if (of_kind(Touch::Kind::vertex_edge))
    std::fprintf(stderr, "  A vertex on an edge has to be a vertex of the faces on both sides.\n");
  if (of_kind(Touch::Kind::vertex_vertex))
    std::fprintf(stderr, "  Vertices at one place are joined by \"weld\" in the scene file.\n");
  if (!pairs.empty()) return 1;
  return touches.empty() ? 0 : 2;
}

}  // namespace icloth
