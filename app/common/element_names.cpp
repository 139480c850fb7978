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

std::string ElementNames::pair(const OffendingPair& pair) const {
  const std::span<const Index> v = pair.vertices;
  if (pair.edge_edge) return "edge " + vertices(v.first(2)) + " — edge " + vertices(v.last(2));
  return "vertex " + vertices(v.first(1)) + " — face " + vertices(v.last(3));
}

bool report_start_intersections(const Scene& scene, bool single_precision,
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
  const auto pairs = find_start_intersections(scene, single_precision);
  if (pairs.empty()) return false;
  const ElementNames names(scene, layouts);
  std::fprintf(stderr, "icloth: scene '%s' starts with %zu pairs of faces that intersect:\n",
               scene.name.c_str(), pairs.size());
  for (std::size_t i = 0; i < std::min(pairs.size(), shown); ++i)
    std::fprintf(stderr, "  %s\n", names.pair(pairs[i]).c_str());
  if (pairs.size() > shown) std::fprintf(stderr, "  … and %zu more\n", pairs.size() - shown);
  return true;
}

}  // namespace icloth
