#include "sim/collision/tree.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct UniteBoxes {
  ICLOTH_HD Box operator()(Box a, const Box& b) const {
    include(a, b);
    return a;
  }
};

/// The elements to sort: a list of elements, or the range from `first` on.
struct Items {
  View<const Index> list;
  Index first;
  ICLOTH_HD Index operator[](Index i) const { return list.data() == nullptr ? first + i : list[i]; }
};

/// The box of the whole motion of an item.
struct BoxAt {
  MovingBoxes box;
  Items items;
  ICLOTH_HD Box operator()(Index i) const { return box[items[i]]; }
};

/// The Morton code of the centre of an item's box, within the bounds of all items.
struct MortonCodes {
  MovingBoxes box;
  Items items;
  View<std::uint64_t> code;
  View<Index> item;
  Box bounds;

  ICLOTH_HD void operator()(Index i) const {
    const Box b = box[items[i]];
    float p[3];
    for (int k = 0; k < 3; ++k) {
      const float extent = bounds.hi[k] - bounds.lo[k];
      p[k] = extent > 0 ? (0.5f * (b.lo[k] + b.hi[k]) - bounds.lo[k]) / extent : 0.0f;
    }
    code[i] = morton_code(p[0], p[1], p[2]);
    item[i] = items[i];
  }
};

/// Fits the lowest level to the boxes of the items; missing children get empty boxes.
struct FitLeaves {
  MovingBoxes box;
  View<const Index> item;
  View<TreeNode> node;

  ICLOTH_HD void operator()(Index n) const {
    for (int c = 0; c < kTreeWidth; ++c) {
      const Index leaf = n * kTreeWidth + c;
      set_child(node[n], c, leaf < item.size() ? box.at(item[leaf]) : MovingBox{});
    }
  }
};

/// Fits a level to the boxes of the level below it.
struct FitLevel {
  View<TreeNode> node;
  Index below, below_count, level;

  ICLOTH_HD void operator()(Index n) const {
    for (int c = 0; c < kTreeWidth; ++c) {
      const Index child = n * kTreeWidth + c;
      MovingBox b;
      if (child < below_count)
        for (int k = 0; k < kTreeWidth; ++k) include(b, child_box(node[below + child], k));
      set_child(node[level + n], c, b);
    }
  }
};

}  // namespace

template <class Items>
void CurveOrder::sort_items(const MovingBoxes& boxes, const Items& items, Index count) {
  elements_.resize(count);
  codes_.resize(count);
  if (count == 0) return;
  const Box bounds = reduce("broad_phase.bounds", count, Box{}, BoxAt{boxes, items}, UniteBoxes{});
  for_each("broad_phase.morton", count,
           MortonCodes{boxes, items, codes_.view(), elements_.view(), bounds});
  sort_by_key("broad_phase.sort", codes_.view(), elements_.view(), 30);
}

void CurveOrder::sort(const MovingBoxes& boxes, Index first) {
  sort_items(boxes, Items{{}, first}, boxes.size() - first);
}

void CurveOrder::sort(const MovingBoxes& boxes, View<const Index> elements) {
  sort_items(boxes, Items{elements, 0}, elements.size());
}

TreeView Tree::view() const {
  TreeView t;
  t.nodes = nodes_.view();
  t.items = leaves_.view();
  t.levels = levels_;
  for (int l = 0; l < levels_; ++l) t.level_first[l] = level_first_[l];
  return t;
}

void Tree::build(const MovingBoxes& boxes, Index first) {
  leaves_.sort(boxes, first);
  make_levels(boxes);
}

void Tree::build(const MovingBoxes& boxes, View<const Index> elements) {
  leaves_.sort(boxes, elements);
  make_levels(boxes);
}

void Tree::make_levels(const MovingBoxes& boxes) {
  levels_ = 0;
  if (empty()) return;

  // Each level has an eighth of the nodes of the one below, down to a single root.
  Index total = 0;
  for (Index count = leaves_.size(); levels_ == 0 || count > 1;) {
    count = (count + kTreeWidth - 1) / kTreeWidth;
    level_first_[levels_] = total;
    level_count_[levels_++] = count;
    total += count;
  }
  nodes_.resize(total);
  refit(boxes);
}

void Tree::refit(const MovingBoxes& boxes) {
  if (levels_ == 0) return;
  for_each("broad_phase.leaves", level_count_[0], FitLeaves{boxes, leaves_.view(), nodes_.view()});
  for (int l = 1; l < levels_; ++l)
    for_each("broad_phase.refit", level_count_[l],
             FitLevel{nodes_.view(), level_first_[l - 1], level_count_[l - 1], level_first_[l]});
}

}  // namespace icloth::ICLOTH_BUILD
