// The deployment of a form as time goes by.
#include "form/state.h"

#include "base/vec.h"
#include "design/motion.h"

#include <string.h>

struct ax_form_motion {
    ax_design design; // what moves
    ax_pool* pool;
    double (*flat)[3], (*places)[3];
    ax_design_motion* motion;
};

ax_form_motion* ax_form_motion_make(ax_form* f)
{
    if (!ax_form_hangs(f))
        return NULL;
    ax_form_motion* m = AX_NEW0(ax_form_motion, 1);
    ax_design* d = &m->design;
    size_t n = (size_t)f->lattice.linkage.hinge_count;
    ax_form_snapshot(f, false, d);
    d->simulated = ax_copy(f->simulated, n, sizeof *d->simulated);
    d->load = f->dynamics.load;
    for (int k = 0; k < f->held_count; ++k)
        for (int i = 0; i < f->held[k].count && f->held[k].support; ++i)
            d->supports[f->held[k].hinges[i]] = 1;
    m->pool = ax_pool_make(ax_pool_threads(f->pool));
    m->flat = ax_alloc(n, sizeof *m->flat);
    m->places = ax_alloc(n, sizeof *m->places);
    ax_design_lay_flat(d, (const double(*)[3])d->simulated, m->flat);
    m->motion = ax_design_motion_make(d, (const double(*)[3])m->flat, m->pool);
    return m;
}

void ax_form_motion_free(ax_form_motion* m)
{
    if (!m)
        return;
    ax_design_motion_free(m->motion);
    ax_pool_free(m->pool);
    ax_design_free(&m->design);
    ax_free(m->flat);
    ax_free(m->places);
    ax_free(m);
}

const double (*ax_form_motion_to(ax_form_motion* m, double t, const ax_progress* progress))[3]
{
    return ax_design_motion_to(m->motion, t, progress, m->places) ? (const double(*)[3])m->places : NULL;
}
