#include "sim/files/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

namespace icloth {
namespace {

constexpr std::size_t kLongestName = 64;

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // One row of the table of distances is kept: those from the first letters of `a` to all
  // beginnings of `b`.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// A character of UTF-8 at the start of a text.
struct Character {
  std::size_t bytes = 1;
  std::uint32_t code = kBroken;

  static constexpr std::uint32_t kBroken = 0xFFFFFFFF;
};

Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return {1, lead};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};

  // The first byte holds the upper bits of the code, and each further one six more.
  std::uint32_t code = lead & (0x7Fu >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if (!is_continuation(text[k])) return {};
    code = code << 6 | (static_cast<unsigned char>(text[k]) & 0x3F);
  }

  // A code is invalid when it is longer than needed, half a surrogate pair, or beyond Unicode.
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool valid =
      code >= kSmallest[bytes] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
  return valid ? Character{bytes, code} : Character{};
}

/// Moves the cursor, ends the line or turns the writing around.
bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}

/// Byte at which character `k` of valid UTF-8 begins, or the end of a text that is shorter.
std::size_t offset_of(std::string_view text, std::size_t k) {
  std::size_t at = 0;
  for (; at < text.size(); ++at)
    if (!is_continuation(text[at]) && k-- == 0) break;
  return at;
}

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return !is_continuation(c); }));
}

}  // namespace

std::string harmless(std::string_view text) {
  std::string result;
  result.reserve(text.size());

  // A message is one line, and nothing in it may move the cursor or change how the rest looks.
  while (!text.empty()) {
    const auto [bytes, code] = first_character(text);
    if (code == '\n' || code == '\r' || code == '\t') {
      result += ' ';
    } else if (code == Character::kBroken || is_control(code)) {
      result += '?';
    } else {
      result += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return result;
}

std::string excerpt(std::string_view input) {
  // No more bytes are looked at than can be shown: the input may be hundreds of megabytes.
  constexpr std::size_t kHead = kMostQuoted / 2, kTail = kMostQuoted - kHead - 1;
  constexpr std::size_t kMostBytes = 4 * kMostQuoted;
  const bool is_huge = input.size() > 2 * kMostBytes;
  const std::string text = harmless(is_huge ? input.substr(0, kMostBytes) : input);
  const std::size_t count = character_count(text);
  if (!is_huge && count <= kMostQuoted) return text;

  const std::string end = is_huge ? harmless(input.substr(input.size() - kMostBytes)) : text;
  const std::size_t skipped = character_count(end) - kTail;
  return text.substr(0, offset_of(text, kHead)) + "…" + end.substr(offset_of(end, skipped));
}

std::string file_line(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '_');
  return name;
}

std::string in_quotes(std::string_view input) {
  std::string text(1, '\'');
  text += excerpt(input);
  return text += '\'';
}

std::string shown_path(std::string_view path) {
  const std::string text = harmless(path);
  const std::size_t count = character_count(text);
  if (count <= kMostQuoted) return text;
  return "…" + text.substr(offset_of(text, count - (kMostQuoted - 1)));
}

std::string markup_text(std::string_view text) {
  constexpr std::pair<char, std::string_view> kMarks[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string out;
  for (const char c : text) {
    const auto* mark = std::ranges::find(kMarks, c, &std::pair<char, std::string_view>::first);
    out += mark != std::end(kMarks) ? mark->second : std::string_view(&c, 1);
  }
  return out;
}

std::string number_text(double value) {
  constexpr double kLargestWhole = 1e15;
  if (value == std::floor(value) && std::fabs(value) < kLargestWhole)
    return std::to_string(static_cast<long long>(value));
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, error == std::errc{} ? end : text};
}

std::string rounded_text(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", std::min(digits, 17), value);
  return text;
}

std::string brief_number(double value) {
  if (value == 0) return "0";
  const double size = std::fabs(value);
  char text[40];

  // Usual values have two digits, and whole numbers are written up to four digits.
  if (size >= 0.01 && size < 9.95) {
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
  }
  if (size >= 9.95 && size < 9999.5) {
    std::snprintf(text, sizeof text, "%.0f", value);
    return text;
  }

  // Very small and very large values keep one digit: 4e-04 becomes 4e-4, and 2e+05 becomes 2e5.
  std::snprintf(text, sizeof text, "%.0e", value);
  std::string out = text;
  const std::size_t e = out.find('e');
  if (e == std::string::npos) return out;
  out.erase(e + 2, std::min(out.find_first_not_of('0', e + 2), out.size() - 1) - (e + 2));
  if (out[e + 1] == '+') out.erase(e + 1, 1);
  return out;
}

std::string first_items(std::span<const std::string> items, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), most); ++i)
    text += (i > 0 ? ", " : "") + items[i];
  if (items.size() > most) text += " and " + std::to_string(items.size() - most) + " more";
  return text;
}

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> candidates) {
  word = word.substr(0, kLongestName);  // it may come from a file
  std::string_view best;
  std::size_t smallest = 0;

  // When several names are equally near, the first one wins.
  for (std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (!best.empty() && distance >= smallest) continue;
    best = candidate;
    smallest = distance;
  }
  return best;
}

}  // namespace icloth
