#include "nkd/structure.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "nkd/header.h"
#include "sys/hash.h"

namespace kd::nkd {

namespace {

Finding found(Issue issue, std::string detail = {}) { return {issue, std::move(detail)}; }

template <class Stored>
bool misaligned(const flatbuffers::Vector<Stored>* v) {
  return v && reinterpret_cast<uintptr_t>(v->Data()) % 16 != 0;
}

/// The index of the first value >= limit, or the size. Branch-free within blocks, so that the compiler vectorises it.
template <class T>
size_t first_at_least(std::span<const T> values, uint64_t limit) {
  if (limit > std::numeric_limits<T>::max()) return values.size();
  const T bound = static_cast<T>(limit);
  constexpr size_t kBlock = 4096;
  for (size_t begin = 0; begin < values.size(); begin += kBlock) {
    const size_t end = std::min(begin + kBlock, values.size());
    bool beyond = false;
    for (size_t i = begin; i < end; ++i) beyond |= values[i] >= bound;
    if (!beyond) continue;
    for (size_t i = begin; i < end; ++i) {
      if (values[i] >= bound) return i;
    }
  }
  return values.size();
}

bool is_lattice_plane(float plane, int bits) {
  return plane >= 0 && plane <= static_cast<float>(lattice_max(bits)) && plane == std::floor(plane);
}

}  // namespace

Check check_container(std::span<const std::byte> bytes) {
  const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
  constexpr size_t kHeader = 16;
  if (bytes.size() < kHeader || !nkd_schema::ObjectBufferHasIdentifier(data)) return found(Issue::not_nkd);
  if (bytes.size() >= FLATBUFFERS_MAX_BUFFER_SIZE) return found(Issue::offsets, "2 GiB or more, which no .nkd has");
  flatbuffers::Verifier verifier(data, bytes.size(), 8, 16, true);
  if (!nkd_schema::VerifyObjectBuffer(verifier)) return found(Issue::offsets);
  const nkd_schema::Object& o = *nkd_schema::GetObject(data);
  if (o.version() != kFormatVersion) {
    return found(Issue::version, fmt::format("version {}, this program reads {}", o.version(), kFormatVersion));
  }
  const auto absent = [](const auto* member) { return member == nullptr; };
  if (absent(o.origin()) || absent(o.extent()) || absent(o.checksums()) || absent(o.tree()) || absent(o.provenance()) ||
      absent(o.nodes()) || absent(o.references()) || absent(o.triangles()) || absent(o.vertices()) ||
      o.nodes()->size() == 0 || o.triangles()->size() == 0 || o.vertices()->size() == 0) {
    return found(Issue::missing_section);
  }
  if (misaligned(o.nodes()) || misaligned(o.references()) || misaligned(o.triangles()) || misaligned(o.vertices()) ||
      misaligned(o.source_primitives()) || misaligned(o.normals()) || misaligned(o.normal_indices()) ||
      misaligned(o.materials()) || misaligned(o.material_ids())) {
    return found(Issue::alignment);
  }
  if (o.file_bytes() != bytes.size()) {
    return found(Issue::file_size, fmt::format("{} bytes, and it says {}", bytes.size(), o.file_bytes()));
  }
  return std::nullopt;
}

Check check_summary(const Summary& s) {
  if (s.lattice.bits < kMinLatticeBits || s.lattice.bits > kMaxLatticeBits) {
    return found(Issue::bits, fmt::format("{} bits", s.lattice.bits));
  }
  const Vec3d e = s.lattice.extent;
  if (!is_finite(s.lattice.origin) || !is_finite(e) || e.x < 0 || e.y < 0 || e.z < 0) return found(Issue::box);
  const auto sound = [](double d) { return std::isfinite(d) && d >= 0; };
  if (!sound(s.max_displacement) || !sound(s.rms_displacement)) return found(Issue::displacement);
  return std::nullopt;
}

Check check_nodes(const Geometry& geometry) {
  const auto nodes = geometry.nodes;
  if (nodes.size() < 2 || nodes.size() > kMaxChild) {
    return found(Issue::node_count, fmt::format("{} nodes", nodes.size()));
  }
  if (!is_leaf(nodes[kEmptyLeaf]) || reference_count(nodes[kEmptyLeaf]) != 0) return found(Issue::empty_leaf);
  // Parents precede children, so one pass from the front knows each node's depth when it comes to it. 0: no parent yet.
  std::vector<uint8_t> depth_of(nodes.size(), 0);
  depth_of[0] = 1;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    const Node node = nodes[i];
    if (depth_of[i] == 0 && i != kEmptyLeaf) return found(Issue::unreached_node, fmt::format("node {}", i));
    if (is_leaf(node)) {
      if (uint64_t{first_reference(node)} + reference_count(node) > geometry.references.size()) {
        return found(Issue::leaf_range, fmt::format("node {}", i));
      }
      continue;
    }
    if (depth_of[i] > kMaxDepth) return found(Issue::depth, fmt::format("node {}", i));
    if (!is_lattice_plane(split_plane(node), geometry.bits)) return found(Issue::plane, fmt::format("node {}", i));
    // The children that are stored, one or two, stand side by side. Taken as a range they need no branch on which they
    // are, which no processor could foresee: a third less time for all the checks.
    const uint32_t lower = node.link >> 4, empty = node.link >> 2 & (kLowerEmpty | kUpperEmpty);
    const uint32_t first = lower + (empty & kLowerEmpty), last = lower + 1 - (empty >> 1);
    if (first > last || first <= i || last >= nodes.size()) {
      return found(Issue::child_index, fmt::format("node {}", i));
    }
    if ((depth_of[first] | depth_of[last]) != 0) return found(Issue::shared_child, fmt::format("node {}", i));
    depth_of[first] = depth_of[last] = static_cast<uint8_t>(depth_of[i] + 1);
  }
  return std::nullopt;
}

Check check_indices(const Geometry& geometry) {
  const auto words = static_cast<size_t>(triple_words(geometry.bits));
  if (geometry.vertices.size() % words != 0) return found(Issue::vertex_size);
  if (geometry.triangles.size() % static_cast<size_t>(triple_words(geometry.corner_bits())) != 0) {
    return found(Issue::triangle_size);
  }
  if (const size_t i = first_at_least(geometry.references, geometry.triangle_count()); i < geometry.references.size()) {
    return found(Issue::reference, fmt::format("reference {}", i));
  }
  const PackedTriangles packed = geometry.packed();
  const auto vertex_count = static_cast<uint32_t>(geometry.vertex_count());
  for (size_t i = 0; i < geometry.triangle_count(); ++i) {
    const Vec3u c = packed.corners_of(i);
    if (c.x >= vertex_count || c.y >= vertex_count || c.z >= vertex_count) {
      return found(Issue::corner, fmt::format("triangle {}", i));
    }
  }
  if (words == 3) {
    if (const size_t i = first_at_least(geometry.vertices, uint64_t{1} << geometry.bits);
        i < geometry.vertices.size()) {
      return found(Issue::vertex_range, fmt::format("vertex {}", i / 3));
    }
  }
  return std::nullopt;
}

Check check_source_primitives(const Attributes& a, size_t triangle_count) {
  if (a.source_primitives.empty() || a.source_primitives.size() == triangle_count) return std::nullopt;
  return found(Issue::source_primitives);
}

Check check_normals(const Attributes& a, size_t triangle_count) {
  if (a.normal_indices.empty()) return std::nullopt;
  if (a.normal_indices.size() != 3 * triangle_count) return found(Issue::normals);
  for (size_t i = 0; i < a.normal_indices.size(); ++i) {
    if (a.normal_indices[i] >= a.normals.size() && a.normal_indices[i] != 0xffffffffu) {
      return found(Issue::normals, fmt::format("triangle {}", i / 3));
    }
  }
  for (size_t i = 0; i < a.normals.size(); ++i) {
    if (!is_finite(vec_cast<double>(a.normals[i]))) return found(Issue::normal_value, fmt::format("normal {}", i));
  }
  return std::nullopt;
}

Check check_materials(const Attributes& a, size_t triangle_count) {
  if (a.material_ids.empty()) return std::nullopt;
  if (a.material_ids.size() != triangle_count) return found(Issue::materials);
  if (const size_t i = first_at_least(a.material_ids, a.materials.size()); i < a.material_ids.size()) {
    return found(Issue::materials, fmt::format("triangle {}", i));
  }
  for (size_t i = 0; i < a.materials.size(); ++i) {
    const Material& m = a.materials[i];
    const auto sound = [](Vec3f c) { return is_finite(vec_cast<double>(c)) && c.x >= 0 && c.y >= 0 && c.z >= 0; };
    if (!sound(m.ambient) || !sound(m.diffuse) || !sound(m.specular) || !std::isfinite(m.shininess) ||
        m.shininess < 0) {
      return found(Issue::material_value, fmt::format("material {}", i));
    }
  }
  return std::nullopt;
}

template <class T>
Check check_checksum(std::span<const T> section, uint64_t recorded, const char* name) {
  const uint64_t actual = section.empty() ? 0 : hash_span(section);
  if (actual == recorded) return std::nullopt;
  return found(Issue::checksum, fmt::format("section {}", name));
}
template Check check_checksum(std::span<const uint32_t>, uint64_t, const char*);
template Check check_checksum(std::span<const uint16_t>, uint64_t, const char*);
template Check check_checksum(std::span<const Node>, uint64_t, const char*);
template Check check_checksum(std::span<const Vec3f>, uint64_t, const char*);
template Check check_checksum(std::span<const Material>, uint64_t, const char*);

Check check_header_checksum(const nkd_schema::Object& object) {
  if (header_checksum(object) == object.header_checksum()) return std::nullopt;
  return found(Issue::header_checksum);
}

Check check_geometry_checksums(const nkd_schema::Object& object, const Geometry& geometry) {
  const nkd_schema::Checksums& sums = *object.checksums();
  if (auto f = check_checksum(geometry.nodes, sums.nodes(), "nodes")) return f;
  if (auto f = check_checksum(geometry.references, sums.references(), "references")) return f;
  if (auto f = check_checksum(geometry.triangles, sums.triangles(), "triangles")) return f;
  return check_checksum(geometry.vertices, sums.vertices(), "vertices");
}

}  // namespace kd::nkd
