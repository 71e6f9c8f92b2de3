#include "operator/brush.h"

#include <assert.h>
#include <stdlib.h>

const char* const ax_falloff_names[4] = {[AX_FALLOFF_SPHERE] = "sphere",
                                         [AX_FALLOFF_FLAT] = "flat",
                                         [AX_FALLOFF_LINEAR] = "linear",
                                         [AX_FALLOFF_GAUSS] = "gauss"};

double ax_falloff_share(ax_falloff falloff, double x, double from, double to)
{
    if (!(x < 1))
        return 0;
    switch (falloff) {
    case AX_FALLOFF_FLAT:
        return 1;
    case AX_FALLOFF_LINEAR:
        return 1 - x;
    case AX_FALLOFF_GAUSS: // three standard deviations within the radius, lowered so that it ends at nothing
        return (exp(-4.5 * x * x) - exp(-4.5)) / (1 - exp(-4.5));
    case AX_FALLOFF_SPHERE: {
        double k = to / from - 1;
        return fabs(k) < 1e-9 ? 1 - x * x : 1 - log1p(k * x * x) / log1p(k);
    }
    }
    assert(!"a falloff without a case");
    return 0;
}

// ---- copies of a stroke ------------------------------------------------------------------------------------------------------

static int copy_count(const ax_stroke* stroke)
{
    return stroke->copies * (stroke->mirrored ? 2 : 1);
}

static void place_point(const ax_stroke* stroke, int copy, int k, double out[2])
{
    double x = stroke->points.values[2 * k] - stroke->centre[0],
           y = stroke->points.values[2 * k + 1] - stroke->centre[1];
    if (copy >= stroke->copies) {
        double c = cos(2 * stroke->mirror_angle), s = sin(2 * stroke->mirror_angle), mirrored = c * x + s * y;
        y = s * x - c * y;
        x = mirrored;
    }
    double turn = 2 * AX_PI * (copy % stroke->copies) / stroke->copies, c = cos(turn), s = sin(turn);
    out[0] = stroke->centre[0] + c * x - s * y;
    out[1] = stroke->centre[1] + s * x + c * y;
}

// Distances of places from the stroke and its copies, where they are below what stands there. Those above `reach` need not be
// found: a long stroke is one of hundreds of segments, few of them near a place.
static void lower_distances(const ax_stroke* stroke, double reach, int count, const double (*places)[2],
                            double* distance)
{
    int points = stroke->points.count;
    for (int copy = 0; copy < copy_count(stroke); ++copy) {
        double a[2], b[2];
        place_point(stroke, copy, 0, a);
        for (int k = points > 1; k < points; ++k) {
            place_point(stroke, copy, k, b);
            double lo[2] = {fmin(a[0], b[0]) - reach, fmin(a[1], b[1]) - reach};
            double hi[2] = {fmax(a[0], b[0]) + reach, fmax(a[1], b[1]) + reach};
            for (int i = 0; i < count; ++i) {
                const double* p = places[i];
                if (p[0] < lo[0] || p[0] > hi[0] || p[1] < lo[1] || p[1] > hi[1])
                    continue;
                double d = ax_segment_distance2(places[i], a, b);
                distance[i] = d < distance[i] ? d : distance[i];
            }
            memcpy(a, b, sizeof a);
        }
    }
}

static void forget_beyond(double radius, int count, double* distance)
{
    for (int k = 0; k < count; ++k)
        if (distance[k] > radius)
            distance[k] = INFINITY;
}

// Distance of every panel's centre from the stroke and its copies, on the sheet. Infinite beyond `radius`.
static void stroke_on_sheet(const ax_stroke* stroke, const ax_sheet* sheet, double radius, double* distance)
{
    for (int t = 0; t < sheet->count; ++t)
        distance[t] = INFINITY;
    lower_distances(stroke, radius, sheet->count, (const double(*)[2])sheet->centre, distance);
    forget_beyond(radius, sheet->count, distance);
}

// ---- fast marching over the deployed surface ---------------------------------------------------------------------------------

// Panels, and holes as fans about their centres, which are numbered after the hinges.
typedef struct skin {
    int vertex_count, face_count;
    double (*deployed)[3], (*sheet)[2];
    int (*faces)[3];
    int *start, *corner; // per vertex: its corners, 3 face + k
} skin;

// What is open along the rim stays open: strokes go round it.
static skin make_skin(const ax_form_view* view)
{
    const ax_linkage* l = view->linkage;
    int hinges = l->hinge_count, fans = l->hole_count ? l->hole_start[l->hole_count] : 0;
    ax_mesh cover = ax_linkage_cover(l, view->deployed);
    skin s = {.vertex_count = cover.vertex_count,
              .face_count = l->triangle_count + fans,
              .deployed = cover.positions,
              .faces = cover.faces};
    s.sheet = ax_calloc((size_t)s.vertex_count, sizeof *s.sheet);
    memcpy(s.sheet, view->sheet, (size_t)hinges * sizeof *s.sheet);
    for (int hole = 0; hole < l->hole_count; ++hole) {
        int sides = l->hole_start[hole + 1] - l->hole_start[hole];
        for (int k = l->hole_start[hole]; k < l->hole_start[hole + 1]; ++k)
            for (int d = 0; d < 2; ++d)
                s.sheet[hinges + hole][d] += view->sheet[l->hole_hinges[k]][d] / sides;
    }
    s.start = AX_NEW0(int, s.vertex_count + 1);
    s.corner = AX_NEW(int, 3 * (size_t)s.face_count);
    const int* vertex = (const int*)s.faces;
    for (int c = 0; c < 3 * s.face_count; ++c)
        ++s.start[vertex[c] + 1];
    for (int v = 0; v < s.vertex_count; ++v)
        s.start[v + 1] += s.start[v];
    for (int c = 3 * s.face_count - 1; c >= 0; --c) // from the back, so that start ends where it began
        s.corner[--s.start[vertex[c] + 1]] = c;
    memmove(s.start, s.start + 1, (size_t)s.vertex_count * sizeof *s.start);
    s.start[s.vertex_count] = 3 * s.face_count;
    return s;
}

static void free_skin(skin* s)
{
    ax_free(s->deployed);
    ax_free(s->sheet);
    ax_free(s->faces);
    ax_free(s->start);
    ax_free(s->corner);
}

// Distance at c from those at a and b, as of a plane wave over the flat triangle; along an edge where the wave would leave it.
static double march_over(const double a[3], const double b[3], const double c[3], double at_a, double at_b)
{
    double u[3], v[3];
    ax_sub3(a, c, u);
    ax_sub3(b, c, v);
    double uu = ax_dot3(u, u), uv = ax_dot3(u, v), vv = ax_dot3(v, v), det = uu * vv - uv * uv;
    double by_edge = fmin(at_a + sqrt(uu), at_b + sqrt(vv));
    if (!(det > 1e-12 * uu * vv))
        return by_edge;
    // t solves  q11 (t - at_a)^2 + 2 q12 (t - at_a)(t - at_b) + q22 (t - at_b)^2 = 1  with Q = ([u v]' [u v])^-1
    double q11 = vv / det, q12 = -uv / det, q22 = uu / det;
    double sum = q11 + 2 * q12 + q22, half = (q11 + q12) * at_a + (q12 + q22) * at_b;
    double rest = q11 * at_a * at_a + 2 * q12 * at_a * at_b + q22 * at_b * at_b - 1, root = half * half - sum * rest;
    if (!(root >= 0))
        return by_edge;
    double t = (half + sqrt(root)) / sum, x = t - at_a, y = t - at_b;
    bool within = q11 * x + q12 * y > 0 && q12 * x + q22 * y > 0; // the wave comes through the edge a b
    return within ? fmin(t, by_edge) : by_edge;
}

typedef struct front {
    int count, *heap, *place; // place in the heap, -1: not in it
    const double* key;
} front;

static bool is_before(const front* f, int a, int b)
{
    return f->key[a] < f->key[b] || (f->key[a] == f->key[b] && a < b); // ties by number: the same bits everywhere
}

static void set_place(front* f, int at, int v)
{
    f->heap[at] = v;
    f->place[v] = at;
}

static void rise(front* f, int v)
{
    if (f->place[v] < 0)
        set_place(f, f->count++, v);
    int at = f->place[v];
    for (; at > 0 && is_before(f, v, f->heap[(at - 1) / 2]); at = (at - 1) / 2)
        set_place(f, at, f->heap[(at - 1) / 2]);
    set_place(f, at, v);
}

static int take_first(front* f)
{
    int first = f->heap[0], v = f->heap[--f->count], at = 0;
    f->place[first] = -1;
    for (int child = 1; child < f->count; child = 2 * at + 1) {
        child += child + 1 < f->count && is_before(f, f->heap[child + 1], f->heap[child]);
        if (!is_before(f, f->heap[child], v))
            break;
        set_place(f, at, f->heap[child]);
        at = child;
    }
    if (f->count)
        set_place(f, at, v);
    return first;
}

// From the distances already there outwards, up to `radius`.
static void march(const skin* s, double radius, double* distance)
{
    int n = s->vertex_count;
    front f = {.heap = AX_NEW(int, n), .place = AX_NEW(int, n), .key = distance};
    unsigned char* done = AX_NEW0(unsigned char, n);
    memset(f.place, -1, (size_t)n * sizeof *f.place);
    for (int v = 0; v < n; ++v)
        if (isfinite(distance[v]))
            rise(&f, v);
    while (f.count) {
        int v = take_first(&f);
        done[v] = 1;
        if (distance[v] > radius)
            break;
        for (int k = s->start[v]; k < s->start[v + 1]; ++k) {
            const int* face = s->faces[s->corner[k] / 3];
            int a = face[(s->corner[k] + 1) % 3],
                b = face[(s->corner[k] + 2) % 3]; // a face has three corners: 3 face falls out
            for (int turn = 0; turn < 2; ++turn) {
                int to = turn ? a : b, other = turn ? b : a;
                if (done[to])
                    continue;
                double d = done[other] ? march_over(s->deployed[v], s->deployed[other], s->deployed[to], distance[v],
                                                    distance[other])
                                       : distance[v] + ax_distance3(s->deployed[v], s->deployed[to]);
                if (d < distance[to]) {
                    distance[to] = d;
                    rise(&f, to);
                }
            }
        }
    }
    ax_free(f.heap);
    ax_free(f.place);
    ax_free(done);
}

// How much longer edges are than on the sheet, about each vertex.
static double* measure_stretch(const skin* s)
{
    double *deployed = AX_NEW0(double, s->vertex_count), *sheet = AX_NEW0(double, s->vertex_count);
    for (int c = 0; c < 3 * s->face_count; ++c) {
        int a = s->faces[c / 3][c % 3], b = s->faces[c / 3][(c + 1) % 3];
        double there = ax_distance3(s->deployed[a], s->deployed[b]), here = ax_distance2(s->sheet[a], s->sheet[b]);
        deployed[a] += there, deployed[b] += there;
        sheet[a] += here, sheet[b] += here;
    }
    for (int v = 0; v < s->vertex_count; ++v)
        deployed[v] /= sheet[v];
    ax_free(sheet);
    return deployed;
}

void ax_stroke_on_deployed(const ax_stroke* stroke, const ax_sheet* sheet, const ax_form_view* view, double radius,
                           double* distance)
{
    skin s = make_skin(view);
    double *at = AX_NEW(double, s.vertex_count), *stretch = measure_stretch(&s);
    for (int v = 0; v < s.vertex_count; ++v)
        at[v] = INFINITY;
    lower_distances(stroke, sheet->spacing, s.vertex_count, (const double(*)[2])s.sheet, at);
    // beside the stroke, where the map is nearly a similarity, lengths are those on the sheet times its stretch
    forget_beyond(sheet->spacing, s.vertex_count, at);
    for (int v = 0; v < s.vertex_count; ++v)
        at[v] *= stretch[v];
    march(&s, radius + 2 * sheet->spacing, at);
    for (int t = 0; t < sheet->count; ++t) {
        const int* corner = sheet->linkage->triangles[t];
        distance[t] = (at[corner[0]] + at[corner[1]] + at[corner[2]]) / 3;
        // a mean of corners about the stroke is no distance from it: there the sheet knows better
        double near = INFINITY;
        lower_distances(stroke, sheet->spacing, 1, (const double(*)[2]) & sheet->centre[t], &near);
        if (near < sheet->spacing)
            distance[t] = near * (stretch[corner[0]] + stretch[corner[1]] + stretch[corner[2]]) / 3;
    }
    forget_beyond(radius, sheet->count, distance);
    ax_free(at);
    ax_free(stretch);
    free_skin(&s);
}

// ---- as operators have it ----------------------------------------------------------------------------------------------------

const char* const ax_brush_ways[2] = {"sheet", "deployed"};

ax_brush ax_brush_default(void)
{
    return (ax_brush){.copies = 1, .centre = {NAN, NAN}, .hinges = "all"};
}

ax_status ax_brush_take(const ax_operator_context* context, const ax_brush* brush, ax_sheet* sheet, double** distance,
                        ax_error* error)
{
    ax_status status = ax_sheet_take(context, brush->hinges, sheet, error);
    if (status != AX_OK)
        return status;
    const double* centre = isnan(brush->centre[0]) ? sheet->middle : brush->centre;
    const ax_stroke stroke = {.points = brush->points,
                              .centre = {centre[0], centre[1]},
                              .copies = brush->copies,
                              .mirrored = brush->mirror,
                              .mirror_angle = brush->mirror_angle * AX_PI / 180};
    *distance = AX_NEW(double, sheet->count);
    if (brush->along) {
        ax_form_view view = ax_form_look(*context->form);
        ax_stroke_on_deployed(&stroke, sheet, &view, brush->radius, *distance);
    } else
        stroke_on_sheet(&stroke, sheet, brush->radius, *distance);
    for (int t = 0; t < sheet->count; ++t)
        (*distance)[t] = sheet->chosen[t] ? (*distance)[t] / brush->radius : INFINITY;
    return AX_OK;
}
