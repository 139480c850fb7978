#include "sim/files/body_io.h"

#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "sim/files/body_assimp.h"
#include "sim/files/body_checks.h"
#include "sim/files/body_process.h"
#include "sim/files/body_transport.h"
#include "sim/files/bvh_io.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr const char* kVerb = "--icloth-read-body";
constexpr const char* kMotionVerb = "--icloth-read-motion";
constexpr std::uint64_t kLargestBody = std::uint64_t{512} << 20;    // [bytes]
constexpr std::uint64_t kLargestMotion = std::uint64_t{128} << 20;  // [bytes]

bool is_served = false;  // main has called serve_body_reader

/// The answer of the child process about a file: a body or a motion, or an error.
std::string read_and_encode(const std::string& path, bool is_motion) {
  // Exceptions cannot reach the parent process, so each becomes a line of text in the answer.
  try {
    if (is_motion) return encode_motion(parse_bvh(read_file(path, kLargestMotion), path));
    check_body(read_file(path, kLargestBody), path);
    return encode_body(read_with_assimp(path));
  } catch (const InputError& error) {
    return encode_error(error.what());
  } catch (const std::bad_alloc&) {
    return encode_error(shown_path(path) + ": asks for more memory than a file of its size needs");
  } catch (const std::exception& error) {
    return encode_error(shown_path(path) + ": cannot be read as a " +
                        (is_motion ? "motion (" : "body (") + excerpt(error.what()) + ")");
  }
}

/// What the child process sends about a file.
std::string answer_of_child(const char* verb, const std::string& path) {
  const std::uint64_t size = regular_file_size(path);
  if (!is_served) throw std::logic_error("main has not called serve_body_reader");
  const ProcessResult result = run_own_program(verb, path, limits_for(size));
  if (!result.failure.empty()) throw InputError(shown_path(path) + ": " + result.failure);
  return result.bytes;
}

}  // namespace

Body read_body(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj" || extension == ".ply") return {.mesh = read_mesh(path).mesh};
  return decode_body(answer_of_child(kVerb, path), path);
}

Rig read_motion(const std::string& path) {
  return decode_motion(answer_of_child(kMotionVerb, path), path);
}

std::optional<int> serve_body_reader(int argc, const char* const* argv) {
  is_served = true;
  if (argc != 3) return std::nullopt;
  const bool is_motion = std::strcmp(argv[1], kMotionVerb) == 0;
  if (!is_motion && std::strcmp(argv[1], kVerb) != 0) return std::nullopt;
  const std::string path = argv[2];
  std::error_code gone;  // a file that vanished meanwhile is refused below
  const auto size = std::filesystem::file_size(path, gone);
  enter_limits(limits_for(gone ? 0 : size));
  return send_result(read_and_encode(path, is_motion)) ? 0 : 1;
}

}  // namespace icloth
