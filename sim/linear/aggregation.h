// Groups of neighbours in a graph, from which the levels of the multilevel preconditioner are made.
#pragma once

#include <vector>

#include "kernels/parallel/platform.h"

namespace icloth {

/// An undirected graph: the neighbours of node i are neighbour[first[i] … first[i + 1] − 1]; there
/// are no loops.
struct Graph {
  std::vector<Index> first{0}, neighbour;

  Index size() const { return static_cast<Index>(first.size()) - 1; }
};

/// Makes the graph of the upper half of a symmetric pattern, whose diagonal is left out.
Graph graph_of_pattern(const std::vector<Index>& row_first, const std::vector<Index>& column);

struct Aggregation {
  Index count = 0;
  std::vector<Index> group;  ///< of each node, 0 … count − 1
};

/// Makes connected groups of about `size` nodes. They are compact, as each grows by the node that
/// most of its members know. Nodes that are left over in between join a neighbour, so no group
/// exceeds 1.5 × size. Equal graphs give equal groups.
Aggregation aggregate(const Graph& graph, Index size);

/// Makes the upper half of the pattern between the groups, with the diagonal first in each row.
void coarse_pattern(const Graph& graph, const Aggregation& groups, std::vector<Index>& row_first,
                    std::vector<Index>& column);

}  // namespace icloth
