#include "operator/start.h"

typedef struct arguments {
    const char* file;
    int triangles, unit, up, border;
    double edge, size, scale_lo, scale_hi, mouth_min, angle;
    bool project, refine;
} arguments;

static const char* const borders[] = {
    [AX_BORDER_EQUILATERAL] = "equilateral", [AX_BORDER_RELEASED] = "released", [AX_BORDER_INSIDE] = "inside"};

static void defaults(void* given)
{
    arguments* a = given;
    const ax_design_options options = ax_design_options_default();
    *a = (arguments){.triangles = options.triangles,
                     .unit = options.unit,
                     .border = options.border,
                     .scale_lo = options.target.scale_lo,
                     .scale_hi = options.target.scale_hi,
                     .mouth_min = options.mouth_min,
                     .angle = NAN};
}

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 6;
    return a->scale_lo < a->scale_hi ? NULL : "\"scale_lo\" must be less than \"scale_hi\".";
}

static const ax_field fields[] = {
    AX_TEXT(arguments, file, "File", .required = true, .doc = "Mesh of the surface: OBJ, STL, PLY, OFF or another."),
    AX_INTEGER(arguments, triangles, "Triangles", 24, 2000000,
               .doc = "Wanted number of panels, unless their edge is given."),
    AX_NUMBER(arguments, edge, "Panel edge", "length", 0, 1e9, .open = true, .fallback = "by the number of triangles",
              .doc = "Wanted mean edge of the panels."),
    AX_CHOICE(arguments, unit, "Unit", ax_unit_words, .doc = "Unit of the mesh and of every length in the recipe."),
    AX_UP(arguments),
    AX_CHOICE(arguments, border, "Border panels", borders,
              .doc = "Equilateral with hinges on the boundary curve, released from being equilateral, or whole panels "
                     "inside."),
    AX_NUMBER(arguments, scale_lo, "Smallest scale factor", "", 1, 2, .doc = "Lower end of the band of scale factors."),
    AX_NUMBER(arguments, scale_hi, "Largest scale factor", "", 1, 2, .doc = "Upper end of the band."),
    AX_NUMBER(arguments, mouth_min, "Mouth angle", "deg", 0, 59,
              .doc = "Smallest mouth angle allowed at a flat hinge: room for joints and the saw."),
    AX_NUMBER(arguments, angle, "Lattice angle", "deg", -360, 360, .fallback = "searched for the best rim",
              .doc = "Direction of the lattice rows against the x axis of the flattened surface."),
    AX_FLAG(arguments, refine, "Refine",
            .doc =
                "Divide and round the surface until its facets are half as wide as the panels: wide flat facets carry "
                "no load."),
    AX_FLAG(arguments, project, "Project",
            .doc = "If the surface is not dome-like everywhere, design for the nearest one that is."),
    AX_NUMBER(arguments, size, "Size", "length", 0, 1e9, .open = true, .fallback = "as in the file",
              .doc = "Scale the surface until the longest of its extents is this."),
};

// While the design is solved the form is that of the state at hand, for whoever looks when progress is reported.
typedef struct viewing {
    const ax_operator_context* context;
    ax_form *before, *form;
} viewing;

static void look(void* context, const ax_design* so_far)
{
    viewing* v = context;
    ax_form_free(v->form);
    *v->context->form = ax_form_from_design(so_far, &v->form, NULL) == AX_OK ? v->form : v->before;
}

static void end_viewing(viewing* v)
{
    ax_form_free(v->form);
    *v->context->form = v->before;
}

static ax_status design_for(const arguments* a, const char* path, const ax_progress* progress,
                            const ax_design_watch* watch, ax_design* design, ax_error* error)
{
    ax_design_options options = ax_design_options_default();
    options.triangles = a->triangles;
    options.edge = a->edge;
    options.target.scale_lo = a->scale_lo;
    options.target.scale_hi = a->scale_hi;
    options.mouth_min = a->mouth_min;
    options.border = (ax_border)a->border;
    options.angle_given = !isnan(a->angle);
    options.angle = options.angle_given ? a->angle : 0;
    options.project = a->project;
    options.unit = (ax_unit)a->unit;
    options.load.kind = AX_LOAD_NONE; // "gravity" and "inflation" deploy it
    options.watch = watch;
    ax_read_options read = ax_read_options_default();
    read.up = (ax_up)a->up;
    ax_mesh mesh;
    ax_status status = ax_mesh_read(path, &read, &mesh, NULL, error);
    if (status == AX_OK) {
        if (a->size > 0)
            ax_mesh_resize(&mesh, a->size);
        if (a->refine)
            ax_design_refine_target(&mesh, &options);
        status = ax_design_from_target(&mesh, &options, progress, design, error);
        ax_mesh_free(&mesh);
    }
    return status;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    char* path = ax_operator_path(context, a->file);
    ax_design design = {0};
    ax_form* form = NULL;
    viewing v = {.context = context, .before = *context->form};
    const ax_design_watch watch = {.look = look, .context = &v};
    ax_status status = design_for(a, path, context->progress, context->progress ? &watch : NULL, &design, error);
    end_viewing(&v);
    if (status == AX_OK)
        status = ax_form_from_design(&design, &form, error);
    if (status == AX_OK) {
        ax_form_free(*context->form);
        *context->form = form;
    }
    ax_design_free(&design);
    ax_free(path);
    return status;
}

const ax_operator_type ax_operator_start_target = {
    .name = "start_target",
    .title = "Start from a surface",
    .doc = "The linkage that opens into a target surface, as the command `design` makes it; its rim slides on the "
           "surface's boundary.",
    .group = "start",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .starts = true,
    .apply = apply,
};
