#include "stress/shapes.h"

#include "stress/shape_parts.h"

namespace kd::stress {

namespace {

constexpr ShapeRow kRows[] = {
    {"ball", "an icosphere of 81,920 triangles", ball, false, 0.5, true, false},
    {"box", "an axis-aligned box of 9,216 triangles", box, false, 1, true, false},
    {"small-ball", "an icosphere of 320 triangles", small_ball, false, 1, true, false},
    {"tetrahedron", "slanted plane faces, tessellated exactly", tetrahedron, false, 1, true, false},
    {"needles", "triangles two of whose corners all but touch", needles, true, 1, false, false},
    {"slivers", "triangles whose corners all but lie on a line", slivers, true, 1, false, false},
    {"mixed", "triangles of every size", mixed, true, 1, false, false},
    {"fan", "two fans of 65,536 triangles each", fan, true, 0.0005, true, false},  // a ray at a hub meets them all
    {"small-fan", "two fans of 128 triangles each", small_fan, true, 1, true, false},
    {"duplicates", "coplanar copies and overlaps of a wall", duplicates, true, 1, false, false},
    {"flat-cells", "rooms a lattice step wide", flat_cells, true, 1, false, false},
    {"flat-mesh", "a mesh without extent along z", flat_mesh, false, 1, false, false},
    {"stairs", "boxes that stand side by side", stairs, true, 1, false, false},
    {"sheets", "two sheets one lattice step apart", sheets, false, 1, false, true},
};

}  // namespace

std::span<const ShapeRow> shape_rows() { return kRows; }

}  // namespace kd::stress
