// icloth render --compare: screenshot regression as users of the program run it.
#include <gtest/gtest.h>

#include "render/image.h"
#include "tests/app/cli/program.h"

namespace icloth::testing {
namespace {

class Golden : public Cli {
 protected:
  /// Draws the scene after some steps.
  Outcome draw(const std::string& steps, const std::string& options) const {
    write("drop.json", kDrop);
    return icloth("render drop.json --device cpu --quality draft --steps " + steps + " " + options);
  }
};

TEST_F(Golden, IsMadeOnceAndMatchedAgain) {
  const Outcome made = draw("0", "--size 160x120 --compare golden.png --update");
  if (made.code == 3) GTEST_SKIP() << made.err;
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(contains(made.out, "golden.png: written; before: not there\n")) << made.out;

  // The size of the golden picture is the one that is drawn.
  const Outcome same = draw("0", "--compare golden.png --tolerance exact");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_TRUE(contains(same.out, "icloth.png: as golden.png (0.000 % of the pixels differ"))
      << same.out;
  EXPECT_EQ(read_png((folder_ / "icloth.png").string()).width, 160);
  EXPECT_FALSE(fs::exists(folder_ / "icloth.html"));
}

TEST_F(Golden, ThatDiffersHasAPage) {
  const Outcome made = draw("0", "--size 160x120 --compare golden.png --update");
  if (made.code == 3) GTEST_SKIP() << made.err;
  const Outcome other = draw("9", "--compare golden.png --out 'a b.png'");
  EXPECT_EQ(other.code, 1) << other.out;
  EXPECT_TRUE(contains(other.err, "icloth: a b.png: differs from golden.png: ")) << other.err;
  EXPECT_TRUE(contains(other.err, "see a b.html\n")) << other.err;
  EXPECT_EQ(count_lines(other.err), 1u) << other.err;
  for (const char* file : {"a b_expected.png", "a b_difference.png"})
    EXPECT_EQ(read_png((folder_ / file).string()).height, 120) << file;
  const std::string page = read(folder_ / "a b.html");
  for (const char* part : {"'a%20b.png'", "'a%20b_expected.png'", "'a%20b_difference.png'"})
    EXPECT_TRUE(contains(page, part)) << page;

  // What the picture is now becomes the golden one.
  const Outcome renewed = draw("9", "--compare golden.png --update");
  EXPECT_EQ(renewed.code, 0) << renewed.err;
  EXPECT_TRUE(contains(renewed.out, "golden.png: written; before: ")) << renewed.out;
  EXPECT_EQ(draw("9", "--compare golden.png --quiet").code, 0);
}

TEST_F(Golden, OfAnotherSizeIsNoMatch) {
  const Outcome made = draw("0", "--size 160x120 --compare golden.png --update");
  if (made.code == 3) GTEST_SKIP() << made.err;
  const Outcome other = draw("0", "--size 120x160 --compare golden.png");
  EXPECT_EQ(other.code, 1) << other.out;
  EXPECT_TRUE(contains(other.err, "the sizes differ")) << other.err;
  EXPECT_FALSE(fs::exists(folder_ / "icloth_difference.png"));
}

TEST_F(Golden, ThatCannotBeComparedWithIsRefusedBeforeTheRun) {
  const Outcome drawn = draw("0", "--size 160x120");
  if (drawn.code == 3) GTEST_SKIP() << drawn.err;
  write("no.png", "no picture");
  const std::string render = "render drop.json --steps 0 ";
  expect_bad_input(render + "--compare none.png", "none.png: is not there");
  expect_bad_input(render + "--compare no.png", "no.png: missing or no PNG picture");
  expect_bad_input(render + "--compare golden.jpg", "expected FILE.png");
  expect_bad_input(render + "--out a.png --compare ./a.png", "is where --out writes");
  expect_bad_input(render + "--compare none.png --update --tolerance loose", "expected exact");
  expect_bad_input(render + "--update", "--compare");
}

TEST_F(Golden, IsNotMadeOfARunThatFailed) {
  // Two triangles that cross each other are no start.
  write("cross.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.3 1\nf 1 2 3\nf 4 5 6\n");
  const Outcome failed = icloth(
      "render cross.obj --device cpu --steps 1 --size 160x120 --compare golden.png --update");
  if (failed.code == 3) GTEST_SKIP() << failed.err;
  EXPECT_EQ(failed.code, 1) << failed.out;
  EXPECT_TRUE(contains(failed.err, "golden.png: not written, as the run failed")) << failed.err;
  EXPECT_FALSE(fs::exists(folder_ / "golden.png"));
}

}  // namespace
}  // namespace icloth::testing
