#include "fabricate/plan.h"

#include "base/vec.h"
#include "fabricate/stroke_font.h"

#include <assert.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char* const operation_names[] = {"LABEL", "SCORE", "HOLE", "SLIT", "CUT", "NOTE"};

const char* ax_operation_name(ax_operation operation)
{
    assert((size_t)operation < AX_OPERATIONS);
    return operation_names[operation];
}

// Bytes of the character that begins here, 0: it is none; jansson knows UTF-8.
static size_t character(const char* at, size_t left)
{
    for (size_t length = 1; length <= 4 && length <= left; ++length) {
        json_t* valid = json_stringn(at, length);
        json_decref(valid);
        if (valid)
            return length;
    }
    return 0;
}

void ax_plan_set_title(ax_cut_plan* plan, const char* title)
{
    size_t used = 0, left = title ? strlen(title) : 0;
    while (left) {
        size_t length = character(title, left), taken = length ? length : 1;
        if (used + taken >= sizeof plan->title)
            break;
        memcpy(plan->title + used, length ? title : "?", taken);
        used += taken, title += taken, left -= taken;
    }
    plan->title[used] = '\0';
}

void ax_cut_plan_free(ax_cut_plan* plan)
{
    if (!plan)
        return;
    ax_free(plan->points);
    ax_free(plan->paths);
    ax_free(plan->items);
    ax_free(plan->sheets);
    ax_free(plan->panels);
    ax_free(plan->hinges);
    ax_free(plan->clashes);
    ax_free(plan->frames);
    ax_free(plan->parts);
    *plan = (ax_cut_plan){0};
}

// Room for one more element.
static void* grow(void* block, int count, int* room, size_t size)
{
    if (count < *room)
        return block;
    *room = *room ? 2 * *room : 256;
    return ax_realloc(block, (size_t)*room, size);
}

void ax_plan_item(ax_plan_builder* b, ax_operation operation, int panel, const char* format, ...)
{
    ax_cut_plan* p = b->plan;
    p->items = grow(p->items, p->item_count, &b->item_room, sizeof *p->items);
    ax_cut_item* item = &p->items[p->item_count++];
    *item = (ax_cut_item){.operation = operation, .panel = panel, .first = p->path_count};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(item->name, sizeof item->name, format, arguments);
    va_end(arguments);
}

void ax_plan_path(ax_plan_builder* b, bool closed)
{
    ax_cut_plan* p = b->plan;
    p->paths = grow(p->paths, p->path_count, &b->path_room, sizeof *p->paths);
    p->paths[p->path_count++] = (ax_cut_path){.first = p->point_count, .closed = closed};
    if (p->item_count)
        ++p->items[p->item_count - 1].count;
}

void ax_plan_point(ax_plan_builder* b, double x, double y)
{
    ax_cut_plan* p = b->plan;
    p->points = grow(p->points, p->point_count, &b->point_room, sizeof *p->points);
    p->points[p->point_count++] = (ax_cut_point){x, y, 0};
    ++p->paths[p->path_count - 1].count;
}

void ax_plan_arc(ax_plan_builder* b, const double centre[2], double x, double y, double sweep, bool last)
{
    if (fabs(sweep) > AX_PI) {
        const ax_cut_point* from = &b->plan->points[b->plan->point_count - 1];
        double c = cos(sweep / 2), s = sin(sweep / 2), dx = from->x - centre[0], dy = from->y - centre[1];
        ax_plan_arc(b, centre, centre[0] + c * dx - s * dy, centre[1] + s * dx + c * dy, sweep / 2, false);
        sweep /= 2;
    }
    b->plan->points[b->plan->point_count - 1].bulge = tan(sweep / 4);
    if (!last)
        ax_plan_point(b, x, y);
}

void ax_plan_circle(ax_plan_builder* b, double x, double y, double radius, bool clockwise)
{
    ax_plan_path(b, true);
    for (int side = 0; side < 2; ++side) {
        ax_plan_point(b, x + (side ? -radius : radius), y);
        b->plan->points[b->plan->point_count - 1].bulge = clockwise ? -1 : 1;
    }
}

void ax_plan_copy(ax_plan_builder* b, int path, const ax_motion* motion)
{
    const ax_cut_path from = b->plan->paths[path];
    ax_plan_path(b, from.closed);
    for (int k = from.first; k < from.first + from.count; ++k) {
        const ax_cut_point point = b->plan->points[k];
        double at[2];
        ax_move(motion, point.x, point.y, at);
        ax_plan_point(b, at[0], at[1]);
        b->plan->points[b->plan->point_count - 1].bulge = point.bulge;
    }
}

typedef struct lettering {
    ax_plan_builder* builder;
    double height;
    const ax_motion* place;
} lettering;

static void draw_letter(void* context, bool down, double x, double y)
{
    const lettering* l = context;
    if (!down)
        ax_plan_path(l->builder, false);
    double at[2];
    ax_move(l->place, l->height * x, l->height * y, at);
    ax_plan_point(l->builder, at[0], at[1]);
}

void ax_plan_text(ax_plan_builder* b, const char* text, double height, const ax_motion* place)
{
    lettering l = {b, height, place};
    ax_stroke_text(text, draw_letter, &l);
}

ax_cut_arc ax_cut_arc_of(const ax_cut_point* a, const ax_cut_point* b)
{
    // the centre lies beside the chord's middle by (1 / bulge - bulge) / 4 chords, to the left where the arc turns left
    double dx = b->x - a->x, dy = b->y - a->y, beside = (1 / a->bulge - a->bulge) / 4;
    ax_cut_arc arc = {.centre = {(a->x + b->x) / 2 - beside * dy, (a->y + b->y) / 2 + beside * dx},
                      .sweep = 4 * atan(a->bulge)};
    arc.radius = hypot(a->x - arc.centre[0], a->y - arc.centre[1]);
    arc.start = atan2(a->y - arc.centre[1], a->x - arc.centre[0]);
    return arc;
}

bool ax_cut_path_is_circle(const ax_cut_plan* plan, const ax_cut_path* path, double centre[2], double* radius)
{
    const ax_cut_point* p = plan->points + path->first;
    if (!path->closed || path->count != 2 || fabs(p[0].bulge) != 1 || p[1].bulge != p[0].bulge)
        return false;
    centre[0] = (p[0].x + p[1].x) / 2, centre[1] = (p[0].y + p[1].y) / 2;
    *radius = hypot(p[1].x - p[0].x, p[1].y - p[0].y) / 2;
    return true;
}

// The next vertex of a path after its k-th, NULL after the last of an open one.
static const ax_cut_point* next_point(const ax_cut_plan* plan, const ax_cut_path* path, int k)
{
    if (k + 1 < path->count)
        return &plan->points[path->first + k + 1];
    return path->closed ? &plan->points[path->first] : NULL;
}

double ax_path_area(const ax_cut_plan* plan, const ax_cut_path* path)
{
    double area = 0;
    const ax_cut_point* origin = &plan->points[path->first]; // near, so that nothing is lost far from (0, 0)
    for (int k = 0; k < path->count; ++k) {
        const ax_cut_point *a = &plan->points[path->first + k], *b = next_point(plan, path, k);
        if (!b)
            break;
        area += ((a->x - origin->x) * (b->y - origin->y) - (b->x - origin->x) * (a->y - origin->y)) / 2;
        if (a->bulge != 0) {
            ax_cut_arc arc = ax_cut_arc_of(a, b);
            area += arc.radius * arc.radius * (arc.sweep - sin(arc.sweep)) / 2;
        }
    }
    return area;
}

double ax_path_length(const ax_cut_plan* plan, const ax_cut_path* path)
{
    double length = 0;
    for (int k = 0; k < path->count; ++k) {
        const ax_cut_point *a = &plan->points[path->first + k], *b = next_point(plan, path, k);
        if (!b)
            break;
        double chord = hypot(b->x - a->x, b->y - a->y), sweep = 4 * atan(a->bulge);
        length += a->bulge != 0 ? chord * (sweep / 2) / sin(sweep / 2) : chord;
    }
    return length;
}

static void widen(double lo[2], double hi[2], double x, double y)
{
    lo[0] = fmin(lo[0], x), hi[0] = fmax(hi[0], x);
    lo[1] = fmin(lo[1], y), hi[1] = fmax(hi[1], y);
}

void ax_path_bounds(const ax_cut_plan* plan, const ax_cut_path* path, double lo[2], double hi[2])
{
    for (int k = 0; k < path->count; ++k) {
        const ax_cut_point *a = &plan->points[path->first + k], *b = next_point(plan, path, k);
        widen(lo, hi, a->x, a->y);
        if (!b || a->bulge == 0)
            continue;
        ax_cut_arc arc = ax_cut_arc_of(a, b);
        for (int quarter = 0; quarter < 4; ++quarter) { // the ends of the axes that the arc passes
            double turn = fmod((quarter * AX_PI / 2 - arc.start) * (arc.sweep > 0 ? 1 : -1) + 4 * AX_PI, 2 * AX_PI);
            if (turn < fabs(arc.sweep))
                widen(lo, hi,
                      arc.centre[0] + arc.radius * (quarter == 0   ? 1
                                                    : quarter == 2 ? -1
                                                                   : 0),
                      arc.centre[1] + arc.radius * (quarter == 1   ? 1
                                                    : quarter == 3 ? -1
                                                                   : 0));
        }
    }
}
