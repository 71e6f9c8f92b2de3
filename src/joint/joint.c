// Unknowns per hinge: flat p (2) and deployed q (3), lengths in units of the mean edge L. Minimise the soft rows
//   equilateral  w_t (l_k^2 - l_{k+1}^2) / (2 l^2)      three per triangle, l on q
//   surface      n . (q - c)                            c closest point, n its normal
//   curve        (I - t t')(q - c)                      t tangent of the curve at c
//   fixed        q - c
//   plane        n . (q - c)                            given, or the best fit of its hinges, held during the step
//   fairness     (q - q0)_i - (q - q0)_j                every edge
//   stay         p - p0, q - q0
//   mouth        min(beta - beta_aim, 0)                one-sided, chosen again at each step
//   apart        max(depth + margin, 0)                 pairs of panels named by the caller, depth by separating axes
// subject to  c_e = (|p_i - p_j|^2 - |q_i - q_j|^2) / 2 = 0  for every edge.
//
// Each step solves the linearised KKT system by the condensed matrix S'S + mu C'C and Uzawa refinement of the multipliers:
// one sparse Cholesky of 5 unknowns a hinge, where an LDL' of the full system would have 7 and need pivoting.
//
// The anchor (p0, q0) of fairness and stay is the start for four steps, which finds the shape, and from then on the last
// iterate. Held for ever it leaves multipliers as large as the soft weights, and the curvature of the constraints that
// Gauss-Newton neglects makes convergence linear (factor 0.7, 60 steps); with multipliers near zero it is quadratic, seven
// steps in all, and the rows that are not anchored end at rounding. Second differences along kagome lines as fairness gave the
// same shapes at five times the cost of the factor. A sticky active set for the mouths, and steps without a merit test,
// end at congruence 0.05 to 0.3 at the ends of the scale band.
#include "joint/joint.h"

#include "base/vec.h"
#include "constraint/eigen3.h"
#include "linalg/block_factor.h"
#include "linkage/lattice.h"

#include <assert.h>
#include <string.h>

enum { UNKNOWNS = 5, STEPS = 40, ANCHORED_STEPS = 4 };
static const double weight_inner = 10, weight_border = 3, weight_released = 0.02, weight_surface = 3, weight_curve = 10,
                    weight_fixed = 1000, weight_plane = 10, weight_fair = 0.05, weight_stay = 0.003, weight_mouth = 10,
                    mouth_margin = 1.05, mouth_share = 0.7, mouth_comfort = 15 * AX_PI / 180, apart_margin = 0.02;
static const double on_place =
    1e-7; // edges: a short step leaves hinges further off where their place has just changed facets

typedef double state[UNKNOWNS]; // p0, p1, q0, q1, q2 of one hinge

// Nearest point of a hinge's place, with the normal of a surface or the tangent of a curve there.
typedef struct contact {
    double point[3], direction[3];
    int face; // of a surface, where the next search starts
} contact;

typedef struct flat_plane {
    double point[3], normal[3];
} flat_plane;

typedef struct solver {
    const ax_joint_problem* problem;
    const ax_linkage* linkage;
    int hinges, triangles, edges, mouths;
    double unit;      // mean edge, document units
    double origin[3]; // subtracted from deployed places, so that far-away models lose no digits
    double flat_origin[2];
    state *x, *anchor, *trial, *step, *right;
    double *congruence, *multiplier; // per edge 3 t + k
    bool settled;                    // the shape is found
    double fine;                     // a step this short is the last
    double mouth_aim;                // radians: below it a mouth is pushed open
    unsigned char* bordering;        // per triangle: at the rim, and not as equilateral as the others must be
    int (*mouth)[3];                 // previous, hinge, next
    unsigned char* active;           // per mouth
    contact* contact;                // per hinge
    flat_plane* plane;               // per plane of the problem
    unsigned char* in_pattern;       // per mouth: its outer pair is in the matrix
    ax_blocks matrix;
    int (*block)[3]; // per triangle: block opposite each corner
    ax_pool* pool;
    ax_block_factor* factor;
    int factorisations;
} solver;

static void edge_ends(const solver* s, int e, int* i, int* j)
{
    const int* corner = s->linkage->triangles[e / 3];
    *i = corner[(e + 1) % 3], *j = corner[(e + 2) % 3];
}

static void build_pattern(solver* s)
{
    int most = s->edges + s->mouths + 9 * s->problem->apart_count, count = 0;
    int(*pairs)[2] = ax_alloc((size_t)most, sizeof *pairs);
    for (int e = 0; e < s->edges; ++e, ++count)
        edge_ends(s, e, &pairs[count][0], &pairs[count][1]);
    for (int m = 0; m < s->mouths; ++m)
        if (s->in_pattern[m])
            pairs[count][0] = s->mouth[m][0], pairs[count][1] = s->mouth[m][2], ++count;
    for (int pair = 0; pair < s->problem->apart_count; ++pair)
        for (int k = 0; k < 9; ++k, ++count) {
            pairs[count][0] = s->linkage->triangles[s->problem->apart[pair][0]][k / 3];
            pairs[count][1] = s->linkage->triangles[s->problem->apart[pair][1]][k % 3];
        }
    if (s->factor) {
        ax_blocks_free(&s->matrix);
        ax_block_factor_free(s->factor);
    }
    s->matrix = ax_blocks_make(s->hinges, UNKNOWNS, count, (const int(*)[2])pairs);
    ax_free(pairs);
    for (int e = 0; e < s->edges; ++e) {
        int i, j;
        edge_ends(s, e, &i, &j);
        s->block[e / 3][e % 3] = ax_blocks_find(&s->matrix, i, j);
    }
    double(*place)[3] = ax_calloc((size_t)s->hinges, sizeof *place);
    for (int h = 0; h < s->hinges; ++h)
        memcpy(place[h], s->x[h], 2 * sizeof **place);
    s->factor = ax_block_factor_make(&s->matrix, (const double(*)[3])place, s->pool);
    ax_free(place);
}

static double constraint(const solver* s, const state* x, int e)
{
    int i, j;
    edge_ends(s, e, &i, &j);
    double d[UNKNOWNS];
    for (int k = 0; k < UNKNOWNS; ++k)
        d[k] = x[i][k] - x[j][k];
    return (d[0] * d[0] + d[1] * d[1] - d[2] * d[2] - d[3] * d[3] - d[4] * d[4]) / 2;
}

// With the panel that has it.
static double worst_congruence(const solver* s, const state* x, int* panel)
{
    double worst = 0;
    *panel = 0;
    for (int e = 0; e < s->edges; ++e) {
        int i, j;
        edge_ends(s, e, &i, &j);
        double p = hypot(x[i][0] - x[j][0], x[i][1] - x[j][1]);
        double q = ax_distance3(x[i] + 2, x[j] + 2), off = fabs(p / q - 1);
        if (off > worst)
            worst = off, *panel = e / 3;
    }
    return worst;
}

static double mouth_angle(const solver* s, const state* x, int m)
{
    return ax_mouth_angle(x[s->mouth[m][0]], x[s->mouth[m][1]], x[s->mouth[m][2]]);
}

// Depth by which a pair of panels overlaps along its best separating edge (negative: the gap there), and the hinges that
// decide it: the edge from end[0] to end[1] of one panel, and the deepest corner end[2] of the other. A hinge that both share
// does not count: mouths keep such panels apart.
static double apart_depth(const solver* s, const state* x, int pair, int end[3])
{
    double least = INFINITY;
    for (int side = 0; side < 6; ++side) {
        const int* of = s->linkage->triangles[s->problem->apart[pair][side / 3]];
        const int* other = s->linkage->triangles[s->problem->apart[pair][1 - side / 3]];
        int a = of[side % 3], b = of[(side + 1) % 3], deepest = -1;
        double depth = -INFINITY, length = ax_distance2(x[a], x[b]);
        for (int k = 0; k < 3; ++k) {
            bool shared = other[k] == of[0] || other[k] == of[1] || other[k] == of[2];
            double d = ax_orient2(x[a], x[b], x[other[k]]) / length;
            if (!shared && d > depth)
                depth = d, deepest = other[k];
        }
        if (depth < least)
            least = depth, end[0] = a, end[1] = b, end[2] = deepest;
    }
    return least;
}

// How unequal edges a and b of a triangle are: (l_a^2 - l_b^2) / (2 mean l^2), with its derivative by l_k^2.
static double unequal(const double l2[3], int a, int b, double slope[3])
{
    double mean = (l2[0] + l2[1] + l2[2]) / 3, e = (l2[a] - l2[b]) / (2 * mean);
    for (int k = 0; k < 3; ++k)
        slope[k] = ((k == a) - (k == b)) / (2 * mean) - e / (3 * mean);
    return e;
}

// Equilateral rows of a triangle: residuals r[3] and gradients with respect to the q of its corners.
static void equilateral_rows(const solver* s, const state* x, int t, double r[3], double gradient[3][3][3])
{
    const int* corner = s->linkage->triangles[t];
    double d[3][3], l2[3], slope[3], most = s->bordering[t] ? s->problem->border_unequal : 0;
    for (int k = 0; k < 3; ++k) {
        ax_sub3(x[corner[(k + 1) % 3]] + 2, x[corner[(k + 2) % 3]] + 2, d[k]);
        l2[k] = ax_dot3(d[k], d[k]);
    }
    for (int row = 0; row < 3; ++row) {
        double e = unequal(l2, row, (row + 1) % 3, slope), excess = copysign(fmax(fabs(e) - most, 0), e);
        double w = !s->bordering[t] ? weight_inner : most == 0 || excess != 0 ? weight_border : weight_released;
        // once the shape is found, released triangles keep the one they have
        r[row] = w * (excess != 0 || s->settled ? excess : e);
        if (!gradient)
            continue;
        memset(gradient[row], 0, sizeof gradient[row]);
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c) {
                gradient[row][(k + 1) % 3][c] += w * 2 * slope[k] * d[k][c];
                gradient[row][(k + 2) % 3][c] -= w * 2 * slope[k] * d[k][c];
            }
    }
}

static double worst_unequal(const solver* s, const state* x)
{
    double worst = 0;
    for (int t = 0; t < s->triangles; ++t) {
        const int* corner = s->linkage->triangles[t];
        double l2[3], slope[3], most = s->bordering[t] ? s->problem->border_unequal : 0;
        for (int k = 0; k < 3; ++k) {
            double d[3];
            ax_sub3(x[corner[(k + 1) % 3]] + 2, x[corner[(k + 2) % 3]] + 2, d);
            l2[k] = ax_dot3(d, d);
        }
        for (int k = 0; k < 3; ++k)
            worst = fmax(worst, fabs(unequal(l2, k, (k + 1) % 3, slope)) - most);
    }
    return worst;
}

static ax_joint_place_kind place_kind(const solver* s, int hinge)
{
    return s->problem->places ? s->problem->places[hinge].kind : AX_JOINT_FREE;
}

static void unit_vector(double v[3])
{
    double length = ax_norm3(v);
    for (int c = 0; c < 3 && length > 0; ++c)
        v[c] /= length;
}

// The plane that fits its hinges best, by principal axes. Fixed hinges, which cannot come to the plane, draw it to them.
static void fit_plane(const solver* s, const ax_joint_plane* of, flat_plane* plane)
{
    static const double draw = 1e3;
    double total = 0, mean[3] = {0, 0, 0};
    for (int k = 0; k < of->count; ++k) {
        double w = place_kind(s, of->hinges[k]) == AX_JOINT_FIXED ? draw * draw : 1;
        total += w;
        for (int c = 0; c < 3; ++c)
            mean[c] += w * s->x[of->hinges[k]][2 + c];
    }
    ax_lane3 *arm = ax_calloc((size_t)of->count, sizeof *arm), axis[3]; // one lane of eight is used
    for (int c = 0; c < 3; ++c)
        plane->point[c] = mean[c] / total;
    for (int k = 0; k < of->count; ++k)
        for (int c = 0; c < 3; ++c)
            arm[k][c][0] = (place_kind(s, of->hinges[k]) == AX_JOINT_FIXED ? draw : 1) *
                           (s->x[of->hinges[k]][2 + c] - plane->point[c]);
    ax_principal_axes(of->count, (const ax_lane3*)arm, axis);
    for (int c = 0; c < 3; ++c)
        plane->normal[c] = axis[2][c][0];
    ax_free(arm);
}

// Nearest points of all deployed hinges on their places, and the planes. Returns the largest distance.
static double find_places(solver* s)
{
    double worst = 0;
    for (int h = 0; h < s->hinges; ++h) {
        const ax_joint_place* to = s->problem->places ? &s->problem->places[h] : NULL;
        if (!to || to->kind == AX_JOINT_FREE)
            continue;
        contact* found = &s->contact[h];
        double place[3], second[3];
        for (int c = 0; c < 3; ++c)
            place[c] = s->x[h][2 + c] * s->unit + s->origin[c];
        if (to->kind == AX_JOINT_ON_SURFACE) {
            ax_closest_point at = ax_closest_find(to->surface, place, found->face);
            found->face = at.face;
            memcpy(found->point, at.point, sizeof at.point);
            memcpy(found->direction, at.normal, sizeof at.normal);
        } else if (to->kind == AX_JOINT_ON_POLYLINE) {
            ax_polyline_point at = ax_polyline_find(to->polyline, place);
            memcpy(found->point, at.point, sizeof at.point);
            memcpy(found->direction, at.tangent, sizeof at.tangent);
        } else if (to->kind == AX_JOINT_ON_CURVE) {
            double t = ax_curve_nearest(to->curve, place, found->point);
            ax_curve_derivatives(to->curve, t, found->direction, second);
            unit_vector(found->direction);
            if (s->settled && ax_curve_stops(to->curve, t)) // steps along one side of a corner would leave it for ever
                memset(found->direction, 0, sizeof found->direction);
        }
        if (to->kind != AX_JOINT_FIXED) // those stand where they are held
            for (int c = 0; c < 3; ++c)
                found->point[c] = (found->point[c] - s->origin[c]) / s->unit;
        worst = fmax(worst, ax_distance3(s->x[h] + 2, found->point));
    }
    for (int p = 0; p < s->problem->plane_count; ++p) {
        const ax_joint_plane* of = &s->problem->planes[p];
        flat_plane* plane = &s->plane[p];
        if (of->given)
            for (int c = 0; c < 3; ++c)
                plane->point[c] = (of->point[c] - s->origin[c]) / s->unit, plane->normal[c] = of->normal[c];
        else
            fit_plane(s, of, plane);
        unit_vector(plane->normal);
        for (int k = 0; k < of->count; ++k) {
            double d[3];
            ax_sub3(s->x[of->hinges[k]] + 2, plane->point, d);
            worst = fmax(worst, fabs(ax_dot3(plane->normal, d)));
        }
    }
    return worst;
}

// Weighs the distance d of a hinge from its place: out = W d, W symmetric; `matrix` receives W.
static void weigh_place(const solver* s, int h, const double d[3], double out[3], double matrix[3][3])
{
    ax_joint_place_kind kind = place_kind(s, h);
    const double* n = s->contact[h].direction;
    for (int r = 0; r < 3; ++r) {
        out[r] = 0;
        for (int c = 0; c < 3; ++c) {
            switch (kind) {
            case AX_JOINT_ON_SURFACE:
                matrix[r][c] = weight_surface * weight_surface * n[r] * n[c];
                break;
            case AX_JOINT_ON_POLYLINE:
            case AX_JOINT_ON_CURVE:
                matrix[r][c] = weight_curve * weight_curve * ((r == c) - n[r] * n[c]);
                break;
            case AX_JOINT_FIXED:
                matrix[r][c] = weight_fixed * weight_fixed * (r == c);
                break;
            default:
                matrix[r][c] = 0;
            }
            out[r] += matrix[r][c] * d[c];
        }
    }
}

// Half the sum of squares of all soft rows, contacts held.
static double objective(const solver* s, const state* x)
{
    double sum = 0;
    for (int t = 0; t < s->triangles; ++t) {
        double r[3];
        equilateral_rows(s, x, t, r, NULL);
        sum += r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    }
    double stay = 0, placed = 0;
    for (int h = 0; h < s->hinges; ++h) {
        double d[3], weighed[3], matrix[3][3];
        ax_sub3(x[h] + 2, s->contact[h].point, d);
        weigh_place(s, h, d, weighed, matrix);
        placed += ax_dot3(d, weighed);
        for (int k = 0; k < UNKNOWNS; ++k)
            stay += (x[h][k] - s->anchor[h][k]) * (x[h][k] - s->anchor[h][k]);
    }
    for (int p = 0; p < s->problem->plane_count; ++p)
        for (int k = 0; k < s->problem->planes[p].count; ++k) {
            double d[3], out;
            ax_sub3(x[s->problem->planes[p].hinges[k]] + 2, s->plane[p].point, d);
            out = ax_dot3(s->plane[p].normal, d);
            placed += weight_plane * weight_plane * out * out;
        }
    double fair = 0;
    for (int e = 0; e < s->edges; ++e) {
        int i, j;
        edge_ends(s, e, &i, &j);
        for (int c = 2; c < UNKNOWNS; ++c) {
            double d = (x[i][c] - s->anchor[i][c]) - (x[j][c] - s->anchor[j][c]);
            fair += d * d;
        }
    }
    double mouths = 0; // and panels held apart
    for (int m = 0; m < s->mouths; ++m) {
        double short_of = fmin(mouth_angle(s, x, m) - s->mouth_aim, 0);
        mouths += short_of * short_of;
    }
    for (int pair = 0; pair < s->problem->apart_count; ++pair) {
        int end[3];
        double into = fmax(apart_depth(s, x, pair, end) + apart_margin, 0);
        mouths += into * into;
    }
    return (sum + placed + weight_stay * weight_stay * stay + weight_fair * weight_fair * fair +
            weight_mouth * weight_mouth * mouths) /
           2;
}

static double merit(const solver* s, const state* x, double nu)
{
    double violation = 0;
    for (int e = 0; e < s->edges; ++e)
        violation += fabs(constraint(s, x, e));
    return objective(s, x) + nu * violation;
}

// Adds w * left right' to the block of two nodes, whichever is the larger.
static void add_product(solver* s, int k, int i, int j, const double* left, const double* right, double w)
{
    double block[UNKNOWNS * UNKNOWNS];
    const double *row = i > j ? left : right, *column = i > j ? right : left;
    for (int r = 0; r < UNKNOWNS; ++r)
        for (int c = 0; c < UNKNOWNS; ++c)
            block[r * UNKNOWNS + c] = w * row[r] * column[c];
    ax_blocks_add(&s->matrix, k, i < j ? i : j, block);
}

static void add_square(solver* s, int i, const double* gradient, double w)
{
    double block[UNKNOWNS * UNKNOWNS];
    for (int r = 0; r < UNKNOWNS; ++r)
        for (int c = 0; c < UNKNOWNS; ++c)
            block[r * UNKNOWNS + c] = w * gradient[r] * gradient[c];
    ax_blocks_add_diagonal(&s->matrix, i, block);
}

static void add_scaled(double* to, const double* from, double factor)
{
    for (int k = 0; k < UNKNOWNS; ++k)
        to[k] += factor * from[k];
}

// Gradient of constraint e with respect to its first end; the second end has the opposite.
static void constraint_gradient(const state* x, int i, int j, double g[UNKNOWNS])
{
    for (int k = 0; k < UNKNOWNS; ++k)
        g[k] = (k < 2 ? 1 : -1) * (x[i][k] - x[j][k]);
}

// Adds one row of weight weight_mouth on three hinges: its residual r and gradients.
static void add_row(solver* s, const int hinge[3], double gradient[3][UNKNOWNS], double r)
{
    double w = weight_mouth * weight_mouth;
    for (int k = 0; k < 3; ++k) {
        int o = (k + 1) % 3;
        add_square(s, hinge[k], gradient[k], w);
        add_scaled(s->right[hinge[k]], gradient[k], w * r);
        add_product(s, ax_blocks_find(&s->matrix, hinge[k], hinge[o]), hinge[k], hinge[o], gradient[k], gradient[o], w);
    }
}

// The condensed matrix and the gradient of the soft rows (into `right`).
static void assemble(solver* s, double mu)
{
    const state* x = (const state*)s->x;
    ax_blocks_clear(&s->matrix);
    memset(s->right, 0, (size_t)s->hinges * sizeof *s->right);
    for (int e = 0; e < s->edges; ++e) {
        int i, j;
        double g[UNKNOWNS];
        edge_ends(s, e, &i, &j);
        constraint_gradient(x, i, j, g);
        double block[UNKNOWNS * UNKNOWNS], w = weight_fair * weight_fair;
        for (int r = 0; r < UNKNOWNS; ++r)
            for (int c = 0; c < UNKNOWNS; ++c)
                block[r * UNKNOWNS + c] = mu * g[r] * g[c] + (r == c && r >= 2 ? w : 0);
        ax_blocks_add_diagonal(&s->matrix, i, block);
        ax_blocks_add_diagonal(&s->matrix, j, block);
        for (int k = 0; k < UNKNOWNS * UNKNOWNS; ++k)
            block[k] = -block[k];
        ax_blocks_add(&s->matrix, s->block[e / 3][e % 3], i < j ? i : j, block);
        for (int c = 2; c < UNKNOWNS; ++c) {
            double d = w * ((x[i][c] - s->anchor[i][c]) - (x[j][c] - s->anchor[j][c]));
            s->right[i][c] += d, s->right[j][c] -= d;
        }
        s->congruence[e] = constraint(s, x, e);
    }
    for (int t = 0; t < s->triangles; ++t) {
        const int* corner = s->linkage->triangles[t];
        double r[3], gradient[3][3][3], wide[3][UNKNOWNS] = {{0}};
        equilateral_rows(s, x, t, r, gradient);
        for (int row = 0; row < 3; ++row) {
            for (int k = 0; k < 3; ++k) {
                memcpy(wide[k] + 2, gradient[row][k], sizeof gradient[row][k]);
                add_square(s, corner[k], wide[k], 1);
                add_scaled(s->right[corner[k]], wide[k], r[row]);
            }
            for (int k = 0; k < 3; ++k) {
                int a = (k + 1) % 3, b = (k + 2) % 3;
                add_product(s, s->block[t][k], corner[a], corner[b], wide[a], wide[b], 1);
            }
        }
    }
    for (int h = 0; h < s->hinges; ++h) {
        double block[UNKNOWNS * UNKNOWNS] = {0}, d[3], weighed[3], matrix[3][3];
        ax_sub3(x[h] + 2, s->contact[h].point, d);
        weigh_place(s, h, d, weighed, matrix);
        for (int r = 0; r < 3; ++r) {
            memcpy(block + (r + 2) * UNKNOWNS + 2, matrix[r], sizeof matrix[r]);
            s->right[h][2 + r] += weighed[r];
        }
        for (int k = 0; k < UNKNOWNS; ++k) {
            block[k * UNKNOWNS + k] += weight_stay * weight_stay;
            s->right[h][k] += weight_stay * weight_stay * (x[h][k] - s->anchor[h][k]);
        }
        ax_blocks_add_diagonal(&s->matrix, h, block);
    }
    for (int p = 0; p < s->problem->plane_count; ++p)
        for (int k = 0; k < s->problem->planes[p].count; ++k) {
            int h = s->problem->planes[p].hinges[k];
            double d[3], gradient[UNKNOWNS] = {0}, w = weight_plane * weight_plane;
            ax_sub3(x[h] + 2, s->plane[p].point, d);
            memcpy(gradient + 2, s->plane[p].normal, sizeof s->plane[p].normal);
            add_square(s, h, gradient, w);
            add_scaled(s->right[h], gradient, w * ax_dot3(s->plane[p].normal, d));
        }
    for (int m = 0; m < s->mouths; ++m) {
        if (!s->active[m])
            continue;
        const int* hinge = s->mouth[m];
        double gradient[3][UNKNOWNS] = {{0}};
        double a[2], b[2];
        for (int c = 0; c < 2; ++c)
            a[c] = x[hinge[0]][c] - x[hinge[1]][c], b[c] = x[hinge[2]][c] - x[hinge[1]][c];
        double a2 = a[0] * a[0] + a[1] * a[1], b2 = b[0] * b[0] + b[1] * b[1];
        gradient[0][0] = -a[1] / a2, gradient[0][1] = a[0] / a2;
        gradient[2][0] = b[1] / b2, gradient[2][1] = -b[0] / b2;
        for (int c = 0; c < 2; ++c)
            gradient[1][c] = -(gradient[0][c] + gradient[2][c]);
        add_row(s, hinge, gradient, mouth_angle(s, x, m) - s->mouth_aim);
    }
    for (int pair = 0; pair < s->problem->apart_count; ++pair) {
        int end[3];
        double into = apart_depth(s, x, pair, end) + apart_margin;
        if (into <= 0)
            continue;
        double gradient[3][UNKNOWNS] = {{0}}, e[2] = {x[end[1]][0] - x[end[0]][0], x[end[1]][1] - x[end[0]][1]};
        double d[2] = {x[end[2]][0] - x[end[0]][0], x[end[2]][1] - x[end[0]][1]};
        double length2 = e[0] * e[0] + e[1] * e[1], t = (e[0] * d[0] + e[1] * d[1]) / length2;
        double normal[2] = {-e[1] / sqrt(length2), e[0] / sqrt(length2)};
        for (int c = 0; c < 2; ++c) {
            gradient[0][c] = -(1 - t) * normal[c];
            gradient[1][c] = -t * normal[c];
            gradient[2][c] = normal[c];
        }
        add_row(s, end, gradient, into);
    }
}

// Solves  S'S d + C'y = -g,  C d = -c  by Uzawa iterations on the factor of S'S + mu C'C. The multipliers start at those of
// the last step.
static void solve_step(solver* s, double mu)
{
    const state* x = (const state*)s->x;
    double scale = 0;
    for (int e = 0; e < s->edges; ++e)
        scale += s->congruence[e] * s->congruence[e];
    for (int round = 0; round < 12; ++round) {
        memcpy(s->step, s->right, (size_t)s->hinges * sizeof *s->step);
        for (int e = 0; e < s->edges; ++e) {
            int i, j;
            double g[UNKNOWNS];
            edge_ends(s, e, &i, &j);
            constraint_gradient(x, i, j, g);
            double y = s->multiplier[e] + mu * s->congruence[e];
            add_scaled(s->step[i], g, y);
            add_scaled(s->step[j], g, -y);
        }
        ax_block_factor_solve(s->factor, s->step[0], s->step[0], 1);
        double left = 0;
        for (int e = 0; e < s->edges; ++e) {
            int i, j;
            double g[UNKNOWNS], change = s->congruence[e];
            edge_ends(s, e, &i, &j);
            constraint_gradient(x, i, j, g);
            for (int k = 0; k < UNKNOWNS; ++k)
                change -= g[k] * (s->step[i][k] - s->step[j][k]);
            s->multiplier[e] += mu * change;
            left += change * change;
        }
        if (left <= 1e-6 * fmin(1, scale) * scale || left < 1e-30 * s->edges)
            break;
    }
    for (int h = 0; h < s->hinges; ++h)
        for (int k = 0; k < UNKNOWNS; ++k)
            s->step[h][k] = -s->step[h][k];
}

static void refresh_active(solver* s)
{
    bool grown = false;
    for (int m = 0; m < s->mouths; ++m) {
        s->active[m] = mouth_angle(s, (const state*)s->x, m) < s->mouth_aim;
        if (s->active[m] && !s->in_pattern[m])
            s->in_pattern[m] = 1, grown = true;
    }
    if (grown)
        build_pattern(s);
}

static solver make(const ax_joint_problem* problem, double (*flat)[2], double (*deployed)[3])
{
    const ax_linkage* linkage = problem->linkage;
    int n = linkage->hinge_count;
    solver s = {.problem = problem,
                .linkage = linkage,
                .hinges = n,
                .triangles = linkage->triangle_count,
                .edges = 3 * linkage->triangle_count,
                .pool = ax_pool_make(0)};
    for (int e = 0; e < s.edges; ++e) {
        int i, j;
        edge_ends(&s, e, &i, &j);
        s.unit += ax_distance2(flat[i], flat[j]) / s.edges;
    }
    for (int h = 0; h < n; ++h) {
        for (int c = 0; c < 2; ++c)
            s.flat_origin[c] += flat[h][c] / n;
        for (int c = 0; c < 3; ++c)
            s.origin[c] += deployed[h][c] / n;
    }
    s.x = ax_alloc((size_t)n, sizeof *s.x);
    for (int h = 0; h < n; ++h)
        for (int k = 0; k < UNKNOWNS; ++k)
            s.x[h][k] =
                k < 2 ? (flat[h][k] - s.flat_origin[k]) / s.unit : (deployed[h][k - 2] - s.origin[k - 2]) / s.unit;
    s.anchor = ax_copy(s.x, (size_t)n, sizeof *s.x);
    s.trial = ax_alloc((size_t)n, sizeof *s.x);
    s.step = ax_alloc((size_t)n, sizeof *s.x);
    s.right = ax_alloc((size_t)n, sizeof *s.x);
    s.congruence = AX_NEW0(double, s.edges);
    s.multiplier = AX_NEW0(double, s.edges);
    // triangles at the rim give way where the rim is held
    s.bordering = AX_NEW0(unsigned char, s.triangles);
    for (int t = 0; t < s.triangles; ++t) {
        bool border = false, held = false;
        for (int k = 0; k < 3; ++k) {
            int h = linkage->triangles[t][k];
            border |= linkage->on_rim[h];
            held |= linkage->on_rim[h] && place_kind(&s, h) > AX_JOINT_ON_SURFACE;
        }
        s.bordering[t] = held || (border && problem->border_unequal > 0);
    }
    s.mouth = ax_linkage_mouths(linkage, &s.mouths);
    // aim above the bound where the scale leaves room: snapping the rim costs border mouths up to 13 degrees otherwise
    s.mouth_aim = fmax(problem->mouth_min * mouth_margin,
                       fmin(mouth_comfort, mouth_share * 2 * (AX_PI / 3 - acos(1 / problem->scale_max))));
    s.active = AX_NEW0(unsigned char, s.mouths);
    s.in_pattern = AX_NEW0(unsigned char, s.mouths);
    s.contact = AX_NEW0(contact, n);
    for (int h = 0; h < n; ++h) {
        s.contact[h].face = -1;
        memcpy(s.contact[h].point, s.x[h] + 2, sizeof s.contact[h].point); // where a fixed hinge is held
    }
    s.plane = AX_NEW0(flat_plane, problem->plane_count);
    s.fine = 1e-9;
    for (int h = 0; h < n; ++h)
        if (place_kind(&s, h) == AX_JOINT_ON_SURFACE)
            s.fine = 1e-6; // facets are no smoother
    s.block = ax_alloc((size_t)s.triangles, sizeof *s.block);
    build_pattern(&s);
    return s;
}

static void release(solver* s)
{
    void* blocks[] = {s->x,     s->anchor, s->trial,      s->step,    s->right, s->congruence, s->multiplier,
                      s->mouth, s->active, s->in_pattern, s->contact, s->plane, s->bordering,  s->block};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_blocks_free(&s->matrix);
    ax_block_factor_free(s->factor);
    ax_pool_free(s->pool);
}

// In document units.
static void get_states(const solver* s, double (*flat)[2], double (*deployed)[3])
{
    for (int h = 0; h < s->hinges; ++h) {
        for (int c = 0; c < 2; ++c)
            flat[h][c] = s->x[h][c] * s->unit + s->flat_origin[c];
        for (int c = 0; c < 3; ++c)
            deployed[h][c] = s->x[h][2 + c] * s->unit + s->origin[c];
    }
}

static void show(const solver* s)
{
    double(*flat)[2] = ax_alloc((size_t)s->hinges, sizeof *flat),
    (*deployed)[3] = ax_alloc((size_t)s->hinges, sizeof *deployed);
    get_states(s, flat, deployed);
    s->problem->look(s->problem->looking, (const double(*)[2])flat, (const double(*)[3])deployed);
    ax_free(flat);
    ax_free(deployed);
}

ax_status ax_joint_solve(const ax_joint_problem* problem, double (*flat)[2], double (*deployed)[3],
                         const ax_progress* progress, ax_joint_result* result, ax_error* error)
{
    solver s = make(problem, flat, deployed);
    ax_status status = AX_OK;
    size_t bytes = (size_t)s.hinges * sizeof *s.x;
    int k = 0, worst;
    double mu = 1e3, longest = INFINITY, off_place = 0, congruence = worst_congruence(&s, (const state*)s.x, &worst);
    for (; k < STEPS; ++k) {
        if (problem->look)
            show(&s);
        if (!ax_progress_report(progress, "Solving flat and deployed state together", fmin(0.95, k / 8.0),
                                congruence)) {
            status = ax_fail(error, AX_CANCELLED, "Cancelled.");
            break;
        }
        off_place = find_places(&s);
        if (congruence < 1e-12 && ((longest < s.fine && off_place < on_place) || k > 3 * ANCHORED_STEPS))
            break;
        refresh_active(&s);
        assemble(&s, mu);
        if (!ax_block_factor_run(s.factor, &s.matrix))
            break; // rounding has eaten the stay term: keep the last good state
        ++s.factorisations;
        solve_step(&s, mu);

        double stiffest = 0;
        longest = 0;
        for (int h = 0; h < s.hinges; ++h)
            for (int c = 0; c < UNKNOWNS; ++c)
                longest = fmax(longest, fabs(s.step[h][c]));
        for (int e = 0; e < s.edges; ++e)
            stiffest = fmax(stiffest, fabs(s.multiplier[e]));
        double nu = fmax(2 * stiffest, 1e-8), before = merit(&s, (const state*)s.x, nu), t = fmin(1, 0.5 / longest);
        for (int halving = 0;; ++halving, t /= 2) {
            for (int h = 0; h < s.hinges; ++h)
                for (int c = 0; c < UNKNOWNS; ++c)
                    s.trial[h][c] = s.x[h][c] + t * s.step[h][c];
            if (halving == 6 || merit(&s, (const state*)s.trial, nu) <= before * (1 + 1e-12))
                break;
        }
        memcpy(s.x, s.trial, bytes);
        congruence = worst_congruence(&s, (const state*)s.x, &worst);
        if (k + 1 >= ANCHORED_STEPS) {
            memcpy(s.anchor, s.x, bytes);
            s.settled = true;
        }
        if (k >= 2)
            mu = 1e5;
    }
    if (status == AX_OK)
        get_states(&s, flat, deployed);
    *result = (ax_joint_result){.steps = k,
                                .factorisations = s.factorisations,
                                .converged = congruence < 1e-10,
                                .congruence = congruence,
                                .congruence_at = worst,
                                .off_place = off_place,
                                .unequal = worst_unequal(&s, (const state*)s.x)};
    release(&s);
    return status;
}
