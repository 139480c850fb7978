// Reading JSON that people wrote: every value is checked, every key must be known, and an error
// says where it is. Included by the loaders only.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/vec.h"

namespace icloth {

/// Valid range of a number, inclusive.
struct NumberRange {
  double minimum = -1e9, maximum = 1e9;
};
inline constexpr NumberRange kPositive{1e-9, 1e9};
inline constexpr NumberRange kNotNegative{0, 1e9};

/// Value with its place in the file, for messages such as "a.json: cloths[0].grid: value 3,
/// expected …".
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, std::string where)
      : json_(&json), where_(std::move(where)) {}

  const nlohmann::json& json() const { return *json_; }
  const std::string& where() const { return where_; }

  bool is_object() const;
  bool is_array() const;
  bool is_string() const;
  bool is_number() const;
  bool is_unsigned() const;  ///< a whole number without a sign
  bool is_boolean() const;
  std::size_t size() const;  ///< of an array or object, else 1; a null: 0

  /// Throws InputError: where, the value (shortened) and what was expected.
  [[noreturn]] void refuse(std::string_view expected) const;

  double number(NumberRange range = {}) const;
  std::int64_t integer(std::int64_t minimum, std::int64_t maximum) const;
  bool boolean() const;
  const std::string& text() const;
  Vec3d vector(NumberRange range = {}) const;  ///< array of three numbers
  std::vector<double> numbers(std::size_t count, NumberRange range = {}) const;
  std::vector<JsonValue> items() const;  ///< elements of an array

 private:
  const nlohmann::json* json_;
  std::string where_;
};

/// Object whose keys are asked for one after the other; finish() refuses those nobody asked for.
class JsonObject {
 public:
  explicit JsonObject(JsonValue value);

  const JsonValue& value() const { return value_; }
  /// Member, or a JSON null where it is missing: test with has() before.
  JsonValue operator[](std::string_view key);
  bool has(std::string_view key);
  JsonValue required(std::string_view key);

  double number(std::string_view key, double fallback, NumberRange range = {});
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string fallback);
  Vec3d vector(std::string_view key, Vec3d fallback);

  /// Throws InputError at the first unknown key, naming the nearest known one.
  void finish() const;

 private:
  JsonValue value_;
  std::vector<std::string> known_;
};

/// JSON with comments. `name`: of the file, for messages. Throws InputError naming file, line and
/// column.
nlohmann::json parse_json(std::string_view text, const std::string& name);

/// JSON with comments from a file. Throws InputError naming file, line and column.
nlohmann::json read_json(const std::string& path);

}  // namespace icloth
