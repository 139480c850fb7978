// icloth render --out FILE.mp4: videos by ffmpeg, decoded again.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "render/image.h"
#include "tests/app/cli/program.h"

namespace icloth::testing {
namespace {

constexpr int kWidth = 160, kHeight = 120;
const std::string kRender = "render drop.json --device cpu --quality draft --size 160x120 ";

class Video : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("drop.json", kDrop);
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg";
    const Outcome drawn = icloth(kRender + "--steps 0 --out first.png");
    if (drawn.code == 3) GTEST_SKIP() << drawn.err;
    ASSERT_EQ(drawn.code, 0) << drawn.err;
  }

  /// All frames of a video, as RGBA one after the other.
  std::string decoded(const std::string& name) const {
    const std::string command = "cd '" + folder_.string() +
                                "' && ffmpeg -nostdin -loglevel error -y -i " + name +
                                " -f rawvideo -pix_fmt rgba frames.raw";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return read(folder_ / "frames.raw");
  }
};

constexpr std::size_t kFrame = std::size_t{4} * kWidth * kHeight;

/// Mean difference of a channel between a frame and a picture [1/255].
double mean_difference(const std::string& frames, std::size_t frame, const Image& image) {
  double sum = 0;
  for (std::size_t k = 0; k < kFrame; ++k)
    sum += std::abs(static_cast<std::uint8_t>(frames[frame * kFrame + k]) - image.pixels[k]);
  return sum / static_cast<double>(kFrame);
}

TEST_F(Video, ShowsTheRunAtItsSpeed) {
  const Outcome made = icloth(kRender + "--steps 20 --fps 25 --out drop.mp4");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_FALSE(fs::exists(folder_ / "drop.mp4.part"));

  // Frames at 0, 0.04 … 0.2 s: the first shows the start state, the last the one after 20 steps.
  const std::string frames = decoded("drop.mp4");
  ASSERT_EQ(frames.size(), 6 * kFrame);
  ASSERT_EQ(icloth(kRender + "--steps 20 --out last.png").code, 0);
  const Image first = read_png((folder_ / "first.png").string());
  const Image last = read_png((folder_ / "last.png").string());
  EXPECT_LT(mean_difference(frames, 0, first), 2);
  EXPECT_LT(mean_difference(frames, 5, last), 2);
  EXPECT_GT(mean_difference(frames, 5, first), 4);
}

TEST_F(Video, OfAStepThatIsLongerThanAFrameRepeatsStates) {
  const Outcome made =
      icloth(kRender + "--steps 2 --set step.time_step=0.02 --fps 100 --out slow.mp4");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(decoded("slow.mp4").size(), 5 * kFrame);
}

TEST_F(Video, OfARunThatIsInterruptedHasWhatWasMade) {
  // The signal may come too early on a busy machine, before the run has begun.
  for (int delay = 2; delay < 60 && !fs::exists(folder_ / "long.mp4"); delay *= 2) {
    const std::string command = "cd '" + folder_.string() + "' && timeout --signal=INT " +
                                std::to_string(delay) + " '" + ICLOTH_PROGRAM "' " + kRender +
                                "--time 1000 --quiet --out long.mp4 > /dev/null 2>&1";
    std::system(command.c_str());
  }
  EXPECT_FALSE(fs::exists(folder_ / "long.mp4.part"));
  EXPECT_GE(decoded("long.mp4").size(), kFrame);
}

TEST_F(Video, OfAStartThatIsRefusedShowsItForASecond) {
  write("cross.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.3 1\nf 1 2 3\nf 4 5 6\n");
  const Outcome made = icloth(
      "render cross.obj --device cpu --quality draft --size 160x120 --fps "
      "10 --out cross.mp4");
  EXPECT_EQ(made.code, 1) << made.err;
  EXPECT_EQ(decoded("cross.mp4").size(), 10 * kFrame);
}

TEST_F(Video, ThatCannotBeMadeIsRefusedInOneLine) {
  expect_bad_input("render drop.json --device cpu --size 161x120 --out a.mp4", "even numbers");
  expect_bad_input(kRender + "--out none/a.mp4", "there is no folder 'none'");
  expect_bad_input(kRender + "--out a.avi", "expected FILE.png or FILE.mp4");
  expect_bad_input(kRender + "--out a.mp4 --compare first.png", "is for pictures");
  expect_bad_input(kRender + "--out a.mp4 --fps 0", "--fps");

  // A folder of programs without ffmpeg.
  fs::create_directory(folder_ / "bin");
  fs::create_symlink("/usr/bin/timeout", folder_ / "bin/timeout");
  const Outcome without = icloth(kRender + "--out a.mp4", "PATH=\"$PWD/bin\"");
  EXPECT_EQ(without.code, 2);
  EXPECT_TRUE(contains(without.err, "the package 'ffmpeg'")) << without.err;
  EXPECT_EQ(count_lines(without.err), 1u) << without.err;
}

TEST_F(Video, TellsWhyFfmpegFailed) {
  fs::create_directory(folder_ / "bin");
  write("bin/ffmpeg", "#!/bin/sh\nhead -c 100000 > /dev/null\necho 'No space left' >&2\nexit 1\n");
  fs::permissions(folder_ / "bin/ffmpeg", fs::perms::owner_all);
  const Outcome failed = icloth(kRender + "--out a.mp4", "PATH=\"$PWD/bin:$PATH\"");
  EXPECT_EQ(failed.code, 2);
  EXPECT_EQ(failed.err, "icloth: a.mp4: ffmpeg made no video (No space left)\n");
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4.part"));
}

}  // namespace
}  // namespace icloth::testing
