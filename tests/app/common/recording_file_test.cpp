// Recordings are told from scenes by how they begin.
#include "app/common/recording_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

TEST(RecordingFile, IsToldFromOtherFiles) {
  const TemporaryFolder folder;
  const std::string path = folder.path("session.json");
  Recording recording;
  recording.scene = "scarf";
  save_recording(recording, path);
  EXPECT_TRUE(is_recording(path));
  EXPECT_FALSE(is_recording(ICLOTH_TEST_FOLDER "/data/drop.json"));
  EXPECT_FALSE(is_recording(ICLOTH_TEST_FOLDER));
  EXPECT_FALSE(is_recording("scarf"));
}

TEST(RecordingFile, NamesTheBuildThatMadeIt) {
  Recording recording;
  for (const Build build : {Build::cpu32, Build::cpu64, Build::cuda32}) {
    recording.build = build_name(build);
    EXPECT_EQ(recorded_build(recording), build);
  }
}

}  // namespace
}  // namespace icloth
