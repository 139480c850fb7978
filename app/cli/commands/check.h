// icloth check: exact intersection test of mesh files.
#pragma once

#include <string>
#include <vector>

namespace icloth {

struct CheckOptions {
  std::vector<std::string> meshes;  ///< OBJ or PLY; tested as one soup
  std::size_t list = 10;            ///< pairs that are printed
};

/// Tests every face against every other one, except groups "obstacle:…" among themselves, and
/// prints the pairs that touch or cross. Returns 0 when there is none, else 1. Throws InputError.
int run_check(const CheckOptions& options);

}  // namespace icloth
