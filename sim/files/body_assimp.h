// Reading with assimp, in this process. For the child process of read_body alone.
#pragma once

#include <string>

#include "sim/files/body_io.h"

namespace icloth {

/// Reads a body of any format that assimp knows, without any protection against hostile files.
Body read_with_assimp(const std::string& path);

}  // namespace icloth
