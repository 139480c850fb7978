// Texts that people read and write: input in messages, numbers, names that were mistyped.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace icloth {

inline constexpr std::size_t kMostQuoted = 80;  ///< characters of input that a message repeats

/// The text as a terminal can show it: control characters, what changes the direction of writing,
/// and bytes that are no UTF-8 become '?', line breaks and tabs blanks.
std::string harmless(std::string_view text);

/// Input as a message may repeat it: harmless, and without its middle where it is longer than
/// kMostQuoted characters. Every message that repeats keys, values or words of a file uses it.
std::string excerpt(std::string_view input);

/// A name of any characters as a line of a file can hold it: with `_` for control characters.
std::string file_line(std::string name);

/// The excerpt in single quotes.
std::string in_quotes(std::string_view input);

/// The text as HTML, SVG and XML may hold it, between their marks and in quotes.
std::string markup_text(std::string_view text);

/// A path as a message may repeat it: the end, which tells files apart, where it is too long.
std::string shown_path(std::string_view path);

/// Shortest text that reads back as the same number, whole numbers in full: "0.1", "40000000",
/// "1e-05", "nan".
std::string number_text(double value);

/// A number with at most so many significant digits: "0.316667".
std::string rounded_text(double value, int digits = 3);

/// A number for a narrow column, two digits where they matter: "0.12", "340", "4e-4".
std::string brief_number(double value);

/// "a, b and 3 more": the first `most` items, and how many there are beyond them.
std::string first_items(std::span<const std::string> items, std::size_t most);

/// The candidate with the smallest edit distance to `word` ("" when there is none).
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace icloth
