// A form that opens once more, slowly enough to be watched.
#include "form/state.h"

#include "base/vec.h"
#include "design/motion.h"

#include <math.h>

// Stiffness with which hinges are drawn to where they are, of the whole sheet and of panels at 1: while the sheet is tied to what holds it,
// and while it opens by its holes or by a load, in some fifty iterations whatever the mesh. Without, it would snap open within ten.
static const double tied = 90, by_holes = 3, by_load = 30;
enum { TIE_ITERATIONS = 6, LEAST_ITERATIONS = 20 };
static const double opened = 5e-4; // move of an iteration over the spacing

// The state that is seen to open.
static double (*opening_state(ax_form* f))[3]
{
    return ax_form_hangs(f) ? f->simulated : f->deployed;
}

// Panels that open do not keep their lengths exactly: multipliers would store up what is off until it snaps.
void ax_form_drag_solvers(ax_form* f)
{
    ax_solver* s = ax_form_hangs(f) ? f->hang : f->shape;
    ax_solver_set_proximal(s, fmax(f->drag, AX_FORM_PROXIMAL));
    ax_solver_use_multipliers(s, f->drag == 0 || ax_form_hangs(f));
}

static void drag(ax_form* f, double stiffness)
{
    f->drag = stiffness / f->lattice.linkage.triangle_count;
    ax_form_build(f);
    ax_form_drag_solvers(f);
}

// As the flat state is nearest to the open one, in the plane of its rim, bulged towards it.
static void lay(ax_form* f, double height)
{
    int n = f->lattice.linkage.hinge_count;
    double(*x)[3] = opening_state(f), (*flat)[3] = ax_alloc((size_t)n, sizeof *flat);
    const ax_design sheet = {.linkage = f->lattice.linkage, .flat = f->flat};
    ax_design_lay_flat(&sheet, (const double(*)[3])x, flat);
    const int* first = f->lattice.linkage.triangles[0];
    double a[3], b[3], normal[3], side = 0, rim = 0;
    int rim_count = 0;
    ax_sub3(flat[first[1]], flat[first[0]], a);
    ax_sub3(flat[first[2]], flat[first[0]], b);
    ax_cross(a, b, normal);
    double area = ax_norm3(normal);
    for (int h = 0; h < n; ++h) {
        ax_sub3(x[h], flat[h], a);
        double way = ax_dot3(a, normal) / area;
        side += way;
        if (f->holder[h][1] < 0)
            rim += way, ++rim_count;
    }
    rim /= rim_count;
    double up = copysign(height * f->radius, side / n - rim);
    for (int h = 0; h < n; ++h) {
        double r = ax_distance2(f->lattice.hinges[h], f->centre) / f->radius;
        for (int c = 0; c < 3; ++c)
            x[h][c] = flat[h][c] + (rim + up * fmax(0, 1 - r * r)) * normal[c] / area;
    }
    ax_free(flat);
}

void ax_form_reopen(ax_form* f, double height)
{
    lay(f, height);
    ax_form_build(f);
    ax_solver_reset_multipliers(ax_form_hangs(f) ? f->hang : f->shape);
    drag(f, tied);
    ax_form_iterate(f, TIE_ITERATIONS);
    drag(f, ax_form_hangs(f) ? by_load : by_holes);
    f->dragged = 0;
}

void ax_form_end_drag(ax_form* f)
{
    if (f->drag > 0)
        drag(f, 0);
}

void ax_form_dragged(ax_form* f, int iterations)
{
    f->dragged += iterations;
    if (f->dragged > LEAST_ITERATIONS && f->scaled_step < opened)
        ax_form_end_drag(f);
}
