#include "nkd/write.h"

#include <fmt/format.h>

#include "nkd/header.h"
#include "nkd/schema.h"
#include "sys/atomic_file.h"
#include "sys/hash.h"

namespace kd::nkd {

namespace {

constexpr size_t kSectionAlignment = 16;
constexpr uint64_t kLargestFile = (1ull << 31) - 1;

template <class T>
uint64_t checksum(std::span<const T> s) {
  return s.empty() ? 0 : hash_span(s);
}

nkd_schema::Double3 stored(Vec3d v) { return {v.x, v.y, v.z}; }

/// A section of `Stored` elements from a span of core's type with the same bytes.
template <class Stored, class T>
flatbuffers::Offset<flatbuffers::Vector<const Stored*>> struct_section(flatbuffers::FlatBufferBuilder& builder,
                                                                       std::span<const T> s) {
  if (s.empty()) return 0;
  const size_t count = s.size_bytes() / sizeof(Stored);
  builder.ForceVectorAlignment(count, sizeof(Stored), kSectionAlignment);
  return builder.CreateVectorOfStructs(reinterpret_cast<const Stored*>(s.data()), count);
}

template <class T>
flatbuffers::Offset<flatbuffers::Vector<T>> scalar_section(flatbuffers::FlatBufferBuilder& builder,
                                                           std::span<const T> s, bool required = false) {
  if (s.empty() && !required) return 0;
  builder.ForceVectorAlignment(s.size(), sizeof(T), kSectionAlignment);
  return builder.CreateVector(s.data(), s.size());
}

uint64_t payload_size(const Geometry& g, const Attributes& a) {
  return g.nodes.size_bytes() + g.references.size_bytes() + g.triangles.size_bytes() + g.vertices.size_bytes() +
         a.source_primitives.size_bytes() + a.normals.size_bytes() + a.normal_indices.size_bytes() +
         a.materials.size_bytes() + a.material_ids.size_bytes();
}

}  // namespace

Result<uint64_t> write_object(const std::string& path, const Summary& summary, const Geometry& geometry,
                              const Attributes& attributes) {
  const uint64_t payload = payload_size(geometry, attributes);
  if (payload > kLargestFile - (1u << 20)) {
    return Error{ErrorClass::resource, path,
                 fmt::format("the object has {} bytes, and a .nkd holds at most 2 GiB: split the mesh", payload)};
  }
  flatbuffers::FlatBufferBuilder builder(payload + 4096);

  // A FlatBuffer grows towards its front: what is created first lies last in the file. The sections that every render
  // reads are created last and stand together behind the header.
  const auto material_ids = scalar_section(builder, attributes.material_ids);
  const auto materials = struct_section<nkd_schema::Material>(builder, attributes.materials);
  const auto normal_indices = struct_section<nkd_schema::Triangle>(builder, attributes.normal_indices);
  const auto normals = struct_section<nkd_schema::Float3>(builder, attributes.normals);
  const auto source_primitives = scalar_section(builder, attributes.source_primitives);
  const auto vertices = scalar_section(builder, geometry.vertices, true);
  const auto triangles = scalar_section(builder, geometry.triangles, true);
  const auto references = scalar_section(builder, geometry.references, true);
  const auto nodes = struct_section<nkd_schema::Node>(builder, geometry.nodes);

  const auto names = summary.material_names.empty() ? 0 : builder.CreateVectorOfStrings(summary.material_names);
  const Provenance& p = summary.provenance;
  const auto provenance = nkd_schema::CreateProvenanceDirect(builder, p.source_name.c_str(), p.source_hash,
                                                             p.settings.c_str(), p.writer.c_str());
  const nkd_schema::Checksums checksums(
      checksum(geometry.nodes), checksum(geometry.references), checksum(geometry.triangles),
      checksum(geometry.vertices), checksum(attributes.source_primitives), checksum(attributes.normals),
      checksum(attributes.normal_indices), checksum(attributes.materials), checksum(attributes.material_ids));
  const TreeStatistics& t = summary.tree;
  const nkd_schema::TreeStatistics tree(t.sah_cost, t.inner_nodes, t.leaves, t.empty_leaves, t.depth, t.largest_leaf);
  const auto origin = stored(summary.lattice.origin), extent = stored(summary.lattice.extent);

  nkd_schema::ObjectBuilder object(builder);
  object.add_version(kFormatVersion);
  object.add_bits(static_cast<uint8_t>(summary.lattice.bits));
  object.add_vertex_form(static_cast<nkd_schema::VertexForm>(geometry.form));
  object.add_origin(&origin);
  object.add_extent(&extent);
  object.add_max_displacement(summary.max_displacement);
  object.add_rms_displacement(summary.rms_displacement);
  object.add_nodes(nodes);
  object.add_references(references);
  object.add_triangles(triangles);
  object.add_vertices(vertices);
  object.add_source_primitives(source_primitives);
  object.add_normals(normals);
  object.add_normal_indices(normal_indices);
  object.add_materials(materials);
  object.add_material_names(names);
  object.add_material_ids(material_ids);
  object.add_emissive(is_emissive(attributes.materials));
  object.add_checksums(&checksums);
  object.add_tree(&tree);
  object.add_provenance(provenance);
  object.add_file_bytes(1);  // both known only once the file is; a default would take no place
  object.add_header_checksum(1);
  nkd_schema::FinishObjectBuffer(builder, object.Finish());

  nkd_schema::Object* finished = nkd_schema::GetMutableObject(builder.GetBufferPointer());
  finished->mutate_file_bytes(builder.GetSize());
  finished->mutate_header_checksum(header_checksum(*finished));
  const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
  if (auto written = write_file(path, bytes); !written) return written.error();
  return bytes.size();
}

}  // namespace kd::nkd
