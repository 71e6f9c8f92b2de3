#include "support/compare.h"

#include "ax/report.h"
#include "support/test.h"

#include <string.h>

static bool same_array(const void* a, const void* b, size_t count, size_t size)
{
    return !a == !b && (!a || memcmp(a, b, count * size) == 0);
}

static bool same_real(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static bool same_linkage(const ax_linkage* a, const ax_linkage* b)
{
    if (a->triangle_count != b->triangle_count || a->hinge_count != b->hinge_count || a->hole_count != b->hole_count ||
        a->opening_count != b->opening_count)
        return false;
    size_t triangles = (size_t)a->triangle_count, holes = (size_t)a->hole_count, openings = (size_t)a->opening_count;
    return same_array(a->triangles, b->triangles, triangles, sizeof *a->triangles) &&
           same_array(a->panels, b->panels, triangles, sizeof *a->panels) &&
           same_array(a->hole_start, b->hole_start, holes + 1, sizeof(int)) &&
           same_array(a->hole_hinges, b->hole_hinges, (size_t)a->hole_start[holes], sizeof(int)) &&
           same_array(a->opening_start, b->opening_start, openings + 1, sizeof(int)) &&
           same_array(a->opening_hinges, b->opening_hinges, (size_t)a->opening_start[openings], sizeof(int)) &&
           same_array(a->on_rim, b->on_rim, (size_t)a->hinge_count, 1);
}

static const char* difference(const ax_design* a, const ax_design* b)
{
    if (!same_linkage(&a->linkage, &b->linkage))
        return "linkage";
    size_t hinges = (size_t)a->linkage.hinge_count, triangles = (size_t)a->linkage.triangle_count;
    if (!same_array(a->flat, b->flat, hinges, sizeof *a->flat) ||
        !same_array(a->deployed, b->deployed, hinges, sizeof *a->deployed) ||
        !same_array(a->simulated, b->simulated, hinges, sizeof *a->simulated))
        return "states";
    if (!same_array(a->scale, b->scale, triangles, sizeof *a->scale) ||
        !same_array(a->supports, b->supports, hinges, 1) ||
        !same_array(a->forces, b->forces, hinges, sizeof *a->forces) ||
        !same_array(a->edge_forces, b->edge_forces, triangles, sizeof *a->edge_forces))
        return "scale, supports or forces";
    if (a->target.vertex_count != b->target.vertex_count || a->target.face_count != b->target.face_count ||
        !same_array(a->target.positions, b->target.positions, (size_t)a->target.vertex_count, sizeof(double[3])) ||
        !same_array(a->target.faces, b->target.faces, (size_t)a->target.face_count, sizeof(int[3])))
        return "target";
    if (a->unit != b->unit || a->border != b->border || a->projected != b->projected ||
        !same_real(a->scale_ratio, b->scale_ratio) || !same_real(a->mouth_min, b->mouth_min))
        return "settings";
    const ax_load *u = &a->load, *v = &b->load;
    if (u->kind != v->kind || memcmp(u->direction, v->direction, sizeof u->direction) != 0 ||
        !same_real(u->pressure, v->pressure) || !same_real(u->density, v->density))
        return "load";
    const ax_projection *p = &a->projection, *q = &b->projection;
    if (!same_real(p->moved_area_share, q->moved_area_share) || !same_real(p->largest_move, q->largest_move) ||
        !same_real(p->curvature_min, q->curvature_min) || !same_real(p->nonpositive_share, q->nonpositive_share) ||
        p->steps != q->steps)
        return "projection";
    const ax_mesh_repairs *r = &a->repairs, *s = &b->repairs;
    if (r->welded_vertices != s->welded_vertices || r->degenerate_faces != s->degenerate_faces ||
        r->duplicate_faces != s->duplicate_faces || r->unused_vertices != s->unused_vertices ||
        r->flipped_faces != s->flipped_faces || r->turned_outward != s->turned_outward)
        return "repairs";
    int count;
    const ax_figure* figures = ax_report_figures(&count);
    for (int f = 0; f < count; ++f)
        for (int k = 0; k < figures[f].count; ++k)
            if (!same_real(ax_figure_value(&figures[f], &a->report, k), ax_figure_value(&figures[f], &b->report, k)))
                return figures[f].key;
    return NULL;
}

bool same_design(const ax_design* a, const ax_design* b)
{
    return difference(a, b) == NULL;
}

void assert_same_design(const ax_design* a, const ax_design* b)
{
    const char* where = difference(a, b);
    if (where)
        fail_msg("the designs differ in %s", where);
}
