// icloth ccd: the elementary collision test over a file of queries.
#pragma once

#include <string>

namespace icloth {

/// Tests every query of `file` (format: app/cli/commands/query_file.h) and prints queries, hits,
/// the false negatives and false positives against the expected column where there is one, and
/// mean, median and maximum time per query. `prediction_file` (empty: none) gets one line a query,
/// `0` or `1 TOI`. Returns the exit code: 0, or 1 when an expected contact was missed. Throws
/// InputError.
int run_ccd(const std::string& file, const std::string& prediction_file);

}  // namespace icloth
