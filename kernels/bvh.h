// A bounding volume tree with eight children a node, implicit over the elements in Morton order:
// node i of a level holds the boxes of nodes 8i … 8i+7 of the level below, and a refit is one
// parallel pass a level. It has no pointers and no atomics, and is the same on every device.
#pragma once

#include "kernels/tree_node.h"

namespace icloth::ICLOTH_BUILD {

inline constexpr int kTreeLevels = 11;  ///< 8¹¹ > 2³¹ elements

/// A tree as kernels see it.
struct TreeView {
  View<const TreeNode> nodes;  ///< all levels, the lowest first
  View<const Index> items;     ///< element of each leaf, in Morton order
  Index level_first[kTreeLevels] = {};
  int levels = 0;  ///< 0: empty tree
};

/// The query of one element.
struct OneElement {
  static constexpr int kWidth = 1;
  MovingBox box;

  ICLOTH_HD void set(int, const MovingBox& own) { box = own; }
  ICLOTH_HD const MovingBox& hull() const { return box; }
  ICLOTH_HD const MovingBox& member(int) const { return box; }
  ICLOTH_HD unsigned all() const { return 1; }
  /// The members that may meet a node, all of which a search of the hull has found already.
  ICLOTH_HD unsigned meeting(const MovingBox&) const { return 1; }
};

/// The query of up to eight elements that lie near each other, which descend the tree together.
class EightElements {
 public:
  static constexpr int kWidth = kTreeWidth;

  ICLOTH_HD EightElements() {
    for (int c = 0; c < kWidth; ++c) set_child(boxes_, c, {});
  }
  ICLOTH_HD void set(int member, const MovingBox& box) {
    set_child(boxes_, member, box);
    include(hull_, box);
    all_ |= 1u << member;
  }
  ICLOTH_HD const MovingBox& hull() const { return hull_; }
  ICLOTH_HD MovingBox member(int c) const { return child_box(boxes_, c); }
  ICLOTH_HD unsigned all() const { return all_; }
  ICLOTH_HD unsigned meeting(const MovingBox& node) const { return meeting_children(boxes_, node); }

 private:
  TreeNode boxes_;
  MovingBox hull_;
  unsigned all_ = 0;
};

/// A processor saves most of the descent by queries of eight elements. A device has a thread for
/// each element instead, of which it needs many.
#if defined(__CUDACC__)
using Neighbours = OneElement;
#else
using Neighbours = EightElements;
#endif

/// Calls found(member, element) for every member of a query and every leaf that does not stay apart
/// from it; member m leaves out the leaves up to number after_leaf + m. Returns the number of boxes
/// that were compared with.
template <class Query, class Found>
ICLOTH_HD Index query_tree(const TreeView& tree, const Query& query, Index after_leaf,
                           const Found& found) {
  if (tree.levels == 0) return 0;
  Index tests = 0;

  // Each member of the query is compared with all leaves of a node at once.
  const auto visit_leaves = [&](Index node, unsigned members) {
    for (; members != 0; members &= members - 1) {
      const int member = lowest_bit(members);
      tests += kTreeWidth;
      unsigned mask = meeting_children(tree.nodes[node], query.member(member));
      for (; mask != 0; mask &= mask - 1) {
        const Index leaf = node * kTreeWidth + lowest_bit(mask);
        if (leaf > after_leaf + member) found(member, tree.items[leaf]);
      }
    }
  };
  if (tree.levels == 1) {
    visit_leaves(0, query.all());
    return tests;
  }

  // The traversal is depth first with a stack of its own. A level leaves at most kTreeWidth − 1
  // siblings waiting, which bounds the stack.
  struct Entry {
    int level;
    Index node;
  } stack[kTreeLevels * (kTreeWidth - 1) + 1];
  int depth = 0;
  stack[depth++] = {tree.levels - 1, 0};

  // Each node on the stack tests all of its children at once, with the hull of the query.
  while (depth > 0) {
    const Entry top = stack[--depth];
    tests += kTreeWidth;
    const TreeNode& node = tree.nodes[tree.level_first[top.level] + top.node];
    unsigned mask = meeting_children(node, query.hull());
    for (; mask != 0; mask &= mask - 1) {
      const int c = lowest_bit(mask);
      const Index child = top.node * kTreeWidth + c;

      // Nodes all of whose leaves are left out are passed by.
      const Index last_leaf = ((child + 1) << (3 * top.level)) - 1;
      if (last_leaf <= after_leaf) continue;
      if (top.level > 1)
        stack[depth++] = {top.level - 1, child};
      else
        visit_leaves(child, query.meeting(child_box(node, c)));
    }
  }
  return tests;
}

/// 30-bit Morton code of a point in the unit cube: 10 bits a coordinate, interleaved.
ICLOTH_HD inline std::uint64_t morton_code(float x, float y, float z) {
  std::uint64_t code = 0;
  const float p[3] = {x, y, z};
  for (int k = 0; k < 3; ++k) {
    const float scaled = p[k] * 1024.0f;
    std::uint64_t v = scaled >= 1023.0f ? 1023u : (scaled > 0 ? static_cast<unsigned>(scaled) : 0u);

    // These masks spread the 10 bits so that each is followed by two free ones.
    v = (v | (v << 16)) & 0x030000FFu;
    v = (v | (v << 8)) & 0x0300F00Fu;
    v = (v | (v << 4)) & 0x030C30C3u;
    v = (v | (v << 2)) & 0x09249249u;
    code |= v << (2 - k);
  }
  return code;
}

}  // namespace icloth::ICLOTH_BUILD
