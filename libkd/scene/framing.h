// A camera for what comes without one.
#pragma once

#include "core/box.h"
#include "scene/scene.h"

namespace kd::scene {

/// Sees all of `box_scene`, which is finite and not empty but may be flat or a point, from the front, a little from
/// above and from the right; y is up. As near as a margin of a twentieth of the film allows.
Camera framing_camera(const Box3d& box_scene, const FilmSize& film);

}  // namespace kd::scene
