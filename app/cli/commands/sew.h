// icloth sew: from a sewing pattern and a body to a garment that is worn.
#pragma once

#include <string>
#include <vector>

#include "kernels/parallel/platform.h"

namespace icloth {

struct SewOptions {
  std::string pattern;  ///< JSON of GarmentCode; with `within`: mesh of the panels
  std::string body;     ///< mesh that it is put on; empty: the garment is sewn in the air
  std::string out;      ///< OBJ of the garment, with its pattern as texture coordinates
  std::string material = "default";
  double within = 0;  ///< borders of a mesh that near each other are sewn [m]; 0: a pattern
  std::string rest;   ///< mesh of the same panels at rest; empty: they are at rest as they are
  Index triangles = 4000;
  std::vector<std::string> hold;  ///< labels of edges that keep their height until it settles
  double settling = 0.5;          ///< time with weight [s]
  int threads = 0;                ///< 0: all
  bool report = false;
  bool dress = true;  ///< false: the garment is written as it is sewn
  bool quiet = false;
};

/// Sews the pattern, puts it on the body, and writes it. Returns 0, or 1 where it cannot be worn.
/// Throws InputError.
int run_sew(const SewOptions& options);

}  // namespace icloth
