// Flattens a mesh, lays a sheet over its flat rim with the scale factors of the map, holds the rim on that of the mesh, and lets the
// solver open it again. (Free, it could bend: scale factors alone do not tell one shape from another.)
#include <ax/export.h>
#include <ax/form.h>
#include <math.h>
#include <stdio.h>

static int say(const ax_error* error)
{
    fprintf(stderr, "%s\n", error->message);
    return error->status;
}

// The scale factor for length scale u = 0 is `rim`; what lies between vertices takes that of the nearest one.
static double scale_at(const ax_flattening* f, const double at[2], double rim)
{
    int best = 0;
    for (int v = 1; v < f->vertex_count; ++v)
        if (hypot(rim * at[0] - f->uv[v][0], rim * at[1] - f->uv[v][1]) <
            hypot(rim * at[0] - f->uv[best][0], rim * at[1] - f->uv[best][1]))
            best = v;
    return rim * exp(-f->u[best]);
}

int main(int count, char** words)
{
    ax_error error;
    ax_mesh mesh;
    ax_flattening flat;
    ax_form* form;
    if (count != 3)
        return AX_USAGE;
    if (ax_mesh_read(words[1], NULL, &mesh, NULL, &error) || ax_flatten(&mesh, NULL, &flat, &error))
        return say(&error);
    const double rim = 1.05 * exp(flat.u_max); // so that the smallest scale factor is 1.05
    double(*outline)[2] = ax_alloc((size_t)flat.rim_count, sizeof *outline);
    for (int k = 0; k < flat.rim_count; ++k)
        for (int d = 0; d < 2; ++d)
            outline[k][d] = flat.uv[flat.rim[k]][d] / rim;
    const ax_form_start start = {
        .outline_count = flat.rim_count, .outline = outline, .triangles = 600, .scale = rim, .unit = AX_METRE};
    if (ax_form_make(&start, &form, &error))
        return say(&error);
    ax_form_view view = ax_form_look(form);
    double* scale = AX_NEW(double, view.linkage->triangle_count);
    for (int t = 0; t < view.linkage->triangle_count; ++t) {
        double middle[2] = {0};
        for (int k = 0; k < 3; ++k)
            for (int d = 0; d < 2; ++d)
                middle[d] += view.sheet[view.linkage->triangles[t][k]][d] / 3;
        scale[t] = scale_at(&flat, middle, rim);
    }
    ax_form_prescribe(form, scale);
    double(*curve)[3] = ax_alloc((size_t)flat.rim_count, sizeof *curve);
    for (int k = 0; k < flat.rim_count; ++k)
        for (int d = 0; d < 3; ++d)
            curve[k][d] = mesh.positions[flat.rim[k]][d];
    int* hinges = AX_NEW(int, view.linkage->hinge_count);
    const ax_rim_part held = {
        .kind = AX_RIM_SLIDE,
        .count = ax_linkage_rim(view.linkage, hinges),
        .hinges = hinges,
        .curve = {.kind = AX_CURVE_POLYLINE,
                  .closed = true,
                  .count = flat.rim_count,
                  .points = (const double(*)[3])curve}};
    if (ax_form_set_rim(form, 1, &held, &error))
        return say(&error);
    ax_form_dynamics dynamics = ax_form_dynamics_default();
    dynamics.kind = AX_DYNAMICS_EXPAND;
    ax_form_set_dynamics(form, &dynamics);
    if (ax_form_settle(form, 0, NULL, &error))
        return say(&error);
    ax_form_report report;
    ax_form_measure(form, &report);
    printf("scale range %.4f, edges off by %.1e, holes open to %.1f %%, %s\n", exp(flat.u_max - flat.u_min),
           report.deployed_error, 100 * report.opening_mean, report.settled ? "settled" : "not settled");
    ax_design design;
    ax_form_snapshot(form, false, &design);
    if (ax_export(&design, words[2], NULL, &error))
        return say(&error);
    ax_design_free(&design);
    ax_form_report_free(&report);
    ax_form_free(form);
    ax_free(hinges);
    ax_free(curve);
    ax_free(scale);
    ax_free(outline);
    ax_flattening_free(&flat);
    ax_mesh_free(&mesh);
    return 0;
}
