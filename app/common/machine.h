// The facts that results have to name: program, machine, memory.
#pragma once

#include <string>

#include "sim/simulator.h"

namespace icloth {

std::string program_version();  ///< "0.1.0"
std::string program_commit();   ///< of the source tree, "-dirty" when changed, or "unknown"
std::string compiler_name();    ///< "g++ 12.2.0, Release"
std::string processor_name();   ///< as the kernel names it
int processor_threads();        ///< hardware threads that this process may use
double memory_bytes();          ///< of the machine
double peak_memory_bytes();     ///< largest resident size of this process since the last reset
void reset_peak_memory();       ///< a new measurement starts; does nothing where Linux is too old

/// Bytes a second that all threads together read and write in a[i] = b[i] + s·c[i], best of a
/// few runs over arrays that exceed the caches. Takes about half a second.
double measure_memory_bandwidth();

/// The device that a build computes on, where that is not the processor.
struct ComputeDevice {
  std::string name;           ///< as the driver names it; empty: the processor
  double copy_bandwidth = 0;  ///< [bytes/s] read and written, as measure_copy_bandwidth; 0: unknown
};

/// The device that `build` uses now. It is measured, which takes some hundredths of a second.
ComputeDevice compute_device(Build build);

}  // namespace icloth
