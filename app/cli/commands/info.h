// icloth info: the abilities of this program and this machine.
#pragma once

namespace icloth {

/// Prints version, machine, builds and renderer. Returns 0.
int run_info();

}  // namespace icloth
