#include "operator/selection.h"

typedef struct arguments {
    const char *file, *name;
    int up;
    double clearance, scale, at[3];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->name = "site";
    a->scale = 1;
}

static const ax_field fields[] = {
    AX_TEXT(arguments, file, "File", .required = true, .doc = "Mesh of the geometry: OBJ, DXF, STL, PLY or another."),
    AX_TEXT(arguments, name, "Name", .doc = "Name by which the report calls it; one of this name is replaced."),
    AX_NUMBER(arguments, clearance, "Clearance", "length", 0, 1e9, .doc = "Distance that the shell must keep."),
    AX_NUMBER(arguments, scale, "Scale", "", 0, 1e9, .open = true,
              .doc = "Factor from the file's unit to the document's."),
    AX_UP(arguments),
    AX_VECTOR(arguments, at, "Origin", "length", 3, .doc = "Where the file's origin lies."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 1;
    return ax_is_name(a->name) ? NULL : ax_no_name;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    char* path = ax_operator_path(context, a->file);
    ax_read_options read = ax_read_options_default();
    read.up = (ax_up)a->up;
    ax_mesh mesh;
    ax_status status = ax_mesh_read_faces(path, &read, &mesh, error);
    if (status == AX_OK) {
        for (int v = 0; v < mesh.vertex_count; ++v)
            for (int d = 0; d < 3; ++d)
                mesh.positions[v][d] = a->at[d] + a->scale * mesh.positions[v][d];
        ax_form_put_underlay(*context->form, a->name, &mesh, a->clearance);
        ax_mesh_free(&mesh);
    }
    ax_free(path);
    return status;
}

const ax_operator_type ax_operator_underlay = {
    .name = "underlay",
    .title = "Underlay",
    .doc = "Reference geometry of the site, such as a room or a column, from which the deployed shell must keep a "
           "distance; the report tells where it does not.",
    .group = "site",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .apply = apply,
};
