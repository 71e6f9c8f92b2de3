// Parts of the rim and constraints by themselves: copied, judged, and the curves that they name.
#include "form/state.h"

#include <math.h>
#include <string.h>

const char* ax_curve_kind_name(ax_curve_kind kind)
{
    static const char* const names[] = {"line", "circle", "ellipse", "polyline", "spline"};
    return names[kind];
}

const char* ax_held_kind_name(ax_held_kind kind)
{
    static const char* const names[] = {"plane", "plane given", "line",   "circle",   "curve",
                                        "fixed", "surface",     "mirror", "rotation", "fairness"};
    return names[kind];
}

static ax_curve_shape copy_shape(const ax_curve_shape* shape)
{
    ax_curve_shape copy = *shape;
    copy.points = ax_copy(shape->points, (size_t)shape->count, sizeof *shape->points);
    return copy;
}

ax_rim_part ax_rim_part_copy(const ax_rim_part* part)
{
    ax_rim_part copy = *part;
    copy.hinges = ax_copy(part->hinges, (size_t)part->count, sizeof *part->hinges);
    copy.places = part->kind == AX_RIM_FIXED ? ax_copy(part->places, (size_t)part->count, sizeof *part->places) : NULL;
    copy.curve = part->kind == AX_RIM_SLIDE ? copy_shape(&part->curve) : (ax_curve_shape){0};
    return copy;
}

void ax_rim_part_release(ax_rim_part* part)
{
    ax_free((void*)part->hinges);
    ax_free((void*)part->places);
    ax_free((void*)part->curve.points);
}

ax_form_constraint ax_form_constraint_copy(const ax_form_constraint* c)
{
    ax_form_constraint copy = *c;
    copy.name = ax_copy_text(c->name);
    copy.hinges = ax_copy(c->hinges, (size_t)c->count, sizeof *c->hinges);
    copy.places = c->kind == AX_HELD_FIXED ? ax_copy(c->places, (size_t)c->count, sizeof *c->places) : NULL;
    copy.curve = c->kind == AX_HELD_CURVE ? copy_shape(&c->curve) : (ax_curve_shape){0};
    copy.surface = NULL;
    if (c->kind == AX_HELD_SURFACE) {
        ax_mesh* mesh = AX_NEW(ax_mesh, 1);
        *mesh = ax_mesh_copy(c->surface);
        copy.surface = mesh;
    }
    return copy;
}

void ax_form_constraint_release(ax_form_constraint* c)
{
    ax_free((void*)c->name);
    ax_free((void*)c->hinges);
    ax_free((void*)c->places);
    ax_free((void*)c->curve.points);
    if (c->surface) {
        ax_mesh_free((ax_mesh*)c->surface);
        ax_free((void*)c->surface);
    }
}

ax_curve* ax_curve_of_shape(const ax_curve_shape* s)
{
    switch (s->kind) {
    case AX_CURVE_LINE:
        return ax_curve_line(s->points[0], s->points[1]);
    case AX_CURVE_CIRCLE:
        return ax_curve_circle(s->points[0], s->points[1], s->points[2][0]);
    case AX_CURVE_ELLIPSE:
        return ax_curve_ellipse(s->points[0], s->points[1], s->points[2]);
    case AX_CURVE_POLYLINE:
        return ax_curve_rounded(s->points, s->count, s->closed, s->fillet);
    default:
        return ax_curve_spline(s->points, s->count, s->closed);
    }
}

static ax_status check_shape(const ax_curve_shape* shape, ax_error* error)
{
    static const struct {
        int least, most;
    } wanted[] = {{2, 2}, {3, 3}, {3, 3}, {2, 100000}, {2, 100000}};
    int k = shape->kind;
    const char* name = ax_curve_kind_name(shape->kind);
    if (shape->count < wanted[k].least || shape->count > wanted[k].most)
        return ax_fail(error, AX_USAGE, "A %s needs %s%d points, %d are given.", name,
                       wanted[k].most > wanted[k].least ? "at least " : "", wanted[k].least, shape->count);
    for (int p = 0; p < shape->count; ++p)
        for (int c = 0; c < 3; ++c)
            if (!isfinite(shape->points[p][c]))
                return ax_fail(error, AX_USAGE, "Point %d of the %s is no number.", p, name);
    if (shape->kind == AX_CURVE_CIRCLE && shape->points[2][0] < 0)
        return ax_fail(error, AX_USAGE, "The radius of a circle is %g; it must not be below 0.", shape->points[2][0]);
    return AX_OK;
}

ax_status ax_form_check_rim(const ax_form* f, int count, const ax_rim_part* parts, ax_error* error)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    unsigned char* taken = AX_NEW0(unsigned char, linkage->hinge_count);
    ax_status status = AX_OK;
    for (int k = 0; k < count && status == AX_OK; ++k) {
        if (parts[k].kind == AX_RIM_SLIDE)
            status = check_shape(&parts[k].curve, error);
        for (int i = 0; i < parts[k].count && status == AX_OK; ++i) {
            int h = parts[k].hinges[i];
            if (h < 0 || h >= linkage->hinge_count)
                status = ax_fail(error, AX_USAGE, "There is no hinge %d: the design has hinges 0 to %d.", h,
                                 linkage->hinge_count - 1);
            else if (taken[h]++)
                status = ax_fail(error, AX_USAGE, "Hinge %d is in two parts of the boundary.", h);
        }
    }
    ax_free(taken);
    return status;
}

ax_status ax_form_check_constraint(const ax_form* f, const ax_form_constraint* c, ax_error* error)
{
    if (!c->name || !*c->name || strlen(c->name) > 63)
        return ax_fail(error, AX_USAGE, "A constraint needs a name of 1 to 63 letters.");
    if (!(c->weight > 0 && c->weight <= 1e6))
        return ax_fail(error, AX_USAGE, "The weight %g of constraint '%s' is outside 0 to 1e6.", c->weight, c->name);
    static const int least[] = {4, 1, 3, 4, 1, 1, 1, 2, 2, 1};
    if (c->count < least[c->kind])
        return ax_fail(error, AX_USAGE, "Constraint '%s' (%s) needs at least %d hinges, %d are selected.", c->name,
                       ax_held_kind_name(c->kind), least[c->kind], c->count);
    for (int i = 0; i < c->count; ++i)
        if (c->hinges[i] < 0 || c->hinges[i] >= f->lattice.linkage.hinge_count)
            return ax_fail(error, AX_USAGE, "Constraint '%s' names hinge %d; the design has hinges 0 to %d.", c->name,
                           c->hinges[i], f->lattice.linkage.hinge_count - 1);
    int each = c->kind == AX_HELD_MIRROR ? 2 : (c->kind == AX_HELD_ROTATION ? c->order : 1);
    if (each < 1 || each > AX_MOST_POINTS || c->count % each)
        return ax_fail(error, AX_USAGE, "Constraint '%s' has %d hinges, no multiple of its order %d.", c->name,
                       c->count, each);
    return c->kind == AX_HELD_CURVE ? check_shape(&c->curve, error) : AX_OK;
}
