// Text formats, read token by token: what the readers share to say on which line a file is wrong.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace kd::mesh {

inline std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// ASCII letters only: what file formats mean by "in any case".
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// What a URI says with %xx for some characters.
inline std::string decoded_uri(std::string_view uri) {
  std::string decoded;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const char* digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      decoded += static_cast<char>(value);
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  return decoded;
}

/// The whole of `token` as a number, correctly rounded; "nan" and "inf" are numbers, what exceeds double is infinite.
inline std::optional<double> parse_number(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (fault == std::errc::result_out_of_range) return std::strtod(std::string(token).c_str(), nullptr);
  if (fault != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

inline std::optional<uint64_t> parse_count(std::string_view token) {
  uint64_t value = 0;
  const auto [end, fault] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (fault != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

/// Tokens between white space; lines end with LF, CR LF or CR and count from 1.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) {}

  /// The next token of the text, or an empty one at its end.
  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) step();
    return take();
  }
  /// The next token of this line, or an empty one at its end.
  std::string_view next_in_line() {
    while (at_ < text_.size() && is_space(text_[at_]) && !is_break(text_[at_])) ++at_;
    return take();
  }
  /// Moves to the start of the next line; false where there is none.
  bool next_line() {
    while (at_ < text_.size() && !is_break(text_[at_])) ++at_;
    if (at_ < text_.size()) step();
    return at_ < text_.size();
  }
  uint64_t line() const { return line_; }
  size_t offset() const { return at_; }

 private:
  static bool is_break(char c) { return c == '\n' || c == '\r'; }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || is_break(c); }

  void step() {
    if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    if (is_break(text_[at_])) ++line_;
    ++at_;
  }
  std::string_view take() {
    const size_t first = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }

  std::string_view text_;
  size_t at_ = 0;
  uint64_t line_ = 1;
};

}  // namespace kd::mesh
