// Some corners of a polygon in a tree: which of them lie in a triangle?
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "kernels/index.h"
#include "kernels/vec.h"
#include "sim/files/grid_point.h"

namespace icloth {

/// Corners can be left out and taken in again. Refers to the points that it was made of.
class CornerTree {
 public:
  CornerTree() = default;
  CornerTree(std::span<const GridPoint> points, std::vector<Index> corners)
      : points_(points), order_(std::move(corners)), leaf_of_(points.size(), kNone) {
    if (!order_.empty()) build(0, static_cast<Index>(order_.size()), kNone);
    counts_.assign(points.size(), false);
    for (const Index i : order_) set(i, true);
  }

  /// Whether a corner counts from now on. One that the tree was not made of never does.
  void set(Index corner, bool counts) {
    if (leaf_of_.empty() || leaf_of_[at(corner)] == kNone || counts_[at(corner)] == counts) return;
    counts_[at(corner)] = counts;
    for (Index n = leaf_of_[at(corner)]; n != kNone; n = nodes_[at(n)].parent)
      nodes_[at(n)].count += counts ? 1 : -1;
  }

  /// Calls `holds(i)` for corners that count, until one call is true: for all that lie in the
  /// triangle, which turns left, or whose turn against its last edge is above −beyond, and for some
  /// others. Whether there was one. Every box that is looked at takes 1 from `budget`.
  template <class Holds>
  bool any(const std::array<GridPoint, 3>& t, double beyond, std::int64_t& budget,
           const Holds& holds) const {
    for (std::size_t n = 0; n < nodes_.size(); --budget) {
      const Node& node = nodes_[n];
      if (node.count == 0 || misses(node, t, beyond)) {
        n = at(node.skip);
        continue;
      }
      for (Index i = node.first; i < node.end; ++i)
        if (counts_[at(order_[at(i)])] && holds(order_[at(i)])) return true;
      ++n;
    }
    return false;
  }

 private:
  static constexpr Index kLeafSize = 8;

  /// Nodes in depth-first order.
  struct Node {
    GridPoint low, high;
    Index parent, skip = 0;    ///< the node to go on with when this one is not entered
    Index first = 0, end = 0;  ///< in order_, of a leaf
    Index count = 0;           ///< corners below it that count
  };

  /// True when the whole box is outside of one edge of the triangle.
  static bool misses(const Node& node, const std::array<GridPoint, 3>& t, double beyond) {
    for (std::size_t k = 0; k < 3; ++k) {
      const GridPoint a = t[k], b = t[(k + 1) % 3];
      const GridPoint most_left{b.y > a.y ? node.low.x : node.high.x,
                                b.x > a.x ? node.high.y : node.low.y};
      const auto side = static_cast<double>(turn(a, b, most_left));
      if (side < (k == 2 ? -beyond : 0)) return true;
    }
    return false;
  }

  void build(Index begin, Index end, Index parent) {
    const std::size_t n = nodes_.size();
    Node node{points_[at(order_[at(begin)])], points_[at(order_[at(begin)])], parent};
    for (Index i = begin; i < end; ++i) {
      const GridPoint p = points_[at(order_[at(i)])];
      node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y)};
      node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y)};
    }
    const bool is_leaf = end - begin <= kLeafSize;
    if (is_leaf) node.first = begin, node.end = end;
    nodes_.push_back(node);

    // Halves at the median across the longer side.
    if (is_leaf) {
      for (Index i = begin; i < end; ++i) leaf_of_[at(order_[at(i)])] = static_cast<Index>(n);
    } else {
      const auto axis =
          node.high.x - node.low.x >= node.high.y - node.low.y ? &GridPoint::x : &GridPoint::y;
      const Index middle = begin + (end - begin) / 2;
      std::nth_element(
          order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
          [&](Index i, Index j) { return points_[at(i)].*axis < points_[at(j)].*axis; });
      build(begin, middle, static_cast<Index>(n));
      build(middle, end, static_cast<Index>(n));
    }
    nodes_[n].skip = static_cast<Index>(nodes_.size());
  }

  std::span<const GridPoint> points_;
  std::vector<Index> order_;    ///< corners, those of a leaf beside each other
  std::vector<Index> leaf_of_;  ///< of each point, kNone where it is not in the tree
  std::vector<bool> counts_;    ///< of each point
  std::vector<Node> nodes_;
};

}  // namespace icloth
