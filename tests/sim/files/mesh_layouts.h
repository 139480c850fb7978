// Flat rectangles cut into triangles in the ways that meshers use.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/support/small_scenes.h"

namespace icloth::testing {

enum class Layout { equilateral, one_diagonal, alternating, cross, jittered };
inline constexpr Layout kLayouts[] = {Layout::equilateral, Layout::one_diagonal,
                                      Layout::alternating, Layout::cross, Layout::jittered};
inline const char* name_of(Layout layout) {
  constexpr const char* names[] = {"equilateral", "one diagonal", "alternating", "cross",
                                   "jittered"};
  return names[static_cast<int>(layout)];
}

/// columns × rows squares of side `edge` in the xz plane from the origin, uv = (x, −z), front up.
inline TriangleMesh make_squares(Layout layout, int columns, int rows, double edge) {
  TriangleMesh mesh;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  const auto id = [&](int i, int j) { return static_cast<Index>(j * (columns + 1) + i); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      Vec2d p{static_cast<double>(i), static_cast<double>(j)};
      const bool inside = i > 0 && i < columns && j > 0 && j < rows;
      if (layout == Layout::jittered && inside) {
        if (2 * i != columns) p.x += jitter(random);  // the middle line stays straight
        p.y += jitter(random);
      }
      mesh.positions.push_back({edge * p.x, 0, -edge * p.y});
    }
  const auto add = [&](Index a, Index b, Index c) { mesh.faces.push_back({a, b, c}); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Index a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
      if (layout == Layout::cross) {
        const Index m = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back({edge * (i + 0.5), 0, -edge * (j + 0.5)});
        add(a, b, m), add(b, c, m), add(c, d, m), add(d, a, m);
        continue;
      }
      const bool other = (layout == Layout::alternating && (i + j) % 2 == 1) ||
                         (layout == Layout::jittered && random() % 2 == 1);
      if (other)
        add(a, b, d), add(b, c, d);
      else
        add(a, b, c), add(a, c, d);
    }
  return mesh;
}

/// columns × rows cells of rows of equilateral triangles that stand across x, as make_squares.
inline TriangleMesh make_equilateral(int columns, int rows, double edge) {
  TriangleMesh mesh;
  std::vector<Index> first{0};
  const double step = 0.8660254037844386 * edge;
  for (int i = 0; i <= columns; ++i) {
    std::vector<double> places;
    for (int j = 0; j <= rows; ++j) places.push_back(j);
    if (i % 2 == 1) {
      places = {0};
      for (int j = 0; j < rows; ++j) places.push_back(j + 0.5);
      places.push_back(rows);
    }
    for (const double place : places) mesh.positions.push_back({step * i, 0, -edge * place});
    first.push_back(static_cast<Index>(mesh.positions.size()));
  }
  for (int i = 0; i < columns; ++i) {
    const Index a = first[static_cast<std::size_t>(i)], b = first[static_cast<std::size_t>(i) + 1];
    // `wide` has the half edges at its ends.
    const bool first_wide = i % 2 == 1;
    const Index wide = first_wide ? a : b, narrow = first_wide ? b : a;
    const auto add = [&](Index p, Index q, Index r) {
      mesh.faces.push_back(first_wide ? Triangle{p, r, q} : Triangle{p, q, r});
    };
    for (Index j = 0; j <= rows; ++j) {
      add(narrow + j, wide + j, wide + j + 1);
      if (j < rows) add(narrow + j, wide + j + 1, narrow + j + 1);
    }
  }
  return mesh;
}

/// Sheet of `columns` × `rows` cells of default fabric, of any layout, with edges of about `edge`.
inline Cloth make_layout(Layout layout, int columns, int rows, double edge) {
  Cloth cloth;
  cloth.name = name_of(layout);
  cloth.mesh = layout == Layout::equilateral ? make_equilateral(columns, rows, edge)
                                             : make_squares(layout, columns, rows, edge);
  cloth.rest = cloth.mesh.positions;
  cloth.material = load_material("default", "");
  return cloth;
}

}  // namespace icloth::testing
