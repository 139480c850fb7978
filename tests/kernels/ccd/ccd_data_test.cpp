// The elementary CCD on published queries with exact truth; skipped where the data is not there.
// Data: $ICLOTH_DATA or ../shared/data, ccd/*.csv.gz: kind, 24 numbers, expected, category, id,
// f32exact, coplanar_always, n_impacts, toi.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kernels/ccd/elementary_ccd.h"

namespace icloth {
namespace {

struct Row {
  PairKind kind{};
  CcdQuery<double> query;
  bool expected{}, exact_in_float{};
  double toi{};
};

struct ClosePipe {
  void operator()(std::FILE* f) const { pclose(f); }
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out(1);
  for (char c : line) {
    if (c == ',') {
      out.emplace_back();
    } else if (c != '\n') {
      out.back() += c;
    }
  }
  return out;
}

Row parse(const std::vector<std::string>& field) {
  Row row;
  row.kind = field[0] == "vf" ? PairKind::vf : PairKind::ee;
  for (std::size_t i = 0; i < 24; ++i) {
    const std::size_t point = i / 3 % 4;
    Vec3d& x = i < 12 ? row.query.p0[point] : row.query.p1[point];
    (i % 3 == 0 ? x.x : i % 3 == 1 ? x.y : x.z) = std::strtod(field[i + 1].c_str(), nullptr);
  }
  row.expected = field[25] == "1";
  row.exact_in_float = field[28] == "1";
  row.toi = row.expected ? std::strtod(field[31].c_str(), nullptr) : 0;
  return row;
}

std::filesystem::path data_folder() {
  const char* set = std::getenv("ICLOTH_DATA");
  return std::filesystem::path(set ? set : ICLOTH_DATA_DEFAULT) / "ccd";
}

struct Counts {
  long rows = 0, hits = 0, missed = 0, false_positives = 0, late = 0, filtered_hits = 0;
  std::vector<double> early;  ///< true time of impact minus the reported one, of each hit

  double median_early() {
    if (early.empty()) return 0;
    const auto middle = early.begin() + static_cast<std::ptrdiff_t>(early.size() / 2);
    std::nth_element(early.begin(), middle, early.end());
    return *middle;
  }
};

template <class T>
void add(const Row& row, const CcdQuery<T>& q, Counts& counts) {
  CcdHit hit;
  const bool vf = row.kind == PairKind::vf;
  const bool found = vf ? ccd_vf(q, 0, hit) : ccd_ee(q, 0, hit);
  const bool kept = vf ? ccd_filter<PairKind::vf>(q) : ccd_filter<PairKind::ee>(q);
  ++counts.rows;
  counts.hits += found;
  counts.missed += row.expected && !found;
  counts.false_positives += !row.expected && found;
  counts.late += row.expected && found && hit.toi > row.toi;
  counts.filtered_hits += row.expected && !kept;
  if (row.expected && found) counts.early.push_back(row.toi - hit.toi);
}

void expect_exact(const char* precision, Counts& c, double early) {
  EXPECT_EQ(c.missed, 0) << precision;
  EXPECT_EQ(c.filtered_hits, 0) << precision;
  EXPECT_EQ(c.late, 0) << precision;
  EXPECT_EQ(c.false_positives, 0) << precision;
  EXPECT_LE(c.median_early(), early) << precision;
  std::printf("%s: %ld queries, %ld hits, early by %.1e (median)\n", precision, c.rows, c.hits,
              c.median_early());
}

class CcdData : public testing::TestWithParam<const char*> {};

TEST_P(CcdData, EveryQueryIsDecidedRight) {
  const std::filesystem::path file = data_folder() / (std::string(GetParam()) + ".csv.gz");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  const std::string command = "gzip -dc '" + file.string() + "'";
  const std::unique_ptr<std::FILE, ClosePipe> pipe(popen(command.c_str(), "r"));
  ASSERT_TRUE(pipe);
  Counts fp64, fp32;
  char line[4096];
  for (long number = 0; std::fgets(line, sizeof line, pipe.get()); ++number) {
    if (number == 0) continue;
    const std::vector<std::string> field = split(line);
    ASSERT_EQ(field.size(), 32u) << file << ":" << number + 1;
    const Row row = parse(field);
    add(row, row.query, fp64);
    if (!row.exact_in_float) continue;
    CcdQuery<float> single;
    for (int k = 0; k < 4; ++k) {
      single.p0[k] = convert<float>(row.query.p0[k]);
      single.p1[k] = convert<float>(row.query.p1[k]);
    }
    add(row, single, fp32);
  }
  ASSERT_GT(fp64.rows, 1000);
  expect_exact("double", fp64, 1e-6);
  expect_exact("float", fp32, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Files, CcdData, testing::Values("handcrafted", "simulation", "negatives"),
                         [](const auto& file) { return std::string(file.param); });

}  // namespace
}  // namespace icloth
