// Reading with assimp, in this process. For the child process of read_body alone.
#pragma once

#include <string>

#include "sim/files/body_io.h"

namespace icloth {

/// As read_body, of any format that assimp knows, without any protection from what is in the file.
Body read_with_assimp(const std::string& path);

}  // namespace icloth
