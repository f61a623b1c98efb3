#include "nkd/object_file.h"

#include "nkd/structure.h"

namespace kd::nkd {

namespace {

Vec3d vec(const nkd_schema::Double3& d) { return {d.x(), d.y(), d.z()}; }

std::string text(const flatbuffers::String* s) { return s ? s->str() : std::string(); }

Summary read_summary(const nkd_schema::Object& o) {
  Summary s;
  s.lattice = {vec(*o.origin()), vec(*o.extent()), o.bits()};
  s.max_displacement = o.max_displacement();
  s.rms_displacement = o.rms_displacement();
  const nkd_schema::TreeStatistics& t = *o.tree();
  s.tree = {t.sah_cost(), t.inner_nodes(), t.leaves(), t.empty_leaves(), t.depth(), t.largest_leaf()};
  const nkd_schema::Provenance& p = *o.provenance();
  s.provenance = {text(p.source_name()), p.source_hash(), text(p.settings()), text(p.writer())};
  s.emissive = o.emissive();
  if (o.material_names()) {
    for (const auto* name : *o.material_names()) s.material_names.push_back(text(name));
  }
  return s;
}

Geometry read_geometry(const nkd_schema::Object& o) {
  return {section<Node>(o.nodes()),
          section<uint32_t>(o.references()),
          section<uint8_t>(o.triangles()),
          section<uint8_t>(o.vertices()),
          o.bits(),
          static_cast<VertexForm>(o.vertex_form())};
}

/// Spans only: no page of the sections is touched.
Attributes read_attributes(const nkd_schema::Object& o) {
  return {section<uint32_t>(o.source_primitives()), section<Vec3f>(o.normals()), section<uint32_t>(o.normal_indices()),
          section<Material>(o.materials()), section<uint16_t>(o.material_ids())};
}

Check check_source_primitives_section(const nkd_schema::Object& o, const Attributes& a, size_t triangle_count) {
  if (auto f = check_checksum(a.source_primitives, o.checksums()->source_primitives(), "source_primitives")) return f;
  return check_source_primitives(a, triangle_count);
}

Check check_normal_sections(const nkd_schema::Object& o, const Attributes& a, size_t triangle_count) {
  if (auto f = check_checksum(a.normals, o.checksums()->normals(), "normals")) return f;
  if (auto f = check_checksum(a.normal_indices, o.checksums()->normal_indices(), "normal_indices")) return f;
  return check_normals(a, triangle_count);
}

Check check_material_sections(const nkd_schema::Object& o, const Attributes& a, size_t triangle_count) {
  if (auto f = check_checksum(a.materials, o.checksums()->materials(), "materials")) return f;
  if (auto f = check_checksum(a.material_ids, o.checksums()->material_ids(), "material_ids")) return f;
  if (auto f = check_materials(a, triangle_count)) return f;
  if (is_emissive(a.materials) == o.emissive()) return std::nullopt;
  return found(Issue::material_value, "emission where the header has none, or none where it has some");
}

Error unsound(const std::string& path, const Finding& finding) { return {ErrorClass::object, path, finding.line()}; }

}  // namespace

Result<ObjectFile> ObjectFile::open(const std::string& path) {
  auto file = open_header(path);
  if (!file) return file;
  if (auto sound = file->check_geometry(); !sound) return sound.error();
  return file;
}

Result<ObjectFile> ObjectFile::open_header(const std::string& path) {
  auto file = MappedFile::open(path, MappedFile::Access::sparse);
  if (!file) return file.error();
  ObjectFile o;
  o.path_ = path;
  o.file_ = std::move(*file);
  if (auto f = check_container(o.file_.bytes())) return unsound(path, *f);
  o.object_ = nkd_schema::GetObject(o.file_.bytes().data());
  o.summary_ = read_summary(*o.object_);
  o.geometry_ = read_geometry(*o.object_);
  if (auto f = check_summary(o.summary_)) return unsound(path, *f);
  if (auto f = check_vertex_form(o.geometry_)) return unsound(path, *f);
  if (auto f = check_header_checksum(*o.object_)) return unsound(path, *f);
  return o;
}

template <class... Sections>
void ObjectFile::will_read(const Sections&... sections) const {
  (file_.will_read(std::as_bytes(sections)), ...);
}

Result<void> ObjectFile::check_geometry() const {
  will_read(geometry_.nodes, geometry_.references, geometry_.triangles, geometry_.vertices);
  if (auto f = check_geometry_checksums(*object_, geometry_)) return unsound(path_, *f);
  if (auto f = check_nodes(geometry_)) return unsound(path_, *f);
  if (auto f = check_indices(geometry_)) return unsound(path_, *f);
  return {};
}

bool ObjectFile::has_normals() const { return object_->normal_indices() && object_->normal_indices()->size() > 0; }
bool ObjectFile::has_source_primitives() const {
  return object_->source_primitives() && object_->source_primitives()->size() > 0;
}
bool ObjectFile::has_materials() const { return object_->material_ids() && object_->material_ids()->size() > 0; }

Result<std::span<const uint32_t>> ObjectFile::source_primitives() const {
  const Attributes a = read_attributes(*object_);
  will_read(a.source_primitives);
  if (auto f = check_source_primitives_section(*object_, a, geometry_.triangle_count())) return unsound(path_, *f);
  return a.source_primitives;
}

Result<ObjectFile::Normals> ObjectFile::normals() const {
  const Attributes a = read_attributes(*object_);
  will_read(a.normals, a.normal_indices);
  if (auto f = check_normal_sections(*object_, a, geometry_.triangle_count())) return unsound(path_, *f);
  return Normals{a.normals, a.normal_indices};
}

Result<ObjectFile::Materials> ObjectFile::materials() const {
  const Attributes a = read_attributes(*object_);
  will_read(a.materials, a.material_ids);
  if (auto f = check_material_sections(*object_, a, geometry_.triangle_count())) return unsound(path_, *f);
  return Materials{a.materials, a.material_ids};
}

std::vector<Finding> ObjectFile::check_attributes() const {
  const Attributes a = read_attributes(*object_);
  will_read(a.source_primitives, a.normals, a.normal_indices, a.materials, a.material_ids);
  const size_t count = geometry_.triangle_count();
  std::vector<Finding> findings;
  for (const Check& f : {check_source_primitives_section(*object_, a, count), check_normal_sections(*object_, a, count),
                         check_material_sections(*object_, a, count)}) {
    if (f) findings.push_back(*f);
  }
  return findings;
}

}  // namespace kd::nkd
