// for_each, reduce and teams against plain loops; compiled once a build.
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "tests/kernels/parallel/primitives_support.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct WriteSquares {
  View<std::int64_t> out;
  ICLOTH_HD void operator()(Index i) const { out[i] += std::int64_t{i} * i + 1; }
};

TEST_F(Primitives, ForEachVisitsEveryElementOnce) {
  for (const Index n : kSizes) {
    const auto values = same_for_all_threads([n] {
      Array<std::int64_t> out(n);
      out.fill(0);
      for_each("squares", n, WriteSquares{out.view()});
      return out.download();
    });
    ASSERT_EQ(values.size(), static_cast<std::size_t>(n));
    for (Index i = 0; i < n; ++i) {
      ASSERT_EQ(values[static_cast<std::size_t>(i)], std::int64_t{i} * i + 1) << n;
    }
  }
}

struct CountVisits {
  View<Index> visits;
  ICLOTH_HD std::int64_t operator()(Index i) const {
    ++visits[i];
    return static_cast<std::int64_t>(mixed(static_cast<std::uint64_t>(i)) % 1000);
  }
};

TEST_F(Primitives, ReduceAddsIntegersExactlyAndCallsOnce) {
  for (const Index n : kSizes) {
    Array<Index> visits(n);
    visits.fill(0);
    const auto sum = reduce("integers", n, std::int64_t{0}, CountVisits{visits.view()}, Sum{});
    std::int64_t expected = 0;
    for (Index i = 0; i < n; ++i) {
      expected += static_cast<std::int64_t>(mixed(static_cast<std::uint64_t>(i)) % 1000);
    }
    EXPECT_EQ(sum, expected) << n;
    EXPECT_EQ(visits.download(), std::vector<Index>(static_cast<std::size_t>(n), 1));
  }
}

/// Magnitudes from 1e-12 to 1e12 of both signs: any other order of additions gives other bits.
template <class T>
struct WildNumber {
  ICLOTH_HD T operator()(Index i) const {
    const std::uint64_t bits = mixed(static_cast<std::uint64_t>(i));
    T value = static_cast<T>(bits % 1000003) - T(500001);
    for (std::uint64_t k = 0; k < (bits >> 32) % 13; ++k)
      value *= (bits >> 60) % 2 ? T(10) : T(0.1);
    return value;
  }
};

template <class T>
void check_wild_sum(Index n) {
  const T sum =
      same_for_all_threads([n] { return reduce("wild", n, T(0), WildNumber<T>{}, Sum{}); });
  long double exact = 0, magnitude = 0;
  for (Index i = 0; i < n; ++i) {
    const auto value = static_cast<long double>(WildNumber<T>{}(i));
    exact += value;
    magnitude += std::fabs(value);
  }
  // n additions in tree order lose far less than √n ulp of the magnitudes' sum.
  const auto bound = magnitude * static_cast<long double>(std::numeric_limits<T>::epsilon()) *
                     (1 + std::sqrt(static_cast<long double>(n)));
  EXPECT_LE(std::fabs(static_cast<long double>(sum) - exact), bound) << n;
}

TEST_F(Primitives, ReduceOfWildNumbersIsAccurateAndSameForAllThreads) {
  for (const Index n : kSizes) {
    check_wild_sum<float>(n);
    check_wild_sum<double>(n);
    check_wild_sum<Real>(n);
  }
}

struct MixedKey {
  ICLOTH_HD std::uint64_t operator()(Index i) const { return mixed(static_cast<std::uint64_t>(i)); }
};

TEST_F(Primitives, ReduceFindsLargestAndSmallest) {
  for (const Index n : kSizes) {
    std::uint64_t largest = 0, smallest = ~std::uint64_t{0};
    for (Index i = 0; i < n; ++i) {
      largest = std::max(largest, MixedKey{}(i));
      smallest = std::min(smallest, MixedKey{}(i));
    }
    EXPECT_EQ(reduce("largest", n, std::uint64_t{0}, MixedKey{}, Max{}), largest);
    EXPECT_EQ(reduce("smallest", n, ~std::uint64_t{0}, MixedKey{}, Min{}), smallest);
  }
}

struct OneNan {
  Index where;
  ICLOTH_HD double operator()(Index i) const {
    return i == where ? static_cast<double>(NAN) : static_cast<double>(i);
  }
};

TEST_F(Primitives, NanIsNotHiddenByMaxOrMin) {
  for (const Index where : {0, 1, 500, 4999}) {
    EXPECT_TRUE(std::isnan(reduce("max", 5000, -1.0, OneNan{where}, Max{})));
    EXPECT_TRUE(std::isnan(reduce("min", 5000, 1e9, OneNan{where}, Min{})));
  }
  EXPECT_EQ(reduce("max", 5000, -1.0, OneNan{-1}, Max{}), 4999.0);
}

struct Bounds {
  double low, high;
  Index where_high;
  ICLOTH_HD friend bool operator==(const Bounds& a, const Bounds& b) {
    return a.low == b.low && a.high == b.high && a.where_high == b.where_high;
  }
};
struct BoundsOf {
  ICLOTH_HD Bounds operator()(Index i) const {
    const double value = static_cast<double>(mixed(static_cast<std::uint64_t>(i)) % 1000);
    return {value, value, i};
  }
};
/// Among equal highs the smaller index: commutative, so the order does not show.
struct Merge {
  ICLOTH_HD Bounds operator()(Bounds a, Bounds b) const {
    const bool first = a.high > b.high || (a.high == b.high && a.where_high < b.where_high);
    return {Min{}(a.low, b.low), first ? a.high : b.high, first ? a.where_high : b.where_high};
  }
};

TEST_F(Primitives, ReduceTakesStructs) {
  const Bounds none{1e9, -1e9, std::numeric_limits<Index>::max()};
  for (const Index n : kSizes) {
    Bounds expected = none;
    for (Index i = 0; i < n; ++i) expected = Merge{}(expected, BoundsOf{}(i));
    const Bounds found =
        same_for_all_threads([&] { return reduce("bounds", n, none, BoundsOf{}, Merge{}); });
    EXPECT_TRUE(found == expected) << n;
  }
}

/// Problem t has sizes[t] elements from t · stride on.
struct SumOfTeam {
  View<const Index> sizes;
  View<Real> values, sums;
  View<Index> singles;
  Index stride;

  ICLOTH_HD void operator()(Team& team, Index t) const {
    const View<Real> mine = values.sub(t * stride, sizes[t]);
    team.for_each(sizes[t], [&](Index i) { mine[i] = WildNumber<Real>{}(t + i); });
    const Real sum = team.reduce(
        sizes[t], Real(0), [&](Index i) { return mine[i]; }, Sum{});
    // Every thread has the result, and the scaling is seen by the second reduction.
    team.for_each(sizes[t], [&](Index i) { mine[i] = sum + static_cast<Real>(i); });
    const Real top = team.reduce(
        sizes[t], -Real(1e30), [&](Index i) { return mine[i] - sum; }, Max{});
    team.single([&] {
      sums[t] = sum;
      singles[t] += sizes[t] == 0 ? 1 : (top > Real(-1) ? 1 : 1000);
    });
  }
};

struct TeamRun {
  std::vector<Real> values, sums;
  std::vector<Index> singles;
  bool operator==(const TeamRun&) const = default;
};

TeamRun run_teams(Index teams, Index stride, const std::vector<Index>& host_sizes) {
  Array<Index> sizes, singles(teams);
  sizes.upload(host_sizes);
  singles.fill(0);
  Array<Real> values(teams * stride), sums(teams);
  values.fill(0);
  for_each_team(
      "teams", teams,
      SumOfTeam{std::as_const(sizes).view(), values.view(), sums.view(), singles.view(), stride});
  return {values.download(), sums.download(), singles.download()};
}

/// Several dependent loops and sums by the whole device.
struct DeviceTeamWork {
  View<Real> values, sums;
  View<Index> singles;

  template <class Team>
  ICLOTH_HD void operator()(Team& team) const {
    const Index n = values.size();
    team.for_each(n, [&](Index i) { values[i] = WildNumber<Real>{}(i); });
    const Real sum = team.reduce(
        n, Real(0), [&](Index i) { return values[i]; }, Sum{});
    // Many sums in a row, each of what other threads wrote after the one before.
    Real top = 0;
    for (int round = 1; round <= 5; ++round) {
      top = team.reduce(
          n, Real(-1e30), [&](Index i) { return values[n - 1 - i] = Real(round * (i % 997)); },
          Max{});
    }
    team.for_each(n, [&](Index i) { values[i] = sum + values[i]; });
    team.single([&] {
      sums[0] = sum, sums[1] = top;
      ++singles[0];
    });
  }
};

TEST_F(Primitives, ADeviceTeamSharesWhatItWrites) {
  for (const Index n : kSizes) {
    const auto run = [n] {
      Array<Real> values(n), sums(2);
      Array<Index> singles(1);
      singles.fill(0);
      with_device_team("device_team", n,
                       DeviceTeamWork{values.view(), sums.view(), singles.view()});
      return TeamRun{values.download(), sums.download(), singles.download()};
    };
    const TeamRun result = same_for_all_threads(run);
    EXPECT_TRUE(result == run()) << "two runs differ";
    EXPECT_EQ(result.singles[0], 1);
    double sum = 0, magnitude = 0;
    for (Index i = 0; i < n; ++i) {
      sum += static_cast<double>(WildNumber<Real>{}(i));
      magnitude += std::fabs(static_cast<double>(WildNumber<Real>{}(i)));
    }
    const auto epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());
    EXPECT_NEAR(static_cast<double>(result.sums[0]), sum,
                epsilon * magnitude * (1 + std::sqrt(static_cast<double>(n))));
    if (n > 0) {
      EXPECT_EQ(result.sums[1], Real(5 * std::min<Index>(n - 1, 996)));
    }
    for (Index i = 0; i < n; ++i) {
      const Real expected = result.sums[0] + Real(5 * ((n - 1 - i) % 997));
      ASSERT_EQ(result.values[static_cast<std::size_t>(i)], expected) << n << ' ' << i;
    }
  }
}

TEST_F(Primitives, TeamsWorkOnProblemsOfAllSizes) {
  constexpr Index kStride = 1100;
  for (const Index teams : {0, 1, 33, 1025}) {
    std::vector<Index> sizes;
    for (Index t = 0; t < teams; ++t) sizes.push_back(kSizes[static_cast<std::size_t>(t) % 7]);
    const TeamRun run = same_for_all_threads([&] { return run_teams(teams, kStride, sizes); });
    for (Index t = 0; t < teams; ++t) {
      const auto at = static_cast<std::size_t>(t);
      double sum = 0, magnitude = 0;
      for (Index i = 0; i < sizes[at]; ++i) {
        const auto value = static_cast<double>(WildNumber<Real>{}(t + i));
        sum += value;
        magnitude += std::fabs(value);
      }
      const auto epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon());
      ASSERT_NEAR(static_cast<double>(run.sums[at]), sum, 40 * epsilon * magnitude) << t;
      ASSERT_EQ(run.singles[at], 1);
    }
  }
}

TEST_F(Primitives, ProfileHasOneRowAName) {
  Array<std::int64_t> out(10);
  const WriteSquares squares{out.view()};
  profile_reset();
  for_each("off", 10, squares);
  EXPECT_TRUE(profile_rows().empty());
  profile_enable(true);
  for_each("a", 10, squares);
  reduce("b", 10, std::uint64_t{0}, MixedKey{}, Max{});
  for_each("a", 10, squares);
  profile_enable(false);
  const std::vector<ProfileRow> rows = profile_rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].name, "a");
  EXPECT_EQ(rows[0].calls, 2);
  EXPECT_GE(rows[0].ms, 0);
  EXPECT_EQ(rows[1].name, "b");
  profile_reset();
  EXPECT_TRUE(profile_rows().empty());
}

/// Two simulators in two threads: their scratch must not mix.
TEST_F(Primitives, TwoThreadsMayCallAtOnce) {
  const auto expected = reduce("once", 300'000, 0.0, WildNumber<double>{}, Sum{});
  std::atomic<int> wrong{0};
  const auto repeat = [&] {
    for (int k = 0; k < 20; ++k) {
      if (reduce("again", 300'000, 0.0, WildNumber<double>{}, Sum{}) != expected) ++wrong;
    }
  };
  std::thread other(repeat);
  repeat();
  other.join();
  EXPECT_EQ(wrong, 0);
}

#if !defined(__CUDACC__)
TEST_F(Primitives, ExceptionsReachTheCaller) {
  for (const Index n : {10, 100'000}) {
    const auto fail_at_7 = [](Index i) {
      if (i == 7) throw std::domain_error("seven");
    };
    EXPECT_THROW(for_each("fails", n, fail_at_7), std::domain_error);
    Array<Index> out;
    const auto collect_and_fail = [&](Index i, auto& emit) {
      emit(i);
      fail_at_7(i);
    };
    EXPECT_THROW(collect("fails", n, collect_and_fail, out), std::domain_error);
    EXPECT_EQ(collect(
                  "works", n, [](Index i, auto& emit) { emit(i); }, out),
              n);
  }
}
#endif

}  // namespace
}  // namespace icloth::ICLOTH_BUILD
