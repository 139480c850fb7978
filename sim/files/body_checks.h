// Checks of body files before a reader that is not ours sees them.
#pragma once

#include <string>
#include <string_view>

namespace icloth {

/// Looks for what is known to lead readers astray: lengths and counts that the file does not hold
/// (GLB, glTF, binary STL), nodes that contain themselves or are repeated without end (glTF,
/// Collada), XML nested too deeply. Formats without a check pass. The checks give these files a
/// message that names the fault; safety against all others is that of the child process.
/// Throws InputError naming file, element, value and what was expected.
void check_body(std::string_view bytes, const std::string& path);

}  // namespace icloth
