// icloth export: formats that a run could not finish, from the point caches that it left.
#pragma once

#include <string>
#include <vector>

namespace icloth {

struct ExportOptions {
  std::vector<std::string> spools;   ///< folders of runs
  std::vector<std::string> formats;  ///< of kFrameFormats; empty: mdd and usda
  std::string out;                   ///< folder; empty: that of the spool
};

/// Writes the formats of each spool and says how many frames they have. Returns 0. Throws
/// InputError where a spool is damaged or is none.
int run_export(const ExportOptions& options);

}  // namespace icloth
