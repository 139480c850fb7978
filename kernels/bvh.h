// A bounding volume tree with eight children a node, implicit over the elements in Morton order:
// node i of a level holds the boxes of nodes 8i … 8i+7 of the level below, and a refit is one
// parallel pass a level. It has no pointers and no atomics, and is the same on every device.
#pragma once

#include <cfloat>

#if !defined(__CUDACC__) && defined(__SSE2__)
#include <immintrin.h>
#endif

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

inline constexpr int kTreeWidth = 8;
inline constexpr int kTreeLevels = 11;  ///< 8¹¹ > 2³¹ elements

/// A box in single precision, rounded outward where it is made.
struct Box {
  float lo[3] = {FLT_MAX, FLT_MAX, FLT_MAX};
  float hi[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
};

ICLOTH_HD inline void include(Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k) {
    a.lo[k] = b.lo[k] < a.lo[k] ? b.lo[k] : a.lo[k];
    a.hi[k] = b.hi[k] > a.hi[k] ? b.hi[k] : a.hi[k];
  }
}

/// The smallest box around two points, padded; rounding goes outward.
ICLOTH_HD inline Box swept_box(Vec3r a, Vec3r b, Real pad) {
  const Real p[3] = {a.x, a.y, a.z}, q[3] = {b.x, b.y, b.z};
  Box box;
  for (int k = 0; k < 3; ++k) {
    const Real low = (p[k] < q[k] ? p[k] : q[k]) - pad, high = (p[k] > q[k] ? p[k] : q[k]) + pad;
    // Three float roundings happen at most; 4 ulp outward cover them.
    box.lo[k] = static_cast<float>(low) - 2.4e-7f * std::fabs(static_cast<float>(low)) - FLT_MIN;
    box.hi[k] = static_cast<float>(high) + 2.4e-7f * std::fabs(static_cast<float>(high)) + FLT_MIN;
  }
  return box;
}

/// The boxes of eight children, stored coordinate by coordinate so that one vector comparison tests
/// all of them.
struct TreeNode {
  float lo[3][kTreeWidth], hi[3][kTreeWidth];
};

ICLOTH_HD inline Box child_box(const TreeNode& node, int child) {
  Box box;
  for (int k = 0; k < 3; ++k) box.lo[k] = node.lo[k][child], box.hi[k] = node.hi[k][child];
  return box;
}

ICLOTH_HD inline void set_child(TreeNode& node, int child, const Box& box) {
  for (int k = 0; k < 3; ++k) node.lo[k][child] = box.lo[k], node.hi[k][child] = box.hi[k];
}

/// A tree as kernels see it.
struct TreeView {
  View<const TreeNode> nodes;  ///< all levels, the lowest first
  View<const Index> items;     ///< element of each leaf, in Morton order
  Index level_first[kTreeLevels] = {};
  int levels = 0;  ///< 0: empty tree
};

/// Compares a box with all children of a node: bit c of the result is set where child c overlaps
/// it. This is the plain version, for devices and for processors without the vectors below; not
/// even a number that is not finite makes the two differ.
ICLOTH_HD inline unsigned overlapping_children_one_by_one(const TreeNode& node, const Box& box) {
  unsigned mask = 0;
  for (int c = 0; c < kTreeWidth; ++c) {
    bool apart = false;
    for (int k = 0; k < 3; ++k)
      apart = apart | (node.lo[k][c] > box.hi[k]) | (box.lo[k] > node.hi[k][c]);
    mask |= static_cast<unsigned>(!apart) << c;
  }
  return mask;
}

/// The same in vector registers: eight children in one comparison with AVX, four without. It is
/// written in intrinsics because g++ 12 compiles the plain loop to one comparison a number.
ICLOTH_HD inline unsigned overlapping_children(const TreeNode& node, const Box& box) {
#if defined(__CUDACC__) || !defined(__SSE2__)
  return overlapping_children_one_by_one(node, box);

#elif defined(__AVX__)
  // A child is apart where it lies above or below in one of the axes.
  __m256 apart = _mm256_setzero_ps();
  for (int k = 0; k < 3; ++k) {
    const __m256 above =
        _mm256_cmp_ps(_mm256_loadu_ps(node.lo[k]), _mm256_set1_ps(box.hi[k]), _CMP_GT_OQ);
    const __m256 below =
        _mm256_cmp_ps(_mm256_set1_ps(box.lo[k]), _mm256_loadu_ps(node.hi[k]), _CMP_GT_OQ);
    apart = _mm256_or_ps(apart, _mm256_or_ps(above, below));
  }
  return ~static_cast<unsigned>(_mm256_movemask_ps(apart)) & 0xFFu;

#else
  // The same for four children at a time.
  unsigned mask = 0;
  for (int half = 0; half < kTreeWidth; half += 4) {
    __m128 apart = _mm_setzero_ps();
    for (int k = 0; k < 3; ++k) {
      const __m128 above = _mm_cmpgt_ps(_mm_loadu_ps(node.lo[k] + half), _mm_set1_ps(box.hi[k]));
      const __m128 below = _mm_cmpgt_ps(_mm_set1_ps(box.lo[k]), _mm_loadu_ps(node.hi[k] + half));
      apart = _mm_or_ps(apart, _mm_or_ps(above, below));
    }
    mask |= (~static_cast<unsigned>(_mm_movemask_ps(apart)) & 0xFu) << half;
  }
  return mask;
#endif
}

/// The number of the lowest bit that is set in a mask that is not 0.
ICLOTH_HD inline int lowest_bit(unsigned mask) {
#if defined(__CUDA_ARCH__)
  return __ffs(static_cast<int>(mask)) - 1;
#else
  return __builtin_ctz(mask);
#endif
}

/// Calls found(leaf, element) for every leaf after `after_leaf` whose box overlaps. Returns the
/// number of boxes that were compared with.
template <class Found>
ICLOTH_HD Index query_tree(const TreeView& tree, const Box& box, Index after_leaf,
                           const Found& found) {
  if (tree.levels == 0) return 0;
  Index tests = 0;

  // The traversal is depth first with a stack of its own. A level leaves at most kTreeWidth − 1
  // siblings waiting, which bounds the stack.
  struct Entry {
    int level;
    Index node;
  } stack[kTreeLevels * (kTreeWidth - 1) + 1];
  int depth = 0;
  stack[depth++] = {tree.levels - 1, 0};

  // Each node on the stack tests all of its children at once.
  while (depth > 0) {
    const Entry top = stack[--depth];
    tests += kTreeWidth;
    const TreeNode& node = tree.nodes[tree.level_first[top.level] + top.node];
    unsigned mask = overlapping_children(node, box);
    while (mask != 0) {
      const Index child = top.node * kTreeWidth + lowest_bit(mask);
      mask &= mask - 1;

      // Leaves are reported, and inner nodes go on the stack unless all leaves below them come
      // before `after_leaf`.
      if (top.level == 0) {
        if (child > after_leaf) found(child, tree.items[child]);
      } else {
        const Index last_leaf = ((child + 1) << (3 * top.level)) - 1;
        if (last_leaf > after_leaf) stack[depth++] = {top.level - 1, child};
      }
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
