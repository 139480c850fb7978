#include "sim/linear/hierarchy.h"

#include <algorithm>

#include "kernels/parallel/parallel.h"
#include "sim/linear/aggregation.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// The factor by which a piecewise constant correction is too stiff: it takes all of its difference
/// across one row of edges, which costs more energy than a smooth function (Braess 1995, "Towards
/// algebraic multigrid for elliptic problems of second order"). Factors from 1 to 2 make little
/// difference; 1.5 converges fastest.
constexpr Real kOverestimate = Real(1.5);

// The sizes of groups: vertices on the finest level, nodes on the others.
constexpr Index kFirstGroup = 8, kGroup = 4;
constexpr Index kFewNodes = 64;  // a level of so few is the last

/// Notes the nodes of a level below which something was renewed.
struct RenewedNodes {
  View<const Index> child_first, child;
  View<const std::uint8_t> finer;  ///< of the vertices, or of the nodes
  View<std::uint8_t> renewed;
  Index first;

  ICLOTH_HD void operator()(Index k) const {
    const Index i = first + k;
    std::uint8_t any = 0;
    for (Index c = child_first[i]; c < child_first[i + 1]; ++c) any |= finer[child[c]];
    renewed[i] = any;
  }
};

/// Sums up the blocks of one level from those of the finer one, where these were renewed.
struct CoarseBlocks {
  View<const Index> to_row, to_column;  ///< of the blocks
  View<const std::uint8_t> renewed;     ///< (nodes); empty: all
  View<const Index> row, column;        ///< of the finer level
  const Real* entries;                  ///< 9 a block of the finer level
  View<const Real> live;  ///< mass of the finer rows or its inverse: 0 for prescribed ones
  View<const Index> source_first;
  View<const BlockSource> source;
  View<Mat3r> value;
  Index first;

  ICLOTH_HD void operator()(Index k) const {
    const Index block = first + k;
    if (renewed.size() > 0 && renewed[to_row[block]] == 0 && renewed[to_column[block]] == 0) return;
    Mat3r sum{};
    for (Index s = source_first[block]; s < source_first[block + 1]; ++s) {
      const Index from = source[s].block;

      // Prescribed vertices take no part. Blocks below the diagonal are not stored, and come
      // transposed from above it.
      if (!(live[row[from]] > 0) || !(live[column[from]] > 0)) continue;
      const Real* m = entries + 9 * static_cast<std::ptrdiff_t>(from);
      if (source[s].transposed == 0)
        for (int e = 0; e < 9; ++e) sum.m[e] += m[e];
      else
        for (int e = 0; e < 9; ++e) sum.m[e] += m[3 * (e % 3) + e / 3];
    }

    value[block] = (1 / kOverestimate) * sum;
  }
};

/// Completes the diagonal block of a node but for contacts. CoarseBlocks has divided the mass by
/// kOverestimate with the rest, so what is missing of it is added. A block that was not renewed
/// loses the contacts that it was given.
struct AddMass {
  View<const std::uint8_t> renewed;  ///< (nodes); empty: all
  View<const Index> child_first, child;
  View<const Real> inverse_mass;  ///< of the vertices on the finest level, else empty
  View<const Index> row_first;
  View<Mat3r> value, diagonal;
  View<Real> mass;
  Index first;

  ICLOTH_HD void operator()(Index k) const {
    const Index i = first + k;
    Mat3r& block = value[row_first[i]];
    if (renewed.size() > 0 && renewed[i] == 0) {
      block = diagonal[i];
      return;
    }
    Real sum = 0;
    for (Index c = child_first[i]; c < child_first[i + 1]; ++c) sum += mass_of(child[c]);
    block += Mat3r::identity((1 - 1 / kOverestimate) * sum);
    diagonal[i] = block;
    mass[i] = sum;
  }

  ICLOTH_HD Real mass_of(Index c) const {
    if (inverse_mass.size() == 0) return mass[c];
    return inverse_mass[c] > 0 ? 1 / inverse_mass[c] : Real(0);
  }
};

/// The damped inverse of a diagonal block, or zero for a node without free vertices.
ICLOTH_HD Mat3r smoother_of(const Mat3r& block, Real mass) {
  return mass > 0 ? Multilevel::kDamping * inverse_spd(block) : Mat3r{};
}

/// Adds the contacts to the finest level, and makes its smoother and the lumped couplings.
struct FinishFirstLevel {
  View<const Index> child_first, child;
  View<const Real> inverse_mass;
  CouplingView couplings;
  CoarseRows coupled;
  View<const Real> mass;
  View<const Mat3r> diagonal;
  View<Mat3r> lumped, smoother;

  /// At each vertex |w| H is lumped, which is not less than w wᵀ⊗H of one side.
  ICLOTH_HD void operator()(Index i) const {
    Mat3r sum{};
    for (Index c = child_first[i]; c < child_first[i + 1]; ++c)
      if (inverse_mass[child[c]] > 0)
        couplings.of_vertex(
            child[c], [&](Index k, Real w) { sum += couplings.list[k].h.scaled(std::fabs(w)); });
    lumped[i] = sum;

    // The smoother works with the diagonal block of the level, contacts included.
    Mat3r block = diagonal[i];
    coupled.of_row(i, [&](Index j, const Mat3r& contacts) {
      if (j == i) block += contacts;
    });
    smoother[i] = smoother_of(block, mass[i]);
  }
};

/// Adds the lumped couplings of the finer level to a level, and makes its smoother.
struct FinishLevel {
  View<const Index> child_first, child;
  View<const Index> row_first;
  View<const Real> mass;
  View<const Mat3r> diagonal;
  View<Mat3r> value, lumped, smoother;
  Index first;

  ICLOTH_HD void operator()(Index k) const {
    const Index i = first + k;
    Mat3r sum{};
    for (Index c = child_first[i]; c < child_first[i + 1]; ++c) sum += lumped[child[c]];
    lumped[i] = (1 / kOverestimate) * sum;
    Mat3r block = diagonal[i];
    block += lumped[i];
    value[row_first[i]] = block;
    smoother[i] = smoother_of(block, mass[i]);
  }
};

/// The row of each block.
std::vector<Index> rows_of_blocks(const std::vector<Index>& row_first) {
  std::vector<Index> rows(static_cast<std::size_t>(row_first.back()));
  for (std::size_t i = 0; i + 1 < row_first.size(); ++i)
    std::fill(rows.begin() + row_first[i], rows.begin() + row_first[i + 1], static_cast<Index>(i));
  return rows;
}

/// Appends the lists of the places at which each value 0 … values − 1 stands, ascending, as CSR.
void append_places(const std::vector<Index>& value, Index values, Index offset,
                   std::vector<Index>& first, std::vector<Index>& place) {
  std::vector<Index> next(static_cast<std::size_t>(values) + 1, 0);
  for (const Index v : value) ++next[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < next.size(); ++v) next[v] += next[v - 1];

  // The lists go on where those of the levels before end.
  const std::size_t before = place.size();
  for (std::size_t v = 1; v < next.size(); ++v)
    first.push_back(static_cast<Index>(before) + next[v]);
  place.resize(before + value.size());
  for (std::size_t k = 0; k < value.size(); ++k)
    place[before + static_cast<std::size_t>(next[static_cast<std::size_t>(value[k])]++)] =
        offset + static_cast<Index>(k);
}

/// The lists of all levels while they are made on the host.
struct Layout {
  std::vector<Index> child_first{0}, child, parent;
  std::vector<Index> row_first{0}, column;
  std::vector<Index> source_first{0};
  std::vector<BlockSource> source;

  Index nodes() const { return static_cast<Index>(row_first.size()) - 1; }
  Index blocks() const { return static_cast<Index>(column.size()); }

  /// Appends the sources of the coarse blocks (first, columns), which are the finer blocks
  /// (fine_first, fine_columns) between their groups. The finer blocks are numbered from `offset`
  /// on.
  void append_sources(const std::vector<Index>& fine_first, const std::vector<Index>& fine_columns,
                      Index offset, const std::vector<Index>& group,
                      const std::vector<Index>& first, const std::vector<Index>& columns) {
    std::vector<Index> target;              // coarse block of each contribution …
    std::vector<BlockSource> contribution;  // … and the contribution itself
    const std::vector<Index> fine_row = rows_of_blocks(fine_first);
    for (std::size_t k = 0; k < fine_columns.size(); ++k) {
      const Index i = fine_row[k], j = fine_columns[k];
      const Index from = group[static_cast<std::size_t>(i)],
                  to = group[static_cast<std::size_t>(j)];

      // The coarse block stands in the row of the smaller group number.
      const auto row = static_cast<std::size_t>(std::min(from, to));
      const auto found = std::lower_bound(columns.begin() + first[row],
                                          columns.begin() + first[row + 1], std::max(from, to));
      const Index block = static_cast<Index>(found - columns.begin());

      // A finer block between two groups adds itself, or its transpose where the order of the
      // groups is reversed. Inside a group it adds both, as only one of the two is stored.
      const Index number = offset + static_cast<Index>(k);
      if (from <= to) {
        target.push_back(block);
        contribution.push_back({number, 0});
      }
      if (from > to || (from == to && i != j)) {
        target.push_back(block);
        contribution.push_back({number, 1});
      }
    }

    // The contributions are ordered by the coarse block that they add to.
    std::vector<Index> place;
    const Index before = source_first.back();
    std::vector<Index> local{0};
    append_places(target, static_cast<Index>(columns.size()), 0, local, place);
    for (std::size_t b = 1; b < local.size(); ++b) source_first.push_back(before + local[b]);
    for (const Index k : place) source.push_back(contribution[static_cast<std::size_t>(k)]);
  }

  /// Appends the pattern of a level, with rows and blocks numbered on.
  void append_pattern(const std::vector<Index>& first, const std::vector<Index>& columns) {
    const Index node = nodes(), block = blocks();
    for (std::size_t i = 1; i < first.size(); ++i) row_first.push_back(block + first[i]);
    for (const Index j : columns) column.push_back(node + j);
  }
};

}  // namespace

void Hierarchy::set_up(const std::vector<Index>& row_first, const std::vector<Index>& column) {
  levels_ = 0;
  Layout layout;
  std::vector<Index> fine_first = row_first, fine_column = column;
  while (levels_ < Multilevel::kMaxLevels) {
    // A level groups the nodes of the finer one, until few are left or the groups no longer shrink
    // the problem.
    const Graph graph = graph_of_pattern(fine_first, fine_column);
    if (graph.size() <= (levels_ == 0 ? 0 : kFewNodes)) break;
    const Aggregation groups = aggregate(graph, levels_ == 0 ? kFirstGroup : kGroup);
    if (groups.count > graph.size() / 2) break;  // pieces that have nothing to do with each other

    // The numbers of nodes and blocks run on through all levels.
    std::vector<Index> first, columns;
    coarse_pattern(graph, groups, first, columns);
    const Index finer_node = levels_ == 0 ? 0 : level_[levels_ - 1].first;
    const Index finer_block = levels_ == 0 ? 0 : blocks_[levels_ - 1].first;
    level_[levels_] = {layout.nodes(), groups.count};
    blocks_[levels_] = {layout.blocks(), static_cast<Index>(columns.size())};
    if (levels_ == 0)
      group_.upload(groups.group);
    else
      for (const Index g : groups.group) layout.parent.push_back(layout.nodes() + g);

    // Kernels follow these lists: children of each node, sources of each block, and the pattern.
    append_places(groups.group, groups.count, finer_node, layout.child_first, layout.child);
    layout.append_sources(fine_first, fine_column, finer_block, groups.group, first, columns);
    layout.append_pattern(first, columns);

    fine_first.swap(first);
    fine_column.swap(columns);
    ++levels_;
  }

  // The nodes of the coarsest level have no parent. All lists go to the device once.
  layout.parent.resize(static_cast<std::size_t>(layout.nodes()), kNone);
  child_first_.upload(layout.child_first);
  child_.upload(layout.child);
  parent_.upload(layout.parent);
  vertex_row_.upload(rows_of_blocks(row_first));
  node_row_.upload(rows_of_blocks(layout.row_first));
  matrix_.set_pattern(layout.row_first, layout.column);
  source_first_.upload(layout.source_first);
  source_.upload(layout.source);

  // The numbers of a system go into arrays of a fixed size.
  renewed_.resize(layout.nodes());
  mass_.resize(layout.nodes());
  for (Array<Mat3r>* a : {&diagonal_, &lumped_, &smoother_}) a->resize(layout.nodes());
  for (Array<Vec3r>* a : {&b_, &z_, &t_}) a->resize(layout.nodes() + kPadding);
}

void Hierarchy::fill_matrix(const SystemView& system, View<const std::uint8_t> renewed) {
  const bool some = renewed.size() > 0;
  const View<const std::uint8_t> nodes = some ? renewed_.view() : View<const std::uint8_t>{};
  for (int l = 0; l < levels_; ++l) {
    if (some)
      for_each("implicit.renewed_nodes", level_[l].count,
               RenewedNodes{.child_first = child_first_.view(),
                            .child = child_.view(),
                            .finer = l == 0 ? renewed : nodes,
                            .renewed = renewed_.view(),
                            .first = level_[l].first});

    // The finest level sums up the blocks of the system, every other one those of the level before.
    CoarseBlocks sum{.to_row = node_row_.view(),
                     .to_column = matrix_.column.view(),
                     .renewed = nodes,
                     .row = vertex_row_.view(),
                     .column = system.column,
                     .entries = system.entries,
                     .live = system.inverse_mass,
                     .source_first = source_first_.view(),
                     .source = source_.view(),
                     .value = matrix_.value.view(),
                     .first = blocks_[l].first};
    if (l > 0) {
      sum.row = node_row_.view();
      sum.column = matrix_.column.view();
      sum.entries = matrix_.value.view().data()->m;
      sum.live = mass_.view();
    }

    for_each("implicit.coarse_blocks", blocks_[l].count, sum);

    // The masses, which must not be divided by kOverestimate, are added to the diagonals.
    for_each("implicit.coarse_masses", level_[l].count,
             AddMass{.renewed = nodes,
                     .child_first = child_first_.view(),
                     .child = child_.view(),
                     .inverse_mass = l == 0 ? system.inverse_mass : View<const Real>{},
                     .row_first = matrix_.row_first.view(),
                     .value = matrix_.value.view(),
                     .diagonal = diagonal_.view(),
                     .mass = mass_.view(),
                     .first = level_[l].first});
  }
}

void Hierarchy::fill_contacts(const SystemView& system) {
  if (levels_ == 0) return;

  // The finest level takes the couplings as they are.
  coupled_.fill(system, group_.view(), level_[0].count);
  for_each("implicit.coarse_nodes", level_[0].count,
           FinishFirstLevel{.child_first = child_first_.view(),
                            .child = child_.view(),
                            .inverse_mass = system.inverse_mass,
                            .couplings = system.couplings,
                            .coupled = coupled_.rows(),
                            .mass = mass_.view(),
                            .diagonal = diagonal_.view(),
                            .lumped = lumped_.view(),
                            .smoother = smoother_.view()});

  // Each coarser level takes its numbers from the level before.
  for (int l = 1; l < levels_; ++l)
    for_each("implicit.coarse_nodes", level_[l].count,
             FinishLevel{.child_first = child_first_.view(),
                         .child = child_.view(),
                         .row_first = matrix_.row_first.view(),
                         .mass = mass_.view(),
                         .diagonal = diagonal_.view(),
                         .value = matrix_.value.view(),
                         .lumped = lumped_.view(),
                         .smoother = smoother_.view(),
                         .first = level_[l].first});
}

Multilevel Hierarchy::view(const SystemView& system, View<const Mat3r> inverse_diagonal) {
  Multilevel m{};
  m.inverse_diagonal = inverse_diagonal;
  m.inverse_mass = system.inverse_mass;
  m.group = group_.view();

  // Residuals are summed up over the children of a node, corrections are taken from its parent.
  m.child_first = child_first_.view();
  m.child = child_.view();
  m.parent = parent_.view();

  m.matrix = matrix_.view();
  m.coupled = coupled_.rows();

  // The vectors serve every application, one level after the other.
  m.smoother = smoother_.view();
  m.b = b_.view();
  m.z = z_.view();
  m.t = t_.view();
  std::copy_n(level_, Multilevel::kMaxLevels, m.level);
  m.levels = levels_;
  return m;
}

double Hierarchy::bytes() const {
  // A level makes two products, and reads or writes each of b, z and t four times.
  const double blocks = matrix_.column.size(), nodes = matrix_.row_first.size();
  return 2 * blocks * (sizeof(Mat3r) + 3 * sizeof(Index)) +
         nodes * (12 * sizeof(Vec3r) + 3 * sizeof(Mat3r) + 8 * sizeof(Index)) +
         2.0 * coupled_.rows().value.size() * (sizeof(Mat3r) + sizeof(Index)) +
         static_cast<double>(group_.size()) * (3 * sizeof(Vec3r) + 2 * sizeof(Index));
}

}  // namespace icloth::ICLOTH_BUILD
