// Which triangle test rays are traced with: by name, and by what an object allows.
#pragma once

#include <string>

#include "nkd/object_file.h"
#include "render/trace.h"
#include "sys/result.h"

namespace kd::bench {

/// "exact, moller-trumbore or woop".
std::string triangle_test_names();

const char* name_of(render::TriangleTest test);

/// ErrorClass::usage for a name that none has.
Result<render::TriangleTest> triangle_test_named(const std::string& name);

/// By name. "" is exact for an object on the lattice and woop for one of float32 vertices, for which exact is
/// ErrorClass::usage, as no name is for any.
Result<render::TriangleTest> choose_triangle_test(const std::string& name, const nkd::ObjectFile& object);

}  // namespace kd::bench
