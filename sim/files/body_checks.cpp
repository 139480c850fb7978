#include "sim/files/body_checks.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/gltf_checks.h"
#include "sim/files/text.h"
#include "sim/files/xml_checks.h"

namespace icloth {
namespace {

std::uint32_t load_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);  // little endian, as GLB and STL are
  return value;
}

/// Pieces of a GLB file: a header of 12 bytes (magic, version, length), then chunks of length, kind
/// and data. The first is the JSON text, the second, where there is one, the buffer.
void check_glb(std::string_view bytes, const std::string& path) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  const auto refuse = [&](const std::string& element, std::uint64_t value,
                          const std::string& expected) {
    throw InputError(shown_path(path) + ": " + element + ": value " + std::to_string(value) +
                     ", expected " + expected);
  };

  // The length in the header shows whether the file was cut off.
  if (bytes.size() < kHeader + kChunkHeader || !bytes.starts_with("glTF"))
    throw InputError(shown_path(path) +
                     ": header: expected 'glTF', a version, a length and a chunk");
  if (load_u32(bytes, 4) != 2) refuse("header: version", load_u32(bytes, 4), "2");
  if (load_u32(bytes, 8) != bytes.size())
    refuse("header: length", load_u32(bytes, 8),
           std::to_string(bytes.size()) + ", the size of the file");

  // The chunks must fill the file.
  std::vector<std::string_view> chunks;
  for (std::string_view rest = bytes.substr(kHeader); !rest.empty();) {
    const std::string element = "chunk " + std::to_string(chunks.size()) + ": length";
    if (rest.size() < kChunkHeader) refuse(element, rest.size(), "a header of 8 bytes");
    const std::uint32_t length = load_u32(rest, 0);
    rest.remove_prefix(kChunkHeader);
    if (length > rest.size())
      refuse(element, length, "at most the " + std::to_string(rest.size()) + " bytes that follow");
    chunks.push_back(rest.substr(0, length));
    rest.remove_prefix(length);
  }
  check_gltf(chunks[0], chunks.size() > 1 ? chunks[1].size() : 0, path);
}

/// Binary STL: 80 bytes of anything, a count, 50 bytes a triangle. A text begins with "solid", but
/// so do some binary files.
void check_stl(std::string_view bytes, const std::string& path) {
  constexpr std::uint64_t kHeader = 84, kTriangle = 50;

  // A zero byte near the beginning shows that the file is binary in spite of the word.
  const auto begin = bytes.substr(0, 512);
  if (begin.starts_with("solid") && begin.find('\0') == std::string_view::npos) return;

  // The number of triangles has to fit the size of the file, since memory is taken for all of them.
  if (bytes.size() < kHeader)
    throw InputError(shown_path(path) + ": value " + std::to_string(bytes.size()) +
                     " bytes, expected a header of 84");
  const std::uint64_t most = (bytes.size() - kHeader) / kTriangle;
  if (load_u32(bytes, 80) > most)
    throw InputError(shown_path(path) + ": header: triangles: value " +
                     std::to_string(load_u32(bytes, 80)) + ", expected at most " +
                     std::to_string(most) + ", as many as the file's " +
                     std::to_string(bytes.size()) + " bytes hold");
}

}  // namespace

void check_body(std::string_view bytes, const std::string& path) {
  const std::string extension = lower_extension(path);
  const bool is_glb = bytes.starts_with("glTF") || extension == ".glb";
  if (is_glb) return check_glb(bytes, path);
  if (extension == ".gltf") return check_gltf(bytes, 0, path);
  if (extension == ".stl") return check_stl(bytes, path);

  // Whatever else begins like XML: Collada, X3D, AMF, IRR …
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first != std::string_view::npos && bytes[first] == '<') check_xml(bytes, path);
}

}  // namespace icloth
