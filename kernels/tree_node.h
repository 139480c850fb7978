// A node of a bounding volume tree: the moving boxes of eight children, all compared at once.
#pragma once

#include "kernels/box.h"

#if !defined(__CUDACC__) && defined(__SSE2__)
#include <immintrin.h>
#endif

namespace icloth::ICLOTH_BUILD {

inline constexpr int kTreeWidth = 8;

/// The boxes of eight children at one end of their motion, stored coordinate by coordinate so that
/// one vector comparison tests all of them.
struct EightBoxes {
  float lo[3][kTreeWidth], hi[3][kTreeWidth];
};

struct TreeNode {
  EightBoxes start, end;
};

ICLOTH_HD inline Box box_of(const EightBoxes& boxes, int child) {
  Box box;
  for (int k = 0; k < 3; ++k) box.lo[k] = boxes.lo[k][child], box.hi[k] = boxes.hi[k][child];
  return box;
}
ICLOTH_HD inline void set_box(EightBoxes& boxes, int child, const Box& box) {
  for (int k = 0; k < 3; ++k) boxes.lo[k][child] = box.lo[k], boxes.hi[k][child] = box.hi[k];
}

ICLOTH_HD inline MovingBox child_box(const TreeNode& node, int child) {
  return {box_of(node.start, child), box_of(node.end, child)};
}
ICLOTH_HD inline void set_child(TreeNode& node, int child, const MovingBox& box) {
  set_box(node.start, child, box.start);
  set_box(node.end, child, box.end);
}

/// Compares a moving box with all children of a node: bit c of the result is set unless child c
/// stays apart from it. This is the plain version, for devices and for processors without the
/// vectors below; not even a number that is not finite makes the two differ.
ICLOTH_HD inline unsigned meeting_children_one_by_one(const TreeNode& node, const MovingBox& box) {
  unsigned mask = 0;
  for (int c = 0; c < kTreeWidth; ++c)
    mask |= static_cast<unsigned>(!stay_apart(box, child_box(node, c))) << c;
  return mask;
}

/// The same in vector registers: eight children in one comparison with AVX, four without. It is
/// written in intrinsics because g++ 12 compiles the plain loop to one comparison a number.
ICLOTH_HD inline unsigned meeting_children(const TreeNode& node, const MovingBox& box) {
#if defined(__CUDACC__) || !defined(__SSE2__)
  return meeting_children_one_by_one(node, box);

#elif defined(__AVX__)
  // A child stays apart where it is above at both ends, or below at both, in one of the axes.
  const auto greater = [](__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_GT_OQ); };
  __m256 apart = _mm256_setzero_ps();
  for (int k = 0; k < 3; ++k) {
    const __m256 above =
        _mm256_and_ps(greater(_mm256_loadu_ps(node.start.lo[k]), _mm256_set1_ps(box.start.hi[k])),
                      greater(_mm256_loadu_ps(node.end.lo[k]), _mm256_set1_ps(box.end.hi[k])));
    const __m256 below =
        _mm256_and_ps(greater(_mm256_set1_ps(box.start.lo[k]), _mm256_loadu_ps(node.start.hi[k])),
                      greater(_mm256_set1_ps(box.end.lo[k]), _mm256_loadu_ps(node.end.hi[k])));
    apart = _mm256_or_ps(apart, _mm256_or_ps(above, below));
  }
  return ~static_cast<unsigned>(_mm256_movemask_ps(apart)) & 0xFFu;

#else
  // The same for four children at a time.
  unsigned mask = 0;
  for (int half = 0; half < kTreeWidth; half += 4) {
    __m128 apart = _mm_setzero_ps();
    for (int k = 0; k < 3; ++k) {
      const __m128 above = _mm_and_ps(
          _mm_cmpgt_ps(_mm_loadu_ps(node.start.lo[k] + half), _mm_set1_ps(box.start.hi[k])),
          _mm_cmpgt_ps(_mm_loadu_ps(node.end.lo[k] + half), _mm_set1_ps(box.end.hi[k])));
      const __m128 below = _mm_and_ps(
          _mm_cmpgt_ps(_mm_set1_ps(box.start.lo[k]), _mm_loadu_ps(node.start.hi[k] + half)),
          _mm_cmpgt_ps(_mm_set1_ps(box.end.lo[k]), _mm_loadu_ps(node.end.hi[k] + half)));
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

}  // namespace icloth::ICLOTH_BUILD
