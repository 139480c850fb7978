// A moving box against the eight children of a tree node: vectors against the plain loop, and
// queries of eight elements against those of one.
#include "kernels/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>
#include <vector>

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

Box some_box(SomeNumbers& number) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = number();
    box.hi[k] = box.lo[k] + std::fabs(number());
  }
  return box;
}

TEST(Tree, VectorsFindTheChildrenThatThePlainLoopFinds) {
  SomeNumbers number;
  int meeting = 0, apart = 0;
  for (int trial = 0; trial < 100'000; ++trial) {
    TreeNode node;
    for (int c = 0; c < kTreeWidth; ++c) set_child(node, c, {some_box(number), some_box(number)});
    const MovingBox box{some_box(number), some_box(number)};
    const unsigned expected = meeting_children_one_by_one(node, box);
    ASSERT_EQ(meeting_children(node, box), expected) << "trial " << trial;
    meeting += expected != 0 ? 1 : 0;
    apart += expected != 0xFFu ? 1 : 0;
  }
  EXPECT_GT(meeting, 10'000) << "the trials reach both answers";
  EXPECT_GT(apart, 10'000);
}

TEST(Tree, BoxesThatTouchMeetAndEmptyOnesDoNot) {
  const float above = std::nextafter(1.0f, 2.0f);
  const Box touching{{1, 0, 0}, {2, 1, 1}}, beyond{{above, 0, 0}, {2, 1, 1}},
      before{{-2, 0, 0}, {-1, 1, 1}};
  TreeNode node;
  for (int c = 0; c < kTreeWidth; ++c) set_child(node, c, {});
  set_child(node, 3, {touching, touching});
  set_child(node, 4, {beyond, touching});  // comes to touch
  set_child(node, 5, {beyond, before});    // passes to the other side
  set_child(node, 6, {beyond, beyond});
  const Box unit{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(meeting_children(node, {unit, unit}), 1u << 3 | 1u << 4 | 1u << 5);
}

/// A tree over boxes in the order in which they are given.
struct PlainTree {
  std::vector<TreeNode> nodes;
  std::vector<Index> items;
  TreeView view;

  explicit PlainTree(const std::vector<MovingBox>& boxes) {
    std::vector<MovingBox> level = boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) items.push_back(static_cast<Index>(i));
    while (view.levels == 0 || level.size() > 1) {
      view.level_first[view.levels++] = static_cast<Index>(nodes.size());
      std::vector<MovingBox> hulls;
      for (std::size_t first = 0; first < level.size(); first += kTreeWidth) {
        TreeNode node;
        MovingBox hull;
        for (std::size_t c = 0; c < kTreeWidth; ++c) {
          const MovingBox child = first + c < level.size() ? level[first + c] : MovingBox{};
          set_child(node, static_cast<int>(c), child);
          include(hull, child);
        }
        nodes.push_back(node);
        hulls.push_back(hull);
      }
      level = std::move(hulls);
    }
    view.nodes = {nodes.data(), static_cast<Index>(nodes.size())};
    view.items = {items.data(), static_cast<Index>(items.size())};
  }
};

/// Small boxes along a line that folds back on itself, each with a motion of its own.
std::vector<MovingBox> folded_line(Index count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> jitter(-1, 1);
  std::vector<MovingBox> boxes;
  for (Index i = 0; i < count; ++i) {
    const float along = static_cast<float>(i < count / 2 ? i : count - i);
    MovingBox box;
    for (Box* end : {&box.start, &box.end}) {
      const float centre[3] = {along + jitter(random), 2 * jitter(random), 2 * jitter(random)};
      for (int k = 0; k < 3; ++k) end->lo[k] = centre[k] - 0.5f, end->hi[k] = centre[k] + 0.5f;
    }
    boxes.push_back(box);
  }
  return boxes;
}

/// The pairs (element, later leaf) that queries of a width find in the tree of the elements.
template <class Group>
std::vector<std::pair<Index, Index>> later_pairs(const std::vector<MovingBox>& boxes) {
  const PlainTree tree(boxes);
  const auto count = static_cast<Index>(boxes.size());
  std::vector<std::pair<Index, Index>> found;
  for (Index first = 0; first < count; first += Group::kWidth) {
    Group group;
    for (Index m = 0; m < Group::kWidth && first + m < count; ++m)
      group.set(m, boxes[static_cast<std::size_t>(first + m)]);
    query_tree(tree.view, group, first,
               [&](Index member, Index leaf) { found.emplace_back(first + member, leaf); });
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Tree, QueriesOfOneAndOfEightFindAllPairsThatMeet) {
  for (const Index count : {1, 7, 8, 9, 63, 64, 65, 700}) {
    const std::vector<MovingBox> boxes = folded_line(count);
    std::vector<std::pair<Index, Index>> expected;
    for (Index i = 0; i < count; ++i)
      for (Index k = i + 1; k < count; ++k)
        if (!stay_apart(boxes[static_cast<std::size_t>(i)], boxes[static_cast<std::size_t>(k)]))
          expected.emplace_back(i, k);
    if (count >= 63) {
      EXPECT_GT(expected.size(), static_cast<std::size_t>(count)) << count;
    }
    EXPECT_EQ(later_pairs<OneElement>(boxes), expected) << count;
    EXPECT_EQ(later_pairs<EightElements>(boxes), expected) << count;
  }
}

TEST(Tree, TheLowestBitIsFound) {
  for (int bit = 0; bit < 32; ++bit) EXPECT_EQ(lowest_bit(~0u << bit), bit);
}

}  // namespace
}  // namespace icloth::ICLOTH_BUILD
