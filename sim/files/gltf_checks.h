// Checks of the JSON of a glTF file against the data that is there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace icloth {

/// `chunk_bytes`: size of the binary chunk of a GLB, 0 where there is none. Buffers must be in the
/// folder of `path` or below it, views within their buffers, accessors within their views, and
/// nodes a forest. Throws InputError naming file, element, value and what was expected.
void check_gltf(std::string_view json, std::uint64_t chunk_bytes, const std::string& path);

}  // namespace icloth
