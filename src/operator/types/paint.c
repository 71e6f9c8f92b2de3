#include "operator/brush.h"
#include "operator/scale_field.h"

enum { SET, ADD, SUBTRACT, SMOOTH };
static const char* const modes[] = {[SET] = "set", [ADD] = "add", [SUBTRACT] = "subtract", [SMOOTH] = "smooth"};

typedef struct arguments {
    ax_brush brush;
    double value, strength;
    int mode;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    *a = (arguments){.brush = ax_brush_default(), .value = NAN, .strength = 1};
}

static const ax_field fields[] = {
    AX_CHOICE(arguments, mode, "Mode", modes,
              .doc = "Set to the value, add it, subtract it, or smooth what is there over a quarter of the radius."),
    AX_NUMBER(arguments, value, "Value", "", 0, 2, .fallback = "none",
              .doc = "Scale factor to set, 1 to 2, or how much to add or subtract."),
    AX_NUMBER(arguments, strength, "Strength", "", 0, 1, .doc = "Share of the change that is made."),
    AX_BRUSH_FIELDS(arguments),
};
enum { VALUE_FIELD = 1 };

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    *field = VALUE_FIELD;
    if (a->mode != SMOOTH && isnan(a->value))
        return "\"value\" is needed to set, add or subtract.";
    if (a->mode == SET && a->value < 1)
        return "\"value\" is the scale factor to set, 1 to 2.";
    return NULL;
}

// The scale factor that a panel is drawn towards.
static double goal(const arguments* a, double present, double smoothed)
{
    switch (a->mode) {
    case SET:
        return a->value;
    case ADD:
        return fmin(present + a->value, 2);
    case SUBTRACT:
        return fmax(present - a->value, 1);
    default:
        return exp(smoothed);
    }
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    ax_sheet sheet;
    double* distance;
    ax_status status = ax_brush_take(context, &a->brush, &sheet, &distance, error);
    if (status != AX_OK)
        return status;
    double* smoothed = AX_NEW(double, sheet.count);
    for (int t = 0; t < sheet.count; ++t)
        smoothed[t] = log(sheet.scale[t]);
    if (a->mode == SMOOTH)
        ax_field_smooth(sheet.linkage, sheet.spacing, sheet.chosen, a->brush.radius / 4, smoothed);
    for (int t = 0; t < sheet.count; ++t) {
        double from = sheet.scale[t], to = goal(a, from, smoothed[t]);
        double share = a->strength * ax_falloff_share((ax_falloff)a->brush.falloff, distance[t], from, to);
        sheet.scale[t] = from * exp(share * log(to / from)); // ln lambda is what bends
    }
    ax_sheet_give(context, &sheet);
    ax_free(smoothed);
    ax_free(distance);
    return AX_OK;
}

const ax_operator_type ax_operator_paint = {
    .name = "paint",
    .title = "Paint",
    .doc = "Paints scale factors with a brush: within the radius of the stroke they are set, raised, lowered or evened "
           "out.",
    .group = "scale",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
