#include "ax/report.h"

#include <assert.h>
#include <math.h>

#define PLACE(field)     .key = #field, .offset = offsetof(ax_report, field)
#define NUMBER(field, n) PLACE(field), .kind = AX_FIGURE_NUMBER, .count = n
#define COUNT(field, n)  PLACE(field), .kind = AX_FIGURE_COUNT, .count = n
#define FLAG(field)      PLACE(field), .kind = AX_FIGURE_FLAG, .count = 1
#define AT_MOST(x)       .relation = AX_AT_MOST, .limit = x
#define AT_LEAST(x)      .relation = AX_AT_LEAST, .limit = x
#define GEOMETRY         .group = AX_GROUP_GEOMETRY
#define FIT              .group = AX_GROUP_FIT
#define FLAT             .group = AX_GROUP_FLAT
#define DEPLOYMENT       .group = AX_GROUP_DEPLOYMENT
#define EFFORT           .group = AX_GROUP_EFFORT

static const ax_figure figures[] = {
    {NUMBER(edge_mean, 1), GEOMETRY, .label = "Mean edge L", .unit = "length"},
    {NUMBER(edge_min, 1), GEOMETRY, .label = "Shortest edge", .unit = "length"},
    {NUMBER(edge_max, 1), GEOMETRY, .label = "Longest edge", .unit = "length"},
    {NUMBER(congruence_max, 1), GEOMETRY, .label = "Congruence, flat to deployed", .unit = "", AT_MOST(1e-9)},
    {NUMBER(equilateral_inner_max, 1), GEOMETRY, .label = "Equilateral, inner triangles", .unit = "", AT_MOST(1e-4)},
    {NUMBER(equilateral_border_max, 1), GEOMETRY, .label = "Equilateral, border triangles", .unit = "", AT_MOST(1e-3)},
    {NUMBER(scale_min, 1), GEOMETRY, .label = "Smallest scale factor", .unit = ""},
    {NUMBER(scale_max, 1), GEOMETRY, .label = "Largest scale factor", .unit = ""},
    {NUMBER(hole_angle_deployed_deg, 3), GEOMETRY, .label = "Hole angles deployed, 5, 50, 95 %", .unit = "deg"},
    {NUMBER(panel_area, 1), GEOMETRY, .label = "Area of all panels", .unit = "area"},
    {NUMBER(deployed_bounds, 3), GEOMETRY, .label = "Deployed size", .unit = "length"},

    {NUMBER(surface_max_over_L, 1), FIT, .label = "Hinges to the surface, largest", .unit = "L", AT_MOST(2e-3)},
    {NUMBER(surface_rms_over_L, 1), FIT, .label = "Hinges to the surface, rms", .unit = "L"},
    {NUMBER(rim_max_over_L, 1), FIT, .label = "Rim hinges to the boundary curve", .unit = "L", AT_MOST(2e-3)},
    {NUMBER(cover_p99_over_L, 1), FIT, .label = "99 % of the surface is covered within", .unit = "L", AT_MOST(0.95)},

    {NUMBER(flat_bounds, 2), FLAT, .label = "Flat size", .unit = "length"},
    {NUMBER(mouth_min_deg, 1), FLAT, .label = "Smallest mouth angle", .unit = "deg", AT_LEAST(0)},
    {COUNT(mouth_min_hinge, 1), FLAT, .label = "Hinge with the smallest mouth angle", .unit = ""},
    {NUMBER(mouth_median_deg, 1), FLAT, .label = "Median mouth angle", .unit = "deg"},
    {COUNT(flipped_flat, 1), FLAT, .label = "Triangles turned over", .unit = "", AT_MOST(0)},
    {COUNT(overlap_pairs, 1), FLAT, .label = "Overlapping pairs", .unit = "", AT_MOST(0)},
    {COUNT(overlap_first, 2), FLAT, .label = "First overlapping pair", .unit = ""},

    {FLAG(simulated), DEPLOYMENT, .label = "Deployed by simulation", .unit = "", AT_LEAST(1)},
    {FLAG(from_flat), DEPLOYMENT, .label = "Opened from flat", .unit = "", AT_LEAST(1)},
    {FLAG(inflated_first), DEPLOYMENT, .label = "Inflated before it was loaded", .unit = ""},
    {COUNT(rim_stages, 1), DEPLOYMENT, .label = "Stages in which the rim moved", .unit = ""},
    {NUMBER(simulated_rms_over_L, 1), DEPLOYMENT, .label = "Simulated to designed, rms", .unit = "L", AT_MOST(0.1)},
    {NUMBER(simulated_max_over_L, 1), DEPLOYMENT, .label = "Simulated to designed, largest", .unit = "L", AT_MOST(0.3)},
    {COUNT(simulated_max_hinge, 1), DEPLOYMENT, .label = "Hinge farthest from the design", .unit = ""},
    {NUMBER(simulated_edge_error_max, 1), DEPLOYMENT, .label = "Edge error", .unit = "", AT_MOST(1e-10)},
    {NUMBER(force_residual, 1), DEPLOYMENT, .label = "Force residual over load", .unit = "", AT_MOST(1e-10)},
    {FLAG(stable), DEPLOYMENT, .label = "Stable equilibrium", .unit = "", AT_LEAST(1)},
    {NUMBER(edge_force_min, 1), DEPLOYMENT, .label = "Smallest edge force", .unit = "N"},
    {NUMBER(edge_force_max, 1), DEPLOYMENT, .label = "Largest edge force", .unit = "N"},
    {NUMBER(compressed_share, 1), DEPLOYMENT, .label = "Share of edges pushed", .unit = ""},
    {NUMBER(hinge_force_max, 1), DEPLOYMENT, .label = "Largest hinge force", .unit = "N"},
    {NUMBER(energy, 1), DEPLOYMENT, .label = "Energy of the load", .unit = "J"},
    {NUMBER(load_total, 1), DEPLOYMENT, .label = "Load in all", .unit = "N"},
    {NUMBER(reaction_total, 1), DEPLOYMENT, .label = "Support reactions in all", .unit = "N"},

    {COUNT(joint_steps, 1), EFFORT, .label = "Steps of the joint solve", .unit = ""},
    {COUNT(projective_steps, 1), EFFORT, .label = "Projective steps", .unit = ""},
    {COUNT(newton_steps, 1), EFFORT, .label = "Newton steps", .unit = ""},
    {NUMBER(seconds_flatten, 1), EFFORT, .label = "Flattening", .unit = "s"},
    {NUMBER(seconds_joint, 1), EFFORT, .label = "Joint solve", .unit = "s"},
    {NUMBER(seconds_deploy, 1), EFFORT, .label = "Deployment", .unit = "s"},
    {NUMBER(seconds_total, 1), EFFORT, .label = "In all", .unit = "s"},
};

const ax_figure* ax_report_figures(int* count)
{
    *count = (int)(sizeof figures / sizeof *figures);
    return figures;
}

const char* ax_report_opening(const ax_report* report)
{
    return !report->simulated       ? ""
           : !report->from_flat     ? "started from the designed state: does not show that it opens by itself"
           : report->rim_stages > 1 ? "opened from flat by moving the rim in stages"
           : report->inflated_first ? "opened from flat by inflation, then loaded"
                                    : "opened from flat in one go";
}

const char* ax_figure_group_name(ax_figure_group group)
{
    static const char* const names[] = {"Geometry", "Fit to target", "Flat state", "Deployment", "Effort"};
    assert(group >= 0 && group < sizeof names / sizeof *names);
    return names[group];
}

double ax_figure_value(const ax_figure* figure, const ax_report* report, int k)
{
    assert(k >= 0 && k < figure->count);
    const void* place = (const char*)report + figure->offset;
    switch (figure->kind) {
    case AX_FIGURE_NUMBER:
        return ((const double*)place)[k];
    case AX_FIGURE_COUNT:
        return ((const int*)place)[k];
    case AX_FIGURE_FLAG:
        return ((const bool*)place)[k];
    }
    assert(!"a kind without a case");
    return NAN;
}

void ax_figure_set(const ax_figure* figure, ax_report* report, int k, double value)
{
    assert(k >= 0 && k < figure->count);
    void* place = (char*)report + figure->offset;
    switch (figure->kind) {
    case AX_FIGURE_NUMBER:
        ((double*)place)[k] = value;
        break;
    case AX_FIGURE_COUNT:
        ((int*)place)[k] = (int)value;
        break;
    case AX_FIGURE_FLAG:
        ((bool*)place)[k] = value != 0;
        break;
    }
}

double ax_figure_limit(const ax_figure* figure, const ax_design* design)
{
    if (figure->relation == AX_SHOWN_ONLY)
        return NAN;
    if (figure->offset == offsetof(ax_report, mouth_min_deg))
        return design->mouth_min;
    if (figure->offset == offsetof(ax_report, equilateral_border_max) && design->border == AX_BORDER_RELEASED)
        return NAN; // released on purpose
    bool about_rim = figure->offset == offsetof(ax_report, rim_max_over_L) ||
                     figure->offset == offsetof(ax_report, cover_p99_over_L);
    if (about_rim && design->border == AX_BORDER_INSIDE)
        return NAN; // whole triangles inside do not reach the boundary
    bool about_target = about_rim || figure->offset == offsetof(ax_report, surface_max_over_L);
    if (about_target && design->target.face_count == 0)
        return NAN; // found without a target
    return figure->limit;
}

bool ax_figure_holds(const ax_figure* figure, const ax_design* design)
{
    double limit = ax_figure_limit(figure, design), value = ax_figure_value(figure, &design->report, 0);
    if (isnan(limit))
        return true;
    return figure->relation == AX_AT_MOST ? value <= limit : value >= limit;
}
