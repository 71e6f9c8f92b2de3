// Target surface to linkage: screen, project if asked, flatten, lay the lattice, lift and twist it, solve both states jointly, deploy.
#include "ax/design.h"

#include "analysis/measure.h"
#include "base/clock.h"
#include "base/random.h"
#include "base/vec.h"
#include "design/apart.h"
#include "design/place.h"
#include "linkage/lattice.h"
#include "mesh/closest.h"
#include "mesh/geometry.h"

#include <assert.h>
#include <string.h>

enum { LEAST_TRIANGLES = 24, MOST_TRIANGLES = 2000000, TRIALS = 40 };

ax_design_options ax_design_options_default(void)
{
    return (ax_design_options){
        .triangles = 600,
        .target = ax_target_options_default(),
        .mouth_min = 2,
        .load = {.kind = AX_LOAD_INFLATION, .direction = {0, 0, 1}, .pressure = 100, .density = 4},
        .unit = AX_METRE,
    };
}

// The flattened target at the scale of the flat sheet.
typedef struct flat_domain {
    ax_mesh mesh; // the flattening in the plane z = 0, faces shared with the target
    const ax_mesh* target;
    const ax_flattening* flattening;
    double factor;        // flat = uv / factor, lambda = factor e^-u
    double (*outline)[2]; // rim, counter-clockwise
    double (*rim_flat)[3], (*rim_target)[3];
    ax_polyline *flat_curve, *target_curve;
    ax_closest *flat_tree, *target_tree;
    double area, mean_scale;
} flat_domain;

// In place: the trees keep the address of the meshes.
static void make_domain(const ax_mesh* target, const ax_flattening* flattening, double lo, double hi, flat_domain* d)
{
    *d = (flat_domain){.target = target, .flattening = flattening};
    d->factor = sqrt(lo * hi) * exp((flattening->u_max + flattening->u_min) / 2);
    d->mesh = (ax_mesh){.vertex_count = target->vertex_count, .face_count = target->face_count, .faces = target->faces};
    d->mesh.positions = ax_calloc((size_t)target->vertex_count, sizeof *d->mesh.positions);
    for (int v = 0; v < target->vertex_count; ++v)
        for (int c = 0; c < 2; ++c)
            d->mesh.positions[v][c] = flattening->uv[v][c] / d->factor;
    int n = flattening->rim_count;
    d->outline = ax_alloc((size_t)n, sizeof *d->outline);
    d->rim_flat = ax_calloc((size_t)n, sizeof *d->rim_flat);
    d->rim_target = ax_alloc((size_t)n, sizeof *d->rim_target);
    for (int k = 0; k < n; ++k) {
        memcpy(d->outline[k], d->mesh.positions[flattening->rim[k]], sizeof d->outline[k]);
        memcpy(d->rim_flat[k], d->outline[k], sizeof d->outline[k]);
        memcpy(d->rim_target[k], target->positions[flattening->rim[k]], sizeof d->rim_target[k]);
    }
    d->flat_curve = ax_polyline_make(n, (const double(*)[3])d->rim_flat);
    d->target_curve = ax_polyline_make(n, (const double(*)[3])d->rim_target);
    d->flat_tree = ax_closest_make(&d->mesh);
    d->target_tree = ax_closest_make(target);
    double curved = 0;
    for (int f = 0; f < d->mesh.face_count; ++f) {
        d->area += ax_face_area(&d->mesh, f);
        curved += ax_face_area(target, f);
    }
    d->mean_scale = sqrt(curved / d->area);
}

static void free_domain(flat_domain* d)
{
    ax_free(d->mesh.positions);
    ax_free(d->outline);
    ax_free(d->rim_flat);
    ax_free(d->rim_target);
    ax_polyline_free(d->flat_curve);
    ax_polyline_free(d->target_curve);
    ax_closest_free(d->flat_tree);
    ax_closest_free(d->target_tree);
}

// Direction of the longest run of the outline that turns by less than five degrees in all.
static double longest_straight_part(const double (*outline)[2], int count)
{
    double best = -1, angle = 0;
    for (int k = 0, end = 1; k < count; ++k) {
        const double *a = outline[k], *first = outline[(k + 1) % count];
        double heading = atan2(first[1] - a[1], first[0] - a[0]);
        if (end < k + 1)
            end = k + 1;
        for (; end < k + count; ++end) {
            const double *p = outline[end % count], *q = outline[(end + 1) % count];
            double turn = remainder(atan2(q[1] - p[1], q[0] - p[0]) - heading, 2 * AX_PI);
            if (fabs(turn) > 5 * AX_PI / 180)
                break;
        }
        const double* b = outline[end % count];
        if (ax_distance2(a, b) > best)
            best = ax_distance2(a, b), angle = atan2(b[1] - a[1], b[0] - a[0]);
    }
    return angle;
}

// Root mean square distance of rim hinges to the outline, in spacings: how well the lattice row ends follow it.
static double rim_distance(const flat_domain* d, const ax_lattice* lattice)
{
    double sum = 0;
    int count = 0;
    for (int h = 0; h < lattice->linkage.hinge_count; ++h)
        if (lattice->linkage.on_rim[h]) {
            double place[3] = {lattice->hinges[h][0], lattice->hinges[h][1], 0};
            double distance = ax_polyline_find(d->flat_curve, place).distance / lattice->spacing;
            sum += distance * distance, ++count;
        }
    return sqrt(sum / count);
}

// Best of a number of random orientations and offsets at one spacing.
static ax_status search_lattice(const flat_domain* d, const ax_design_options* options, double spacing, int trials,
                                uint64_t seed, ax_lattice* best, ax_error* error)
{
    const ax_outline outline = {d->flattening->rim_count, (const double(*)[2])d->outline};
    ax_random random = {20180625 + seed};
    double best_score = INFINITY;
    bool fixed = options->angle_given || options->align_to_edge;
    double angle = options->align_to_edge ? longest_straight_part((const double(*)[2])d->outline, outline.count)
                                          : options->angle * AX_PI / 180;
    *best = (ax_lattice){0};
    for (int k = 0; k < trials; ++k) {
        double a = ax_random_uniform(&random, 0, AX_PI / 3);
        double offset[2] = {ax_random_uniform(&random, 0, spacing), ax_random_uniform(&random, 0, spacing)};
        // with a count wanted the spacing has some play, which lets rows end on straight edges
        double stretch = options->edge > 0 ? 1 : ax_random_uniform(&random, 0.99, 1.01);
        ax_lattice lattice;
        ax_status status = ax_lattice_lay(&outline, spacing * stretch, fixed ? angle : a, offset,
                                          options->border == AX_BORDER_INSIDE, &lattice, error);
        if (status != AX_OK)
            continue;
        double score = rim_distance(d, &lattice);
        if (score < best_score) {
            best_score = score;
            ax_lattice_free(best);
            *best = lattice;
        } else
            ax_lattice_free(&lattice);
    }
    return best_score < INFINITY ? AX_OK : AX_CANNOT_REALISE;
}

// Lattice with the count or edge asked; the spacing is corrected until the count is within 2 %.
static ax_status lay(const flat_domain* d, const ax_design_options* options, uint64_t seed, ax_lattice* lattice,
                     ax_error* error)
{
    double spacing =
        options->edge > 0 ? 2 * options->edge / d->mean_scale : sqrt(4 * d->area / (sqrt(3) * options->triangles));
    double expected = 4 * d->area / (sqrt(3) * spacing * spacing);
    if (expected > MOST_TRIANGLES || expected < LEAST_TRIANGLES)
        return ax_fail(
            error, AX_USAGE,
            "An edge of %g would make about %.0f triangles; between %d and %d can be handled. Choose the edge "
            "accordingly.",
            options->edge, expected, LEAST_TRIANGLES, MOST_TRIANGLES);
    int trials = (int)ax_clamp(4e5 / expected, 4, TRIALS);
    for (int round = 0;; ++round) {
        ax_status status = search_lattice(d, options, spacing, trials, seed, lattice, error);
        double share = status == AX_OK ? lattice->linkage.triangle_count / (double)options->triangles : 0;
        if (status != AX_OK || options->edge > 0 || round == 4 || fabs(share - 1) < 0.02)
            return status;
        ax_lattice_free(lattice);
        spacing *= sqrt(share);
    }
}

// Snaps rim hinges to the outline, lifts the lattice to the target, and twists it flat.
static void lift(const flat_domain* d, ax_lattice* lattice, bool snap, double (*flat)[2], double (*deployed)[3])
{
    const ax_linkage* linkage = &lattice->linkage;
    double* at_hinge = AX_NEW(double, linkage->hinge_count);
    for (int h = 0, hint = -1; h < linkage->hinge_count; ++h) {
        double place[3] = {lattice->hinges[h][0], lattice->hinges[h][1], 0};
        if (snap && linkage->on_rim[h]) {
            ax_polyline_point on = ax_polyline_find(d->flat_curve, place);
            memcpy(place, on.point, sizeof place);
            memcpy(lattice->hinges[h], place, sizeof lattice->hinges[h]);
        }
        ax_closest_point at = ax_closest_find(d->flat_tree, place, hint);
        hint = at.face;
        const int* corner = d->target->faces[at.face];
        double u = 0;
        for (int c = 0; c < 3; ++c)
            deployed[h][c] = 0;
        for (int k = 0; k < 3; ++k) {
            u += at.weight[k] * d->flattening->u[corner[k]];
            for (int c = 0; c < 3; ++c)
                deployed[h][c] += at.weight[k] * d->target->positions[corner[k]][c];
        }
        at_hinge[h] = d->factor * exp(-u);
    }
    double* scale = AX_NEW(double, linkage->triangle_count);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* corner = linkage->triangles[t];
        scale[t] = fmax(1, (at_hinge[corner[0]] + at_hinge[corner[1]] + at_hinge[corner[2]]) / 3);
    }
    ax_lattice_twist(lattice, scale, flat);
    ax_free(at_hinge);
    ax_free(scale);
}

static ax_status check_options(const ax_design_options* o, ax_error* error)
{
    double lo = o->target.scale_lo, hi = o->target.scale_hi;
    if (o->edge <= 0 && (o->triangles < LEAST_TRIANGLES || o->triangles > MOST_TRIANGLES))
        return ax_fail(error, AX_USAGE, "The number of triangles must lie between %d and %d, not %d.", LEAST_TRIANGLES,
                       MOST_TRIANGLES, o->triangles);
    if (!(lo >= 1 && hi <= 2 && lo < hi))
        return ax_fail(error, AX_USAGE, "The scale band must satisfy 1 <= LO < HI <= 2, not %g to %g.", lo, hi);
    if (!(o->mouth_min >= 0 && o->mouth_min < 60))
        return ax_fail(error, AX_USAGE, "The smallest mouth angle must lie between 0 and 60 degrees, not %g.",
                       o->mouth_min);
    return AX_OK;
}

ax_refinement ax_design_refine_target(ax_mesh* target, const ax_design_options* options)
{
    // open, a panel and its share of the holes take sqrt(3) L^2
    double edge = options->edge > 0 ? options->edge : sqrt(ax_mesh_area(target) / (sqrt(3) * options->triangles));
    return ax_mesh_refine(target, edge / 2);
}

// Screens, projects where asked and needed, and refuses what cannot be built.
static ax_status accept_target(ax_design* design, const ax_design_options* options, ax_screen* screen,
                               const ax_progress* progress, ax_error* error)
{
    ax_progress_part slot;
    ax_status status =
        ax_target_screen(&design->target, &options->target, ax_progress_within(&slot, progress, 0, 0.5), screen, error);
    if (status != AX_OK)
        return status;
    if (screen->verdict == AX_DEPLOYABLE_PROJECTED) {
        if (!options->project)
            return ax_fail(error, AX_CANNOT_REALISE, "%s Add --project to design for that surface.", screen->words);
        ax_screen_free(screen);
        status = ax_target_project(&design->target, ax_progress_within(&slot, progress, 0.5, 0.9), &design->projection,
                                   error);
        if (status != AX_OK)
            return status;
        design->projected = true;
        status = ax_target_screen(&design->target, &options->target, ax_progress_within(&slot, progress, 0.9, 1),
                                  screen, error);
        if (status != AX_OK)
            return status;
    }
    if (screen->verdict != AX_DEPLOYABLE)
        return ax_fail(error, AX_CANNOT_REALISE, "%s%s", screen->words,
                       design->projected ? " This holds after projection too." : "");
    if (options->load.kind == AX_LOAD_GRAVITY && !screen->by_gravity)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "Gravity cannot deploy this surface: seen from above it is not a height field. Use --load "
                       "inflation, or %s.",
                       screen->lies_on_side ? "give --up y if the y axis of its file points up"
                                            : "turn the target so that z is up");
    design->scale_ratio = screen->scale_ratio;

    return AX_OK;
}

// A panel that turns at hinge h.
static int panel_at(const ax_linkage* linkage, int h)
{
    int t = 0;
    while (linkage->triangles[t][0] != h && linkage->triangles[t][1] != h && linkage->triangles[t][2] != h)
        ++t;
    return t;
}

static ax_status verify(const ax_design* design, const ax_joint_result* joint, ax_error* error)
{
    const ax_report* r = &design->report;
    char place[96], other[16];
    if (!joint->converged)
        return ax_fail(
            error, AX_CANNOT_REALISE,
            "Flat and deployed triangles could not be made congruent: edges differ by up to %.1e after %d steps, most "
            "at "
            "%s, where the scale factor is %.3f. In all they run from %.3f to %.3f; keep away from the ends of 1 to 2 "
            "with --scale, use --border inside, or change the number of triangles.",
            joint->congruence, joint->steps, ax_design_name_place(design, joint->congruence_at, place),
            design->scale[joint->congruence_at], r->scale_min, r->scale_max);
    int flipped;
    if (ax_measure_flipped(&design->linkage, (const double(*)[2])design->flat, &flipped))
        return ax_fail(error, AX_CANNOT_REALISE,
                       "%d flat triangles came out turned over, first %s. Use more triangles or --border inside.",
                       r->flipped_flat, ax_design_name_place(design, flipped, place));
    if (r->overlap_pairs) {
        ax_panel_name(&design->linkage, r->overlap_first[1], other);
        return ax_fail(error, AX_CANNOT_REALISE,
                       "%d pairs of flat triangles overlap, first %s and its neighbour %s. Keep border triangles "
                       "equilateral, use --border inside, or change the number of triangles.",
                       r->overlap_pairs, ax_design_name_place(design, r->overlap_first[0], place), other);
    }
    if (r->mouth_min_deg < design->mouth_min)
        return ax_fail(error, AX_CANNOT_REALISE,
                       "The mouth at %s is %.2f degrees, less than the %.2f asked. Lower --mouth-min, lower the upper "
                       "limit of --scale, or change the number of triangles.",
                       ax_design_name_place(design, panel_at(&design->linkage, r->mouth_min_hinge), place),
                       r->mouth_min_deg, design->mouth_min);
    return AX_OK;
}

// Progress of try number `k` of work that may have to be tried again: half of what the tries before have left.
static const ax_progress* remaining(ax_progress_part* slot, const ax_progress* progress, int k)
{
    return ax_progress_within(slot, progress, 1 - ldexp(1, -k), 1 - ldexp(1, -k - 1));
}

static ax_status solve_jointly(ax_design* design, ax_joint_problem* problem, const ax_progress* progress,
                               ax_error* error)
{
    ax_joint_result joint;
    double start = ax_seconds();
    ax_status status = ax_solve_apart(problem, 0, design->flat, design->deployed, progress, &joint, error);
    design->report.joint_steps += joint.steps;
    design->report.seconds_joint += ax_seconds() - start;
    if (status == AX_OK) {
        ax_design_measure(design);
        status = verify(design, &joint, error);
    }
    return status;
}

// Somebody looks at a design that is being solved.
typedef struct viewing {
    const ax_design_watch* watch;
    ax_design so_far; // borrows everything but the scale factors
} viewing;

static void show(void* context, const double (*flat)[2], const double (*deployed)[3])
{
    viewing* v = context;
    v->so_far.flat = (double(*)[2])flat;
    v->so_far.deployed = (double(*)[3])deployed;
    ax_measure_scale(&v->so_far.linkage, flat, v->so_far.scale);
    v->watch->look(v->watch->context, &v->so_far);
}

// Flat and deployed states on one lattice.
static ax_status solve_on_lattice(ax_design* design, const flat_domain* domain, ax_lattice* lattice,
                                  const ax_design_options* options, double scale_max, const ax_progress* progress,
                                  ax_error* error)
{
    bool snap = options->border != AX_BORDER_INSIDE;
    int n = lattice->linkage.hinge_count;
    ax_lattice_renumber(lattice);
    design->flat = ax_alloc((size_t)n, sizeof *design->flat);
    design->deployed = ax_alloc((size_t)n, sizeof *design->deployed);
    lift(domain, lattice, snap, design->flat, design->deployed);
    design->linkage = lattice->linkage;
    lattice->linkage = (ax_linkage){0};
    design->supports = ax_copy(design->linkage.on_rim, (size_t)n, 1);

    ax_joint_place* places = AX_NEW(ax_joint_place, n);
    for (int h = 0; h < n; ++h)
        places[h] = snap && design->linkage.on_rim[h]
                        ? (ax_joint_place){.kind = AX_JOINT_ON_POLYLINE, .polyline = domain->target_curve}
                        : (ax_joint_place){.kind = AX_JOINT_ON_SURFACE, .surface = domain->target_tree};
    ax_joint_problem problem = {.linkage = &design->linkage,
                                .places = places,
                                .border_unequal = options->border == AX_BORDER_RELEASED ? INFINITY : 0,
                                .mouth_min = options->mouth_min * AX_PI / 180,
                                .scale_max = scale_max};
    viewing v = {.watch = options->watch, .so_far = {.linkage = design->linkage, .unit = design->unit}};
    if (v.watch) {
        v.so_far.scale = AX_NEW(double, design->linkage.triangle_count);
        problem.look = show, problem.looking = &v;
    }
    ax_status status = solve_jointly(design, &problem, progress, error);
    ax_free(v.so_far.scale);
    ax_free(places);
    return status;
}

static void drop_states(ax_design* design)
{
    void* blocks[] = {design->flat, design->deployed, design->supports, design->scale};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
        ax_free(blocks[k]);
    ax_linkage_free(&design->linkage);
    design->flat = NULL, design->deployed = NULL, design->supports = NULL, design->scale = NULL;
}

// Flat and deployed states of a target that has passed the screen. Where the rim cuts a lattice badly, another is tried.
static ax_status solve_states(ax_design* design, const ax_design_options* options, const ax_screen* screen,
                              const ax_progress* progress, ax_error* error)
{
    enum { LATTICES = 5 };
    flat_domain domain;
    make_domain(&design->target, &screen->flattening, options->target.scale_lo, options->target.scale_hi, &domain);
    ax_status status = AX_CANNOT_REALISE;
    for (int k = 0; k < LATTICES && status == AX_CANNOT_REALISE; ++k) {
        ax_progress_part slot;
        ax_lattice lattice = {0};
        drop_states(design);
        status = lay(&domain, options, (uint64_t)k, &lattice, error);
        if (status == AX_OK)
            status = solve_on_lattice(design, &domain, &lattice, options, screen->scale_hi,
                                      remaining(&slot, progress, k), error);
        ax_lattice_free(&lattice);
    }
    free_domain(&domain);
    return status;
}

ax_status ax_design_from_target(const ax_mesh* target, const ax_design_options* options, const ax_progress* progress,
                                ax_design* out, ax_error* error)
{
    *out = (ax_design){0};
    ax_status status = check_options(options, error);
    if (status != AX_OK)
        return status;
    double start = ax_seconds();
    ax_design design = {.unit = options->unit,
                        .target = ax_mesh_copy(target),
                        .load = options->load,
                        .mouth_min = options->mouth_min,
                        .border = options->border};
    ax_screen screen = {0};
    ax_progress_part slot;
    status = accept_target(&design, options, &screen, ax_progress_within(&slot, progress, 0, 0.2), error);
    design.report.seconds_flatten = ax_seconds() - start;
    if (status == AX_OK) {
        for (int c = 0; c < 3; ++c) // also for a design that is inflated: it may be hung later
            design.load.direction[c] = c == 2 ? screen.gravity_direction : 0;
        status = solve_states(&design, options, &screen, ax_progress_within(&slot, progress, 0.2, 0.6), error);
    }
    ax_screen_free(&screen);
    if (status != AX_OK) {
        ax_design_free(&design);
        return status;
    }
    if (options->load.kind != AX_LOAD_NONE) {
        ax_load load = design.load;
        status = ax_design_simulate(&design, &load, ax_progress_within(&slot, progress, 0.6, 1), error);
    }
    design.report.seconds_total = ax_seconds() - start;
    if (status == AX_CANCELLED) {
        ax_design_free(&design);
        return status;
    }
    *out = design;
    return status;
}
