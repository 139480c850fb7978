#include "app/suites/stability/cases.h"

#include "app/suites/stability/case_run.h"

namespace icloth::stability {
namespace {

constexpr Case kCases[] = {
    {"start intersection", "refused, with the pairs", start_intersection},
    {"start below offset", "starts calmly; touching sheets are refused", start_below_offset},
    {"start inside a body", "stays inside", start_inside_a_body},
    {"thin gap", "cloth is not thrown off a body closer than the thickness", thin_gap},
    {"pinned inside a body", "refused where it crosses; within the offset it holds",
     pinned_inside_a_body},
    {"huge coordinates", "refused, or simulated as at the origin", huge_coordinates},
    {"NaN and infinity", "refused, and the simulation goes on", not_finite},

    {"slivers", "simulated, or refused by face", slivers},
    {"bad vertices", "refused by vertex and face", bad_vertices},
    {"non-manifold edge", "simulated", non_manifold},
    {"T-junction", "refused, with the pairs", t_junction},
    {"seam", "the two sides of a seam hold together at rest", seam},

    {"coplanar edges", "pieces sliding in one plane stop each other", coplanar_edges},
    {"folded flat", "a sheet folded to layers opens or stays, never crosses", folded_flat},
    {"twisting", "every step is resolved", twisting},
    {"funnel", "every step is resolved", funnel},
    {"heavy on light", "20 layers carry one a thousand times as heavy", heavy_on_light},
    {"limp heap", "cloth without bending stiffness falls into a heap", limp_heap},

    {"tunnelling ball", "a ball at 30 m/s takes the cloth along", tunnelling_ball},
    {"needle", "a tip between the vertices holds the cloth", needle},
    {"box corner", "a corner holds the cloth", box_corner},
    {"narrow gap", "bodies that leave room for the cloth are resolved", narrow_gap},
    {"pinch", "bodies that overlap squeeze the cloth and give it free again", pinch},
    {"pin in the way", "a body through a pin: refused, with the pairs", pin_in_the_way},
    {"teleport", "a body that jumps across: resolved or refused", teleport},
    {"skirt at 1/20 s", "every step is resolved", skirt},
    {"belt", "over a cylinder it slides beyond exp(friction * pi), and holds below", belt},

    {"stiff 1e3 N/m", "resolved, not stretchy", stiff<3>},
    {"stiff 1e4 N/m", "resolved, not stretchy", stiff<4>},
    {"stiff 1e5 N/m", "resolved, not stretchy", stiff<5>},
    {"stiff 1e6 N/m", "resolved, not stretchy", stiff<6>},
    {"huge forces", "resolved or refused, speeds stay bounded", huge_forces},
    {"jerked grab", "a hand at 50 m/s: every step is resolved", jerked_grab},
    {"changed time step", "0.1 ms to 0.1 s in one run: every step is resolved", changed_time_step},
    {"threads", "1 and 2 threads give the same bits", threads},
    {"soak", "random dragging: every step is resolved", soak},
};

}  // namespace

std::span<const Case> cases() { return kCases; }

}  // namespace icloth::stability
