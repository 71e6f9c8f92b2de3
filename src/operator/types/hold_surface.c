#include "operator/hold.h"

typedef struct arguments {
    ax_holding hold;
    const char* file;
    int up;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 1;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments, .required = true),
    AX_TEXT(arguments, file, "File", .required = true, .doc = "Mesh of the surface: OBJ, STL, PLY, OFF or another."),
    AX_UP(arguments),
    AX_HOLD_WEIGHT(arguments),
};

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    char* path = ax_operator_path(context, a->file);
    ax_read_options read = ax_read_options_default();
    read.up = (ax_up)a->up;
    ax_mesh mesh;
    ax_status status = ax_mesh_read_faces(path, &read, &mesh, error);
    ax_free(path);
    if (status != AX_OK)
        return status;
    ax_form_constraint constraint = {.kind = AX_HELD_SURFACE, .surface = &mesh};
    status = ax_hold_put(context, &a->hold, 1, &constraint, error);
    ax_mesh_free(&mesh);
    return status;
}

const ax_operator_type ax_operator_hold_surface = {
    .name = "hold_surface",
    .title = "Hold on a surface",
    .doc = "Holds hinges on a surface from a mesh file.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .settles = true,
    .apply = apply,
};
