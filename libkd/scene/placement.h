// What placements do, as frames.
#pragma once

#include "core/frame.h"
#include "core/lattice.h"
#include "scene/scene.h"

namespace kd::scene {

/// The placement at a frame of the film, as a frame of the space it is written in: the unit cube for a box, else model
/// space or a character's.
Frame placement_frame(const Placement& placement, double frame);
Frame placement_frame(const CharacterPlacement& placement, double frame);

/// Lattice space to the unit cube, as far as the lattice has it.
Frame unit_cube_frame(const Lattice& lattice);

}  // namespace kd::scene
