// When the emulation has found a fault, it says where, and ends the program.
#pragma once

namespace cuda_on_host {

/// Exit codes of a program in which a fault was found.
inline constexpr int kComplaint = 98;    ///< said by the emulation
inline constexpr int kAccessFault = 99;  ///< an access that the processor refused

/// The present work of the device, for messages: the name of a kernel, copy or library call; null
/// when it is idle.
extern const char* running_operation;

/// Prints the fault, the running operation and the calls that led there, and exits with kComplaint.
[[noreturn]] void complain(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// Prints the calls that led here.
void print_calls();

}  // namespace cuda_on_host
