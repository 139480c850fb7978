// The readers over the seeds of the fuzzer, all of them good files, and over regressions/: files
// like those that once broke a reader, and others made to. good_… must be accepted, bad_… refused,
// all quickly and in little memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "sim/files/file_io.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace {

std::atomic<std::size_t> largest_request{0};  // of memory [bytes]

void* take(std::size_t size) {
  std::size_t before = largest_request;
  while (size > before && !largest_request.compare_exchange_weak(before, size)) {
  }
  if (void* memory = std::malloc(std::max<std::size_t>(size, 1))) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return take(size); }
void* operator new[](std::size_t size) { return take(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace icloth::fuzz {

void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestRequest = 64 << 20;  // far above what the small files need

std::vector<fs::path> files_of(const std::string& kind, const Target& target) {
  std::vector<fs::path> files;
  const fs::path folder = fs::path(ICLOTH_FUZZ_FOLDER) / kind / target.name;
  std::error_code error;  // a reader that was never broken has no folder
  for (const auto& entry : fs::directory_iterator(folder, error)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void expect(const Target& target, const fs::path& file, bool good) {
  SCOPED_TRACE(file.string());
#if !defined(ICLOTH_HAS_ZLIB)
  if (file.extension() == ".gz") return;
#endif
  const std::string bytes = read_file(file.string());
  largest_request = 0;
  const auto start = Clock::now();
  std::string reason;
  EXPECT_NO_THROW(reason = target.read(bytes));
  EXPECT_EQ(reason.empty(), good) << reason;
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), 2.0);
  EXPECT_LT(largest_request, kLargestRequest);
}

class Readers : public testing::TestWithParam<Target> {};

TEST_P(Readers, AcceptTheSeeds) {
  const auto files = files_of("seeds", GetParam());
  EXPECT_FALSE(files.empty());
  for (const fs::path& file : files) expect(GetParam(), file, true);
}

TEST_P(Readers, StandHostileFiles) {
  for (const fs::path& file : files_of("regressions", GetParam())) {
    const std::string name = file.filename().string();
    ASSERT_TRUE(name.starts_with("good_") || name.starts_with("bad_")) << name;
    expect(GetParam(), file, name.starts_with("good_"));
  }
}

/// Cut off anywhere, and with any byte changed: refused or accepted, but nothing else.
TEST_P(Readers, StandCutAndChangedSeeds) {
  for (const fs::path& file : files_of("seeds", GetParam())) {
    SCOPED_TRACE(file.string());
    std::string bytes = read_file(file.string());
    const std::size_t stride = 1 + bytes.size() / 100;
    for (std::size_t i = 0; i < bytes.size(); i += stride) {
      EXPECT_NO_THROW(GetParam().read(bytes.substr(0, i))) << "cut at " << i;
      for (char changed : {'\0', '9', '\xff'}) {
        const char kept = std::exchange(bytes[i], changed);
        EXPECT_NO_THROW(GetParam().read(bytes)) << "changed at " << i;
        bytes[i] = kept;
      }
    }
  }
}

/// Long words where the readers expect keys, values, counts and names.
std::vector<std::string> garbage_for(std::string_view target) {
  const std::string x(5000, 'x'), y = "\x1b[31m" + x;
  if (target == "obj") return {"v 0 0 " + x, "v 0 0 0\nf 1 1 " + y, "vt " + y, x};
  if (target == "ply")
    return {"ply\nformat " + x + "\n", "ply\nformat ascii 1.0\nelement " + x + " -1\nend_header\n",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty " + y + " x\nend_header\n",
            "ply\nformat ascii 1.0\nelement " + x + " 1\nproperty int a\nend_header\n" + x + "\n"};
  if (target == "query") return {"vf," + x + ",", x + ",1", "vf" + y};
  if (target == "dxf") return {x, "0\n" + x, "0\nBLOCK\n2\n" + y, "0\nBLOCK\n0\nLINE\n10\n" + x};
  if (target == "pc2" || target == "mdd" || target == "body") return {x, "POINTCACHE2" + x};
  std::string deep = "1";
  for (int k = 0; k < 3000; ++k) deep = "[" + deep + "]";
  return {"{\"" + x + "\": 1}",
          "{\"name\": " + x + "}",
          "{\"cloths\": \"" + x + "\"}",
          x,
          "{\"parameters\": {\"" + x + "\": 1}, \"cloths\": []}",
          "{\"parameters\": {\"implicit.integrator\": \"" + x + "\"}, \"cloths\": []}",
          "{\"cloths\": [{\"name\": \"c\", \"mesh\": \"" + x + ".obj\"}]}",
          "{\"cloths\": [{\"name\": \"c\", \"material\": \"" + x + "\", \"mesh\": \"flat.obj\"}]}",
          "{\"cloths\": " + deep + "}",
          "{\"base\": \"" + x + "\"}",
          "{\"density\": \"" + x + "\"}",
          "{\"icloth_recording\": \"" + x + "\"}",
          "{\"steps\": [{\"" + x + "\": 1}]}"};
}

TEST_P(Readers, RepeatLittleOfLongGarbage) {
  for (const std::string& bytes : garbage_for(GetParam().name)) {
    std::string reason;
    EXPECT_NO_THROW(reason = GetParam().read(bytes));  // checks that it is one line
    EXPECT_EQ(reason.find(std::string(81, 'x')), std::string::npos) << reason;
    EXPECT_EQ(reason.find('\x1b'), std::string::npos) << reason;
    EXPECT_LT(reason.size(), 500u) << reason;
  }
}

std::string name_of(const testing::TestParamInfo<Target>& test) {
  return std::string(test.param.name);
}

INSTANTIATE_TEST_SUITE_P(All, Readers, testing::ValuesIn(targets().begin(), targets().end()),
                         name_of);

}  // namespace
}  // namespace icloth::fuzz
