// The spool: point caches of a run, from which other formats are made, also after a crash.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/files/frame_list.h"
#include "sim/files/usda_io.h"

namespace icloth {

/// What a folder of point caches holds: NAME.pc2 and NAME.obj of each object, frames.csv, and
/// objects.csv, which says which objects there are.
struct Spool {
  std::vector<CachedMesh> objects;
  std::vector<ListedFrame> frames;  ///< of the caches: those that are whole in all of them
  std::vector<std::string> notes;   ///< what is left out, a clause each

  /// Times of the frames [s].
  std::vector<double> times() const;
};

/// Writes objects.csv, a row for each object in their order. Throws InputError.
void write_object_list(const std::string& folder, std::span<const CachedMesh> objects);

/// Reads a spool, which may come from anywhere: counts are checked against each other and against
/// the sizes of the files before memory is taken, and all coordinates must be finite. A frame that
/// is not whole or not listed is left out, which a note says. Throws InputError naming the file,
/// the element and the value.
Spool read_spool(const std::string& folder);

}  // namespace icloth
