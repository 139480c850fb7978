#include "render/comparison_page.h"

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// The name of a file beside the page as a link: every byte that has a meaning there is a number.
std::string link_to(std::string_view file) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~";
  std::string out;
  for (const char c : file) {
    char byte[8] = "";
    std::snprintf(byte, sizeof byte, "%%%02X",
                  static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += kPlain.find(c) != std::string_view::npos ? std::string(1, c) : byte;
  }
  return out;
}

}  // namespace

std::string write_comparison_page(const std::string& path, const Image& actual,
                                  const Image& expected, const ImageDifference& difference) {
  const std::filesystem::path picture(path);
  const std::string name = picture.stem().string();
  const auto beside = [&](const std::string& ending) {
    return (picture.parent_path() / (name + ending)).string();
  };
  const auto image = [](const std::string& file) { return "<img src='" + link_to(file) + "'>"; };

  // The expected picture lies over the actual one and shows while the pointer is there.
  write_png(beside("_expected.png"), expected);
  std::string page =
      "<!doctype html><meta charset=utf-8><title>" + markup_text(name) +
      "</title>\n<style>.swap{position:relative;display:inline-block}.swap "
      "img+img{position:absolute;left:0;top:0;opacity:0}.swap:hover img+img{opacity:1}</style>\n"
      "<p>" +
      markup_text(name + ": " + difference.text()) +
      ". Left: actual, under the pointer expected. Right: difference &times; 16.</p>\n"
      "<div class=swap>" +
      image(picture.filename().string()) + image(name + "_expected.png") + "</div>\n";
  if (difference.same_size) {
    write_png(beside("_difference.png"), difference_image(actual, expected));
    page += image(name + "_difference.png") + "\n";
  }
  write_file(beside(".html"), page);
  return beside(".html");
}

}  // namespace icloth
