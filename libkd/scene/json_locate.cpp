#include "scene/json_locate.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <flatbuffers/reflection_generated.h>
#include <fmt/format.h>

#include "scene/json_shape.h"

namespace kd::scene {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// A recursive descent over the text, guided by the schema. Functions return false once a fault is recorded. The schema
/// is not recursive and nothing unknown is descended into, so the depth is bounded.
class Scanner {
 public:
  Scanner(std::string_view json, const reflection::Schema& schema, JsonVisitor visit = {})
      : json_(json), schema_(schema), visit_(std::move(visit)) {
    if (json_.starts_with("\xEF\xBB\xBF")) line_start_ = at_ = 3;
  }

  std::optional<JsonFault> scan() { return scan(root_shape(schema_), "the scene"); }
  std::optional<JsonFault> scan(const Shape& shape, std::string_view name) {
    name_ = name;
    if (value(shape) && !at_end()) fail(fmt::format("{} after the end of {}", found(), name));
    return fault_;
  }
  /// Where the value at `path` stands.
  std::optional<JsonSpan> find(std::string_view path) {
    wanted_ = path;
    scan();
    return span_;
  }

 private:
  bool value(const Shape& shape);
  bool value_here(const Shape& shape);
  bool table(const reflection::Object& type);
  bool field(const reflection::Object& type, std::vector<std::string_view>& seen);
  bool array(const Shape& element, size_t wanted_count);
  bool enumerator(const reflection::Enum& type);
  bool number();
  bool whole_number();
  bool truth();
  bool string(std::string_view& content);

  void skip_space();
  bool at_end() {
    skip_space();
    return at_ == json_.size();
  }
  char peek(size_t ahead = 0) const { return at_ + ahead < json_.size() ? json_[at_ + ahead] : '\0'; }
  bool take(char c);
  bool more(char close, bool& again);
  std::string_view number_token() const;

  Position here() const { return {line_, static_cast<int>(at_ - line_start_) + 1}; }
  bool fail(std::string what) { return fail(here(), std::move(what)); }
  bool fail(Position at, std::string what);
  bool expected(std::string_view what) { return fail(fmt::format("{} must be {}, not {}", subject(), what, found())); }
  std::string subject() const;
  std::string found() const;

  std::string_view json_;
  const reflection::Schema& schema_;
  const JsonVisitor visit_;
  size_t at_ = 0;
  int line_ = 1;
  size_t line_start_ = 0;
  std::string path_;
  std::string_view name_;  // of what is scanned
  std::optional<std::string_view> wanted_;
  std::optional<JsonSpan> span_;
  std::optional<JsonFault> fault_;
};

bool Scanner::value(const Shape& shape) {
  skip_space();
  const size_t begin = at_;
  const bool good = value_here(shape);
  if (good && wanted_ && path_ == *wanted_) span_ = JsonSpan{begin, at_};
  return good;
}

bool Scanner::value_here(const Shape& shape) {
  const auto index = static_cast<flatbuffers::uoffset_t>(shape.index);
  const reflection::Object* object = shape.base == reflection::Obj ? schema_.objects()->Get(index) : nullptr;
  const bool is_table = object && !object->is_struct();
  if (visit_) visit_({path_, is_table ? object->name()->string_view() : std::string_view{}, here()});
  switch (shape.base) {
    case reflection::Obj:
      return is_table ? table(*object) : array({reflection::Double, reflection::None, -1}, object->fields()->size());
    case reflection::Vector:
      return array({shape.element, reflection::None, shape.index}, 0);
    case reflection::String: {
      std::string_view content;
      return peek() == '"' ? string(content) : expected("a string");
    }
    case reflection::Double:
      return number();
    case reflection::Bool:
      return truth();
    default:
      return shape.index >= 0 ? enumerator(*schema_.enums()->Get(index)) : whole_number();
  }
}

bool Scanner::table(const reflection::Object& type) {
  const Position start = here();
  if (!take('{')) return expected("an object, {...}");
  std::vector<std::string_view> seen;
  skip_space();
  if (!take('}')) {
    for (bool again = true; again;) {
      if (!field(type, seen) || !more('}', again)) return false;
    }
  }
  for (const reflection::Field* wanted : *type.fields()) {
    const std::string_view name = wanted->name()->string_view();
    if (wanted->required() && std::find(seen.begin(), seen.end(), name) == seen.end()) {
      return fail(start, fmt::format("{} lacks '{}'", subject(), name));
    }
  }
  return true;
}

bool Scanner::field(const reflection::Object& type, std::vector<std::string_view>& seen) {
  skip_space();
  const Position start = here();
  std::string_view name;
  if (peek() != '"') return fail(fmt::format("expected a field's name in double quotes, not {}", found()));
  if (!string(name)) return false;
  const reflection::Field* known = find_field(type, name);
  if (!known) {
    return fail(start, fmt::format("unknown field '{}': {} may have {}", name, subject(), field_names(type)));
  }
  if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
    return fail(start, fmt::format("'{}' is given twice", name));
  }
  seen.push_back(name);
  skip_space();
  if (!take(':')) return fail(fmt::format("expected ':' after '{}', not {}", name, found()));

  const size_t outer = path_.size();
  if (outer > 0) path_ += '.';
  path_ += name;
  const bool good = value({known->type()->base_type(), known->type()->element(), known->type()->index()});
  if (good) path_.resize(outer);
  return good;
}

/// A vector, or with a `wanted_count` a struct.
bool Scanner::array(const Shape& element, size_t wanted_count) {
  const Position start = here();
  const auto wanted = [&] {
    return wanted_count > 0 ? fmt::format("an array of {} numbers", wanted_count) : "an array, [...]";
  };
  if (!take('[')) return expected(wanted());
  size_t count = 0;
  const size_t outer = path_.size();
  skip_space();
  if (!take(']')) {
    for (bool again = true; again; ++count) {
      fmt::format_to(std::back_inserter(path_), "[{}]", count);
      if (!value(element)) return false;
      path_.resize(outer);
      if (!more(']', again)) return false;
    }
  }
  if (wanted_count == 0 || count == wanted_count) return true;
  return fail(start, fmt::format("{} must be {}, not of {}", subject(), wanted(), count));
}

bool Scanner::enumerator(const reflection::Enum& type) {
  const Position start = here();
  std::string wanted;
  for (const reflection::EnumVal* v : *type.values()) {
    wanted += fmt::format("{}\"{}\"", wanted.empty() ? "" : " or ", v->name()->string_view());
  }
  if (peek() != '"') return expected(wanted);
  std::string_view content;
  if (!string(content)) return false;
  for (const reflection::EnumVal* v : *type.values()) {
    if (v->name()->string_view() == content) return true;
  }
  return fail(start, fmt::format("{} must be {}, not \"{}\"", subject(), wanted, content));
}

bool Scanner::number() {
  const std::string_view token = number_token();
  if (token.empty()) return expected("a number");
  double parsed = 0;
  if (std::from_chars(token.data(), token.data() + token.size(), parsed).ec != std::errc()) {
    return fail(fmt::format("{} must be a number that fits a double, about 1e-308 to 1e308", subject()));
  }
  at_ += token.size();
  return true;
}

bool Scanner::whole_number() {
  const std::string_view token = number_token();
  uint32_t parsed = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), parsed);
  if (token.empty() || error != std::errc() || end != token.data() + token.size()) {
    return fail(fmt::format("{} must be a whole number from 0 to {}, not {}", subject(), UINT32_MAX,
                            token.empty() ? found() : std::string(token)));
  }
  at_ += token.size();
  return true;
}

bool Scanner::truth() {
  for (const std::string_view word : {"true", "false"}) {
    if (!json_.substr(at_).starts_with(word) || is_word(peek(word.size()))) continue;
    at_ += word.size();
    return true;
  }
  return expected("true or false");
}

/// The number that stands here by JSON's grammar (no plus sign, leading zero, hexadecimal or bare point), or nothing.
std::string_view Scanner::number_token() const {
  size_t length = 0;
  const auto digits = [&] {
    const size_t first = length;
    while (is_digit(peek(length))) ++length;
    return length > first;
  };
  if (peek() == '-') ++length;
  if (peek(length) == '0') {
    ++length;
  } else if (!digits()) {
    return {};
  }
  if (peek(length) == '.') {
    ++length;
    if (!digits()) return {};
  }
  if (peek(length) == 'e' || peek(length) == 'E') {
    ++length;
    if (peek(length) == '+' || peek(length) == '-') ++length;
    if (!digits()) return {};
  }
  return json_.substr(at_, length);
}

/// Takes a string; `content` is what stands between its quotes, escapes as written.
bool Scanner::string(std::string_view& content) {
  const Position start = here();
  const size_t first = ++at_;
  while (peek() != '"') {
    if (at_ == json_.size()) return fail(start, "this string does not end");
    if (static_cast<unsigned char>(peek()) < ' ') return fail("control character in a string: write it as an escape");
    if (peek() == '\\' && std::string_view("\"\\/bfnrtu").find(peek(1)) == std::string_view::npos) {
      return fail("unknown escape in a string: a backslash itself is written \\\\");
    }
    at_ += peek() == '\\' ? 2 : 1;
  }
  content = json_.substr(first, at_ - first);
  ++at_;
  return true;
}

void Scanner::skip_space() {
  for (; peek() == ' ' || peek() == '\t' || peek() == '\r' || peek() == '\n'; ++at_) {
    if (peek() != '\n') continue;
    ++line_;
    line_start_ = at_ + 1;
  }
}

bool Scanner::take(char c) {
  if (at_ == json_.size() || json_[at_] != c) return false;
  ++at_;
  return true;
}

/// After an element: takes a comma and says there is more, or takes `close` and says there is not.
bool Scanner::more(char close, bool& again) {
  skip_space();
  again = take(',');
  if (again || take(close)) return true;
  return fail(fmt::format("expected ',' or '{}', not {}", close, found()));
}

bool Scanner::fail(Position at, std::string what) {
  fault_ = JsonFault{at, std::move(what)};
  return false;
}

std::string Scanner::subject() const {
  if (path_.empty()) return std::string(name_);
  const size_t dot = path_.rfind('.');
  return fmt::format("'{}'", dot == std::string::npos ? path_ : path_.substr(dot + 1));
}

/// What stands here, for "expected one thing, not another".
std::string Scanner::found() const {
  if (at_ == json_.size()) return "the end of the file";
  const char c = peek();
  if (c == '{') return "an object";
  if (c == '[') return "an array";
  if (c == '"') return "a string";
  if (c == '\'') return "a single quote (JSON's are double)";
  if (c == '/' || c == '#') return "a comment (JSON has none)";
  if (!number_token().empty() && !is_word(peek(number_token().size()))) return "a number";
  size_t length = c == '-' || c == '+' || c == '.' ? 1 : 0;
  while (length < 20 && is_word(peek(length))) ++length;
  if (length > 0) return fmt::format("'{}'", json_.substr(at_, length));
  return c > ' ' && c < 0x7f ? fmt::format("'{}'", c) : fmt::format("byte 0x{:02x}", static_cast<unsigned char>(c));
}

}  // namespace

std::optional<JsonFault> locate_fault(std::string_view json, const reflection::Schema& schema,
                                      const JsonVisitor& visit) {
  return Scanner(json, schema, visit).scan();
}

std::optional<JsonFault> find_fault(std::string_view value, const reflection::Schema& schema, const Shape& shape) {
  return Scanner(value, schema).scan(shape, "the value");
}

std::optional<JsonSpan> find_value(std::string_view json, const reflection::Schema& schema, std::string_view path) {
  return Scanner(json, schema).find(path);
}

Position locate(std::string_view json, const reflection::Schema& schema, std::string_view path) {
  const auto holds_path = [&](std::string_view outer) {
    if (!path.starts_with(outer)) return false;
    const std::string_view inner = path.substr(outer.size());
    return outer.empty() || inner.empty() || inner.front() == '.' || inner.front() == '[';
  };
  Position found;
  locate_fault(json, schema, [&](const JsonValue& v) {
    if (holds_path(v.path)) found = v.at;
  });
  return found;
}

}  // namespace kd::scene
