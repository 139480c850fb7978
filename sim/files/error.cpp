#include "sim/files/error.h"

#include <string_view>

#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::size_t kMaxHead = 700, kMaxTail = 280;  // bytes of a message
constexpr std::size_t kMaxWord = 2 * kMostQuoted;      // bytes of a word

/// UTF-8 characters are not cut in two.
bool is_inside_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Every word that is longer than any of ours without its middle. Messages shorten the input that
/// they repeat; this catches what comes from a library's message.
std::string without_long_words(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    result += word.size() > kMaxWord ? excerpt(word) : std::string(word);
    if (end < text.size()) result += ' ';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

}  // namespace

std::string one_line(std::string text) {
  text = without_long_words(harmless(text));
  if (text.size() > kMaxHead + kMaxTail) {
    std::size_t head = kMaxHead, tail = text.size() - kMaxTail;
    while (head > 0 && is_inside_character(text[head])) --head;
    while (tail < text.size() && is_inside_character(text[tail])) ++tail;
    text = text.substr(0, head) + " … " + text.substr(tail);
  }
  return text;
}

}  // namespace icloth
