#include "sim/files/body_io.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "sim/files/body_assimp.h"
#include "sim/files/body_checks.h"
#include "sim/files/body_process.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/json_reader.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

// The child sends the length of a JSON text [8 bytes], the text, and, where the body was read, its
// positions and faces as they are in memory. The text is {"error": …} or {"vertices", "faces",
// "bones", "morphs", "clips": [{"name", "duration"}]}.

namespace icloth {
namespace {

constexpr const char* kVerb = "--icloth-read-body";
constexpr std::uint64_t kLargestBody = std::uint64_t{1} << 32;  // [bytes]

bool is_served = false;  // main has called serve_body_reader

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string encode(const nlohmann::json& head, const TriangleMesh& mesh) {
  const std::string text = head.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  const std::uint64_t length = text.size();
  std::string bytes(reinterpret_cast<const char*>(&length), sizeof length);
  bytes += text;
  append(bytes, mesh.positions);
  append(bytes, mesh.faces);
  return bytes;
}

nlohmann::json head_of(const Body& body) {
  nlohmann::json head{{"vertices", body.mesh.positions.size()},
                      {"faces", body.mesh.faces.size()},
                      {"bones", body.bones},
                      {"morphs", body.morphs},
                      {"clips", nlohmann::json::array()}};
  for (const BodyClip& clip : body.clips)
    head["clips"].push_back({{"name", clip.name}, {"duration", clip.duration}});
  return head;
}

/// The answer of the child process about a file: a body, or an error.
std::string read_and_encode(const std::string& path) {
  // Exceptions cannot reach the parent process, so each becomes a line of text in the answer.
  try {
    check_body(read_file(path, kLargestBody), path);
    const Body body = read_with_assimp(path);
    return encode(head_of(body), body.mesh);
  } catch (const InputError& error) {
    return encode({{"error", error.what()}}, {});
  } catch (const std::bad_alloc&) {
    return encode(
        {{"error", shown_path(path) + ": asks for more memory than a file of its size needs"}}, {});
  } catch (const std::exception& error) {
    return encode({{"error", shown_path(path) + ": cannot be read as a body (" +
                                 excerpt(error.what()) + ")"}},
                  {});
  }
}

/// The child read a hostile file: what it sends is checked like any other input.
class Decoder {
 public:
  Decoder(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

  Body decode() {
    // The answer begins with the length of its head, which holds an error or the counts of the
    // arrays.
    std::uint64_t length = 0;
    take(&length, sizeof length);
    if (length > rest_.size()) refuse();
    const auto head = nlohmann::json::parse(rest_.substr(0, length), nullptr, false);
    rest_.remove_prefix(length);
    if (head.is_object() && head.contains("error") && head["error"].is_string())
      throw InputError(head["error"].get<std::string>());

    Body body = body_of(JsonValue(head, shown_path(path_)));
    take(body.mesh.positions.data(), body.mesh.positions.size() * sizeof(Vec3d));
    take(body.mesh.faces.data(), body.mesh.faces.size() * sizeof(Triangle));
    check(body.mesh);
    return body;
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError(shown_path(path_) +
                     ": cannot be read: the answer of its reader makes no sense");
  }

  void take(void* to, std::size_t bytes) {
    if (bytes > rest_.size()) refuse();
    if (bytes > 0) std::memcpy(to, rest_.data(), bytes);
    rest_.remove_prefix(bytes);
  }

  /// The head of the answer, and arrays of the announced size where as many bytes follow.
  Body body_of(const JsonValue& head) const {
    // The counts must fit the bytes that follow before memory is taken for them.
    JsonObject object(head);
    const auto most = static_cast<std::int64_t>(kLargestCount);
    const auto count = [&](const char* key) {
      return static_cast<std::size_t>(object.required(key).integer(0, most));
    };
    const std::size_t vertices = count("vertices"), faces = count("faces");
    if (vertices * sizeof(Vec3d) + faces * sizeof(Triangle) != rest_.size()) refuse();

    // The arrays are only sized here; the caller fills them from those bytes.
    Body body;
    body.bones = count("bones");
    body.morphs = count("morphs");
    for (const JsonValue& item : object.required("clips").items()) {
      JsonObject clip(item);
      body.clips.push_back({clip.required("name").text(), clip.required("duration").number()});
    }
    body.mesh.positions.resize(vertices);
    body.mesh.faces.resize(faces);
    return body;
  }

  void check(const TriangleMesh& mesh) const {
    for (Vec3d p : mesh.positions)
      for (double x : {p.x, p.y, p.z})
        if (!(std::abs(x) <= kLargestCoordinate)) refuse();
    const auto count = static_cast<Index>(mesh.positions.size());
    for (const Triangle& face : mesh.faces)
      for (Index v : face)
        if (v < 0 || v >= count) refuse();
    if (mesh.faces.empty()) refuse();
  }

  std::string_view rest_;
  const std::string& path_;
};

Body read_in_child(const std::string& path) {
  const std::uint64_t size = regular_file_size(path);
  if (!is_served) throw std::logic_error("main has not called serve_body_reader");
  const ProcessResult result = run_own_program(kVerb, path, limits_for(size));
  if (!result.failure.empty()) throw InputError(shown_path(path) + ": " + result.failure);
  return Decoder(result.bytes, path).decode();
}

}  // namespace

Body read_body(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj" || extension == ".ply") return {read_mesh(path).mesh, {}, 0, 0};
  return read_in_child(path);
}

std::optional<int> serve_body_reader(int argc, const char* const* argv) {
  is_served = true;
  if (argc != 3 || std::strcmp(argv[1], kVerb) != 0) return std::nullopt;
  const std::string path = argv[2];
  std::error_code gone;  // a file that vanished meanwhile is refused below
  const auto size = std::filesystem::file_size(path, gone);
  enter_limits(limits_for(gone ? 0 : size));
  return send_result(read_and_encode(path)) ? 0 : 1;
}

}  // namespace icloth
