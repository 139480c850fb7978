// Rectangles of cloth in rows of nearly equilateral triangles.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scene/shapes.h"

namespace icloth {
namespace {

struct Resolution {
  Index columns, rows;  ///< triangles: rows · (2·columns + 1)
};

/// Rows and columns whose triangles are as equilateral as the wanted count allows.
Resolution choose_resolution(const GridShape& shape) {
  const double wanted = std::max<double>(shape.triangles, 2);
  const double edge = std::sqrt(shape.width * shape.height / wanted * 4 / std::numbers::sqrt3);
  const double best = std::round(shape.height / (edge * std::numbers::sqrt3 / 2));
  const double rows = std::clamp(best, 1.0, std::max(1.0, std::round(wanted / 3)));
  const double columns = std::max(1.0, std::round((wanted / rows - 1) / 2));
  return {static_cast<Index>(columns), static_cast<Index>(rows)};
}

/// Material coordinates, row by row. Shifted rows have one vertex more: both borders and between
/// them the middles of the other rows' edges.
void place_vertices(const GridShape& shape, Resolution size, std::vector<Vec2d>& uv,
                    std::vector<Index>& row_start) {
  for (Index j = 0; j <= size.rows; ++j) {
    row_start.push_back(static_cast<Index>(uv.size()));
    const double v = shape.height * j / size.rows;
    const bool shifted = j % 2 == 1;
    const Index count = size.columns + (shifted ? 2 : 1);
    for (Index i = 0; i < count; ++i) {
      double u = shifted ? (i - 0.5) / size.columns : static_cast<double>(i) / size.columns;
      u = std::clamp(u, 0.0, 1.0);
      uv.push_back({shape.width * u, v});
    }
  }
  row_start.push_back(static_cast<Index>(uv.size()));
}

/// Triangles between two neighbouring rows, one of them shifted.
void connect_rows(Index lower, Index upper, Index columns, bool upper_shifted,
                  std::vector<Triangle>& faces) {
  for (Index i = 0; i <= columns; ++i) {
    if (upper_shifted) {
      faces.push_back({lower + i, upper + i + 1, upper + i});
      if (i < columns) faces.push_back({lower + i, lower + i + 1, upper + i + 1});
    } else {
      faces.push_back({lower + i, lower + i + 1, upper + i});
      if (i < columns) faces.push_back({lower + i + 1, upper + i + 1, upper + i});
    }
  }
}

/// Plan of the bend: arc length from the middle to (across, along the legs).
Vec2d bend(const GridShape& shape, double s) {
  const double r = shape.bend_radius;
  if (!(r > 0)) return {s, 0};
  const double half = shape.bend_angle * std::numbers::pi / 360;
  const double angle = std::clamp(s / r, -half, half);
  const double leg = s - r * angle;
  return {r * std::sin(angle) + leg * std::cos(angle),
          -r * std::cos(angle) + std::abs(leg) * std::sin(half)};
}

}  // namespace

GridMesh make_grid(const GridShape& shape) {
  const Resolution size = choose_resolution(shape);
  GridMesh grid;
  std::vector<Vec2d> uv;
  place_vertices(shape, size, uv, grid.row);

  // Even rows lie below a shifted one, odd rows above one, and their triangles are mirrored.
  for (Index j = 0; j < size.rows; ++j) {
    const auto row = static_cast<std::size_t>(j);
    connect_rows(grid.row[row], grid.row[row + 1], size.columns, j % 2 == 0, grid.mesh.faces);
  }

  // At rest the sheet is a flat rectangle; at the start it may be bent and lie horizontally.
  for (Vec2d point : uv) {
    const double y = point.y - shape.height / 2;
    const Vec2d plan = bend(shape, point.x - shape.width / 2);
    grid.rest.push_back({point.x, point.y, 0});
    grid.mesh.positions.push_back(shape.horizontal ? Vec3d{plan.x, -plan.y, -y}
                                                   : Vec3d{plan.x, y, plan.y});
  }

  // The rectangle is the material space, so weft is u and warp is v on every face.
  for (const Triangle& face : grid.mesh.faces) {
    std::array<Vec2d, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = uv[static_cast<std::size_t>(face[c])];
    grid.mesh.uv.push_back(corners);
  }
  return grid;
}

std::vector<std::string_view> grid_vertex_names() {
  return {"top_left",  "top_right",  "bottom_left",   "bottom_right", "left_end",
          "right_end", "top_middle", "bottom_middle", "center",       "top",
          "bottom",    "left",       "right"};
}

std::vector<Index> grid_vertices(const GridMesh& grid, std::string_view name) {
  const std::size_t rows = grid.row.size() - 1;
  const auto first = [&](std::size_t row) { return grid.row[row]; };
  const auto last = [&](std::size_t row) { return grid.row[row + 1] - 1; };
  const auto middle = [&](std::size_t row) { return first(row) + (last(row) - first(row)) / 2; };

  // Single vertices end or halve a row.
  if (name == "bottom_left") return {first(0)};
  if (name == "bottom_right") return {last(0)};
  if (name == "top_left") return {first(rows - 1)};
  if (name == "top_right") return {last(rows - 1)};
  if (name == "left_end") return {first(rows / 2)};
  if (name == "right_end") return {last(rows / 2)};
  if (name == "bottom_middle") return {middle(0)};
  if (name == "top_middle") return {middle(rows - 1)};
  if (name == "center") return {middle(rows / 2)};

  // A whole border is the first or last row, or the first or last vertex of each row.
  std::vector<Index> border;
  if (name == "bottom" || name == "top") {
    const std::size_t row = name == "top" ? rows - 1 : 0;
    for (Index v = first(row); v <= last(row); ++v) border.push_back(v);
  } else if (name == "left" || name == "right") {
    for (std::size_t row = 0; row < rows; ++row)
      border.push_back(name == "left" ? first(row) : last(row));
  }
  return border;
}

}  // namespace icloth
