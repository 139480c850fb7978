#include "sim/collision/hash_pairs.h"

#include <algorithm>
#include <cmath>

#include "kernels/parallel/partition_point.h"

namespace icloth::ICLOTH_BUILD {
namespace {

constexpr Index kMostCells = 64;     ///< of an element that is put into cells
constexpr Index kTestsPerItem = 32;  ///< box tests that one thread does
constexpr int kBits = 21;            ///< of one coordinate of a cell
constexpr std::uint64_t kLast = (std::uint64_t{1} << kBits) - 1;

/// A uniform grid, whose cells are numbered by three coordinates from 0 on.
struct Grid {
  float origin[3];
  float inverse_cell;

  /// The coordinate of the cell that holds x. All uses share this function, since the token needs
  /// the same rounding everywhere.
  ICLOTH_HD std::uint64_t coordinate(float x, int axis) const {
    const float scaled = (x - origin[axis]) * inverse_cell;
    if (!(scaled > 0)) return 0;
    return scaled >= static_cast<float>(kLast) ? kLast : static_cast<std::uint64_t>(scaled);
  }
};

/// The cells that a box covers.
struct CellRange {
  std::uint64_t low[3];
  std::uint64_t count[3];
};

/// The boxes of elements of two kinds, the second kind numbered on from the first.
struct TwoKinds {
  MovingBoxes first, second;
  ICLOTH_HD Box operator[](Index i) const {
    return i < first.size() ? first[i] : second[i - first.size()];
  }
  ICLOTH_HD Index size() const { return first.size() + second.size(); }
};

ICLOTH_HD CellRange cells_of(const Grid& grid, const Box& box) {
  CellRange r;
  for (int k = 0; k < 3; ++k) {
    r.low[k] = grid.coordinate(box.lo[k], k);
    r.count[k] = grid.coordinate(box.hi[k], k) - r.low[k] + 1;
  }
  return r;
}

ICLOTH_HD std::uint64_t cell_key(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return (x << (2 * kBits)) | (y << kBits) | z;
}

/// The number of cells of an element, 0 for a large one. Products of counts up to 2²¹ fit.
ICLOTH_HD Index cell_count(const CellRange& r) {
  const std::uint64_t count = r.count[0] * r.count[1] * r.count[2];
  return count <= static_cast<std::uint64_t>(kMostCells) ? static_cast<Index>(count) : 0;
}

/// The bounds of all boxes and their mean size, which the grid is made from.
struct Extent {
  Box bounds;
  double length = 0;  ///< sum of the boxes' mean axes
};
struct ExtentOf {
  TwoKinds box;
  ICLOTH_HD Extent operator()(Index i) const {
    const Box b = box[i];
    Extent e{b, 0};
    for (int k = 0; k < 3; ++k) e.length += static_cast<double>(b.hi[k] - b.lo[k]) / 3;
    return e;
  }
};
struct UniteExtents {
  ICLOTH_HD Extent operator()(Extent a, const Extent& b) const {
    include(a.bounds, b.bounds);
    a.length += b.length;
    return a;
  }
};

/// Counts the cells of each element.
struct CountCells {
  TwoKinds box;
  Grid grid;
  View<Index> count;
  ICLOTH_HD void operator()(Index i) const { count[i] = cell_count(cells_of(grid, box[i])); }
};

/// Picks the elements over so many cells that they are kept apart.
struct IsLarge {
  TwoKinds box;
  Grid grid;
  ICLOTH_HD bool operator()(Index i) const { return cell_count(cells_of(grid, box[i])) == 0; }
};

/// Writes an entry (cell, element) for every cell of an element.
struct WriteCells {
  TwoKinds box;
  Grid grid;
  View<const Index> offset;
  View<std::uint64_t> key;
  View<Index> element;
  ICLOTH_HD void operator()(Index i) const {
    const CellRange r = cells_of(grid, box[i]);
    if (cell_count(r) == 0) return;
    Index at = offset[i];
    for (std::uint64_t x = 0; x < r.count[0]; ++x)
      for (std::uint64_t y = 0; y < r.count[1]; ++y)
        for (std::uint64_t z = 0; z < r.count[2]; ++z) {
          key[at] = cell_key(r.low[0] + x, r.low[1] + y, r.low[2] + z);
          element[at++] = i;
        }
  }
};

/// Picks the first entry of each cell.
struct StartsCell {
  View<const std::uint64_t> key;
  ICLOTH_HD bool operator()(Index i) const { return i == 0 || key[i] != key[i - 1]; }
};

/// Sets the end of the last cell.
struct SetEnd {
  View<Index> list;
  Index value;
  ICLOTH_HD void operator()(Index) const { list[list.size() - 1] = value; }
};

/// The entries of one cell, a range of ascending element numbers.
struct CellView {
  View<const Index> element;
  Index first, last;
  /// The number of entries whose element number is below the limit.
  ICLOTH_HD Index below(Index limit) const {
    return partition_point(last - first, [&](Index k) { return element[first + k] < limit; });
  }
};

/// The pairs of edges in a cell: cloth edges with all later ones.
struct EdgePairs {
  TwoKinds box;
  View<const Int2> edge;
  Index cloth;

  struct Cell {
    std::int64_t cloth, all;
  };
  ICLOTH_HD Cell cell(const CellView& c) const { return {c.below(cloth), c.last - c.first}; }
  /// Cloth edges come first, so they pair with one another and with the obstacles' edges behind
  /// them.
  ICLOTH_HD std::int64_t tests(const Cell& c) const {
    return c.cloth * (c.cloth - 1) / 2 + c.cloth * (c.all - c.cloth);
  }
  /// Finds the two places in a cell that test t compares. Row a has the places after a, so that
  /// rows 0 … a − 1 hold a (2 all − a − 1) / 2 tests.
  ICLOTH_HD void decode(const Cell& c, std::int64_t t, Index& a, Index& b) const {
    const auto before = [&](std::int64_t row) { return row * (2 * c.all - row - 1) / 2; };

    // The row is the solution of a quadratic, which rounding may miss by one.
    const double n = static_cast<double>(c.all) - 0.5;
    auto row = static_cast<std::int64_t>(
        n - std::sqrt(std::fmax(n * n - 2.0 * static_cast<double>(t), 0.0)));
    row = row < 0 ? 0 : row;
    while (before(row) > t) --row;
    while (before(row + 1) <= t) ++row;
    a = static_cast<Index>(row);
    b = static_cast<Index>(row + 1 + t - before(row));
  }
  ICLOTH_HD bool allowed(Index a, Index b) const {
    return a < cloth && !share_vertex(edge[a], edge[b]) &&
           !stay_apart(box.first.at(a), box.first.at(b));
  }
  ICLOTH_HD Pair pair(Index a, Index b) const { return {a, b}; }
};

/// The pairs of a vertex and a face in a cell. Vertices are numbered first, faces behind them.
struct VertexFacePairs {
  TwoKinds box;
  View<const Int3> face;
  Index cloth_vertices, vertices, cloth_faces;

  struct Cell {
    std::int64_t vertices, faces;
  };
  ICLOTH_HD Cell cell(const CellView& c) const {
    const Index v = c.below(vertices);
    return {v, c.last - c.first - v};
  }
  ICLOTH_HD std::int64_t tests(const Cell& c) const { return c.vertices * c.faces; }
  ICLOTH_HD void decode(const Cell& c, std::int64_t t, Index& a, Index& b) const {
    a = static_cast<Index>(t / c.faces);
    b = static_cast<Index>(c.vertices + t % c.faces);
  }
  ICLOTH_HD bool allowed(Index a, Index b) const {
    if (a >= vertices || b < vertices) return false;
    const Index f = b - vertices;
    return (a < cloth_vertices || f < cloth_faces) && !has_vertex(face[f], a) &&
           !stay_apart(box.first.at(a), box.second.at(f));
  }
  ICLOTH_HD Pair pair(Index a, Index b) const { return {a, b - vertices}; }
};

/// Counts the work items of each cell, of kTestsPerItem tests each.
template <class Pairs>
struct CountItems {
  Pairs pairs;
  View<const Index> cell_first, element;
  View<Index> count;
  ICLOTH_HD void operator()(Index c) const {
    const std::int64_t tests = pairs.tests(pairs.cell({element, cell_first[c], cell_first[c + 1]}));
    count[c] = static_cast<Index>((tests + kTestsPerItem - 1) / kTestsPerItem);
  }
};

/// Makes the tests of one work item.
template <class Pairs>
struct TestItem {
  Pairs pairs;
  Grid grid;
  View<const std::uint64_t> key;
  View<const Index> cell_first, element, item_first;

  template <class Emit>
  ICLOTH_HD void operator()(Index item, Emit& emit) const {
    // The cell of the item is the last one that starts at or before it.
    const Index c =
        partition_point(item_first.size() - 1, [&](Index k) { return item_first[k] <= item; }) - 1;
    const Index first = cell_first[c];
    const auto cell = pairs.cell({element, first, cell_first[c + 1]});

    // A work item makes its share of the cell's tests.
    const std::int64_t begin = static_cast<std::int64_t>(item - item_first[c]) * kTestsPerItem;
    const std::int64_t all = pairs.tests(cell);
    const std::int64_t end = begin + kTestsPerItem < all ? begin + kTestsPerItem : all;
    for (std::int64_t t = begin; t < end; ++t) {
      Index a = 0, b = 0;
      pairs.decode(cell, t, a, b);
      test(element[first + a], element[first + b], key[first], emit);
    }
  }

  /// Emits a pair that overlaps, in the one cell that holds the lower corner of the overlap (the
  /// token), so that it is found once.
  template <class Emit>
  ICLOTH_HD void test(Index a, Index b, std::uint64_t here, Emit& emit) const {
    const Box p = pairs.box[a], q = pairs.box[b];
    if (!overlap(p, q)) return;
    std::uint64_t token[3];
    for (int k = 0; k < 3; ++k)
      token[k] = grid.coordinate(p.lo[k] > q.lo[k] ? p.lo[k] : q.lo[k], k);
    if (cell_key(token[0], token[1], token[2]) == here && pairs.allowed(a, b))
      emit(pairs.pair(a, b));
  }
};

/// Tests a large element against all others; a pair of two large ones is found from the first.
template <class Pairs>
struct TestLarge {
  Pairs pairs;
  Grid grid;
  View<const Index> large;

  template <class Emit>
  ICLOTH_HD void operator()(Index other, Emit& emit) const {
    const Box box = pairs.box[other];
    const bool other_large = cell_count(cells_of(grid, box)) == 0;
    for (Index k = 0; k < large.size(); ++k) {
      const Index l = large[k];
      if (l == other || (other_large && l < other) || !overlap(pairs.box[l], box)) continue;
      const Index a = l < other ? l : other, b = l < other ? other : l;
      if (pairs.allowed(a, b)) emit(pairs.pair(a, b));
    }
  }
};

/// Picks the pairs with a dirty vertex.
template <class Dirty>
struct IsDirtyPair {
  View<const Pair> pair;
  Dirty dirty;
  ICLOTH_HD bool operator()(Index i) const { return dirty(pair[i]); }
};

/// Chooses the cells from the bounds and the mean size of the boxes.
Grid make_grid(const TwoKinds& box) {
  const Extent e =
      reduce("broad_phase.extent", box.size(), Extent{}, ExtentOf{box}, UniteExtents{});
  // Cells have 1.5 mean extents: smaller ones hold more copies, larger ones cause more tests.
  double cell = 1.5 * e.length / std::max<double>(1, box.size());

  // Coordinates have kBits bits, so cells must not be smaller than the bounds divided by that.
  for (int k = 0; k < 3; ++k)
    cell = std::max(cell, static_cast<double>(e.bounds.hi[k] - e.bounds.lo[k]) / (kLast - 1.0));
  Grid grid{{e.bounds.lo[0], e.bounds.lo[1], e.bounds.lo[2]}, 0};
  grid.inverse_cell = cell > 0 ? static_cast<float>(1 / cell) : 0;
  return grid;
}

}  // namespace

template <class Pairs>
void HashPairs::run(const char* name, const Pairs& pairs, Array<Pair>& list, Candidates& out) {
  const Index n = pairs.box.size();
  const Grid grid = make_grid(pairs.box);

  // Every element is entered into the cells that its box covers; large ones are kept apart.
  entry_first_.resize(n + 1);
  for_each("broad_phase.cells", n, CountCells{pairs.box, grid, entry_first_.view().sub(0, n)});
  compact("broad_phase.large", n, IsLarge{pairs.box, grid}, large_);
  const Index entries =
      exclusive_scan("broad_phase.cells", entry_first_.view().sub(0, n), entry_first_.view());

  key_.resize(entries);
  element_.resize(entries);
  for_each("broad_phase.cells", n,
           WriteCells{pairs.box, grid, entry_first_.view(), key_.view(), element_.view()});

  // Sorted entries make the cells; each ends where the next one begins.
  sort_by_key("broad_phase.sort", key_.view(), element_.view(), 3 * kBits);
  const Index cells = compact("broad_phase.cells", entries, StartsCell{key_.view()}, cell_first_);
  cell_first_.resize_keep(cells + 1);
  for_each("broad_phase.cells", 1, SetEnd{cell_first_.view(), entries});

  // The tests of all cells are dealt out in work items of equal size, as cells differ widely.
  item_first_.resize(cells + 1);
  for_each("broad_phase.work", cells,
           CountItems<Pairs>{pairs, cell_first_.view(), element_.view(), item_first_.view()});
  const Index items =
      exclusive_scan("broad_phase.work", item_first_.view().sub(0, cells), item_first_.view());

  collect(name, items,
          TestItem<Pairs>{.pairs = pairs,
                          .grid = grid,
                          .key = key_.view(),
                          .cell_first = cell_first_.view(),
                          .element = element_.view(),
                          .item_first = item_first_.view()},
          list);
  out.box_tests += std::int64_t{items} * kTestsPerItem;

  // Large elements, if any, are tested against all others.
  if (large_.empty()) return;
  collect(name, n, TestLarge<Pairs>{pairs, grid, large_.view()}, found_);
  out.box_tests += std::int64_t{large_.size()} * n;
  append_pairs(found_, list);
}

void HashPairs::find(const Topology& mesh, const ElementBoxes& boxes, Candidates& out) {
  run("broad_phase.vertex_face",
      VertexFacePairs{{boxes.vertex, boxes.face},
                      mesh.face.view(),
                      mesh.cloth_vertices,
                      mesh.vertices,
                      mesh.cloth_faces},
      out.vertex_faces, out);
  run("broad_phase.edge_edge", EdgePairs{{boxes.edge, {}}, mesh.edge.view(), mesh.cloth_edges},
      out.edge_edges, out);
}

void HashPairs::find_dirty(const Topology& mesh, const ElementBoxes& boxes,
                           View<const std::uint8_t> dirty, Candidates& out) {
  find(mesh, boxes, out);

  // All pairs are found; those without a dirty vertex are dropped.
  const DirtyVertices vertex{dirty};
  const auto keep = [&](Array<Pair>& list, const auto& is_dirty) {
    const Index count = compact("broad_phase.dirty", list.size(), is_dirty, kept_);
    found_.resize(count);
    for_each("broad_phase.dirty", count, PickPairs{list.view(), kept_.view(), found_.view()});
    swap(list, found_);
  };
  keep(out.vertex_faces,
       IsDirtyPair<DirtyVertexFace>{out.vertex_faces.view(), {vertex, {vertex, mesh.face.view()}}});
  keep(out.edge_edges,
       IsDirtyPair<DirtyEdgeEdge>{out.edge_edges.view(), {{vertex, mesh.edge.view()}}});
}

}  // namespace icloth::ICLOTH_BUILD
