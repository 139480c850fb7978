// Arrays and views; compiled once a build.
#include <limits>
#include <stdexcept>
#include <utility>

#include "tests/kernels/parallel/primitives_support.h"

namespace icloth::ICLOTH_BUILD {
namespace {

std::vector<Index> iota(Index n) {
  std::vector<Index> values;
  for (Index i = 0; i < n; ++i) values.push_back(i);
  return values;
}

TEST_F(Primitives, ArrayIsEmptyAtFirst) {
  const Array<float> array;
  EXPECT_EQ(array.size(), 0);
  EXPECT_EQ(array.view().size(), 0);
  EXPECT_TRUE(array.download().empty());
}

TEST_F(Primitives, ArrayGivesBackWhatWasUploaded) {
  for (const Index n : kSizes) {
    Array<Index> array;
    array.upload(iota(n));
    EXPECT_EQ(array.size(), n);
    EXPECT_EQ(array.download(), iota(n));
  }
}

TEST_F(Primitives, ArrayKeepsContentWhenAsked) {
  Array<Index> array;
  array.upload(iota(100));
  array.resize_keep(5000);
  ASSERT_EQ(array.size(), 5000);
  std::vector<Index> front(100);
  array.download_range(0, front);
  EXPECT_EQ(front, iota(100));
  array.resize_keep(10);
  EXPECT_EQ(array.download(), iota(10));
}

TEST_F(Primitives, ArrayCapacityOnlyGrowsAndByHalf) {
  Array<double> array(1000);
  const double* const memory = array.view().data();
  array.resize(3);
  array.resize(1000);
  EXPECT_EQ(array.view().data(), memory);
  array.resize(1001);
  EXPECT_EQ(array.capacity(), 1500);
  EXPECT_EQ(array.size(), 1001);
}

// Not local to the test: CUDA kernels cannot take types of host functions.
struct Pair {
  double a;
  Index b;
};

TEST_F(Primitives, ArrayFillsAnyValue) {
  Array<Pair> array(1025);
  array.fill({2.5, 7});
  for (const Pair& p : array.download()) {
    ASSERT_EQ(p.a, 2.5);
    ASSERT_EQ(p.b, 7);
  }
  Array<float>().fill(1);  // nothing to do
}

TEST_F(Primitives, ArrayRangesTouchOnlyThemselves) {
  Array<Index> array;
  array.upload(iota(10));
  array.upload_range(4, std::vector<Index>{40, 50});
  std::vector<Index> part(3);
  array.download_range(3, part);
  EXPECT_EQ(part, (std::vector<Index>{3, 40, 50}));
  EXPECT_EQ(array.download()[6], 6);
}

TEST_F(Primitives, ArrayRefusesBadSizesAndRanges) {
  Array<Index> array;
  EXPECT_THROW(array.resize(-1), std::length_error);
  EXPECT_THROW(array.resize_keep(-1), std::length_error);
  array.upload(iota(4));
  std::vector<Index> two(2);
  EXPECT_THROW(array.download_range(3, two), std::out_of_range);
  EXPECT_THROW(array.upload_range(-1, two), std::out_of_range);
  EXPECT_THROW(array.upload_range(std::numeric_limits<Index>::max(), two), std::out_of_range);
  EXPECT_EQ(array.download(), iota(4));
}

TEST_F(Primitives, ArrayMovesSwapsAndCopies) {
  Array<Index> a, b;
  a.upload(iota(5));
  b.upload(iota(7));
  a.swap(b);
  EXPECT_EQ(a.download(), iota(7));
  Array<Index> moved(std::move(a));
  EXPECT_EQ(moved.download(), iota(7));
  b = std::move(moved);
  EXPECT_EQ(b.download(), iota(7));
  Array<Index> copy;
  copy.copy_from(b);
  b.fill(0);
  EXPECT_EQ(copy.download(), iota(7));
}

TEST_F(Primitives, ViewsNarrowAndBecomeConst) {
  Array<Index> array;
  array.upload(iota(10));
  const View<const Index> view = array.view();
  const View<const Index> part = view.sub(3, 4);
  EXPECT_EQ(part.size(), 4);
  EXPECT_EQ(part.data(), array.view().data() + 3);
  EXPECT_EQ(view.sub(10, 0).size(), 0);
}

}  // namespace
}  // namespace icloth::ICLOTH_BUILD
