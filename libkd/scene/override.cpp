#include "scene/override.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "scene/json_shape.h"
#include "scene/scene_reader.h"

namespace kd::scene {

namespace {

/// One step of a path: into a field, or if it has no name, to an element.
struct Step {
  std::string_view name;
  uint32_t index = 0;
  Shape shape;       // of the value it leads to
  std::string path;  // up to and with it
};

class OverrideWriter {
 public:
  OverrideWriter(std::string& json, const Override& change) : json_(json), change_(change) {}

  Result<void> write() {
    const bool good = read_path() && check_value() && put();
    return good ? Result<void>() : Result<void>(*error_);
  }

 private:
  bool fail(std::string what) {
    error_ = Error{ErrorClass::usage, fmt::format("{}={}", change_.path, change_.value), std::move(what)};
    return false;
  }
  const std::string& path_before(size_t step) const {
    static const std::string root;
    return step == 0 ? root : steps_[step - 1].path;
  }
  std::string called(size_t step) const { return step == 0 ? "the scene" : fmt::format("'{}'", path_before(step)); }

  bool read_path();
  bool add_field(std::string_view name);
  bool add_index(std::string_view digits);
  bool check_value();
  bool put();

  const reflection::Schema& schema_ = scene_schema();
  std::string& json_;
  const Override& change_;
  std::vector<Step> steps_;
  std::optional<Error> error_;
};

bool OverrideWriter::read_path() {
  std::string_view rest = change_.path;
  while (!rest.empty()) {
    if (rest.front() == '[') {
      const size_t end = rest.find(']');
      if (end == std::string_view::npos) return fail("the path has '[' without ']'");
      if (!add_index(rest.substr(1, end - 1))) return false;
      rest.remove_prefix(end + 1);
      continue;
    }
    if (!steps_.empty()) {
      if (rest.front() != '.')
        return fail(fmt::format("the path must go on with '.' or '[' behind {}", called(steps_.size())));
      rest.remove_prefix(1);
    }
    const std::string_view name = rest.substr(0, rest.find_first_of(".["));
    if (!add_field(name)) return false;
    rest.remove_prefix(name.size());
  }
  return !steps_.empty() || fail("there is no path: write path=value");
}

bool OverrideWriter::add_field(std::string_view name) {
  const Shape outer = steps_.empty() ? root_shape(schema_) : steps_.back().shape;
  const reflection::Object* table = object_of(schema_, outer);
  if (!table || table->is_struct()) return fail(fmt::format("{} has no fields", called(steps_.size())));
  const reflection::Field* field = find_field(*table, name);
  if (!field) {
    return fail(fmt::format("unknown field '{}': {} may have {}", name, called(steps_.size()), field_names(*table)));
  }
  const std::string& before = path_before(steps_.size());
  steps_.push_back({name, 0, shape_of(*field), fmt::format("{}{}{}", before, before.empty() ? "" : ".", name)});
  return true;
}

bool OverrideWriter::add_index(std::string_view digits) {
  Step step{};
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), step.index);
  if (digits.empty() || fault != std::errc() || end != digits.data() + digits.size()) {
    return fail(fmt::format("an index must be a whole number from 0 on, not '{}'", digits));
  }
  const Shape outer = steps_.empty() ? root_shape(schema_) : steps_.back().shape;
  const reflection::Object* object = object_of(schema_, outer);
  if (outer.base == reflection::Vector) {
    step.shape = {outer.element, reflection::None, outer.index};
  } else if (object && object->is_struct()) {
    step.shape = {reflection::Double, reflection::None, -1};
  } else {
    return fail(fmt::format("{} is no array", called(steps_.size())));
  }
  step.path = fmt::format("{}[{}]", path_before(steps_.size()), step.index);
  steps_.push_back(step);
  return true;
}

bool OverrideWriter::check_value() {
  const auto fault = scene::find_fault(change_.value, schema_, steps_.back().shape);
  return !fault || fail(fault->what);
}

/// Replaces the value, or adds it to the innermost object around it that there is.
bool OverrideWriter::put() {
  if (const auto old = find_value(json_, schema_, steps_.back().path)) {
    json_.replace(old->begin, old->end - old->begin, change_.value);
    return true;
  }
  std::string value = change_.value;
  for (size_t i = steps_.size(); i-- > 0;) {
    if (steps_[i].name.empty()) {
      return fail(fmt::format("there is no element {} in {}", steps_[i].index, called(i)));
    }
    value = fmt::format("\"{}\": {}", steps_[i].name, value);
    if (const auto outer = find_value(json_, schema_, path_before(i))) {
      const bool is_empty = json_[json_.find_first_not_of(" \t\r\n", outer->begin + 1)] == '}';
      json_.insert(outer->begin + 1, value + (is_empty ? "" : ", "));
      return true;
    }
    value = "{" + value + "}";
  }
  return fail("the scene is no object");  // not reached: the root is one
}

}  // namespace

Result<Override> parse_override(std::string_view text) {
  const size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
    return Error{ErrorClass::usage, std::string(text), "an override is written path=value, as in film.width=640"};
  }
  return Override{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Result<std::string> apply_overrides(std::string json, std::span<const Override> overrides) {
  for (const Override& change : overrides) {
    if (const auto written = OverrideWriter(json, change).write(); !written) return written.error();
  }
  return json;
}

}  // namespace kd::scene
