#include "sim/collision/tree.h"

#include <algorithm>

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
  TreeLevel below, level;

  ICLOTH_HD void operator()(Index n) const {
    for (int c = 0; c < kTreeWidth; ++c) {
      const Index child = n * kTreeWidth + c;
      MovingBox b;
      if (child < below.count)
        for (int k = 0; k < kTreeWidth; ++k) include(b, child_box(node[below.first + child], k));
      set_child(node[level.first + n], c, b);
    }
  }
};

/// Levels up to this size are left to one block of a GPU, which need not wait for the others.
constexpr Index kSmallLevel = 256;

/// Fits the levels one after the other, in one kernel on a GPU.
struct FitLevels {
  FitLeaves leaves;
  TreeLevel level[kTreeLevels];
  int levels;

  template <class Team>
  ICLOTH_HD void operator()(Team& team) const {
    team.for_each(level[0].count, leaves);
    int l = 1;
    for (; l < levels && level[l].count > kSmallLevel; ++l) fit(team, l);
    team.in_one_block([&](const auto& block) {
      for (int small = l; small < levels; ++small) fit(block, small);
    });
  }

  template <class Team>
  ICLOTH_HD void fit(const Team& team, int l) const {
    team.for_each(level[l].count, FitLevel{leaves.node, level[l - 1], level[l]});
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
  for (int l = 0; l < levels_; ++l) t.level_first[l] = level_[l].first;
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
    level_[levels_++] = {total, count};
    total += count;
  }
  nodes_.resize(total);
  refit(boxes);
}

void Tree::refit(const MovingBoxes& boxes) {
  if (levels_ == 0) return;
  FitLevels fit{.leaves = {boxes, leaves_.view(), nodes_.view()}, .level = {}, .levels = levels_};
  std::copy_n(level_, levels_, fit.level);
  with_device_team("broad_phase.refit", level_[0].count, fit);
}

}  // namespace icloth::ICLOTH_BUILD
