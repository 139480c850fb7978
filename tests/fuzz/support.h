// Helpers that the targets share.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/mesh.h"

namespace icloth::fuzz {

/// Something was accepted that must not have been.
struct Broken : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool is_true, const char* what) {
  if (!is_true) throw Broken(what);
}

/// Calls `read`; returns "", or the message of the InputError that it throws: one line of bounded
/// length.
template <class Work>
std::string refusal(const Work& read) {
  try {
    read();
    return "";
  } catch (const InputError& error) {
    const std::string_view what = error.what();
    require(!what.empty() && what.size() < 1000, "an error message of bounded length");
    require(what.find_first_of("\n\r\t") == std::string_view::npos, "an error message of one line");
    return std::string(what);
  }
}

/// The positions are finite, the indices those of vertices, the uv none or one each corner.
void require_valid(const TriangleMesh& mesh);
void require_finite(const std::vector<Vec3d>& positions);

/// Folder of this process with a copy of tests/fuzz/beside/ and of the materials. It is the assets
/// folder as well, so that names without a slash lead nowhere else. Gone when the process ends.
const std::string& scratch_folder();
/// Writes the bytes to a file of the scratch folder and returns its path.
std::string write_scratch(const std::string& name, std::string_view bytes);

/// Whether JSON names a file outside its folder. Such input is not read.
bool leaves_folder(std::string_view json);
inline constexpr const char* kLeavesFolder = "a text with a slash";

}  // namespace icloth::fuzz
