// Texts that people read and write: names that were mistyped.
#pragma once

#include <span>
#include <string_view>

namespace icloth {

/// The candidate with the smallest edit distance to `word` ("" when there is none).
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace icloth
