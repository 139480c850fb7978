#include "app/cli/commands/golden_picture.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "render/comparison_page.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

ImageTolerance parse_tolerance(const std::string& name) {
  const auto* found = std::ranges::find(kTolerances, name, &NamedTolerance::name);
  if (found != std::end(kTolerances)) return found->tolerance;
  throw InputError("--tolerance " + excerpt(name) + ": expected exact, software or device");
}

}  // namespace

bool is_picture_size(int width, int height) {
  const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 16384; };
  return fits(width) && fits(height);
}

GoldenPicture open_golden(const std::string& path, const std::string& out,
                          const std::string& tolerance, bool update) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw InputError("--compare " + shown_path(path) + ": " + why);
  };
  GoldenPicture golden{path, std::nullopt, parse_tolerance(tolerance), update};

  // A golden picture that is made for the first time has no size yet.
  if (lower_extension(path) != ".png") refuse("expected FILE.png");
  const auto place = [](const std::string& file) {
    return fs::weakly_canonical(fs::absolute(file));
  };
  if (place(path) == place(out)) refuse("is where --out writes, expected another file");
  if (!fs::exists(path)) {
    if (!update) refuse("is not there, expected a picture; --update makes it");
    return golden;
  }

  golden.image = read_png(path);
  const int width = golden.image->width, height = golden.image->height;
  if (!is_picture_size(width, height))
    refuse(std::to_string(width) + "x" + std::to_string(height) +
           ", expected from 16 to 16384 pixels either way");
  return golden;
}

bool check_golden(const GoldenPicture& golden, const std::string& out, const Image& picture,
                  bool clean, bool quiet) {
  const std::string path = shown_path(golden.path);
  ImageDifference difference;
  if (golden.image) difference = compare(picture, *golden.image, golden.tolerance);

  // A run that failed makes no golden picture.
  if (golden.update) {
    if (clean) write_png(golden.path, picture);
    if (!clean)
      std::fprintf(stderr, "icloth: %s: not written, as the run failed\n", path.c_str());
    else if (!quiet)
      std::printf("%s: written; before: %s\n", path.c_str(),
                  golden.image ? difference.text().c_str() : "not there");
    return clean;
  }

  if (difference.accepted(golden.tolerance)) {
    if (!quiet)
      std::printf("%s: as %s (%s)\n", shown_path(out).c_str(), path.c_str(),
                  difference.text().c_str());
    return true;
  }
  const std::string page = write_comparison_page(out, picture, *golden.image, difference);
  std::fprintf(stderr, "icloth: %s: differs from %s: %s; see %s\n", shown_path(out).c_str(),
               path.c_str(), difference.text().c_str(), shown_path(page).c_str());
  return false;
}

}  // namespace icloth
