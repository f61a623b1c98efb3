// Rotations between keys.
//
// Two keys with one axis, or opposite ones, are joined by as many degrees as they say: 0 and 360 is a full turn. (A key
// of 0 degrees has every axis.) Keys with different axes are joined the short way, by at most 180 degrees: Shoemake,
// "Animating rotation with quaternion curves", 1985. Smooth ones are the cumulative cubic of Kim, Kim and Shin, "A
// general construction scheme for unit quaternion curves with simple high order derivatives", 1995, which has the
// angular velocities of Catmull and Rom's tangents; about one axis it is the Hermite curve of the degrees.
#pragma once

#include "scene/key_segment.h"

namespace kd::scene {

Rotation interpolate(const KeySegment<Rotation>& segment, Interpolation interpolation);

}  // namespace kd::scene
