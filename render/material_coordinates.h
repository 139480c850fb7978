// The material coordinates of the fabric, which tell the shaders how its threads run.
#pragma once

#include <array>
#include <vector>

#include "sim/scene/world.h"

namespace icloth {

/// The material coordinates of the corners of the cloth faces [m] (cloth_faces), from the faces'
/// own frames (World::face_inverse). Neighbours agree wherever a cloth can be laid out flat; a loop
/// that cannot (a tube sewn together) breaks along one line of faces.
std::vector<std::array<Vec2d, 3>> material_coordinates(const World& world);

}  // namespace icloth
