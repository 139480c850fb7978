#include "sim/linear/aggregation.h"

#include <algorithm>
#include <utility>

#include "kernels/index.h"

namespace icloth {
namespace {

/// Calls visit(j) for every neighbour j of node i.
template <class Visit>
void for_neighbours(const Graph& graph, Index i, const Visit& visit) {
  for (Index k = graph.first[at(i)]; k < graph.first[at(i) + 1]; ++k) visit(graph.neighbour[at(k)]);
}

/// Turns counts in first[1 …] into offsets.
void add_up(std::vector<Index>& first) {
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
}

/// Grows the groups one after the other. Seeds are taken from a queue of nodes next to finished
/// groups, so that no gaps are left behind.
class Growth {
 public:
  Growth(const Graph& graph, Index size)
      : graph_(graph), size_(size), known_by_(at(graph.size()), 0), waiting_(known_by_) {
    result_.group.assign(at(graph.size()), kNone);
  }

  Aggregation run() {
    for (Index i = 0; i < graph_.size(); ++i) {
      seeds_.push_back(i);

      // Nodes next to a finished group come first, in the order in which they were met.
      for (; next_seed_ < seeds_.size(); ++next_seed_)
        if (free(seeds_[next_seed_])) grow(seeds_[next_seed_]);
    }

    // Groups that found no room are dissolved at the end.
    give_away_small_groups();
    return std::move(result_);
  }

 private:
  bool free(Index i) const { return result_.group[at(i)] == kNone; }

  /// Grows one group from its seed, node by node.
  void grow(Index seed) {
    met_.clear();
    Index members = 0;

    // Each new member makes its neighbours better known; the free node that most members know is
    // next, which keeps the group compact.
    for (Index next = seed; next != kNone && members < size_; next = most_known()) {
      result_.group[at(next)] = result_.count;
      ++members;
      for_neighbours(graph_, next, [&](Index j) {
        if (free(j) && known_by_[at(j)]++ == 0) met_.push_back(j);
      });
    }

    // The nodes around the group become seeds of later ones.
    for (const Index j : met_) {
      known_by_[at(j)] = 0;
      if (free(j) && !std::exchange(waiting_[at(j)], 1)) seeds_.push_back(j);
    }
    members_.push_back(members);
    ++result_.count;
  }

  /// The free node with the most neighbours in the growing group, or kNone.
  Index most_known() const {
    Index best = kNone;
    for (const Index j : met_)
      if (free(j) && (best == kNone || known_by_[at(j)] > known_by_[at(best)])) best = j;
    return best;
  }

  /// Moves the nodes of groups below a third of the size to a neighbouring group that is neither
  /// small nor full.
  void give_away_small_groups() {
    const Index small = size_ / 3, full = size_ + size_ / 2;
    for (Index i = 0; i < graph_.size(); ++i) {
      Index& mine = result_.group[at(i)];
      if (members_[at(mine)] > small) continue;

      // The node joins the neighbouring group with the fewest members, which evens out the sizes.
      Index best = kNone;
      for_neighbours(graph_, i, [&](Index j) {
        const Index other = result_.group[at(j)];
        if (other == mine || members_[at(other)] <= small || members_[at(other)] >= full) return;
        if (best == kNone || members_[at(other)] < members_[at(best)]) best = other;
      });

      // A node without such a neighbour stays where it is.
      if (best == kNone) continue;
      --members_[at(mine)];
      ++members_[at(best)];
      mine = best;
    }
    renumber();
  }

  /// Numbers the groups that still have members from 0 on.
  void renumber() {
    std::vector<Index> number(members_.size(), kNone);
    result_.count = 0;
    for (std::size_t g = 0; g < members_.size(); ++g)
      if (members_[g] > 0) number[g] = result_.count++;
    for (Index& g : result_.group) g = number[at(g)];
  }

  const Graph& graph_;
  Index size_;
  std::vector<Index> known_by_;  ///< members of the growing group next to each node
  std::vector<Index> waiting_;   ///< 1: is in seeds_ already
  std::vector<Index> met_, seeds_, members_;
  std::size_t next_seed_ = 0;
  Aggregation result_;
};

}  // namespace

Graph graph_of_pattern(const std::vector<Index>& row_first, const std::vector<Index>& column) {
  Graph graph;
  const std::size_t rows = row_first.size() - 1;
  const auto for_edges = [&](const auto& visit) {
    for (std::size_t i = 0; i < rows; ++i)
      for (Index k = row_first[i]; k < row_first[i + 1]; ++k)
        if (column[at(k)] != static_cast<Index>(i)) visit(i, at(column[at(k)]));
  };

  // Every stored block off the diagonal is an edge, and counts at both of its ends.
  graph.first.assign(rows + 1, 0);
  for_edges([&](std::size_t i, std::size_t j) { ++graph.first[i + 1], ++graph.first[j + 1]; });
  add_up(graph.first);

  // A second pass over the edges writes the neighbours to the places that the counts give.
  std::vector<Index> place(graph.first.begin(), graph.first.end() - 1);
  graph.neighbour.resize(at(graph.first.back()));
  for_edges([&](std::size_t i, std::size_t j) {
    graph.neighbour[at(place[i]++)] = static_cast<Index>(j);
    graph.neighbour[at(place[j]++)] = static_cast<Index>(i);
  });
  return graph;
}

Aggregation aggregate(const Graph& graph, Index size) { return Growth(graph, size).run(); }

void coarse_pattern(const Graph& graph, const Aggregation& groups, std::vector<Index>& row_first,
                    std::vector<Index>& column) {
  // Each edge between two groups is noted in the row of the smaller number.
  std::vector<std::vector<Index>> rows(at(groups.count));
  for (Index i = 0; i < graph.size(); ++i)
    for_neighbours(graph, i, [&](Index j) {
      const Index from = groups.group[at(i)], to = groups.group[at(j)];
      if (from < to) rows[at(from)].push_back(to);
    });

  // Sorted rows without duplicates, the diagonal first, are the pattern.
  row_first.assign(1, 0);
  column.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::sort(rows[i].begin(), rows[i].end());
    rows[i].erase(std::unique(rows[i].begin(), rows[i].end()), rows[i].end());
    column.push_back(static_cast<Index>(i));
    column.insert(column.end(), rows[i].begin(), rows[i].end());
    row_first.push_back(static_cast<Index>(column.size()));
  }
}

}  // namespace icloth
