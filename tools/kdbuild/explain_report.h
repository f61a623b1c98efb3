// Explanations for reading: as text, as JSON, as a picture.
#pragma once

#include <string>
#include <vector>

#include "common/report.h"
#include "kdbuild/explain.h"
#include "nkd/object_file.h"

namespace kd::tools {

struct SectionBytes {
  const char* name = "";
  uint64_t bytes = 0;
};

/// An object's file, explained.
struct ObjectExplanation {
  std::string name;  // the file's, without folders
  Explanation tree;
  std::vector<SectionBytes> sections;  // all of the file; the rest is its header and its attributes

  double bytes_per_triangle() const;
};

ObjectExplanation explain_object(const nkd::ObjectFile& file);

void print_explanation(const ObjectExplanation& e);
Json explanation_json(const ObjectExplanation& e);

/// Four panels: SAH cost by depth, leaves by depth, leaves by size, triangles by references. The same explanation gives
/// the same bytes. ErrorClass::output.
Result<void> write_explanation_svg(const std::string& path, const ObjectExplanation& e);

/// Opens an object, prints its explanation if `print`, and draws it if `plot` names a file. Errors as
/// ObjectFile::open and write_explanation_svg.
Result<void> explain_file(const std::string& object_path, bool print, const std::string& plot);

}  // namespace kd::tools
