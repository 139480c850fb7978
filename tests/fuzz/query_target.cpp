// Query files of `icloth ccd`, plain and compressed, and the test of what they hold.
#include <cmath>

#include "app/cli/commands/query_file.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace icloth::fuzz {

std::string read_query(std::string_view bytes) {
  const std::string path = write_scratch("queries.csv", bytes);
  return refusal([&] {
    QueryFile file(path);
    FileQuery q;
    CcdHit hit;
    while (file.next(q)) {
      const bool is_hit =
          q.kind == PairKind::vf ? ccd_vf(q.query, 0, hit) : ccd_ee(q.query, 0, hit);
      require(!is_hit || (hit.toi >= 0 && hit.toi <= 1), "a time of impact within the step");
    }
  });
}

}  // namespace icloth::fuzz
