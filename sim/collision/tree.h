// A bounding volume tree over the moving boxes of elements (kernels/bvh.h).
#pragma once

#include "kernels/bvh.h"
#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {

/// Elements along the Morton curve of the centres of their boxes, where neighbours are near each
/// other.
class CurveOrder {
 public:
  /// Sorts the elements first, first + 1 … boxes.size() − 1.
  void sort(const MovingBoxes& boxes, Index first);
  /// Sorts the listed elements.
  void sort(const MovingBoxes& boxes, View<const Index> elements);
  Index size() const { return elements_.size(); }
  View<const Index> view() const { return elements_.view(); }

 private:
  template <class Items>
  void sort_items(const MovingBoxes& boxes, const Items& items, Index count);

  Array<Index> elements_;
  Array<std::uint64_t> codes_;
};

/// The nodes of one level of a tree, which follow one another.
struct TreeLevel {
  Index first, count;
};

class Tree {
 public:
  /// Builds the tree over the elements first, first + 1 … boxes.size() − 1, sorted anew.
  void build(const MovingBoxes& boxes, Index first);
  /// Builds the tree over the listed elements alone.
  void build(const MovingBoxes& boxes, View<const Index> elements);
  /// Takes new boxes and keeps the order of the leaves.
  void refit(const MovingBoxes& boxes);
  bool empty() const { return leaves_.size() == 0; }
  TreeView view() const;
  /// The elements in the order of the leaves.
  const CurveOrder& leaves() const { return leaves_; }

 private:
  /// Lays the levels out over the leaves and fits them.
  void make_levels(const MovingBoxes& boxes);

  CurveOrder leaves_;
  Array<TreeNode> nodes_;
  TreeLevel level_[kTreeLevels] = {};
  int levels_ = 0;
};

}  // namespace icloth::ICLOTH_BUILD
