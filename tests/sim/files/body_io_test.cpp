// Bodies from files that nobody may trust: read in a child process, refused with one line.
#include "sim/files/body_io.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cstring>
#include <functional>

#include "sim/files/body_process.h"
#include "sim/files/error.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The body is refused in one line that holds the words.
void expect_refused(const std::string& path, const std::vector<std::string>& words) {
  const std::string message = message_of([&] { read_body(path); });
  EXPECT_FALSE(message.empty()) << path;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 400u) << message;
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' not in: " << message;
}

std::string u32(std::uint32_t value) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &value, 4);
  return bytes;
}

std::string glb(const std::string& json, const std::string& data = "") {
  std::string text = json + std::string((4 - json.size() % 4) % 4, ' ');
  std::string chunks = u32(static_cast<std::uint32_t>(text.size())) + "JSON" + text;
  if (!data.empty())
    chunks += u32(static_cast<std::uint32_t>(data.size())) + std::string("BIN\0", 4) + data;
  return "glTF" + u32(2) + u32(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

/// A triangle as glTF, with more keys at the end.
std::string triangle_gltf(const std::string& buffer, int count = 3, const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[)" +
         buffer +
         R"(],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)" +
         R"("componentType":5126,"type":"VEC3","min":[0,0,0],"max":[1,1,0],"count":)" +
         std::to_string(count) + "}]" + more + "}";
}

std::string triangle_bytes() {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  return std::string(reinterpret_cast<const char*>(corners), sizeof corners);
}

std::string stl(std::uint32_t announced, std::size_t there) {
  std::string bytes(80, ' ');
  bytes += u32(announced);
  for (std::size_t t = 0; t < there; ++t)
    bytes += std::string(12, '\0') + triangle_bytes() + std::string(2, '\0');
  return bytes;
}

std::string collada(const std::string& nodes) {
  return "<COLLADA version=\"1.4.1\"><library_nodes>" + nodes +
         "</library_nodes><library_visual_scenes><visual_scene id=\"v\"><node id=\"r\">"
         "<instance_node url=\"#a\"/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url=\"#v\"/></scene></COLLADA>";
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t k = 0; k < times; ++k) all += text;
  return all;
}

TEST(BodyIo, ReadsGoodFilesOfSeveralFormatsInTheChild) {
  const TemporaryFolder folder;
  const std::string buffer = R"({"byteLength":36})";
  EXPECT_EQ(read_body(folder.write("a.glb", glb(triangle_gltf(buffer), triangle_bytes())))
                .mesh.faces.size(),
            1u);
  folder.write("a.bin", triangle_bytes());
  const std::string beside = R"({"byteLength":36,"uri":"a.bin"})";
  const Body body = read_body(folder.write("a.gltf", triangle_gltf(beside)));
  EXPECT_EQ(body.mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(body.rig.empty());
  EXPECT_EQ(body.bones, 0u);
  EXPECT_EQ(read_body(folder.write("a.stl", stl(1, 1))).mesh.faces.size(), 1u);
}

TEST(BodyIo, NamesTheClipsOfAFile) {
  const TemporaryFolder folder;
  std::string data = triangle_bytes();
  const float times[] = {0, 2}, moves[] = {0, 0, 0, 0, 1, 0};
  data.append(reinterpret_cast<const char*>(times), sizeof times);
  data.append(reinterpret_cast<const char*>(moves), sizeof moves);
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"n"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":68}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},)"
      R"({"buffer":0,"byteOffset":44,"byteLength":24}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"min":[0,0,0],"max":[1,1,0]},)"
      R"({"bufferView":1,"componentType":5126,"type":"SCALAR","count":2,"min":[0],"max":[2]},)"
      R"({"bufferView":2,"componentType":5126,"type":"VEC3","count":2}],)"
      R"("animations":[{"name":"walk","samplers":[{"input":1,"output":2}],)"
      R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})";
  const Body body = read_body(folder.write("walk.glb", glb(json, data)));
  ASSERT_EQ(body.rig.clips.size(), 1u);
  EXPECT_EQ(body.rig.clips[0].name, "walk");
  EXPECT_NEAR(body.rig.clips[0].duration, 2, 1e-6);
}

TEST(BodyIo, CountsMorphTargets) {
  const TemporaryFolder folder;
  std::string json = triangle_gltf(R"({"byteLength":36})");
  const std::string plain = R"({"attributes":{"POSITION":0}})";
  json.replace(json.find(plain), plain.size(),
               R"({"attributes":{"POSITION":0},"targets":[{"POSITION":0},{"POSITION":0}]})");
  EXPECT_EQ(read_body(folder.write("a.glb", glb(json, triangle_bytes()))).morphs, 2u);
}

TEST(BodyIo, RefusesLengthsThatTheFileDoesNotHold) {
  const TemporaryFolder folder;
  const std::string chunk("glTF\2\0\0\0\xff\xff\xff\xff\xff\xff\xff\xffJSON{}", 22);
  expect_refused(folder.write("length.glb", chunk), {"length.glb", "length", "4294967295", "22"});
  std::string inner = glb("{}");
  inner.replace(12, 4, "\xff\xff\xff\x7f");
  expect_refused(folder.write("chunk.glb", inner), {"chunk 0", "2147483647", "at most the 4"});
  expect_refused(folder.write("cut.glb", "glTF\2"), {"cut.glb", "header"});

  const std::string buffer = R"({"byteLength":36})";
  expect_refused(folder.write("data.glb", glb(triangle_gltf(R"({"byteLength":99999})"), "1234")),
                 {"buffers[0].byteLength", "99999", "4 bytes"});
  expect_refused(folder.write("count.glb", glb(triangle_gltf(buffer, 400000000), triangle_bytes())),
                 {"accessors[0].count", "400000000", "36 bytes"});
  expect_refused(folder.write("count.stl", stl(4000000000u, 2)), {"4000000000", "at most 2"});
}

TEST(BodyIo, RefusesNodesThatContainThemselves) {
  const TemporaryFolder folder;
  expect_refused(
      folder.write("cycle.dae", collada("<node id=\"a\"><instance_node url=\"#a\"/></node>")),
      {"cycle.dae", "node 'a'", "contains itself"});
  expect_refused(folder.write("two.dae", collada("<node id='a'><instance_node url='#b'/></node>"
                                                 "<node id='b'><instance_node url='#a'/></node>")),
                 {"contains itself"});
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"nodes":[{"children":[1]},{"children":[0]}]})";
  expect_refused(folder.write("cycle.gltf", gltf), {"nodes[0]", "not itself"});

  // Each node holds the next one ten times: ten to the power of twelve.
  std::string doubling;
  for (char c = 'a'; c < 'm'; ++c)
    doubling +=
        "<node id=\"" + std::string(1, c) + "\">" +
        repeated("<instance_node url=\"#" + std::string(1, static_cast<char>(c + 1)) + "\"/>", 10) +
        "</node>";
  expect_refused(folder.write("many.dae", collada(doubling)), {"1000000 nodes"});
}

TEST(BodyIo, SurvivesFilesThatNestDeeply) {
  const TemporaryFolder folder;
  constexpr std::size_t kDeep = 200000;
  expect_refused(folder.write("deep.dae", repeated("<node>", kDeep)), {"deep.dae", "deep"});
  expect_refused(folder.write("deep.x3d", "<X3D>" + repeated("<Group>", kDeep)), {"deep.x3d"});
  expect_refused(folder.write("deep.x", "xof 0303txt 0032\n" + repeated("Frame a {\n", kDeep)),
                 {"deep.x"});
  expect_refused(folder.write("deep.gltf", repeated("[", kDeep)), {"deep.gltf"});
  expect_refused(folder.write("deep.wrl", "#VRML V2.0 utf8\n" + repeated("Group{children[", kDeep)),
                 {"deep.wrl"});
}

TEST(BodyIo, RefusesWhatIsNoRegularFileAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo(folder.path("fifo.stl").c_str(), 0600), 0);
  expect_refused(folder.path("fifo.stl"), {"fifo.stl", "expected a file"});
  ASSERT_EQ(mkfifo(folder.path("fifo.bin").c_str(), 0600), 0);
  expect_refused(folder.write("a.gltf", triangle_gltf(R"({"byteLength":36,"uri":"fifo.bin"})")),
                 {"fifo.bin", "expected a file"});
  expect_refused(folder.write("b.gltf", triangle_gltf(R"({"byteLength":36,"uri":"../b.bin"})")),
                 {"buffers[0].uri", "../b.bin", "below it"});
  expect_refused(folder.path("none.glb"), {"none.glb", "no such file"});
}

TEST(BodyIo, ChildrenThatFailAreReportedAndGone) {
  const TemporaryFolder folder;
  // A program that does not know the verb sends nothing; one that sends too much is stopped.
  const std::string file = folder.write("a.stl", stl(1, 1));
  const ProcessLimits limits = limits_for(184);
  EXPECT_EQ(run_own_program("--gtest_filter=None", "--gtest_brief=1", limits).bytes, "");
  const ProcessResult small =
      run_own_program("--icloth-read-body", file, {limits.memory, 10, limits.seconds});
  EXPECT_NE(small.failure.find("too many"), std::string::npos) << small.failure;
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  EXPECT_LT(usage.ru_maxrss, 1 << 20);  // [KiB]
}

TEST(BodyProcess, AChildThatWorksWithoutAnEndIsStopped) {
  const ProcessLimits limits = {.memory = 1 << 20, .result = 1 << 20, .seconds = 60};
  const ProcessResult spun = run_own_program("--icloth-test-spin", "a.stl", limits);
  EXPECT_EQ(spun.failure, "was not read within 60 s of processor time");

  // The child limits itself to 1 s; where that fails, the clock of the parent ends it.
  const ProcessLimits none = {.memory = 1 << 20, .result = 1 << 20, .seconds = 0};
  const ProcessResult late = run_own_program("--icloth-test-spin", "a.stl", none);
  EXPECT_EQ(late.failure, "was not read within 0 s");
}

TEST(BodyProcess, AChildGetsNoMoreMemoryThanItsLimit) {
  if (!limits_memory()) GTEST_SKIP() << "sanitizers need terabytes of address space";
  const ProcessLimits limits = {.memory = 1 << 20, .result = 1 << 20, .seconds = 60};
  const ProcessResult grown = run_own_program("--icloth-test-grow", "a.stl", limits);
  ASSERT_EQ(grown.failure, "");
  EXPECT_GT(std::stoi(grown.bytes), 50);
  EXPECT_LE(std::stoi(grown.bytes), 100);
}

TEST(BodyProcess, LimitsGrowWithTheFileFromAFirmBase) {
  const ProcessLimits empty = limits_for(0), large = limits_for(std::uint64_t{100} << 20);
  EXPECT_EQ(empty.memory >> 20, 640u);
  EXPECT_EQ((large.memory - empty.memory) >> 20, 4000u);
  EXPECT_EQ((large.seconds - empty.seconds) / empty.seconds, 25u / 4);
}

}  // namespace
}  // namespace icloth
