#include "app/suites/validation/cases.h"

#include "app/suites/validation/case_run.h"

namespace icloth::validation {
namespace {

constexpr Case kCases[] = {
    {"free fall", "backward Euler: x_n = x0 + v0 t + g t (t + dt)/2", true, free_fall},
    {"oscillator", "backward Euler: 1/sqrt(1 + (w dt)^2) and atan(w dt) a step", true, oscillator},
    {"momentum", "Newton's third law", true, momentum},
    {"energy", "second law, hyperelastic fabric", true, energy},
    {"order in dt", "backward Euler is of first order", true, time_order},
    {"order of BDF2", "BDF2 is of second order", true, time_order_bdf2},

    {"hanging strip", "s(s^2 - 1) k/2 = rho g (L - x)", true, hanging_strip},
    {"catenary", "sinh z / z = L/S", true, hung_chain},
    {"chain frequencies", "Bernoulli: j0n/2 sqrt(g/L)", true, chain_frequencies},
    {"string frequencies", "n pi/L sqrt(T/rho)", true, string_frequencies},

    {"cantilever", "heavy elastica; Romero et al. 2021, test 1", true, cantilever},
    {"lateral buckling", "Timoshenko and Gere; Romero et al. 2021, test 3", true, lateral_buckling},
    {"friction of yarns", "slider beside a spring: HB/D, HG/G", true, friction_of_yarns},

    {"incline on a body", "Coulomb: at rest iff tan a <= mu", false, threshold_on_body},
    {"incline on cloth", "Coulomb: at rest iff tan a <= mu", false, threshold_on_cloth},
    {"sliding on a body", "g(sin a - mu cos a) t^2/2", false, sliding_on_body},
    {"sliding on cloth", "g(sin a - mu cos a) t^2/2", false, sliding_on_cloth},
    {"stopping on a body", "v^2/(2 mu g)", false, stopping_on_body},
    {"stopping on cloth", "v^2/(2 mu g)", false, stopping_on_cloth},
    {"stick-slip", "elastica; Sano et al. 2017, Romero et al. 2021, test 4", true, stick_slip},
    {"belt", "Euler and Eytelwein: exp(mu pi)", false, belt},
    {"drape", "Cusick's drapemeter: denim 70 to 90 %; bending length", false, drape},
};

}  // namespace

std::span<const Case> cases() { return kCases; }

}  // namespace icloth::validation
