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
void time_order_bdf2(CaseRun& run);

// cases_tension.cpp: weight and tension against stretching
void hanging_strip(CaseRun& run);
void hung_chain(CaseRun& run);
void chain_frequencies(CaseRun& run);
void string_frequencies(CaseRun& run);

// cases_bending.cpp: heavy strips clamped at one end
void cantilever(CaseRun& run);
void lateral_buckling(CaseRun& run);

// cases_yarns.cpp: friction between yarns
void friction_of_yarns(CaseRun& run);

// cases_friction.cpp: Coulomb's law on a plane
void threshold_on_body(CaseRun& run);
void threshold_on_cloth(CaseRun& run);
void sliding_on_body(CaseRun& run);
void sliding_on_cloth(CaseRun& run);
void stopping_on_body(CaseRun& run);
void stopping_on_cloth(CaseRun& run);

// cases_grip.cpp: friction against elasticity
void stick_slip(CaseRun& run);
void belt(CaseRun& run);

// cases_drape.cpp: Cusick's drapemeter
void drape(CaseRun& run);

}  // namespace icloth::validation
