#include "app/common/dressing_progress.h"

#include <memory>

#include "app/common/progress.h"
#include "sim/files/text.h"

namespace icloth {

DressingWatch show_dressing(bool quiet) {
  // Copies of a watch share one line. Closing and settling are runs of their own.
  auto line = std::make_shared<std::unique_ptr<Progress>>();
  return [line, quiet](const Simulator&, const DressingStatus& status) {
    if (status.step == 1)
      *line = std::make_unique<Progress>(
          excerpt(status.garment) + (status.settling ? " settles" : " draws its seams together"),
          status.most_steps, quiet);
    (*line)->update(status.step);
    return true;
  };
}

}  // namespace icloth
