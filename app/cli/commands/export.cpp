#include "app/cli/commands/export.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "app/common/frame_formats.h"
#include "sim/files/error.h"
#include "sim/files/spool_export.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// Refuses what would write over a spool, or one result over another.
void check(const ExportOptions& options) {
  if (options.spools.size() > 1 && !options.out.empty())
    throw InputError("--out " + shown_path(options.out) + ": " +
                     std::to_string(options.spools.size()) + " spools, expected one with --out");
  std::error_code error;
  const bool in_place =
      options.out.empty() || std::filesystem::equivalent(options.out, options.spools[0], error);
  if (in_place && std::ranges::find(options.formats, "pc2") != options.formats.end())
    throw InputError("--format pc2: the caches of " + shown_path(options.spools[0]) +
                     " are PC2 files, expected --out DIR with another folder");
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("--out " + shown_path(folder) + ": cannot be made a folder (" +
                     error.message() + ")");
}

void convert_spool(const std::string& folder, const ExportOptions& options) {
  const Spool spool = read_spool(folder);
  for (const std::string& note : spool.notes)
    std::fprintf(stderr, "icloth: note: %s\n", one_line(note).c_str());

  // What was written is said in one line.
  const std::string& out = options.out.empty() ? folder : options.out;
  if (!options.out.empty()) make_folder(out);
  std::string written;
  for (const FrameFormat format : frame_formats(options.formats))
    written += (written.empty() ? "" : ", ") + export_spool(spool, out, format);
  std::printf("%s: %zu frames from 0 to %g s, objects %zu: wrote %s\n", shown_path(out).c_str(),
              spool.frames.size(), spool.frames.back().time, spool.objects.size(), written.c_str());
}

}  // namespace

int run_export(const ExportOptions& options) {
  ExportOptions chosen = options;
  if (chosen.formats.empty()) chosen.formats = {"mdd", "usda"};
  check(chosen);
  for (const std::string& folder : chosen.spools) convert_spool(folder, chosen);
  return 0;
}

}  // namespace icloth
