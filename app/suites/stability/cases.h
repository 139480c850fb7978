// The cases of the stability suite, by the file they are in; cases.cpp tells what each requires.
#pragma once

namespace icloth::stability {

class CaseRun;

// cases_start.cpp: start states and input
void start_intersection(CaseRun& run);
void start_below_offset(CaseRun& run);
void start_inside_a_body(CaseRun& run);
void thin_gap(CaseRun& run);
void pinned_inside_a_body(CaseRun& run);
void huge_coordinates(CaseRun& run);
void not_finite(CaseRun& run);

// cases_meshes.cpp: the oddities that a mesh file can hold
void slivers(CaseRun& run);
void bad_vertices(CaseRun& run);
void non_manifold(CaseRun& run);
void t_junction(CaseRun& run);
void seam(CaseRun& run);

// cases_layers.cpp: cloth against itself
void coplanar_edges(CaseRun& run);
void folded_flat(CaseRun& run);
void twisting(CaseRun& run);
void funnel(CaseRun& run);
void heavy_on_light(CaseRun& run);
void limp_heap(CaseRun& run);

// cases_bodies.cpp: cloth against obstacles
void tunnelling_ball(CaseRun& run);
void needle(CaseRun& run);
void box_corner(CaseRun& run);
void narrow_gap(CaseRun& run);
void pinch(CaseRun& run);
void pin_in_the_way(CaseRun& run);
void teleport(CaseRun& run);
void skirt(CaseRun& run);
void belt(CaseRun& run);

// cases_forces.cpp: fabrics, hands, settings
template <int kExponent>
void stiff(CaseRun& run);  ///< 10^kExponent N/m; 3 to 6
void huge_forces(CaseRun& run);
void jerked_grab(CaseRun& run);
void changed_time_step(CaseRun& run);
void threads(CaseRun& run);
void soak(CaseRun& run);

}  // namespace icloth::stability
