// A body on its way from the child process that read it to this one.
#pragma once

#include <string>
#include <string_view>

#include "sim/files/body_io.h"

namespace icloth {

/// The answer of the child about a body, and that about a file that it refuses.
std::string encode_body(const Body& body);
std::string encode_error(const std::string& message);

/// The body of an answer. The child read a hostile file, so what it sends is checked like any other
/// input: counts before memory is taken for them, then every index and number. Throws InputError
/// with the message of the child, or one that says that the answer makes no sense. `path`: of the
/// file, for messages.
Body decode_body(std::string_view bytes, const std::string& path);

/// The same for the motion of a file: a rig without vertices that has one clip.
std::string encode_motion(const Rig& motion);
Rig decode_motion(std::string_view bytes, const std::string& path);

}  // namespace icloth
