// A bounding volume tree over the boxes of whole motions (kernels/bvh.h).
#pragma once

#include "kernels/parallel/parallel.h"
#include "sim/collision/moving_boxes.h"

namespace icloth::ICLOTH_BUILD {

class Tree {
 public:
  /// Builds the tree over the elements first, first + 1 … boxes.size() − 1, sorted anew (in the
  /// Morton order of their boxes' centres).
  void build(const MovingBoxes& boxes, Index first);
  /// Builds the tree over the listed elements alone.
  void build(const MovingBoxes& boxes, View<const Index> elements);
  /// Takes new boxes and keeps the order of the leaves.
  void refit(const MovingBoxes& boxes);
  bool empty() const { return items_.size() == 0; }
  TreeView view() const;

 private:
  template <class Items>
  void sort(const MovingBoxes& boxes, const Items& items, Index count);

  Array<Index> items_;  ///< element numbers in leaf order
  Array<TreeNode> nodes_;
  Array<std::uint64_t> codes_;
  Index level_first_[kTreeLevels] = {};
  Index level_count_[kTreeLevels] = {};
  int levels_ = 0;
};

}  // namespace icloth::ICLOTH_BUILD
