#include "sim/files/error.h"

namespace icloth {
namespace {

constexpr std::size_t kMaxHead = 700, kMaxTail = 280;  // bytes of a message

/// UTF-8 characters are not cut in two.
bool is_inside_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string one_line(std::string text) {
  if (text.size() > kMaxHead + kMaxTail) {
    std::size_t head = kMaxHead, tail = text.size() - kMaxTail;
    while (head > 0 && is_inside_character(text[head])) --head;
    while (tail < text.size() && is_inside_character(text[tail])) ++tail;
    text = text.substr(0, head) + " … " + text.substr(tail);
  }
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return text;
}

}  // namespace icloth
