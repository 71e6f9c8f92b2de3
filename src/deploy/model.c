#include "deploy/model.h"

#include "base/random.h"
#include "base/vec.h"
#include "linalg/cholesky.h"

#include <assert.h>
#include <string.h>

static double panel_area(const ax_linkage* linkage, const double (*flat)[2], int t)
{
    const int* corner = linkage->triangles[t];
    return fabs(ax_orient2(flat[corner[0]], flat[corner[1]], flat[corner[2]])) / 2;
}

static void add_polygon(ax_deploy_model* model, const int* loop, int count)
{
    int at = model->polygon_start[model->polygon_count++];
    memcpy(model->polygon + at, loop, (size_t)count * sizeof *loop);
    model->polygon_start[model->polygon_count] = at + count;
}

static void collect_polygons(ax_deploy_model* model, const ax_linkage* linkage)
{
    int holes = linkage->hole_count, openings = linkage->opening_count;
    int corners = 3 * linkage->triangle_count + linkage->hole_start[holes] + linkage->opening_start[openings];
    model->polygon_start = AX_NEW0(int, linkage->triangle_count + holes + openings + 1);
    model->polygon = AX_NEW(int, corners);
    for (int t = 0; t < linkage->triangle_count; ++t)
        add_polygon(model, linkage->triangles[t], 3);
    for (int h = 0; h < holes; ++h)
        add_polygon(model, linkage->hole_hinges + linkage->hole_start[h],
                    linkage->hole_start[h + 1] - linkage->hole_start[h]);
    for (int h = 0; h < openings; ++h)
        add_polygon(model, linkage->opening_hinges + linkage->opening_start[h],
                    linkage->opening_start[h + 1] - linkage->opening_start[h]);
}

ax_deploy_model ax_deploy_model_make(const ax_linkage* linkage, const double (*flat)[2], const double (*places)[3],
                                     const ax_hold* holds, const double direction[3], double* unit_load)
{
    int n = linkage->hinge_count;
    ax_deploy_model m = {.hinges = n, .inflated = !direction};
    double sum = 0, area = 0;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        for (int k = 0; k < 3; ++k)
            sum += ax_distance2(flat[linkage->triangles[t][(k + 1) % 3]], flat[linkage->triangles[t][(k + 2) % 3]]);
        area += panel_area(linkage, flat, t);
    }
    m.unit = sum / (3 * linkage->triangle_count);
    *unit_load = m.inflated ? 4 * area : area;
    area /= m.unit * m.unit;

    // supports and their centre, which becomes the origin
    m.unknown = AX_NEW(int, n);
    m.hinge = AX_NEW(int, n);
    m.slide = AX_NEW(int, n);
    m.hold = ax_copy(holds, (size_t)n, sizeof *m.hold);
    int held = 0;
    for (int h = 0; h < n; ++h) {
        for (int c = 0; c < 2; ++c)
            m.flat_centre[c] += flat[h][c] / n;
        if (ax_deploy_placed(&m, h)) {
            for (int c = 0; c < 3; ++c)
                m.centre[c] += places[h][c];
            ++held;
        }
        if (holds[h].kind == AX_HOLD_FIXED) {
            m.unknown[h] = -1;
        } else {
            m.hinge[m.unknowns] = h;
            m.unknown[h] = m.unknowns++;
        }
        if (holds[h].kind > AX_HOLD_FIXED)
            m.slide[m.slide_count++] = h;
    }
    assert(held > 0);
    for (int c = 0; c < 3; ++c)
        m.centre[c] /= held;
    m.rest = ax_alloc((size_t)n, sizeof *m.rest);
    m.support = ax_calloc((size_t)n, sizeof *m.support);
    for (int h = 0; h < n; ++h) {
        for (int c = 0; c < 2; ++c)
            m.rest[h][c] = (flat[h][c] - m.flat_centre[c]) / m.unit;
        if (holds[h].kind != AX_HOLD_FREE)
            for (int c = 0; c < 3; ++c)
                m.support[h][c] = (places[h][c] - m.centre[c]) / m.unit;
        if (holds[h].kind == AX_HOLD_ON_CURVE)
            ax_deploy_return(&m, h, m.support[h], m.support[h]);
    }

    int most = 3 * linkage->triangle_count;
    m.edge = ax_alloc((size_t)most, sizeof *m.edge);
    m.length = AX_NEW(double, most);
    m.edge_source = AX_NEW(int, most);
    double rim = 0;
    for (int e = 0; e < most; ++e) {
        int i = linkage->triangles[e / 3][(e + 1) % 3], j = linkage->triangles[e / 3][(e + 2) % 3];
        if (linkage->on_rim[linkage->triangles[e / 3]
                                              [e % 3]]) // a panel with a hinge on the rim spans twice its edge of it
            rim += 2;
        if (m.unknown[i] < 0 && m.unknown[j] < 0)
            continue; // both ends held: no equation
        m.edge[m.edge_count][0] = i, m.edge[m.edge_count][1] = j;
        m.length[m.edge_count] = ax_distance2(m.rest[i], m.rest[j]);
        m.edge_source[m.edge_count++] = e;
    }
    m.tension = 1 / rim;

    m.gravity = ax_calloc((size_t)n, sizeof *m.gravity);
    if (direction)
        for (int t = 0; t < linkage->triangle_count; ++t)
            for (int k = 0; k < 3; ++k)
                for (int c = 0; c < 3; ++c)
                    m.gravity[linkage->triangles[t][k]][c] +=
                        direction[c] * panel_area(linkage, (const double(*)[2])m.rest, t) / area / 3;
    else
        m.pressure = 1 / (4 * area);
    collect_polygons(&m, linkage);
    return m;
}

void ax_deploy_model_keep_fair(ax_deploy_model* m, int count, int points, const int* hinges, const double* coefficients,
                               double stiffness)
{
    assert(points <= 4);
    m->fair = ax_realloc(m->fair, (size_t)(m->fair_count + count), sizeof *m->fair);
    for (int k = 0; k < count; ++k) {
        ax_fair_row* row = m->fair + m->fair_count++;
        *row = (ax_fair_row){.points = points, .stiffness = stiffness * m->unit};
        memcpy(row->hinge, hinges + points * k, (size_t)points * sizeof *hinges);
        memcpy(row->coefficient, coefficients, (size_t)points * sizeof *coefficients);
    }
}

void ax_deploy_model_free(ax_deploy_model* m)
{
    void* blocks[] = {m->unknown, m->hinge,   m->slide,   m->hold,          m->edge,    m->length, m->edge_source,
                      m->rest,    m->support, m->gravity, m->polygon_start, m->polygon, m->fair};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    *m = (ax_deploy_model){0};
}

// The place on a curve nearest to x, model units, as its parameter.
static double nearest(const ax_deploy_model* m, const ax_curve* curve, const double x[3], double out[3])
{
    double place[3];
    for (int c = 0; c < 3; ++c)
        place[c] = x[c] * m->unit + m->centre[c];
    double t = ax_curve_nearest(curve, place, out);
    for (int c = 0; c < 3; ++c)
        out[c] = (out[c] - m->centre[c]) / m->unit;
    return fabs(t - round(t)) < 1e-9 ? round(t) : t; // a corner remains one after a change of units
}

void ax_deploy_return(const ax_deploy_model* m, int h, const double from[3], double x[3])
{
    const ax_hold* hold = &m->hold[h];
    if (hold->kind == AX_HOLD_IN_PLANE) {
        double d[3];
        ax_sub3(x, m->support[h], d);
        double off = ax_dot3(d, hold->normal);
        for (int c = 0; c < 3; ++c)
            x[c] -= off * hold->normal[c];
        return;
    }
    ax_curve_range range = ax_curve_extent(hold->curve);
    double place[3], start[3], to = nearest(m, hold->curve, x, place);
    if (!range.smooth) {
        double t = nearest(m, hold->curve, from, start), span = range.to - range.from, way = to - t;
        if (range.closed)
            way -= span * round(way / span); // the shorter way round
        double corner = way > 0 ? floor(t) + 1 : ceil(t) - 1;
        if (fabs(way) > fabs(corner - t)) {
            ax_curve_point(hold->curve, corner, place);
            for (int c = 0; c < 3; ++c)
                place[c] = (place[c] - m->centre[c]) / m->unit;
        }
    }
    memcpy(x, place, sizeof place);
}

double ax_deploy_along(const ax_deploy_model* m, int h, const double x[3])
{
    double place[3];
    return ax_curve_length(m->hold[h].curve, nearest(m, m->hold[h].curve, x, place));
}

static double unit_tangent(const ax_curve* curve, double t, double tangent[3], double second[3])
{
    ax_curve_derivatives(curve, t, tangent, second);
    double speed = ax_norm3(tangent);
    for (int c = 0; c < 3 && speed > 0; ++c)
        tangent[c] /= speed;
    return speed;
}

static ax_deploy_frame frame_on_curve(const ax_deploy_model* m, const ax_curve* curve, const double x[3],
                                      const double gradient[3])
{
    ax_curve_range range = ax_curve_extent(curve);
    double place[3], tangent[3], second[3], t = nearest(m, curve, x, place);
    double speed = unit_tangent(curve, t, tangent, second);
    ax_deploy_frame frame = {0};
    if (!(speed > 0)) // the curve is a point
        return frame;
    bool first = !range.closed && t <= range.from, last = !range.closed && t >= range.to;
    if (first || last || (!range.smooth && t == round(t))) {
        // from a corner it leaves along the side on which the energy falls more steeply, if it falls on any
        double back[3], ignored[3];
        unit_tangent(curve, first ? t : t - 1e-6, back, ignored);
        double ahead_slope = last ? 0 : ax_dot3(gradient, tangent), back_slope = first ? 0 : -ax_dot3(gradient, back);
        if (ahead_slope >= 0 && back_slope >= 0)
            return frame;
        if (back_slope < ahead_slope)
            memcpy(tangent, back, sizeof back);
        if (!range.smooth)
            memset(second, 0, sizeof second);
    }
    double along = ax_dot3(tangent, second);
    for (int r = 0; r < 3; ++r) {
        frame.bend += gradient[r] * (second[r] - along * tangent[r]) / (speed * speed) * m->unit;
        for (int c = 0; c < 3; ++c)
            frame.allowed[r][c] = tangent[r] * tangent[c];
    }
    return frame;
}

void ax_deploy_frames(const ax_deploy_model* m, const double (*x)[3], const double (*gradient)[3],
                      ax_deploy_frame* frame)
{
    for (int k = 0; k < m->slide_count; ++k) {
        int h = m->slide[k];
        const ax_hold* hold = &m->hold[h];
        if (hold->kind == AX_HOLD_ON_CURVE) {
            frame[k] = frame_on_curve(m, hold->curve, x[h], gradient[h]);
            continue;
        }
        frame[k].bend = 0;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                frame[k].allowed[r][c] = (r == c) - hold->normal[r] * hold->normal[c];
    }
}

void ax_deploy_allow(const ax_deploy_model* m, const ax_deploy_frame* frame, double (*v)[3])
{
    for (int k = 0; k < m->slide_count; ++k) {
        double* at = v[m->slide[k]];
        double out[3] = {ax_dot3(frame[k].allowed[0], at), ax_dot3(frame[k].allowed[1], at),
                         ax_dot3(frame[k].allowed[2], at)};
        memcpy(at, out, sizeof out);
    }
}

// Volume between a polygon, closed by a fan about its centroid c, and the origin: c . S / 6, S = sum x_k x x_{k+1}.
static void polygon_sums(const ax_deploy_model* m, const double (*x)[3], const int* loop, int count, double c[3],
                         double s[3])
{
    (void)m;
    memset(c, 0, 3 * sizeof *c);
    memset(s, 0, 3 * sizeof *s);
    for (int k = 0; k < count; ++k) {
        double part[3];
        ax_cross(x[loop[k]], x[loop[(k + 1) % count]], part);
        for (int d = 0; d < 3; ++d)
            c[d] += x[loop[k]][d] / count, s[d] += part[d];
    }
}

static void row_sum(const ax_fair_row* row, const double (*x)[3], double out[3])
{
    for (int c = 0; c < 3; ++c) {
        out[c] = 0;
        for (int i = 0; i < row->points; ++i)
            out[c] += row->coefficient[i] * x[row->hinge[i]][c];
    }
}

static double fair_energy(const ax_deploy_model* m, const double (*x)[3], double (*gradient)[3])
{
    double energy = 0, sum[3];
    for (int k = 0; k < m->fair_count; ++k) {
        const ax_fair_row* row = m->fair + k;
        row_sum(row, x, sum);
        energy += row->stiffness * ax_dot3(sum, sum) / 2;
        for (int i = 0; i < row->points && gradient; ++i)
            for (int c = 0; c < 3; ++c)
                gradient[row->hinge[i]][c] += row->stiffness * row->coefficient[i] * sum[c];
    }
    return energy;
}

static double load_energy(const ax_deploy_model* m, const double (*x)[3], double (*gradient)[3])
{
    double energy = 0;
    if (!m->inflated) {
        for (int h = 0; h < m->hinges; ++h) {
            energy -= ax_dot3(m->gravity[h], x[h]);
            if (gradient)
                for (int d = 0; d < 3; ++d)
                    gradient[h][d] = -m->gravity[h][d];
        }
        return energy;
    }
    if (gradient)
        memset(gradient, 0, (size_t)m->hinges * sizeof *gradient);
    for (int p = 0; p < m->polygon_count; ++p) {
        const int* loop = m->polygon + m->polygon_start[p];
        int count = m->polygon_start[p + 1] - m->polygon_start[p];
        double c[3], s[3];
        polygon_sums(m, x, loop, count, c, s);
        energy -= m->pressure * ax_dot3(c, s) / 6;
        if (!gradient)
            continue;
        for (int k = 0; k < count; ++k) {
            double across[3], turn[3];
            ax_sub3(x[loop[(k + 1) % count]], x[loop[(k + count - 1) % count]], across);
            ax_cross(across, c, turn);
            for (int d = 0; d < 3; ++d)
                gradient[loop[k]][d] -= m->pressure * (s[d] / count + turn[d]) / 6;
        }
    }
    return energy;
}

double ax_deploy_energy(const ax_deploy_model* m, const double (*x)[3], double (*gradient)[3])
{
    double load = load_energy(m, x, gradient);
    return load + fair_energy(m, x, gradient);
}

void ax_deploy_constraints(const ax_deploy_model* m, const double (*x)[3], double* c)
{
    for (int e = 0; e < m->edge_count; ++e) {
        double d[3], l = m->length[e];
        ax_sub3(x[m->edge[e][0]], x[m->edge[e][1]], d);
        c[e] = (ax_dot3(d, d) / l - l) / 2;
    }
}

double ax_deploy_edge_error(const ax_deploy_model* m, const double (*x)[3])
{
    double worst = 0;
    for (int e = 0; e < m->edge_count; ++e)
        worst = fmax(worst, fabs(ax_distance3(x[m->edge[e][0]], x[m->edge[e][1]]) / m->length[e] - 1));
    return worst;
}

void ax_deploy_add_edge_forces(const ax_deploy_model* m, const double (*x)[3], const double* force,
                               double (*gradient)[3])
{
    for (int e = 0; e < m->edge_count; ++e) {
        int i = m->edge[e][0], j = m->edge[e][1];
        double f = force[e] / m->length[e];
        for (int d = 0; d < 3; ++d) {
            double g = f * (x[i][d] - x[j][d]);
            gradient[i][d] += g, gradient[j][d] -= g;
        }
    }
}

static int pair_count(int corners)
{
    return corners * (corners - 1) / 2;
}

ax_deploy_hessian ax_deploy_hessian_make(const ax_deploy_model* m)
{
    ax_deploy_hessian h = {.edge_block = AX_NEW(int, m->edge_count), .slide = AX_NEW(int, m->unknowns)};
    memset(h.slide, -1, (size_t)m->unknowns * sizeof *h.slide);
    for (int k = 0; k < m->slide_count; ++k)
        h.slide[m->unknown[m->slide[k]]] = k;
    h.polygon_block_start = AX_NEW0(int, m->polygon_count + 1);
    int most = m->edge_count, count = 0;
    for (int p = 0; p < m->polygon_count; ++p) {
        int pairs = m->inflated ? pair_count(m->polygon_start[p + 1] - m->polygon_start[p]) : 0;
        h.polygon_block_start[p + 1] = h.polygon_block_start[p] + pairs;
    }
    int polygon_pairs = h.polygon_block_start[m->polygon_count];
    most += polygon_pairs + 6 * m->fair_count;
    h.polygon_block = AX_NEW(int, polygon_pairs);
    int(*pairs)[2] = ax_alloc((size_t)most, sizeof *pairs), *slot = AX_NEW(int, most);
    for (int e = 0; e < m->edge_count; ++e) {
        int i = m->unknown[m->edge[e][0]], j = m->unknown[m->edge[e][1]];
        h.edge_block[e] = -1;
        if (i >= 0 && j >= 0)
            pairs[count][0] = i, pairs[count][1] = j, slot[count++] = e;
    }
    int edges = count;
    for (int p = 0, at = 0; m->inflated && p < m->polygon_count; ++p) {
        const int* loop = m->polygon + m->polygon_start[p];
        int corners = m->polygon_start[p + 1] - m->polygon_start[p];
        for (int a = 0; a < corners; ++a)
            for (int b = a + 1; b < corners; ++b, ++at) {
                int i = m->unknown[loop[a]], j = m->unknown[loop[b]];
                h.polygon_block[at] = -1;
                if (i >= 0 && j >= 0)
                    pairs[count][0] = i, pairs[count][1] = j, slot[count++] = at;
            }
    }
    int polygons = count;
    h.fair_block = ax_alloc((size_t)m->fair_count, sizeof *h.fair_block);
    for (int k = 0; k < m->fair_count; ++k) {
        const ax_fair_row* row = m->fair + k;
        for (int b = 1, at = 0; b < row->points; ++b)
            for (int a = 0; a < b; ++a, ++at) {
                int i = m->unknown[row->hinge[a]], j = m->unknown[row->hinge[b]];
                h.fair_block[k][at] = -1;
                if (i >= 0 && j >= 0)
                    pairs[count][0] = i, pairs[count][1] = j, slot[count++] = 6 * k + at;
            }
    }
    h.blocks = ax_blocks_make(m->unknowns, 3, count, (const int(*)[2])pairs);
    for (int k = 0; k < count; ++k)
        (k < edges      ? h.edge_block
         : k < polygons ? h.polygon_block
                        : *h.fair_block)[slot[k]] = ax_blocks_find(&h.blocks, pairs[k][0], pairs[k][1]);
    ax_free(pairs);
    ax_free(slot);
    return h;
}

void ax_deploy_hessian_free(ax_deploy_hessian* h)
{
    ax_blocks_free(&h->blocks);
    ax_free(h->edge_block);
    ax_free(h->polygon_block);
    ax_free(h->polygon_block_start);
    ax_free(h->fair_block);
    ax_free(h->slide);
    *h = (ax_deploy_hessian){0};
}

// Adds a block of the rows of unknown i and the columns of unknown j <= i, k its index off the diagonal, where each node
// keeps to the directions that it is allowed.
static void add_block(ax_deploy_hessian* h, const ax_deploy_frame* frame, int k, int i, int j, double block[9])
{
    int side[2] = {frame ? h->slide[i] : -1, frame ? h->slide[j] : -1};
    if (side[0] >= 0 || side[1] >= 0) {
        double half[9], (*keep)[3] = (double(*)[3])half;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) {
                const double(*p)[3] = side[0] >= 0 ? frame[side[0]].allowed : NULL;
                keep[r][c] =
                    p ? p[r][0] * block[c] + p[r][1] * block[3 + c] + p[r][2] * block[6 + c] : block[3 * r + c];
            }
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) {
                const double(*p)[3] = side[1] >= 0 ? frame[side[1]].allowed : NULL;
                block[3 * r + c] = p ? ax_dot3(keep[r], p[c]) : keep[r][c];
            }
    }
    if (i == j)
        ax_blocks_add_diagonal(&h->blocks, i, block);
    else
        ax_blocks_add(&h->blocks, k, j, block);
}

// block += w [v]x
static void add_skew(double block[9], const double v[3], double w)
{
    block[1] -= w * v[2], block[2] += w * v[1];
    block[3] += w * v[2], block[5] -= w * v[0];
    block[6] -= w * v[1], block[7] += w * v[0];
}

static void transpose(double block[9])
{
    for (int r = 0; r < 3; ++r)
        for (int c = r + 1; c < 3; ++c) {
            double keep = block[3 * r + c];
            block[3 * r + c] = block[3 * c + r], block[3 * c + r] = keep;
        }
}

// Second derivatives of the volume: every pair of corners is coupled through the centroid of the fan. The diagonal vanishes.
static void add_volume(ax_deploy_hessian* h, const ax_deploy_model* m, const double (*x)[3],
                       const ax_deploy_frame* frame)
{
    for (int p = 0; p < m->polygon_count; ++p) {
        const int* loop = m->polygon + m->polygon_start[p];
        int count = m->polygon_start[p + 1] - m->polygon_start[p], at = h->polygon_block_start[p];
        double c[3], s[3], across[8][3];
        assert(count <= 8);
        polygon_sums(m, x, loop, count, c, s);
        for (int k = 0; k < count; ++k)
            ax_sub3(x[loop[(k + 1) % count]], x[loop[(k + count - 1) % count]], across[k]);
        double w = -m->pressure / 6;
        for (int a = 0; a < count; ++a)
            for (int b = a + 1; b < count; ++b, ++at) {
                if (h->polygon_block[at] < 0)
                    continue;
                double block[9] = {0}; // derivative of the gradient at a with respect to b
                add_skew(block, across[a], w / count);
                add_skew(block, across[b], -w / count);
                if (b == a + 1)
                    add_skew(block, c, -w);
                if ((b + 1) % count == a)
                    add_skew(block, c, w);
                int i = m->unknown[loop[a]], j = m->unknown[loop[b]];
                if (i < j)
                    transpose(block); // rows belong to the larger node
                add_block(h, frame, h->polygon_block[at], i > j ? i : j, i < j ? i : j, block);
            }
    }
}

static void add_fairness(ax_deploy_hessian* h, const ax_deploy_model* m, const ax_deploy_frame* frame)
{
    for (int k = 0; k < m->fair_count; ++k) {
        const ax_fair_row* row = m->fair + k;
        for (int b = 0, at = 0; b < row->points; ++b)
            for (int a = 0; a <= b; ++a) {
                int i = m->unknown[row->hinge[a]], j = m->unknown[row->hinge[b]],
                    block = a < b ? h->fair_block[k][at++] : -1;
                if (i < 0 || j < 0)
                    continue;
                double v = row->stiffness * row->coefficient[a] * row->coefficient[b];
                double part[9] = {v, 0, 0, 0, v, 0, 0, 0, v};
                add_block(h, frame, block, i > j ? i : j, i < j ? i : j, part);
            }
    }
}

void ax_deploy_hessian_fill(ax_deploy_hessian* h, const ax_deploy_model* m, const double (*x)[3],
                            const ax_deploy_frame* frame, const double* force, double shift, double mu)
{
    ax_blocks_clear(&h->blocks);
    const double identity[9] = {shift, 0, 0, 0, shift, 0, 0, 0, shift};
    for (int u = 0; u < m->unknowns; ++u)
        ax_blocks_add_diagonal(&h->blocks, u, identity);
    for (int k = 0; k < m->slide_count && frame; ++k) {
        double block[9];
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                block[3 * r + c] = mu * ((r == c) - frame[k].allowed[r][c]) + frame[k].bend * frame[k].allowed[r][c];
        ax_blocks_add_diagonal(&h->blocks, m->unknown[m->slide[k]], block);
    }
    for (int e = 0; e < m->edge_count; ++e) {
        int i = m->unknown[m->edge[e][0]], j = m->unknown[m->edge[e][1]];
        double d[3], l = m->length[e], block[9], again[9], minus[9];
        ax_sub3(x[m->edge[e][0]], x[m->edge[e][1]], d);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                block[3 * r + c] = mu * (d[r] / l) * (d[c] / l) + (r == c ? force[e] / l : 0);
        for (int k = 0; k < 9; ++k)
            minus[k] = -block[k], again[k] = block[k];
        if (i >= 0)
            add_block(h, frame, -1, i, i, block);
        if (j >= 0)
            add_block(h, frame, -1, j, j, again);
        if (h->edge_block[e] >= 0)
            add_block(h, frame, h->edge_block[e], i > j ? i : j, i < j ? i : j, minus);
    }
    if (m->inflated)
        add_volume(h, m, x, frame);
    add_fairness(h, m, frame);
}

// Rotation that takes the flat places of the supports nearest to where they are held (Horn 1987, by power iteration on the
// quaternion matrix; flat points have z = 0).
static void align(const ax_deploy_model* m, double rotation[3][3])
{
    double flat_mean[2] = {0, 0}, mean[3] = {0, 0, 0}, s[3][3] = {{0}};
    int held = 0;
    for (int h = 0; h < m->hinges; ++h)
        held += ax_deploy_placed(m, h);
    for (int h = 0; h < m->hinges; ++h)
        if (ax_deploy_placed(m, h)) {
            for (int c = 0; c < 2; ++c)
                flat_mean[c] += m->rest[h][c] / held;
            for (int c = 0; c < 3; ++c)
                mean[c] += m->support[h][c] / held;
        }
    for (int h = 0; h < m->hinges; ++h)
        if (ax_deploy_placed(m, h))
            for (int a = 0; a < 2; ++a)
                for (int b = 0; b < 3; ++b)
                    s[a][b] += (m->rest[h][a] - flat_mean[a]) * (m->support[h][b] - mean[b]);
    double n[4][4] = {{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
                      {0, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
                      {0, 0, -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1]},
                      {0, 0, 0, -s[0][0] - s[1][1] + s[2][2]}};
    double size = 0, q[4] = {1, 0.01, 0.02, 0.03};
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) {
            if (c < r)
                n[r][c] = n[c][r];
            size += fabs(n[r][c]);
        }
    for (int r = 0; r < 4; ++r)
        n[r][r] += size; // makes the largest eigenvalue the dominant one
    for (int round = 0; round < 3000 && size > 0; ++round) {
        double next[4] = {0}, norm = 0;
        for (int r = 0; r < 4; ++r) {
            for (int c = 0; c < 4; ++c)
                next[r] += n[r][c] * q[c];
            norm += next[r] * next[r];
        }
        for (int r = 0; r < 4; ++r)
            q[r] = next[r] / sqrt(norm);
    }
    if (size == 0)
        q[0] = 1, q[1] = q[2] = q[3] = 0;
    double w = q[0], x = q[1], y = q[2], z = q[3];
    double r[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                      {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                      {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    memcpy(rotation, r, sizeof r);
}

void ax_deploy_lay(const ax_deploy_model* m, double (*x)[3])
{
    double r[3][3];
    align(m, r);
    for (int h = 0; h < m->hinges; ++h)
        for (int c = 0; c < 3; ++c)
            x[h][c] = r[c][0] * m->rest[h][0] + r[c][1] * m->rest[h][1];
}

void ax_deploy_start(const ax_deploy_model* m, double noise, double (*x)[3])
{
    ax_deploy_lay(m, x);

    // harmonic extension of the displacement of the supports over the graph of edges
    ax_entries entries = {0};
    double* columns = AX_NEW0(double, 3 * (size_t)m->unknowns);
    double* move[3]; // one column per coordinate
    for (int c = 0; c < 3; ++c)
        move[c] = columns + (size_t)c * (size_t)m->unknowns;
    for (int u = 0; u < m->unknowns; ++u) {
        int h = m->hinge[u];
        double hold = ax_deploy_placed(m, h) ? 1e6 : 1e-9; // the least keeps parts without support solvable
        ax_entries_add(&entries, u, u, hold);
        for (int c = 0; c < 3 && hold > 1; ++c)
            move[c][u] = hold * (m->support[h][c] - x[h][c]);
    }
    for (int e = 0; e < m->edge_count; ++e) {
        int h[2] = {m->edge[e][0], m->edge[e][1]}, u[2] = {m->unknown[h[0]], m->unknown[h[1]]};
        for (int end = 0; end < 2; ++end) {
            if (u[end] < 0)
                continue;
            ax_entries_add(&entries, u[end], u[end], 1);
            if (u[1 - end] < 0)
                for (int c = 0; c < 3; ++c)
                    move[c][u[end]] += m->support[h[1 - end]][c] - x[h[1 - end]][c];
        }
        if (u[0] >= 0 && u[1] >= 0)
            ax_entries_add(&entries, u[0], u[1], -1);
    }
    ax_sparse laplacian = ax_entries_sparse(&entries, m->unknowns);
    ax_cholesky* factor = ax_cholesky_analyse(&laplacian);
    if (ax_cholesky_factor(factor, &laplacian))
        ax_cholesky_solve(factor, columns, columns, 3);
    ax_cholesky_free(factor);
    ax_sparse_free(&laplacian);

    ax_random random = {1};
    for (int h = 0; h < m->hinges; ++h) {
        for (int c = 0; c < 3; ++c)
            if (ax_deploy_placed(m, h))
                x[h][c] = m->support[h][c];
            else
                x[h][c] += move[c][m->unknown[h]] + ax_random_uniform(&random, -noise, noise);
        if (m->hold[h].kind == AX_HOLD_IN_PLANE)
            ax_deploy_return(m, h, x[h], x[h]);
    }
    ax_free(columns);
}
