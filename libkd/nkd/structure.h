// The checks that make a mapped .nkd safe to traverse: each returns the first thing found wrong, or nothing.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "nkd/contents.h"
#include "nkd/issues.h"
#include "nkd/schema.h"

namespace kd::nkd {

using Check = std::optional<Finding>;
inline Check found(Issue issue, std::string detail = {}) { return Finding{issue, std::move(detail)}; }

/// That the bytes are a .nkd of this version whose offsets stay inside, with the required sections, aligned.
Check check_container(std::span<const std::byte> bytes);
/// Bits, box and displacements.
Check check_summary(const Summary& summary);
/// That the form is known, and the lattice one that it may have.
Check check_vertex_form(const Geometry& geometry);
/// That the nodes are one binary tree, at most kMaxDepth deep, with lattice planes and leaves inside the references.
Check check_nodes(const Geometry& geometry);
/// That references, corners and vertices are in range.
Check check_indices(const Geometry& geometry);
Check check_source_primitives(const Attributes& attributes, size_t triangle_count);
Check check_normals(const Attributes& attributes, size_t triangle_count);
Check check_materials(const Attributes& attributes, size_t triangle_count);

Check check_header_checksum(const nkd_schema::Object& object);
Check check_geometry_checksums(const nkd_schema::Object& object, const Geometry& geometry);
/// `name` is the section's, for the message.
template <class T>
Check check_checksum(std::span<const T> section, uint64_t recorded, const char* name);

}  // namespace kd::nkd
