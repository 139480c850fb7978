// icloth info: what this program and this machine can do.
#pragma once

namespace icloth {

/// Prints version, machine, builds and renderer. Returns 0.
int run_info();

}  // namespace icloth
