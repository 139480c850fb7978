#include "sim/files/json_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::uint64_t kMaxBytes = 256u << 20;

/// Short text of a value. Nested ones are not written out: they may be deep.
std::string shown(const nlohmann::json& json) {
  const auto is_nested = [](const nlohmann::json& e) { return e.is_structured(); };
  if (json.is_object()) return "{…}";
  if (json.is_array() && (json.size() > 8 || std::ranges::any_of(json, is_nested)))
    return "[… " + std::to_string(json.size()) + " elements]";
  if (json.is_string()) return '"' + excerpt(json.get_ref<const std::string&>()) + '"';
  return excerpt(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string expected_number(NumberRange range) {
  if (range.minimum <= -1e9 && range.maximum >= 1e9) return "a number";
  if (range.maximum >= 1e9)
    return range.minimum > 0 ? "a number above 0"
                             : "a number, at least " + number_text(range.minimum);
  return "a number from " + number_text(range.minimum) + " to " + number_text(range.maximum);
}

bool in_range(const nlohmann::json& json, NumberRange range) {
  if (!json.is_number()) return false;
  const auto value = json.get<double>();
  return value >= range.minimum && value <= range.maximum;
}

const nlohmann::json kNull;

}  // namespace

bool JsonValue::is_object() const { return json_->is_object(); }
bool JsonValue::is_array() const { return json_->is_array(); }
bool JsonValue::is_string() const { return json_->is_string(); }
bool JsonValue::is_number() const { return json_->is_number(); }
bool JsonValue::is_unsigned() const { return json_->is_number_unsigned(); }
bool JsonValue::is_boolean() const { return json_->is_boolean(); }
std::size_t JsonValue::size() const { return json_->size(); }

void JsonValue::refuse(std::string_view expected) const {
  throw InputError(where_ + ": value " + shown(*json_) + ", expected " + std::string(expected));
}

double JsonValue::number(NumberRange range) const {
  if (!in_range(*json_, range)) refuse(expected_number(range));
  return json_->get<double>();
}

std::int64_t JsonValue::integer(std::int64_t minimum, std::int64_t maximum) const {
  const std::string expected =
      "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum);
  const NumberRange range{static_cast<double>(minimum), static_cast<double>(maximum)};
  if (!in_range(*json_, range)) refuse(expected);
  const auto value = json_->get<double>();
  if (value != std::floor(value)) refuse(expected);
  return static_cast<std::int64_t>(value);
}

bool JsonValue::boolean() const {
  if (!json_->is_boolean()) refuse("true or false");
  return json_->get<bool>();
}

const std::string& JsonValue::text() const {
  if (!json_->is_string()) refuse("a text in quotes");
  return json_->get_ref<const std::string&>();
}

std::vector<double> JsonValue::numbers(std::size_t count, NumberRange range) const {
  const bool valid = json_->is_array() && json_->size() == count &&
                     std::ranges::all_of(*json_, [&](auto& e) { return in_range(e, range); });
  if (!valid)
    refuse("an array of " + std::to_string(count) + " numbers, each " + expected_number(range));
  return json_->get<std::vector<double>>();
}

Vec3d JsonValue::vector(NumberRange range) const {
  const std::vector<double> xyz = numbers(3, range);
  return {xyz[0], xyz[1], xyz[2]};
}

std::vector<JsonValue> JsonValue::items() const {
  if (!json_->is_array()) refuse("an array");
  std::vector<JsonValue> result;
  for (const auto& element : *json_)
    result.emplace_back(element, where_ + "[" + std::to_string(result.size()) + "]");
  return result;
}

JsonObject::JsonObject(JsonValue value) : value_(std::move(value)) {
  if (!value_.json().is_object()) value_.refuse("an object in braces");
}

JsonValue JsonObject::operator[](std::string_view key) {
  known_.emplace_back(key);
  const auto found = value_.json().find(known_.back());
  // "file.json: name" at the top level, "file.json: cloths[0].name" below.
  const bool top = value_.where().find(": ") == std::string::npos;
  return {found == value_.json().end() ? kNull : *found,
          value_.where() + (top ? ": " : ".") + excerpt(key)};
}

bool JsonObject::has(std::string_view key) {
  known_.emplace_back(key);
  return value_.json().contains(known_.back());
}

JsonValue JsonObject::required(std::string_view key) {
  if (!has(key))
    throw InputError((*this)[key].where() + ": is missing, expected the key " + in_quotes(key));
  return (*this)[key];
}

double JsonObject::number(std::string_view key, double fallback, NumberRange range) {
  return has(key) ? (*this)[key].number(range) : fallback;
}
bool JsonObject::boolean(std::string_view key, bool fallback) {
  return has(key) ? (*this)[key].boolean() : fallback;
}
std::string JsonObject::text(std::string_view key, std::string fallback) {
  return has(key) ? (*this)[key].text() : std::move(fallback);
}
Vec3d JsonObject::vector(std::string_view key, Vec3d fallback) {
  return has(key) ? (*this)[key].vector() : fallback;
}

void JsonObject::finish() const {
  for (const auto& [key, unused] : value_.json().items()) {
    if (std::ranges::find(known_, key) != known_.end()) continue;
    const std::vector<std::string_view> known(known_.begin(), known_.end());
    throw InputError(value_.where() + ": key " + in_quotes(key) + " is not known, the nearest is " +
                     in_quotes(nearest_name(key, known)));
  }
}

nlohmann::json parse_json(std::string_view text, const std::string& name) {
  try {
    return nlohmann::json::parse(text, nullptr, true, true);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.…] parse error at line 1, column 2: what; last read: 'word'": our users need
    // the part after ']', and the word may be as long as the file.
    std::string what = error.what();
    const std::size_t bracket = what.find("] ");
    if (bracket != std::string::npos) what.erase(0, bracket + 2);

    // The last word is text of the file, and a message must not repeat all of it.
    constexpr std::string_view kWord = "last read: '";
    if (const std::size_t word = what.find(kWord); word != std::string::npos) {
      const std::size_t begin = word + kWord.size(), end = std::max(what.rfind('\''), begin);
      what.replace(begin, end - begin, excerpt(std::string_view(what).substr(begin, end - begin)));
    }
    throw InputError(name + ": " + what);
  }
}

nlohmann::json read_json(const std::string& path) {
  return parse_json(read_file(path, kMaxBytes), shown_path(path));
}

}  // namespace icloth
