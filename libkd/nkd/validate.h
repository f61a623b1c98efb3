// Deep validation: that a .nkd which is safe to traverse is also right. For who must know before it ships; a render
// does not need it.
#pragma once

#include <vector>

#include "nkd/issues.h"
#include "nkd/object_file.h"

namespace kd::nkd {

/// Everything found wrong in the attribute sections and in the tree: planes inside their cells, leaves in order, no
/// leaf without a triangle that passes through its cell (decided in exact integers), none with one a lattice step away,
/// the recorded statistics. At most one finding of each issue. Empty: sound. O(references x depth).
///
/// Of float32 vertices the tree is held against the nearest lattice points, over which it was built: a triangle as it
/// is stored may reach half a step into a leaf that does not refer to it.
std::vector<Finding> validate(const ObjectFile& file);

}  // namespace kd::nkd
