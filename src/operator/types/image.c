#include "input/image.h"
#include "operator/operator.h"

typedef struct arguments {
    const char *file, *hinges;
    double black, white, lo[2], hi[2];
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.hinges = "all", .black = 1, .white = 1.9, .lo = {NAN, NAN}, .hi = {NAN, NAN}};
}

static const ax_field fields[] = {
    AX_TEXT(arguments, file, "File", .required = true, .doc = "PNG image; colours count by their brightness."),
    AX_NUMBER(arguments, black, "Black", "", 1, 2, .doc = "Scale factor where the image is black."),
    AX_NUMBER(arguments, white, "White", "", 1, 2, .doc = "Scale factor where it is white."),
    AX_VECTOR(arguments, lo, "Lower left", "length", 2, .fallback = "that of the sheet",
              .doc = "Corner of the sheet at which the image's lower left corner lies."),
    AX_VECTOR(arguments, hi, "Upper right", "length", 2, .fallback = "that of the sheet",
              .doc = "Corner at which its upper right corner lies; beyond, its edges go on."),
    AX_TEXT(arguments, hinges, "Region", .doc = "Selection it is confined to: panels all of whose hinges are chosen."),
};

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = 4;
    return a->lo[0] >= a->hi[0] || a->lo[1] >= a->hi[1] ? "\"hi\" must lie to the right of \"lo\" and above it." : NULL;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_image image;
    ax_sheet sheet;
    char* path = ax_operator_path(context, a->file);
    ax_status status = ax_image_read(path, &image, error);
    ax_free(path);
    if (status != AX_OK)
        return status;
    status = ax_sheet_take(context, a->hinges, &sheet, error);
    if (status == AX_OK) {
        const double* lo = isnan(a->lo[0]) ? sheet.lo : a->lo;
        const double* hi = isnan(a->hi[0]) ? sheet.hi : a->hi;
        for (int t = 0; t < sheet.count; ++t)
            if (sheet.chosen[t])
                sheet.scale[t] = a->black + (a->white - a->black) * ax_image_at(&image, lo, hi, sheet.centre[t]);
        ax_sheet_give(context, &sheet);
    }
    ax_image_free(&image);
    return status;
}

const ax_operator_type ax_operator_image = {
    .name = "image",
    .title = "From an image",
    .doc = "Scale factors from the brightness of a PNG image laid over the sheet.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
