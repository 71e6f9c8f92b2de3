#include "mesh/boxtree.h"
#include "mesh/closest.h"

#include <assert.h>

struct ax_polyline {
    int count;
    double (*points)[3];     // count + 1: the first again at the end
    double (*directions)[3]; // mean direction at each point, the first again at the end
    ax_box_tree tree;        // over the segments
};

static void normalise(double v[3])
{
    double length = ax_norm3(v);
    if (length > 0)
        for (int d = 0; d < 3; ++d)
            v[d] /= length;
}

ax_polyline* ax_polyline_make(int count, const double (*points)[3])
{
    assert(count > 0);
    ax_polyline* line = AX_NEW0(ax_polyline, 1);
    line->count = count;
    line->points = ax_alloc((size_t)count + 1, sizeof *line->points);
    line->directions = ax_calloc((size_t)count + 1, sizeof *line->directions);
    for (int i = 0; i <= count; ++i)
        for (int d = 0; d < 3; ++d)
            line->points[i][d] = points[i % count][d];

    double(*boxes)[2][3] = ax_alloc((size_t)count, sizeof *boxes);
    for (int i = 0; i < count; ++i) {
        const double *a = line->points[i], *b = line->points[i + 1];
        double direction[3];
        ax_sub3(b, a, direction);
        normalise(direction);
        for (int d = 0; d < 3; ++d) {
            line->directions[i][d] += direction[d];
            line->directions[i + 1][d] += direction[d];
            boxes[i][0][d] = fmin(a[d], b[d]);
            boxes[i][1][d] = fmax(a[d], b[d]);
        }
    }
    for (int d = 0; d < 3; ++d)
        line->directions[0][d] += line->directions[count][d];
    for (int i = 0; i < count; ++i)
        normalise(line->directions[i]);
    for (int d = 0; d < 3; ++d)
        line->directions[count][d] = line->directions[0][d];
    line->tree = ax_box_tree_make(count, (const double(*)[2][3])boxes);
    ax_free(boxes);
    return line;
}

void ax_polyline_free(ax_polyline* line)
{
    if (!line)
        return;
    ax_free(line->points);
    ax_free(line->directions);
    ax_box_tree_free(&line->tree);
    ax_free(line);
}

typedef struct search {
    const ax_polyline* line;
    const double* x;
    double squared; // distance
    int segment;
    double parameter, point[3];
} search;

static void try_segment(void* context, int place)
{
    search* s = context;
    int segment = s->line->tree.order[place];
    const double *a = s->line->points[segment], *b = s->line->points[segment + 1];
    double ab[3], ax[3], point[3], d[3];
    ax_sub3(b, a, ab);
    ax_sub3(s->x, a, ax);
    double along = ax_dot3(ab, ax), whole = ax_dot3(ab, ab);
    double t = along <= 0 ? 0 : (along >= whole ? 1 : along / whole);
    for (int e = 0; e < 3; ++e)
        point[e] = (1 - t) * a[e] + t * b[e];
    ax_sub3(s->x, point, d);
    double squared = ax_dot3(d, d);
    if (squared > s->squared || (squared == s->squared && segment > s->segment))
        return;
    s->squared = squared;
    s->segment = segment;
    s->parameter = t;
    for (int e = 0; e < 3; ++e)
        s->point[e] = point[e];
}

ax_polyline_point ax_polyline_find(const ax_polyline* line, const double x[3])
{
    search s = {.line = line, .x = x, .squared = INFINITY, .segment = line->count};
    ax_box_tree_nearest(&line->tree, x, x, &s.squared, try_segment, &s);
    assert(s.segment < line->count && "x must be finite");

    ax_polyline_point result = {.segment = s.segment, .parameter = s.parameter, .distance = sqrt(s.squared)};
    const double *before = line->directions[s.segment], *after = line->directions[s.segment + 1];
    for (int d = 0; d < 3; ++d) {
        result.point[d] = s.point[d];
        result.tangent[d] = (1 - s.parameter) * before[d] + s.parameter * after[d];
    }
    if (!(ax_norm3(result.tangent) > 0)) // the line turns back on itself
        ax_sub3(line->points[s.segment + 1], line->points[s.segment], result.tangent);
    normalise(result.tangent);
    return result;
}
