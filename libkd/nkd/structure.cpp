#include "nkd/structure.h"

#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "nkd/first_beyond.h"
#include "nkd/header.h"
#include "sys/hash.h"

namespace kd::nkd {

namespace {

template <class Stored>
bool misaligned(const flatbuffers::Vector<Stored>* v) {
  return v && reinterpret_cast<uintptr_t>(v->Data()) % 16 != 0;
}

/// Of a file whose tables may be those of another version, and unverified: only what leads to the number is looked at.
std::optional<uint32_t> version_of(const uint8_t* data, size_t size) {
  flatbuffers::Verifier verifier(data, size);
  const auto root = verifier.VerifyOffset(0);
  if (root == 0) return std::nullopt;
  const auto* table = reinterpret_cast<const flatbuffers::Table*>(data + root);
  constexpr auto kField = nkd_schema::Object::VT_VERSION;
  if (!table->VerifyTableStart(verifier) || !table->VerifyField<uint32_t>(verifier, kField, sizeof(uint32_t)))
    return std::nullopt;
  return table->GetField<uint32_t>(kField, 0);
}

}  // namespace

Check check_container(std::span<const std::byte> bytes) {
  const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
  constexpr size_t kHeader = 16;
  if (bytes.size() < kHeader || !nkd_schema::ObjectBufferHasIdentifier(data)) return found(Issue::not_nkd);
  if (bytes.size() >= FLATBUFFERS_MAX_BUFFER_SIZE) return found(Issue::offsets, "2 GiB or more, which no .nkd has");
  // First, because the verifier knows the tables of this version only.
  if (const auto version = version_of(data, bytes.size()); version && *version != kFormatVersion) {
    return found(Issue::version, fmt::format("version {}, this program reads {}", *version, kFormatVersion));
  }
  flatbuffers::Verifier verifier(data, bytes.size(), 8, 16, true);
  if (!nkd_schema::VerifyObjectBuffer(verifier)) return found(Issue::offsets);
  const nkd_schema::Object& o = *nkd_schema::GetObject(data);
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

Check check_vertex_form(const Geometry& geometry) {
  const bool sound = geometry.form == VertexForm::lattice ||
                     (geometry.form == VertexForm::float32 && geometry.bits == kMaxLatticeBits);
  if (sound) return std::nullopt;
  return found(Issue::vertex_form, fmt::format("form {}, {} bits", static_cast<int>(geometry.form), geometry.bits));
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
  if (const size_t i = first_beyond(a.material_ids, a.materials.size()); i < a.material_ids.size()) {
    return found(Issue::materials, fmt::format("triangle {}", i));
  }
  for (size_t i = 0; i < a.materials.size(); ++i) {
    const Material& m = a.materials[i];
    const auto sound = [](Vec3f c) { return is_finite(vec_cast<double>(c)) && c.x >= 0 && c.y >= 0 && c.z >= 0; };
    if (!sound(m.ambient) || !sound(m.diffuse) || !sound(m.specular) || !sound(m.emission) ||
        !std::isfinite(m.shininess) || m.shininess < 0) {
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
template Check check_checksum(std::span<const uint8_t>, uint64_t, const char*);
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
