// Bodies that the cloth falls on, in any format.
#pragma once

#include <string>

#include "sim/files/mesh.h"

namespace icloth {

/// Static pose of a body: OBJ and PLY by the own readers, everything else (glTF, FBX, Collada …) by
/// assimp, all meshes merged, node transforms and bind skinning applied, coinciding vertices
/// merged. Throws InputError, also for such a format in a program that was built without assimp.
TriangleMesh read_body(const std::string& path);

}  // namespace icloth
