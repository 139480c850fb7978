// Boxes in a binary tree: which of many small boxes overlap a given one?
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "kernels/index.h"
#include "sim/files/box.h"

namespace icloth {

/// Boxes in a binary tree, split at the median; nodes in depth-first order. Refers to the boxes
/// that it was made of.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    if (!boxes.empty()) build(0, static_cast<Index>(boxes.size()));
  }

  /// Calls visit(i) for every box i that overlaps `query`.
  template <class Visit>
  void visit(const Box& query, const Visit& visit_box) const {
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (!node.box.overlaps(query)) {
        n = at(node.skip);
        continue;
      }

      // Inner nodes list no boxes. In depth-first order the next node is the first one below.
      for (Index i = node.first; i < node.first + node.count; ++i)
        if (boxes_[at(order_[at(i)])].overlaps(query)) visit_box(order_[at(i)]);
      ++n;
    }
  }

 private:
  static constexpr Index kLeafSize = 4;
  struct Node {
    Box box;
    Index first = 0, count = 0;  // range in order_ of a leaf, empty otherwise
    Index skip = 0;              // next node when this one is not entered
  };

  void build(Index begin, Index end) {
    // A node is numbered before its subtrees, which puts the nodes in depth-first order.
    const std::size_t n = nodes_.size();
    nodes_.push_back({Box{}, begin, end - begin <= kLeafSize ? end - begin : 0, 0});
    for (Index i = begin; i < end; ++i) nodes_[n].box.add(boxes_[at(order_[at(i)])]);

    // Halving at the median of the centres, across the longest side, keeps boxes compact and the
    // tree shallow. Box centres are compared at twice their value.
    if (end - begin > kLeafSize) {
      const Vec3d size = nodes_[n].box.high - nodes_[n].box.low;
      const auto axis = size.x >= size.y && size.x >= size.z ? &Vec3d::x
                        : size.y >= size.z                   ? &Vec3d::y
                                                             : &Vec3d::z;
      const Index middle = begin + (end - begin) / 2;
      std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                       [&](Index a, Index b) {
                         const Box &s = boxes_[at(a)], &t = boxes_[at(b)];
                         return s.low.*axis + s.high.*axis < t.low.*axis + t.high.*axis;
                       });
      build(begin, middle);
      build(middle, end);
    }

    // All nodes numbered since then are below this one, so a query that misses its box continues
    // here.
    nodes_[n].skip = static_cast<Index>(nodes_.size());
  }

  std::span<const Box> boxes_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace icloth
