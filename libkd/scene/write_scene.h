// Writes scene files: strict JSON that `parse_scene` reads back, one part a line.
#pragma once

#include <string>

#include "scene/scene.h"
#include "sys/result.h"

namespace kd::scene {

/// Writes `scene` to `path`, atomically. What is read back is the same to the last bit, except for directions of
/// lights, which are scaled to length 1 again. Objects' files become relative to the folder of `path`. In names,
/// control characters and what is not UTF-8 become U+FFFD; objects' names that are then the same, or empty, get
/// numbers. ErrorClass::scene for a value that no scene file can hold: a number that is not finite, or a file's name
/// with control characters or not in UTF-8. ErrorClass::output if `path` cannot be written.
/// The first member, `generator`, has a hash of all that follows it.
Result<void> write_scene(const Scene& scene, const std::string& path);

/// Whether the file is as `write_scene` left it: nothing in it is anyone's own work.
bool is_as_written(const std::string& path);

}  // namespace kd::scene
