#include "analysis/measure.h"

#include "base/vec.h"
#include "linkage/lattice.h"
#include "mesh/geometry.h"

#include <stdlib.h>
#include <string.h>

static void middle_of(int count, const double (*x)[3], double middle[2])
{
    middle[0] = middle[1] = 0;
    for (int h = 0; h < count; ++h)
        for (int c = 0; c < 2; ++c)
            middle[c] += x[h][c] / count;
}

double ax_measure_turn(int count, const double (*from)[3], const double (*to)[3])
{
    double middle[2], along = 0, across = 0;
    middle_of(count, from, middle);
    for (int h = 0; h < count; ++h) {
        double u[2] = {from[h][0] - middle[0], from[h][1] - middle[1]};
        double v[2] = {to[h][0] - middle[0], to[h][1] - middle[1]};
        along += u[0] * v[0] + u[1] * v[1], across += u[0] * v[1] - u[1] * v[0];
    }
    return atan2(across, along);
}

void ax_measure_turned(int count, const double (*from)[3], double angle, double (*to)[3])
{
    double middle[2], cosine = cos(angle), sine = sin(angle);
    middle_of(count, from, middle);
    for (int h = 0; h < count; ++h) {
        double u[2] = {from[h][0] - middle[0], from[h][1] - middle[1]};
        to[h][0] = middle[0] + cosine * u[0] - sine * u[1], to[h][1] = middle[1] + sine * u[0] + cosine * u[1];
        to[h][2] = from[h][2];
    }
}

double ax_measure_move(int count, const double (*from)[3], const double (*to)[3])
{
    double most = 0, (*turned)[3] = ax_alloc((size_t)count, sizeof *turned);
    ax_measure_turned(count, from, ax_measure_turn(count, from, to), turned);
    for (int h = 0; h < count; ++h)
        most = fmax(most, ax_distance3(turned[h], to[h]));
    ax_free(turned);
    return most;
}

double ax_measure_congruence(const ax_linkage* linkage, const double (*flat)[2], const double (*other)[3])
{
    double worst = 0;
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            int i = linkage->triangles[t][(k + 1) % 3], j = linkage->triangles[t][(k + 2) % 3];
            worst = fmax(worst, fabs(ax_distance2(flat[i], flat[j]) / ax_distance3(other[i], other[j]) - 1));
        }
    return worst;
}

static bool is_border(const ax_linkage* linkage, int t)
{
    const int* corner = linkage->triangles[t];
    return linkage->on_rim[corner[0]] || linkage->on_rim[corner[1]] || linkage->on_rim[corner[2]];
}

ax_edge_measure ax_measure_edges(const ax_linkage* linkage, const double (*flat)[2])
{
    ax_edge_measure m = {.min = INFINITY};
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double edge[3], mean = 0, unequal = 0;
        for (int k = 0; k < 3; ++k) {
            edge[k] = ax_distance2(flat[linkage->triangles[t][(k + 1) % 3]], flat[linkage->triangles[t][(k + 2) % 3]]);
            mean += edge[k] / 3;
        }
        for (int k = 0; k < 3; ++k) {
            unequal = fmax(unequal, fabs(edge[k] / mean - 1));
            m.min = fmin(m.min, edge[k]), m.max = fmax(m.max, edge[k]);
        }
        double* worst = is_border(linkage, t) ? &m.equilateral_border : &m.equilateral_inner;
        *worst = fmax(*worst, unequal);
        m.mean += mean / linkage->triangle_count;
    }
    return m;
}

static int ascending(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return (x > y) - (x < y);
}

// Value below which `share` of the values lie; sorts them.
static double quantile(double* values, int count, double share)
{
    if (count == 0)
        return NAN;
    qsort(values, (size_t)count, sizeof *values, ascending);
    return values[(int)fmin(count - 1, floor(share * count))];
}

double* ax_measure_mouth_angles(const ax_linkage* linkage, const double (*flat)[2])
{
    int count;
    int(*mouth)[3] = ax_linkage_mouths(linkage, &count);
    double* smallest = AX_NEW(double, linkage->hinge_count);
    for (int h = 0; h < linkage->hinge_count; ++h)
        smallest[h] = INFINITY;
    for (int m = 0; m < count; ++m) {
        double angle = ax_mouth_angle(flat[mouth[m][0]], flat[mouth[m][1]], flat[mouth[m][2]]);
        smallest[mouth[m][1]] = fmin(smallest[mouth[m][1]], angle);
    }
    ax_free(mouth);
    return smallest;
}

ax_mouth_measure ax_measure_mouths(const ax_linkage* linkage, const double (*flat)[2])
{
    double* smallest = ax_measure_mouth_angles(linkage, flat);
    ax_mouth_measure m = {.min_deg = INFINITY, .min_hinge = -1};
    int used = 0;
    for (int h = 0; h < linkage->hinge_count; ++h) {
        double degrees = smallest[h] * 180 / AX_PI;
        if (degrees < m.min_deg)
            m.min_deg = degrees, m.min_hinge = h;
        if (isfinite(degrees))
            smallest[used++] = degrees;
    }
    m.median_deg = quantile(smallest, used, 0.5);
    ax_free(smallest);
    return m;
}

// Depth by which two triangles overlap: the least overlap of their shadows over the six edge normals; negative: apart.
static double overlap_depth(const double a[3][2], const double b[3][2])
{
    double depth = INFINITY;
    for (int side = 0; side < 6; ++side) {
        const double(*of)[2] = side < 3 ? a : b;
        int k = side % 3, next = (k + 1) % 3;
        double n[2] = {of[k][1] - of[next][1], of[next][0] - of[k][0]}, length = hypot(n[0], n[1]);
        double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
        for (int c = 0; c < 3; ++c) {
            double s[2] = {(a[c][0] * n[0] + a[c][1] * n[1]) / length, (b[c][0] * n[0] + b[c][1] * n[1]) / length};
            for (int w = 0; w < 2; ++w)
                lo[w] = fmin(lo[w], s[w]), hi[w] = fmax(hi[w], s[w]);
        }
        depth = fmin(depth, fmin(hi[0] - lo[1], hi[1] - lo[0]));
    }
    return depth;
}

int ax_measure_overlaps(const ax_linkage* linkage, const double (*flat)[2], double depth, int most, int (*pairs)[2])
{
    int count = linkage->triangle_count, found = 0;
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, cell = 0;
    for (int t = 0; t < count; ++t)
        for (int k = 0; k < 3; ++k) {
            const double *a = flat[linkage->triangles[t][k]], *b = flat[linkage->triangles[t][(k + 1) % 3]];
            cell = fmax(cell, ax_distance2(a, b));
            for (int d = 0; d < 2; ++d)
                lo[d] = fmin(lo[d], a[d]), hi[d] = fmax(hi[d], a[d]);
        }
    // cells as wide as the longest edge: overlapping triangles have centroids in the same or in touching cells, since a
    // centroid is at most two thirds of a median from any point of its triangle
    cell *= 1.2;
    // no more cells than a few per triangle: one huge triangle only makes them coarser
    cell = fmax(cell, sqrt((hi[0] - lo[0]) * (hi[1] - lo[1]) / (4.0 * count)));
    if (!(cell > 0)) // all of it at one point
        cell = 1;
    int columns = (int)((hi[0] - lo[0]) / cell) + 1, rows = (int)((hi[1] - lo[1]) / cell) + 1;
    int *start = AX_NEW0(int, columns*rows + 1), *place = AX_NEW(int, count), *sorted = AX_NEW(int, count);
    for (int t = 0; t < count; ++t) {
        double c[2] = {0, 0};
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 2; ++d)
                c[d] += flat[linkage->triangles[t][k]][d] / 3;
        place[t] = (int)((c[1] - lo[1]) / cell) * columns + (int)((c[0] - lo[0]) / cell);
        ++start[place[t] + 1];
    }
    for (int k = 0; k < columns * rows; ++k)
        start[k + 1] += start[k];
    int* fill = ax_copy(start, (size_t)(columns * rows), sizeof *fill);
    for (int t = 0; t < count; ++t)
        sorted[fill[place[t]]++] = t;
    for (int t = 0; t < count; ++t) {
        double a[3][2], b[3][2];
        for (int k = 0; k < 3; ++k)
            memcpy(a[k], flat[linkage->triangles[t][k]], sizeof a[k]);
        int row = place[t] / columns, column = place[t] % columns;
        for (int r = row > 0 ? row - 1 : 0; r <= row + 1 && r < rows; ++r)
            for (int c = column > 0 ? column - 1 : 0; c <= column + 1 && c < columns; ++c)
                for (int k = start[r * columns + c]; k < start[r * columns + c + 1]; ++k) {
                    int other = sorted[k];
                    if (other <= t)
                        continue;
                    for (int corner = 0; corner < 3; ++corner)
                        memcpy(b[corner], flat[linkage->triangles[other][corner]], sizeof b[corner]);
                    if (overlap_depth((const double(*)[2])a, (const double(*)[2])b) > depth && found++ < most)
                        pairs[found - 1][0] = t, pairs[found - 1][1] = other;
                }
    }
    ax_free(start);
    ax_free(fill);
    ax_free(place);
    ax_free(sorted);
    return found;
}

int ax_measure_flipped(const ax_linkage* linkage, const double (*flat)[2], int* first)
{
    int flipped = 0;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        if (ax_orient2(flat[corner[0]], flat[corner[1]], flat[corner[2]]) > 0)
            continue;
        if (flipped++ == 0 && first)
            *first = t;
    }
    return flipped;
}

// Scale factor that the mouths of a triangle show: beta = 120 degrees - 2 theta, lambda = 1 / cos theta.
static double scale_of_mouths(const int corner[3], const double* mouth)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 3; ++k)
        if (isfinite(mouth[corner[k]]))
            sum += mouth[corner[k]], ++count;
    return count ? 1 / cos(ax_clamp((2 * AX_PI / 3 - sum / count) / 2, 0, AX_PI / 3)) : NAN;
}

void ax_measure_scale(const ax_linkage* linkage, const double (*flat)[2], double* scale)
{
    int count = linkage->triangle_count;
    int(*owners)[2] = ax_linkage_hinge_triangles(linkage);
    double(*centre)[2] = ax_calloc((size_t)count, sizeof *centre), *mouth = ax_measure_mouth_angles(linkage, flat);
    for (int t = 0; t < count; ++t)
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 2; ++d)
                centre[t][d] += flat[linkage->triangles[t][k]][d] / 3;
    for (int t = 0; t < count; ++t) {
        const int* corner = linkage->triangles[t];
        if (is_border(linkage, t)) {
            scale[t] = scale_of_mouths(corner, mouth);
            continue;
        }
        int near[3];
        double edge = 0;
        for (int k = 0; k < 3; ++k) {
            const int* owner = owners[corner[k]];
            near[k] = owner[0] == t ? owner[1] : owner[0];
            edge += ax_distance2(flat[corner[k]], flat[corner[(k + 1) % 3]]) / 3;
        }
        scale[t] = 2 * edge / sqrt(2 * fabs(ax_orient2(centre[near[0]], centre[near[1]], centre[near[2]])) / sqrt(3));
    }
    ax_free(owners);
    ax_free(centre);
    ax_free(mouth);
}

void ax_measure_hole_angles(const ax_linkage* linkage, const double (*places)[3], double out[3])
{
    int most = linkage->hole_start[linkage->hole_count], used = 0;
    double* angle = AX_NEW(double, most);
    for (int h = 0; h < linkage->hole_count; ++h) {
        const int* loop = linkage->hole_hinges + linkage->hole_start[h];
        int n = linkage->hole_start[h + 1] - linkage->hole_start[h];
        for (int k = 0; n == 6 && k < n; ++k) {
            double a[3], b[3], turn[3];
            ax_sub3(places[loop[(k + n - 1) % n]], places[loop[k]], a);
            ax_sub3(places[loop[(k + 1) % n]], places[loop[k]], b);
            ax_cross(a, b, turn);
            angle[used++] = atan2(ax_norm3(turn), ax_dot3(a, b)) * 180 / AX_PI;
        }
    }
    const double share[3] = {0.05, 0.5, 0.95};
    for (int k = 0; k < 3; ++k)
        out[k] = quantile(angle, used, share[k]);
    ax_free(angle);
}

// Force of the edges of one panel on its corner k: tension pulls the hinge into the panel.
void ax_measure_corner_force(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                             int t, int k, double out[3])
{
    const int* corner = linkage->triangles[t];
    memset(out, 0, 3 * sizeof *out);
    for (int o = 1; o <= 2; ++o) { // the edge to corner k + o lies opposite the remaining corner
        double d[3], f = edge_forces[t][(k + 3 - o) % 3];
        ax_sub3(places[corner[(k + o) % 3]], places[corner[k]], d);
        double length = ax_norm3(d);
        for (int c = 0; c < 3; ++c)
            out[c] += f * d[c] / length;
    }
}

double (*ax_measure_unbalanced(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                               const double (*loads)[3]))[3]
{
    double(*sum)[3] = ax_copy(loads, (size_t)linkage->hinge_count, sizeof *sum);
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            double f[3];
            ax_measure_corner_force(linkage, places, edge_forces, t, k, f);
            for (int c = 0; c < 3; ++c)
                sum[linkage->triangles[t][k]][c] += f[c];
        }
    return sum;
}

double ax_measure_force_residual(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                                 const double (*loads)[3], const unsigned char* supports, const ax_slide* slides)
{
    double(*sum)[3] = ax_measure_unbalanced(linkage, places, edge_forces, loads), total = 0, left = 0;
    for (int h = 0; h < linkage->hinge_count; ++h) {
        total += ax_norm3(loads[h]);
        if (!supports[h])
            left += ax_dot3(sum[h], sum[h]);
        else if (slides && slides[h].freedom != AX_HELD_FAST) {
            const double* axis = slides[h].axis;
            double along = ax_dot3(axis, sum[h]);
            for (int c = 0; c < 3; ++c) {
                double part = along * axis[c];
                part = slides[h].freedom == AX_FREE_ALONG ? part : sum[h][c] - part;
                left += part * part;
            }
        }
    }
    ax_free(sum);
    return sqrt(left) / total;
}

void ax_measure_hinge_forces(const ax_linkage* linkage, const double (*places)[3], const double (*edge_forces)[3],
                             const double (*loads)[3], const unsigned char* supports, double* hinge_max,
                             double* reactions)
{
    *hinge_max = *reactions = 0;
    for (int t = 0; t < linkage->triangle_count; ++t)
        for (int k = 0; k < 3; ++k) {
            double f[3];
            ax_measure_corner_force(linkage, places, edge_forces, t, k, f);
            *hinge_max = fmax(*hinge_max, ax_norm3(f));
        }
    double(*sum)[3] = ax_measure_unbalanced(linkage, places, edge_forces, loads);
    for (int h = 0; h < linkage->hinge_count; ++h)
        if (supports[h])
            *reactions += ax_norm3(sum[h]);
    ax_free(sum);
}

double ax_measure_cover(const ax_mesh* target, const ax_linkage* linkage, const double (*places)[3], double share)
{
    ax_mesh panels = {.vertex_count = linkage->hinge_count,
                      .face_count = linkage->triangle_count,
                      .positions = (double(*)[3])places,
                      .faces = linkage->triangles};
    ax_closest* tree = ax_closest_make(&panels);
    double* distance = AX_NEW(double, target->vertex_count);
    for (int v = 0, hint = -1; v < target->vertex_count; ++v) {
        ax_closest_point at = ax_closest_find(tree, target->positions[v], hint);
        distance[v] = at.distance;
        hint = at.face;
    }
    double within = quantile(distance, target->vertex_count, share);
    ax_free(distance);
    ax_closest_free(tree);
    return within;
}
