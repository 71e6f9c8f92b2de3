// What people are told of a form: what is the matter, where, by how much, and what to do about it.
#include "form/regions.h"
#include "form/state.h"

#include "analysis/measure.h"
#include "base/vec.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Limits of what a settled form keeps, and above which people are told.
enum { MOST_PLACES = 3 }; // told of what is the matter at several
static const double settled_error = 1e-2, slack_opening = 0.95, tight_multiplier = 2, rim_gap = 0.02, loaded_gap = 0.3,
                    scale_gap = 0.1, unequal_gap = 0.01, apart_gap = 0.02;

static ax_finding* tell(ax_form_report* r, ax_severity severity, const char* kind, double value, double limit,
                        const char* format, ...) __attribute__((format(printf, 6, 7)));
static ax_finding* tell(ax_form_report* r, ax_severity severity, const char* kind, double value, double limit,
                        const char* format, ...)
{
    r->findings = ax_realloc(r->findings, (size_t)r->finding_count + 1, sizeof *r->findings);
    ax_finding* finding = r->findings + r->finding_count++;
    *finding = (ax_finding){
        .severity = severity, .kind = kind, .triangle = -1, .hinge = -1, .other = -1, .value = value, .limit = limit};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(finding->text, sizeof finding->text, format, arguments);
    va_end(arguments);
    return finding;
}

const char* ax_severity_name(ax_severity severity)
{
    static const char* const names[] = {"note", "warning", "failure"};
    return names[severity];
}

static int by_severity(const ax_finding* x, const ax_finding* y)
{
    return x->severity != y->severity ? (int)y->severity - (int)x->severity : strcmp(x->kind, y->kind);
}

// Least distance of the panels from an underlay, and the panel.
static double underlay_distance(const ax_form* f, int k, int* panel)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    const double(*x)[3] = (const double(*)[3])(ax_form_hangs(f) ? f->simulated : f->deployed);
    double least = INFINITY;
    ax_closest* tree = ax_closest_make(f->underlays + k);
    *panel = -1;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double corner[3][3], before = least;
        for (int c = 0; c < 3; ++c)
            memcpy(corner[c], x[linkage->triangles[t][c]], sizeof corner[c]);
        least = ax_closest_to_triangle(tree, (const double(*)[3])corner, least);
        *panel = least < before ? t : *panel;
    }
    ax_closest_free(tree);
    return least;
}

// The panel whose edges differ most between the flat state and one in space.
static int most_strained(const ax_form* f, const double (*x)[3])
{
    int at = -1;
    double most = -1;
    for (int t = 0; t < f->lattice.linkage.triangle_count; ++t)
        for (int k = 0, a, b; k < 3; ++k) {
            ax_form_edge_ends(f, t, k, &a, &b);
            double off = fabs(ax_distance3(x[a], x[b]) / ax_distance2(f->flat[a], f->flat[b]) - 1);
            if (off > most)
                most = off, at = t;
        }
    return at;
}

// The panel that has a hinge, and where it is on the sheet, in which strokes are given.
static const char* name_place(const ax_form* f, int hinge, char text[64])
{
    char panel[16];
    ax_panel_name(&f->lattice.linkage, f->holder[hinge][0], panel);
    double at[2];
    for (int c = 0; c < 2; ++c) // rounding is no place
        at[c] = fabs(f->lattice.hinges[hinge][c]) < 1e-9 * f->radius ? 0 : f->lattice.hinges[hinge][c];
    snprintf(text, 64, "panel %s (%.3g, %.3g on the sheet)", panel, at[0], at[1]);
    return text;
}

// The panel within the sheet whose edges differ most, which are to be equal there, and by what share of their mean.
static double most_unequal(const ax_form* f, int* panel)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double most = 0;
    *panel = -1;
    for (int t = 0; t < linkage->triangle_count; ++t) {
        const int* h = linkage->triangles[t];
        if (linkage->on_rim[h[0]] || linkage->on_rim[h[1]] || linkage->on_rim[h[2]])
            continue;
        double least = INFINITY, greatest = 0, mean = 0;
        for (int k = 0; k < 3; ++k) {
            double edge = ax_distance2(f->flat[h[k]], f->flat[h[(k + 1) % 3]]);
            least = fmin(least, edge), greatest = fmax(greatest, edge), mean += edge / 3;
        }
        if (greatest - least > most * mean)
            most = (greatest - least) / mean, *panel = t;
    }
    return most;
}

static bool beside_rim(const ax_form* f, int hinge)
{
    bool beside = false;
    for (int side = 0; side < 2; ++side)
        for (int k = 0; k < 3 && f->holder[hinge][side] >= 0; ++k)
            beside = beside || f->lattice.linkage.on_rim[f->lattice.linkage.triangles[f->holder[hinge][side]][k]];
    return beside;
}

static bool rim_is_held(const ax_form* f)
{
    for (int k = 0; k < f->rim_count; ++k)
        if (f->rim[k].kind != AX_RIM_FREE)
            return true;
    return false;
}

// Is the sheet cut to a corner at a hinge where the rim that holds it is an arc? Panels would have to shrink without bound towards such a
// corner, as the conformal map of it onto an arc does, and fold instead.
static bool cut_to_corner(const ax_form* f, int hinge)
{
    static const double reach = 4, least_share = 0.36, along = 1.5, least_turn = AX_PI / 3;
    const ax_linkage* linkage = &f->lattice.linkage;
    double spacing = f->lattice.spacing, here = 0;
    for (int t = 0; t < linkage->triangle_count; ++t)
        here += ax_distance2(f->centres[t], f->lattice.hinges[hinge]) < reach * spacing;
    if (!beside_rim(f, hinge) || here > least_share * AX_PI * reach * reach * 4 / sqrt(3)) // half of them along a side
        return false;
    for (int k = 0; k < f->rim_count; ++k) {
        if (f->rim[k].kind != AX_RIM_SLIDE)
            continue;
        int near = f->rim[k].hinges[0];
        for (int i = 1; i < f->rim[k].count; ++i)
            if (ax_distance2(f->lattice.hinges[f->rim[k].hinges[i]], f->lattice.hinges[hinge]) <
                ax_distance2(f->lattice.hinges[near], f->lattice.hinges[hinge]))
                near = f->rim[k].hinges[i];
        if (ax_distance2(f->lattice.hinges[near], f->lattice.hinges[hinge]) > 2 * spacing)
            continue;
        ax_curve* curve = ax_curve_of_shape(&f->rim[k].curve);
        double on[3], at = ax_curve_length(curve, ax_curve_nearest(curve, f->deployed[near], on)), way[2][3], second[3],
                      reach_along = along * ax_form_sides_mean(f);
        ax_curve_range range = ax_curve_extent(curve);
        for (int side = 0; side < 2; ++side)
            ax_curve_derivatives(curve, ax_curve_at_length(curve, at + (side ? reach_along : -reach_along)), way[side],
                                 second);
        double lengths = ax_norm3(way[0]) * ax_norm3(way[1]);
        bool ends = !range.closed && (at < ax_curve_length(curve, range.from) + reach_along ||
                                      at > ax_curve_length(curve, range.to) - reach_along);
        bool arc = !ends && lengths > 0 && ax_dot3(way[0], way[1]) > cos(least_turn) * lengths;
        ax_curve_free(curve);
        return arc;
    }
    return false;
}

static bool rounds_corner(const ax_form* f, int panel)
{
    const int* h = f->lattice.linkage.triangles[panel];
    return cut_to_corner(f, h[0]) || cut_to_corner(f, h[1]) || cut_to_corner(f, h[2]);
}

static const char corner_words[] =
    "the sheet has a corner there, which its rim rounds: round the outline too (fillet), or the rim less";

// What to do about too much material at a hinge, and about too little.
static const char* slacken_less(const ax_form* f, int hinge)
{
    return beside_rim(f, hinge) && rim_is_held(f)
               ? "Paint smaller scale factors there, move the rim outwards, or tighten to load."
               : "Paint smaller scale factors there, or tighten to load.";
}
static const char* pull_less(const ax_form* f, int hinge, bool everywhere)
{
    return !rim_is_held(f)                      ? "Paint larger scale factors there, or move what holds it closer."
           : everywhere || beside_rim(f, hinge) ? "Paint larger scale factors there, or move the rim inwards."
                                                : "Paint larger scale factors there.";
}

// Slack holes by the places where they are together: too much material there.
static void find_slack(const ax_form* f, ax_form_report* r)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double* off = AX_NEW(double, linkage->hole_count + 1);
    int slack = 0;
    for (int k = 0; k < linkage->hole_count; ++k) {
        off[k] = f->opening[k] < slack_opening ? 1 - f->opening[k] : 0;
        slack += off[k] > 0;
    }
    ax_region regions[MOST_PLACES];
    int all = ax_form_regions(linkage->hole_count, linkage->hole_start, linkage->hole_hinges, linkage->hinge_count, off,
                              MOST_PLACES, regions);
    for (int k = 0; k < all && k < MOST_PLACES; ++k) {
        char how[64] = "", place[64], number[32];
        int hinge = linkage->hole_hinges[linkage->hole_start[regions[k].worst]];
        if (k == 0)
            snprintf(how, sizeof how, "%d of %d holes are slack. ", slack, linkage->hole_count);
        snprintf(number, sizeof number, regions[k].count > 1 ? "%d holes, the slackest" : "a hole", regions[k].count);
        tell(r, AX_SEVERITY_WARNING, "slack", 1 - regions[k].value, slack_opening,
             "%sToo much material at %s: %s %.0f %% open. %s", how, name_place(f, hinge, place), number,
             100 * (1 - regions[k].value), slacken_less(f, hinge))
            ->hinge = hinge;
    }
    ax_free(off);
}

// Panels that are pulled too hard, by the places where they are together: too little material there. Under a load of p per area a cap of
// radius R pulls its edges by p R L / sqrt 3, and the multiplier of a panel is three times that: R that of the sheet is its measure.
static void find_tight(const ax_form* f, ax_form_report* r)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    int count = linkage->triangle_count, tight = 0, *start = AX_NEW(int, count + 1);
    double *off = AX_NEW(double, count), free_pull = sqrt(3) * ax_form_load_per_area(f) * f->radius;
    for (int t = 0; t <= count; ++t)
        start[t] = 3 * t;
    for (int t = 0; t < count; ++t) {
        off[t] = f->pull[t] > tight_multiplier ? f->pull[t] : 0;
        tight += off[t] > 0;
    }
    ax_region regions[MOST_PLACES];
    int all = ax_form_regions(count, start, linkage->triangles[0], linkage->hinge_count, off, MOST_PLACES, regions);
    for (int k = 0; k < all && k < MOST_PLACES; ++k) {
        char place[96], named[64], pull[96], number[32];
        int panel = regions[k].worst, hinge = linkage->triangles[panel][0];
        bool everywhere = tight > count / 2;
        snprintf(place, sizeof place, everywhere ? "nearly everywhere, most at %s" : "at %s",
                 name_place(f, hinge, named));
        snprintf(number, sizeof number, regions[k].count > 1 ? "%d panels bear" : "a panel bears", regions[k].count);
        if (ax_form_hangs(f))
            snprintf(pull, sizeof pull, "up to %.0f times the pull of a sheet that bulges freely",
                     regions[k].value / free_pull);
        else
            snprintf(pull, sizeof pull, "a pull of up to %.1f edges beyond what they reach", regions[k].value);
        tell(r, AX_SEVERITY_WARNING, "tight", regions[k].value, tight_multiplier, "Too little material %s: %s %s. %s",
             place, number, pull, pull_less(f, hinge, everywhere))
            ->triangle = panel;
        r->findings[r->finding_count - 1].hinge = hinge;
    }
    ax_free(start);
    ax_free(off);
}

void ax_form_find_problems(ax_form* f, ax_form_report* r)
{
    const ax_linkage* linkage = &f->lattice.linkage;
    double degree = 180 / AX_PI;
    const char* unit = ax_unit_name(f->unit);
    char place[64], other[16];
    bool moved = f->dynamics.kind != AX_DYNAMICS_NONE;
    const double(*x)[3] = (const double(*)[3])(ax_form_hangs(f) ? f->simulated : f->deployed);
    double worst = fmax(r->flat_error, moved ? fmax(r->deployed_error, ax_form_hangs(f) ? r->simulated_error : 0) : 0);
    if (worst > settled_error) {
        int at = most_strained(f, x), hinge = linkage->triangles[at][0];
        tell(r, AX_SEVERITY_FAILURE, "unsettled", worst, settled_error, "Edges are off by %.3g %%, most at %s: %s.",
             100 * worst, name_place(f, hinge, place),
             !f->iterations         ? "not solved yet"
             : rounds_corner(f, at) ? corner_words
                                    : "the request cannot be met, or needs more steps")
            ->triangle = at;
    }
    int unlike;
    double unequal = f->exact ? most_unequal(f, &unlike) : 0;
    if (unequal > unequal_gap)
        tell(r, AX_SEVERITY_WARNING, "unequal", unequal, unequal_gap,
             "Panels come out with edges that differ by up to %.2g %%, most at %s: what holds it asks for more than "
             "equilateral panels can do.",
             100 * unequal, name_place(f, linkage->triangles[unlike][0], place))
            ->triangle = unlike;
    if (f->apart > apart_gap && moved)
        tell(r, AX_SEVERITY_WARNING, "resolution", f->apart, apart_gap,
             "The shape depends on the number of panels: a coarser sheet rests up to %.2g %% of its size away, most at "
             "%s. Less material there, or more that holds it, leaves one way to fold.",
             100 * f->apart, name_place(f, f->apart_hinge, place))
            ->hinge = f->apart_hinge;
    if (r->overlap_pairs) {
        int pair[1][2] = {{-1, -1}};
        ax_measure_overlaps(linkage, (const double(*)[2])f->flat, AX_FORM_OVERLAP * r->edge, 1, pair);
        char a[16], b[16];
        ax_panel_name(linkage, pair[0][0], a);
        ax_panel_name(linkage, pair[0][1], b);
        tell(r, AX_SEVERITY_FAILURE, "overlap", r->overlap_pairs, 0,
             "%d pairs of panels overlap in the flat state, %s and %s first, at %s: paint smaller scale factors there, "
             "or release the border.",
             r->overlap_pairs, a, b, name_place(f, linkage->triangles[pair[0][0]][0], place));
        r->findings[r->finding_count - 1].triangle = pair[0][0];
        r->findings[r->finding_count - 1].other = pair[0][1];
    }
    if (r->flipped) {
        int first;
        ax_measure_flipped(linkage, (const double(*)[2])f->flat, &first);
        tell(r, AX_SEVERITY_FAILURE, "flipped", r->flipped, 0,
             "%d panels are turned over in the flat state, the first at %s.", r->flipped,
             name_place(f, linkage->triangles[first][0], place))
            ->triangle = first;
    }
    if (r->mouth_min < f->mouth_min - 0.1 / degree)
        tell(r, r->mouth_min < 0 ? AX_SEVERITY_FAILURE : AX_SEVERITY_WARNING, "mouth", r->mouth_min * degree,
             f->mouth_min * degree,
             "The smallest mouth is %.1f degrees, at %s; %.1f are asked: lower the scale factors there.",
             r->mouth_min * degree, name_place(f, r->mouth_hinge, place), f->mouth_min * degree)
            ->hinge = r->mouth_hinge;
    if (r->scale_off_max > scale_gap) {
        char name[16];
        ax_panel_name(linkage, r->scale_off_triangle, name);
        tell(r, AX_SEVERITY_WARNING, "scale", r->scale_off_max, scale_gap,
             "Scale factors come out up to %.2f off what was asked, most at panel %s (asked %.2f, realised %.2f).",
             r->scale_off_max, name, f->prescribed[r->scale_off_triangle], f->realised[r->scale_off_triangle])
            ->triangle = r->scale_off_triangle;
    }
    if (moved) {
        find_slack(f, r);
        find_tight(f, r);
    }
    int fold[2], folds = moved ? ax_form_folds(f, x, fold) : 0;
    if (folds) {
        int hinge = linkage->triangles[fold[0]][0];
        bool corner = rounds_corner(f, fold[0]);
        ax_panel_name(linkage, fold[1], other);
        tell(r, AX_SEVERITY_WARNING, "folded", folds, 0,
             "%d pair%s of neighbouring panels %s folded onto each other, the first at %s with %s%s%s.", folds,
             folds == 1 ? "" : "s", folds == 1 ? "is" : "are", name_place(f, hinge, place), other, corner ? ": " : "",
             corner ? corner_words : "");
        r->findings[r->finding_count - 1].triangle = fold[0];
        r->findings[r->finding_count - 1].other = fold[1];
    }
    for (int k = 0; k < r->held_count; ++k) {
        // under the load alone, what does not support is as near as a simulated state is to be to its design
        bool yields = ax_form_hangs(f) && !ax_form_shares(f) && !r->held[k].supports;
        double gap = (yields ? loaded_gap : rim_gap) * r->edge;
        if (r->held[k].residual > gap && strcmp(r->held[k].kind, "fairness") != 0)
            tell(r, AX_SEVERITY_WARNING, "held", r->held[k].residual, gap,
                 "'%s' (%s) is missed by up to %.3g %s, most at %s.", r->held[k].name, r->held[k].kind,
                 r->held[k].residual, unit, name_place(f, r->held[k].hinge, place))
                ->hinge = r->held[k].hinge;
    }
    double rim = ax_form_rim_area(f), open = ax_form_open_area(f, 0);
    if (moved && rim > AX_FORM_RIM_ROOM * open)
        tell(r, AX_SEVERITY_WARNING, "rim", rim, open,
             "The rim's curve encloses %.3g %s2, and fully open the sheet covers %.3g %s2, %.3g with scale factors of "
             "2: "
             "choose a smaller curve, paint larger scale factors, or start with a larger sheet.",
             rim, unit, open, unit, ax_form_open_area(f, 2));
    if (r->curvature_max > 2 * AX_PI)
        tell(r, AX_SEVERITY_WARNING, "overhang", r->curvature_max, 2 * AX_PI,
             "The painted factors sum to %.0f degrees of curvature, above 360: fully open the surface turns over.",
             r->curvature_max * degree);
    else if (moved && r->overhang > 0)
        tell(r, AX_SEVERITY_NOTE, "overhang", r->overhang, 0, "%.1f %% of the panels look down: no height field.",
             100 * r->overhang);
    for (int k = 0; k < f->underlay_count; ++k) {
        int at;
        double least = underlay_distance(f, k, &at);
        if (least >= f->clearances[k])
            continue;
        char how[48];
        bool touches = least <= 1e-3 * ax_form_sides_mean(f);
        snprintf(how, sizeof how, touches ? "runs into" : "comes within %.3g %s of", least, unit);
        tell(r, AX_SEVERITY_FAILURE, "clearance", touches ? 0 : least, f->clearances[k],
             "The shell %s '%s' at %s; a clearance of %.3g %s is asked.", how, f->underlay_names[k],
             name_place(f, linkage->triangles[at][0], place), f->clearances[k], unit)
            ->triangle = at;
    }
    for (int k = 1; k < r->finding_count; ++k) { // the worst of a kind stays first
        ax_finding finding = r->findings[k];
        int at = k;
        for (; at > 0 && by_severity(&r->findings[at - 1], &finding) > 0; --at)
            r->findings[at] = r->findings[at - 1];
        r->findings[at] = finding;
    }
}

// ---- the joint solve ------------------------------------------------------------------------------------------------------------

// The worst of a kind, furthest beyond its limit; NULL: none.
static const ax_finding* worst_of(const ax_form_report* r, const char* kind)
{
    const ax_finding* worst = NULL;
    for (const ax_finding* x = r->findings; x < r->findings + r->finding_count; ++x)
        if (strcmp(x->kind, kind) == 0 && (!worst || fabs(x->value - x->limit) > fabs(worst->value - worst->limit)))
            worst = x;
    return worst;
}

ax_status ax_form_fail_joint(ax_form* f, const ax_joint_result* joint, ax_error* error)
{
    static const char* const kinds[] = {"rim", "overlap", "flipped", "held", "tight", "slack", "folded"};
    static const double astray = 1e-2; // left so far apart, states tell nothing: those that the solve began with do
    bool near = joint->congruence < astray;
    int at = near ? joint->congruence_at : most_strained(f, (const double(*)[3])f->deployed), told = 0;
    char place[64], text[1600];
    name_place(f, f->lattice.linkage.triangles[at][0], place);
    int used = snprintf(text, sizeof text, "The flat and the deployed state cannot be made congruent: ");
    if (near)
        used += snprintf(text + used, sizeof text - (size_t)used, "after %d steps edges still differ by %.1e, at %s.",
                         joint->steps, joint->congruence, place);
    else
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "where they begin edges differ by up to %.3g %%, at %s, and %d steps lead away from there.",
                         100 * ax_form_deployed_error(f), place, joint->steps);
    if (rounds_corner(f, at))
        used += snprintf(text + used, sizeof text - (size_t)used, " Mind: %s.", corner_words), ++told;
    ax_form_report report;
    ax_form_measure(f, &report);
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds && told < MOST_PLACES; ++kind) {
        const ax_finding* worst = worst_of(&report, kinds[kind]);
        if (worst)
            used += snprintf(text + used, sizeof text - (size_t)used, " %s", worst->text), ++told;
    }
    ax_form_report_free(&report);
    return ax_fail(error, AX_CANNOT_REALISE, "%s%s", text,
                   told ? "" : " Let the form settle further, release the border, or ask less of it.");
}
