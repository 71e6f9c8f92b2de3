#include "picture/view.h"

#include <string.h>

// Completes the frame from `forward`: up is as close to the z axis as can be, or to the y axis when looking along z.
static void complete(ax_view* view)
{
    const double *f = view->forward, z[3] = {0, 0, 1}, y[3] = {0, 1, 0};
    ax_cross(f, fabs(f[2]) < 1 - 1e-9 ? z : y, view->right);
    double length = ax_norm3(view->right);
    for (int c = 0; c < 3; ++c)
        view->right[c] /= length;
    ax_cross(view->right, f, view->up);
    view->scale = 1;
}

ax_view ax_view_from(double azimuth, double elevation, double distance)
{
    ax_view view = {.perspective = true};
    double from[3] = {cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)};
    for (int c = 0; c < 3; ++c)
        view.eye[c] = distance * from[c], view.forward[c] = -from[c];
    complete(&view);
    return view;
}

ax_view ax_view_along(const double direction[3])
{
    ax_view view = {0};
    memcpy(view.forward, direction, sizeof view.forward);
    complete(&view);
    return view;
}

ax_raster_vertex ax_view_project(const ax_view* view, const float place[3])
{
    double d[3] = {place[0] - view->eye[0], place[1] - view->eye[1], place[2] - view->eye[2]};
    double depth = ax_dot3(d, view->forward), shrink = view->perspective ? 1 / depth : 1;
    return (ax_raster_vertex){
        .x = view->offset[0] + view->scale * shrink * ax_dot3(d, view->right),
        .y = view->offset[1] - view->scale * shrink * ax_dot3(d, view->up),
        .near = (float)(view->perspective ? shrink : -depth),
    };
}

void ax_view_ray(const ax_view* view, double x, double y, double origin[3], double direction[3])
{
    double u = (x - view->offset[0]) / view->scale, v = (view->offset[1] - y) / view->scale;
    for (int c = 0; c < 3; ++c) {
        double across = u * view->right[c] + v * view->up[c];
        origin[c] = view->eye[c] + (view->perspective ? 0 : across);
        direction[c] = view->forward[c] + (view->perspective ? across : 0);
    }
    double length = ax_norm3(direction);
    for (int c = 0; c < 3; ++c)
        direction[c] /= length;
}

// Outline of the projected points, counter-clockwise with y down: the extreme points in a number of directions. A sharp corner
// between two directions is kept, since its point is extreme in one of them.
enum { SIDES = 64, STEPS = 16 };
typedef double outline[SIDES][2];

static void find_outline(const ax_view* view, int count, const float (*points)[3], outline hull)
{
    double best[SIDES], direction[SIDES][2];
    for (int k = 0; k < SIDES; ++k) {
        best[k] = -INFINITY;
        direction[k][0] = cos(2 * AX_PI * k / SIDES), direction[k][1] = sin(2 * AX_PI * k / SIDES);
    }
    for (int i = 0; i < count; ++i) {
        ax_raster_vertex at = ax_view_project(view, points[i]);
        for (int k = 0; k < SIDES; ++k) {
            double reach = at.x * direction[k][0] + at.y * direction[k][1];
            if (reach > best[k])
                best[k] = reach, hull[k][0] = at.x, hull[k][1] = at.y;
        }
    }
}

static bool overlaps(const outline hull, double scale, const double shift[2], const ax_rectangle* r)
{
    const double corners[4][2] = {
        {r->x, r->y}, {r->x + r->width, r->y}, {r->x + r->width, r->y + r->height}, {r->x, r->y + r->height}};
    bool beside[4] = {true, true, true, true};
    for (int k = 0; k < SIDES; ++k) {
        double a[2], b[2];
        for (int c = 0; c < 2; ++c)
            a[c] = scale * hull[k][c] + shift[c], b[c] = scale * hull[(k + 1) % SIDES][c] + shift[c];
        beside[0] &= a[0] <= r->x, beside[1] &= a[0] >= r->x + r->width;
        beside[2] &= a[1] <= r->y, beside[3] &= a[1] >= r->y + r->height;
        bool separates = a[0] != b[0] || a[1] != b[1];
        for (int i = 0; i < 4; ++i)
            separates = separates && ax_orient2(a, b, corners[i]) <= 0;
        if (separates)
            return false;
    }
    return !(beside[0] || beside[1] || beside[2] || beside[3]);
}

// Finds the shift nearest to the middle at which a hull of this scale is clear of all obstacles, among STEPS x STEPS.
static bool place(const outline hull, const double lo[2], const double hi[2], double scale, ax_rectangle safe,
                  int count, const ax_rectangle* obstacles, double shift[2])
{
    double best = INFINITY;
    const double low[2] = {safe.x - scale * lo[0], safe.y - scale * lo[1]};
    const double room[2] = {safe.width - scale * (hi[0] - lo[0]), safe.height - scale * (hi[1] - lo[1])};
    for (int j = 0; j <= STEPS; ++j)
        for (int i = 0; i <= STEPS; ++i) {
            double at[2] = {low[0] + room[0] * i / STEPS, low[1] + room[1] * j / STEPS};
            double off = hypot(room[0] * (i - STEPS / 2.0), room[1] * (j - STEPS / 2.0));
            bool clear = off < best;
            for (int k = 0; clear && k < count; ++k)
                clear = !overlaps(hull, scale, at, &obstacles[k]);
            if (clear)
                best = off, shift[0] = at[0], shift[1] = at[1];
        }
    return best < INFINITY;
}

void ax_view_frame(ax_view* view, int count, const float (*points)[3], ax_rectangle safe, int obstacle_count,
                   const ax_rectangle* obstacles)
{
    view->scale = 1, view->offset[0] = view->offset[1] = 0;
    outline hull;
    find_outline(view, count, points, hull);
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < SIDES; ++k)
        for (int c = 0; c < 2; ++c)
            lo[c] = fmin(lo[c], hull[k][c]), hi[c] = fmax(hi[c], hull[k][c]);
    double fitting = fmin(safe.width / fmax(hi[0] - lo[0], 1e-9), safe.height / fmax(hi[1] - lo[1], 1e-9));
    view->scale = fitting;
    if (!place(hull, lo, hi, fitting, safe, obstacle_count, obstacles, view->offset)) {
        double fits = fitting / 8, too_large = fitting;
        place(hull, lo, hi, fits, safe, 0, NULL, view->offset); // should even that be in the way
        view->scale = fits;
        for (int k = 0; k < 12; ++k) {
            double scale = (fits + too_large) / 2;
            if (place(hull, lo, hi, scale, safe, obstacle_count, obstacles, view->offset))
                view->scale = fits = scale;
            else
                too_large = scale;
        }
    }
}
