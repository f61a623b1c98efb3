// A mapped .nkd. Nothing in a file is trusted: opening one checks all that traversal relies on, so that a hostile file
// can neither make it read outside the sections nor run forever. Attribute sections are checked when they are asked
// for; until then none of their pages is read from disk, but the one in which a section begins, where its size is.
#pragma once

#include <string>

#include "nkd/contents.h"
#include "nkd/issues.h"
#include "sys/mapped_file.h"
#include "sys/result.h"

namespace kd::nkd_schema {
struct Object;
}

namespace kd::nkd {

class ObjectFile {
 public:
  /// Maps and validates. ErrorClass::missing if the path cannot be read, ErrorClass::object with the code if
  /// the file is unsound.
  static Result<ObjectFile> open(const std::string& path);
  /// The same of the header alone: summary() and size() are known, no section is read. What geometry() leads to is not
  /// to be followed before check_geometry() has found it sound.
  static Result<ObjectFile> open_header(const std::string& path);
  Result<void> check_geometry() const;

  const std::string& path() const { return path_; }
  uint64_t size() const { return file_.bytes().size(); }
  const Summary& summary() const { return summary_; }
  const Geometry& geometry() const { return geometry_; }

  bool has_normals() const;
  bool has_materials() const;
  bool has_source_primitives() const;
  /// The part of the attributes asked for; the spans are empty where the object has none. ErrorClass::object if
  /// unsound.
  Result<std::span<const uint32_t>> source_primitives() const;
  struct Normals {
    std::span<const Vec3f> values;
    std::span<const uint32_t> indices;
  };
  Result<Normals> normals() const;
  struct Materials {
    std::span<const Material> values;
    std::span<const uint16_t> ids;
  };
  Result<Materials> materials() const;

  /// What is wrong in the attribute sections, all of them read for it. Empty: they are sound.
  std::vector<Finding> check_attributes() const;

 private:
  template <class... Sections>
  void will_read(const Sections&... sections) const;

  std::string path_;
  MappedFile file_;
  const nkd_schema::Object* object_ = nullptr;
  Summary summary_;
  Geometry geometry_;
};

}  // namespace kd::nkd
