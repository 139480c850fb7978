// A box against the eight children of a tree node: vectors against the plain loop.
#include "kernels/bvh.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace icloth::ICLOTH_BUILD {
namespace {

/// Numbers of few values, so that boxes often touch; now and then one that is not finite.
class SomeNumbers {
 public:
  float operator()() {
    switch (rare_(random_)) {
      case 0:
        return std::numeric_limits<float>::quiet_NaN();
      case 1:
        return std::numeric_limits<float>::infinity();
      case 2:
        return -std::numeric_limits<float>::infinity();
      case 3:
        return FLT_MAX;
      case 4:
        return -0.0f;
      default:
        return 0.25f * static_cast<float>(common_(random_));
    }
  }

 private:
  std::mt19937 random_{7};
  std::uniform_int_distribution<int> rare_{0, 199}, common_{-4, 4};
};

TEST(Tree, VectorsFindTheChildrenThatThePlainLoopFinds) {
  SomeNumbers number;
  int overlapping = 0, apart = 0;
  for (int trial = 0; trial < 100'000; ++trial) {
    TreeNode node;
    Box box;
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < kTreeWidth; ++c) {
        node.lo[k][c] = number();
        node.hi[k][c] = node.lo[k][c] + std::fabs(number());
      }
      box.lo[k] = number();
      box.hi[k] = box.lo[k] + std::fabs(number());
    }
    const unsigned expected = overlapping_children_one_by_one(node, box);
    ASSERT_EQ(overlapping_children(node, box), expected) << "trial " << trial;
    overlapping += expected != 0 ? 1 : 0;
    apart += expected != 0xFFu ? 1 : 0;
  }
  EXPECT_GT(overlapping, 10'000) << "the trials reach both answers";
  EXPECT_GT(apart, 10'000);
}

TEST(Tree, BoxesThatTouchOverlapAndEmptyOnesDoNot) {
  TreeNode node;
  for (int c = 0; c < kTreeWidth; ++c) set_child(node, c, {});
  set_child(node, 3, {{1, 0, 0}, {2, 1, 1}});
  set_child(node, 6, {{std::nextafter(1.0f, 2.0f), 0, 0}, {2, 1, 1}});
  EXPECT_EQ(overlapping_children(node, {{0, 0, 0}, {1, 1, 1}}), 1u << 3);
}

TEST(Tree, TheLowestBitIsFound) {
  for (int bit = 0; bit < 32; ++bit) EXPECT_EQ(lowest_bit(~0u << bit), bit);
}

}  // namespace
}  // namespace icloth::ICLOTH_BUILD
