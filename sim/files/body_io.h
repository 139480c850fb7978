// Bodies that the cloth falls on, in any format.
#pragma once

#include <optional>
#include <string>

#include "sim/bodies/rig.h"
#include "sim/files/mesh.h"

namespace icloth {

struct Body {
  TriangleMesh mesh;       ///< bind pose, in the order of the file
  Rig rig = {};            ///< what moves it; empty without bones and clips
  std::size_t bones = 0;   ///< bones that some vertex follows
  std::size_t morphs = 0;  ///< shapes that meshes can be blended with
};

/// A body: OBJ and PLY by the own readers, everything else (glTF, FBX, Collada …) by assimp, all
/// meshes merged, node transforms and bind skinning applied. Coinciding vertices are merged; where
/// there are clips, only those that move together. Throws InputError, also for such a format in a
/// program that was built without assimp.
///
/// Files for assimp are read in a child process with limits on memory, time and stack, so that no
/// file can take this program down (sim/files/body_process.h). The main function of a program that
/// reads bodies calls serve_body_reader first; without it std::logic_error is thrown.
Body read_body(const std::string& path);

/// The motion of a BVH file: its joints as the nodes of a rig without vertices, and one clip. Read
/// in such a child process as well. Throws InputError naming line, value and what was expected.
Rig read_motion(const std::string& path);

/// To be called first in main. In the child process of read_body it reads the body and returns the
/// exit code of the program; otherwise it returns nothing and main goes on.
std::optional<int> serve_body_reader(int argc, const char* const* argv);

}  // namespace icloth
