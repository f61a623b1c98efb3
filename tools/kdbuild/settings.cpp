#include "kdbuild/settings.h"

#include <fmt/format.h>

namespace kd::tools {

std::string settings_text(const CompileSettings& s) {
  const CompileSettings standard;
  std::string text = s.max_error ? fmt::format("--max-error {}", *s.max_error) : fmt::format("--bits {}", s.bits);
  const auto add = [&text](const char* flag, auto value, auto usual) {
    if (value != usual) text += fmt::format(" {} {}", flag, value);
  };
  if (s.vertices != VertexForm::lattice) text += fmt::format(" --vertices {}", name_of(s.vertices));
  if (s.ambient_from_diffuse) text += " --ambient-from-diffuse";
  if (s.split != mesh::Split::none) text += s.split == mesh::Split::object ? " --split object" : " --split material";
  add("--max-object-size", s.max_object_size, standard.max_object_size);
  add("--traversal-cost", s.tree.costs.traversal, standard.tree.costs.traversal);
  add("--intersection-cost", s.tree.costs.intersection, standard.tree.costs.intersection);
  add("--empty-bonus", s.tree.costs.empty_bonus, standard.tree.costs.empty_bonus);
  add("--byte-price", s.tree.costs.byte_price, standard.tree.costs.byte_price);
  add("--max-depth", s.tree.max_depth, standard.tree.max_depth);
  return text;
}

}  // namespace kd::tools
