// Reading files of collision queries, and the command that tests them.
#include "app/cli/commands/query_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/cli/commands/ccd.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

// A vertex that falls through a face at t = ½, and two edges that stay apart.
const std::string kHit = "vf,0.25,1,0.25,0,0,0,1,0,0,0,0,1,0x1p-2,-1,+0.25,0,0,0,1,0,0,0,0,1";
const std::string kMiss = "ee,0,0,0,1,0,0,0,1,0,0,1,1,0,0,0,1,0,0,0,1,0,0,1,1";

class QueryFileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("icloth_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const std::string path = (folder_ / "queries.csv").string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  std::string error_of(const std::string& text) const {
    try {
      QueryFile file(write(text));
      FileQuery q;
      while (file.next(q)) {
      }
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  void expect_error(const std::string& text, const std::string& what) const {
    const std::string message = error_of(text);
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("queries.csv:"), std::string::npos) << message;
  }

  std::filesystem::path folder_;
};

TEST_F(QueryFileTest, ReadsDecimalAndHexadecimalNumbers) {
  QueryFile file(write("kind,p0x\n" + kHit + ",1,category,7\r\n\n" + kMiss));
  FileQuery q;
  ASSERT_TRUE(file.next(q));
  EXPECT_EQ(q.kind, PairKind::vf);
  EXPECT_EQ(q.expected, 1);
  EXPECT_EQ(q.query.p1[0], (Vec3d{0.25, -1, 0.25}));
  EXPECT_EQ(q.query.p0[3], (Vec3d{0, 0, 1}));
  ASSERT_TRUE(file.next(q));
  EXPECT_EQ(q.kind, PairKind::ee);
  EXPECT_EQ(q.expected, -1);
  EXPECT_EQ(q.query.p1[3], (Vec3d{0, 1, 1}));
  EXPECT_FALSE(file.next(q));
}

TEST_F(QueryFileTest, RefusesBadLines) {
  expect_error("kind\nxx,1,2\n", ":2: kind is 'xx', expected vf or ee");
  expect_error(kMiss + "\nvf,1,2\n", ":2: z of point 0 at t=0 is missing");
  for (const char* bad : {"abc", "nan", "inf", "1e999", "", "--1", "+-1", "0x", "1 2", "1.5z"}) {
    std::string line = kMiss;
    line.replace(3, 1, bad);
    expect_error(line + "\n", std::string(":1: x of point 0 at t=0 is '") + bad + "'");
  }
  expect_error(kMiss + ",2\n", ":1: expected result is '2', expected 0 or 1");
  expect_error(std::string(200000, '7') + "\n", ":1: line of more than 65536 characters");
  EXPECT_THROW(QueryFile((folder_ / "missing.csv").string()), InputError);
}

TEST_F(QueryFileTest, VerbWritesPredictionsAndCountsErrors) {
  const std::string predictions = (folder_ / "predictions.txt").string();
  EXPECT_EQ(run_ccd(write(kHit + ",1\n" + kMiss + ",0\n"), predictions), 0);
  std::ifstream in(predictions);
  int hit = 0, miss = 1;
  double toi = 0;
  in >> hit >> toi >> miss;
  EXPECT_EQ(hit, 1);
  EXPECT_NEAR(toi, 0.5, 1e-12);
  EXPECT_LE(toi, 0.5);
  EXPECT_EQ(miss, 0);
  EXPECT_EQ(run_ccd(write(kMiss + ",1\n"), ""), 1) << "an expected contact is missing";
  EXPECT_EQ(run_ccd(write(""), ""), 0);
  EXPECT_THROW(run_ccd(write(kMiss), (folder_ / "no" / "where").string()), InputError);
}

TEST_F(QueryFileTest, LongFilesCrossTheReadBuffer) {
  std::string text;
  for (int k = 0; k < 20000; ++k) text += (k % 2 == 0 ? kHit : kMiss) + "\n";
  QueryFile file(write(text));
  FileQuery q;
  for (int k = 0; k < 20000; ++k) {
    ASSERT_TRUE(file.next(q));
    ASSERT_EQ(q.kind, k % 2 == 0 ? PairKind::vf : PairKind::ee);
  }
  EXPECT_FALSE(file.next(q));
}

}  // namespace
}  // namespace icloth
