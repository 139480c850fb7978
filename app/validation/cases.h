// The cases of the validation suite, by the file they are in; the table is in cases.cpp.
#pragma once

namespace icloth::validation {

class CaseRun;

// cases_time.cpp: time integration
void free_fall(CaseRun& run);
void oscillator(CaseRun& run);
void momentum(CaseRun& run);
void energy(CaseRun& run);
void time_order(CaseRun& run);

// cases_tension.cpp: weight and tension against stretching
void hanging_strip(CaseRun& run);
void hung_chain(CaseRun& run);
void chain_frequencies(CaseRun& run);
void string_frequencies(CaseRun& run);

}  // namespace icloth::validation
