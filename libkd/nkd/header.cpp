#include "nkd/header.h"

#include <string>

#include "sys/hash.h"

namespace kd::nkd {

namespace {

class Digest {
 public:
  template <class T>
  void add(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void add_text(const flatbuffers::String* text) {
    add(text ? text->size() : 0u);
    if (text) bytes_.append(text->c_str(), text->size());
  }
  template <class T>
  void add_size(const flatbuffers::Vector<T>* section) {
    add(section ? section->size() : 0u);
  }
  uint64_t hash() const { return hash_bytes(bytes_.data(), bytes_.size()); }

 private:
  std::string bytes_;
};

}  // namespace

uint64_t header_checksum(const nkd_schema::Object& o) {
  Digest digest;
  digest.add(o.version());
  digest.add(o.bits());
  digest.add(o.vertex_form());
  digest.add(*o.origin());
  digest.add(*o.extent());
  digest.add(o.max_displacement());
  digest.add(o.rms_displacement());
  digest.add_size(o.nodes());
  digest.add_size(o.references());
  digest.add_size(o.triangles());
  digest.add_size(o.vertices());
  digest.add_size(o.source_primitives());
  digest.add_size(o.normals());
  digest.add_size(o.normal_indices());
  digest.add_size(o.materials());
  digest.add_size(o.material_names());
  digest.add_size(o.material_ids());
  digest.add(o.emissive());
  if (o.material_names()) {
    for (const auto* name : *o.material_names()) digest.add_text(name);
  }
  digest.add(*o.checksums());
  digest.add(*o.tree());
  digest.add_text(o.provenance()->source_name());
  digest.add(o.provenance()->source_hash());
  digest.add_text(o.provenance()->settings());
  digest.add_text(o.provenance()->writer());
  digest.add(o.file_bytes());
  return digest.hash();
}

}  // namespace kd::nkd
