// The cost of each part of a scene: one scene that gets them in turn.
#pragma once

#include "app/suites/report/report.h"
#include "sim/simulator.h"

namespace icloth {

/// Adds the table to the report.
void show_parts(Build build, Report& report);

}  // namespace icloth
