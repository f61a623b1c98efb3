// OBJ lines as tinyobjloader wants them: it knows neither comments behind faces nor lines that go on after a
// backslash.
#pragma once

#include <string>
#include <string_view>

#include "mesh/watch.h"

namespace kd::mesh {

/// `text` with each statement on one line: a backslash at the end of a line joins the next line to it (or the one after
/// a line that is a comment as a whole). Comments behind numbers are left out; names may hold a #. A bare `g` gets the
/// blank without which tinyobjloader overlooks it. Every statement begins on the line on which it did.
std::string plain_obj_lines(std::string_view text, Watch& watch);

}  // namespace kd::mesh
