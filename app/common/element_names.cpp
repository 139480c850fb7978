#include "app/common/element_names.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <set>

#include "sim/files/text.h"

namespace icloth {
namespace {

bool is_free_in_double(const Scene& scene) {
  const auto [pairs, touches] = find_start_conflicts(scene, false);
  return pairs.empty() && touches.empty();
}

}  // namespace

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

namespace {

/// Vertices of all cloths that are pinned, by their global numbers.
std::set<Index> pinned_vertices(const Scene& scene) {
  std::set<Index> pinned;
  Index first = 0;
  for (const Cloth& cloth : scene.cloths) {
    for (const Index v : cloth.pins) pinned.insert(first + v);
    first += static_cast<Index>(cloth.mesh.positions.size());
  }
  return pinned;
}

/// The given vertices that are pinned or, where none is, the pinned ones that share a face with
/// them.
std::set<Index> pins_near(const Scene& scene, const std::set<Index>& vertices) {
  const std::set<Index> pinned = pinned_vertices(scene);
  std::set<Index> hit, beside;
  std::ranges::set_intersection(vertices, pinned, std::inserter(hit, hit.end()));
  if (!hit.empty() || pinned.empty()) return hit;

  // Otherwise a body may be caught by pins beside the place that it hit.
  Index first = 0;
  for (const Cloth& cloth : scene.cloths) {
    for (const Triangle& t : cloth.mesh.faces)
      if (std::ranges::any_of(t, [&](Index v) { return vertices.contains(first + v); }))
        for (const Index v : t)
          if (pinned.contains(first + v)) beside.insert(first + v);
    first += static_cast<Index>(cloth.mesh.positions.size());
  }
  return beside;
}

}  // namespace

std::string pins_in_the_way(const Scene& scene, const ElementNames& names,
                            const StepReport& report) {
  constexpr std::size_t shown = 8;
  Index cloth_vertices = 0;
  for (const Cloth& cloth : scene.cloths)
    cloth_vertices += static_cast<Index>(cloth.mesh.positions.size());

  // All cloth vertices that collide with a body are looked at; the message names one body.
  std::set<Index> hit;
  Index body = -1;
  for (const OffendingPair& pair : report.offending) {
    const auto of_body =
        std::ranges::find_if(pair.vertices, [&](Index v) { return v >= cloth_vertices; });
    if (of_body == pair.vertices.end()) continue;
    if (body < 0) body = *of_body;
    for (const Index v : pair.vertices)
      if (v < cloth_vertices) hit.insert(v);
  }
  const std::set<Index> pins = pins_near(scene, hit);
  if (pins.empty()) return "";

  // "cloth:shirt vertex 3" names the first pin, the others follow as numbers.
  const auto split = [&](Index v) {
    const std::string name = names.vertex(v);
    const std::size_t place = name.rfind(" vertex ");
    return std::pair(name.substr(0, place), name.substr(place + 8));
  };
  std::string text = split(body).first + " is pushed into the pinned vertices";
  std::size_t count = 0;
  for (const Index v : pins)
    if (count++ < shown) text += " " + split(v).second;
  if (count > shown) text += " … (" + std::to_string(count) + ")";
  return text + " of " + split(*pins.begin()).first;
}

std::vector<Index> faces_of_pairs(std::span<const Triangle> faces,
                                  std::span<const OffendingPair> pairs) {
  std::vector<Index> found;
  const auto holds = [](const Triangle& face, std::span<const Index> vertices) {
    return std::ranges::all_of(vertices, [&](Index v) { return std::ranges::count(face, v) > 0; });
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const bool is_part = std::ranges::any_of(pairs, [&](const OffendingPair& pair) {
      const std::span<const Index> all(pair.vertices);
      const std::size_t first = pair.edge_edge ? 2 : 1;
      return holds(faces[f], all.first(first)) || holds(faces[f], all.subspan(first));
    });
    if (is_part) found.push_back(static_cast<Index>(f));
  }
  return found;
}

std::vector<std::string> start_remedies(const Scene& scene, const StartConflicts& conflicts,
                                        bool single_precision) {
  std::vector<std::string> remedies;
  const auto any_of_kind = [&](Touch::Kind kind) {
    return std::ranges::any_of(conflicts.touches, [&](const Touch& t) { return t.kind == kind; });
  };
  if (any_of_kind(Touch::Kind::vertex_edge))
    remedies.emplace_back("A vertex on an edge has to be a vertex of the faces on both sides.");
  if (any_of_kind(Touch::Kind::vertex_vertex))
    remedies.emplace_back("Vertices at one place are joined by \"weld\" in the scene file.");

  const bool any = !conflicts.pairs.empty() || !conflicts.touches.empty();
  if (any && single_precision && is_free_in_double(scene))
    remedies.emplace_back(kTooCloseForSingle);
  return remedies;
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
  const StartConflicts conflicts = find_start_conflicts(scene, single_precision);
  const std::vector<IntersectingFaces>& pairs = conflicts.pairs;
  const std::vector<Touch>& touches = conflicts.touches;
  const ElementNames names(scene, layouts);
  const auto list = [&](const char* one, const char* many, const auto& places, const auto& name) {
    if (places.empty()) return;
    std::fprintf(stderr, "icloth: scene %s starts with %zu %s:\n", in_quotes(scene.name).c_str(),
                 places.size(), places.size() == 1 ? one : many);
    for (std::size_t i = 0; i < std::min(places.size(), shown); ++i)
      std::fprintf(stderr, "  %s\n", name(places[i]).c_str());
    if (places.size() > shown) std::fprintf(stderr, "  … and %zu more\n", places.size() - shown);
  };
  list("pair of faces that intersect", "pairs of faces that intersect", pairs,
       [&](const IntersectingFaces& pair) { return names.pair(pair); });
  list("place where neighbouring faces touch beside their common vertices",
       "places where neighbouring faces touch beside their common vertices", touches,
       [&](const Touch& touch) { return names.touch(touch); });

  for (const std::string& remedy : start_remedies(scene, conflicts, single_precision))
    std::fprintf(stderr, "  %s\n", remedy.c_str());
  if (!pairs.empty()) return 1;
  return touches.empty() ? 0 : 2;
}

}  // namespace icloth
