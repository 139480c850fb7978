#include "app/cli/commands/ccd.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <vector>

#include "app/cli/commands/query_file.h"
#include "sim/files/file_io.h"

namespace icloth {
namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration d) {
  return std::chrono::duration<double, std::nano>(d).count();
}

/// The time that reading the clock twice takes [ns].
double clock_cost() {
  double least = 1e9;
  for (int i = 0; i < 1000; ++i) {
    const auto start = Clock::now();
    least = std::min(least, nanoseconds(Clock::now() - start));
  }
  return least;
}

/// Times of many queries in bounded memory: bins of 1 ns, and exact sum and maximum.
class TimeStatistics {
 public:
  void add(double ns) {
    ++bins_[static_cast<std::size_t>(std::clamp(ns, 0.0, static_cast<double>(kBins - 1)))];
    ++count_;
    sum_ += ns;
    maximum_ = std::max(maximum_, ns);
  }
  void print(const char* what) const {
    if (count_ == 0) return;
    std::printf("%s mean %.0f ns, median %zu ns, maximum %.0f ns\n", what,
                sum_ / static_cast<double>(count_), median(), maximum_);
  }

 private:
  static constexpr std::size_t kBins = 1 << 17;
  /// The bin at which half of the times are reached.
  std::size_t median() const {
    long below = 0;
    std::size_t bin = 0;
    while (bin + 1 < kBins && (below += bins_[bin]) * 2 < count_) ++bin;
    return bin;
  }
  std::vector<long> bins_ = std::vector<long>(kBins);
  long count_ = 0;
  double sum_ = 0, maximum_ = 0;
};

/// The counts and times of all queries.
struct Tally {
  long queries = 0, vf = 0, hits = 0, expected = 0, false_negatives = 0, false_positives = 0;
  TimeStatistics hit_times, miss_times, times;
};

bool test(const FileQuery& q, CcdHit& hit) {
  return q.kind == PairKind::vf ? ccd_vf(q.query, 0, hit) : ccd_ee(q.query, 0, hit);
}

/// Tests one query; the best of three calls keeps interruptions by the system out of the times.
bool timed_test(const FileQuery& q, double overhead, CcdHit& hit, Tally& tally) {
  bool is_hit = false;
  double best = 1e18;
  for (int k = 0; k < 3; ++k) {
    const auto start = Clock::now();
    is_hit = test(q, hit);
    best = std::min(best, nanoseconds(Clock::now() - start));
  }
  best = std::max(best - overhead, 0.0);
  (is_hit ? tally.hit_times : tally.miss_times).add(best);
  tally.times.add(best);
  return is_hit;
}

/// Counts the query, and compares the answer with the expected one where there is one.
void count(const FileQuery& q, bool is_hit, Tally& tally) {
  ++tally.queries;
  tally.vf += q.kind == PairKind::vf;
  tally.hits += is_hit;
  tally.expected += q.expected >= 0;
  tally.false_negatives += q.expected == 1 && !is_hit;
  tally.false_positives += q.expected == 0 && is_hit;
}

void print(const Tally& t) {
  std::printf("queries          %ld (%ld vf, %ld ee)\n", t.queries, t.vf, t.queries - t.vf);
  std::printf("hits             %ld\n", t.hits);
  if (t.expected > 0) {
    std::printf("false negatives  %ld (of %ld queries with an expected result)\n",
                t.false_negatives, t.expected);
    std::printf("false positives  %ld\n", t.false_positives);
  }
  t.times.print("time per query  ");
  t.hit_times.print("  hits          ");
  t.miss_times.print("  misses        ");
}

}  // namespace

int run_ccd(const std::string& file, const std::string& prediction_file) {
  // A prediction file that cannot be written is refused before the long part.
  QueryFile queries(file);
  std::optional<OutputFile> predictions;
  if (!prediction_file.empty()) predictions.emplace(prediction_file);

  // The queries are read one by one, so that files of any size fit into memory.
  const double overhead = clock_cost();
  Tally tally;
  FileQuery q;
  CcdHit hit;
  while (queries.next(q)) {
    const bool is_hit = timed_test(q, overhead, hit, tally);
    count(q, is_hit, tally);

    // Each query has its line in the prediction file.
    if (!predictions) continue;
    char line[40] = "0\n";
    if (is_hit) std::snprintf(line, sizeof line, "1 %.17g\n", hit.toi);
    predictions->write(line);
  }
  if (predictions) predictions->commit();
  print(tally);
  return tally.false_negatives > 0 ? 1 : 0;
}

}  // namespace icloth
