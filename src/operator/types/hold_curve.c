#include "operator/hold.h"

enum { LINE, CIRCLE, POLYLINE, SPLINE };
static const char* const curves[] = {
    [LINE] = "line", [CIRCLE] = "circle", [POLYLINE] = "polyline", [SPLINE] = "spline"};

typedef struct arguments {
    ax_holding hold;
    int curve;
    ax_points points;
    bool closed;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hold.weight = 1;
    a->curve = SPLINE;
}

static const ax_field fields[] = {
    AX_HOLD_NAME(arguments),
    AX_HOLD_HINGES(arguments, .required = true),
    AX_CHOICE(arguments, curve, "Curve", curves,
              .doc = "A line through two points, a circle through three, a polyline with these corners, or a spline."),
    AX_POINTS(arguments, points, "Points", 3, 2, .hi = 10000, .required = true,
              .doc = "Points of the curve, in order."),
    AX_FLAG(arguments, closed, "Closed",
            .doc = "Whether the last point of a polyline or spline is joined to the first."),
    AX_HOLD_WEIGHT(arguments),
    AX_HOLD_SUPPORT(arguments),
};

// Centre, normal and (radius, 0, 0) of the circle through three points; false if they lie on a line.
static bool find_circle(double (*p)[3], double shape[3][3])
{
    double u[3], v[3], n[3], to[3], w[3];
    ax_sub3(p[1], p[0], u);
    ax_sub3(p[2], p[0], v);
    ax_cross(u, v, n);
    double area2 = ax_dot3(n, n), uu = ax_dot3(u, u), vv = ax_dot3(v, v);
    if (!(area2 > 1e-16 * uu * vv))
        return false;
    for (int d = 0; d < 3; ++d)
        w[d] = uu * v[d] - vv * u[d];
    ax_cross(w, n, to);
    for (int d = 0; d < 3; ++d) {
        shape[0][d] = p[0][d] + to[d] / (2 * area2);
        shape[1][d] = n[d] / sqrt(area2);
        shape[2][d] = d == 0 ? ax_norm3(to) / (2 * area2) : 0;
    }
    return true;
}

static const char* check(const void* given, int* field)
{
    const arguments* a = given;
    static const int counts[] = {[LINE] = 2, [CIRCLE] = 3};
    *field = 3;
    if (a->curve <= CIRCLE && a->points.count != counts[a->curve])
        return a->curve == LINE ? "a line takes two points." : "a circle takes three points.";
    if (a->closed && a->points.count < 3)
        return "a closed curve needs three points.";
    double(*points)[3] = (double(*)[3])a->points.values, shape[3][3];
    if (a->curve == LINE && ax_distance3(points[0], points[1]) == 0)
        return "the two points of a line must differ.";
    return a->curve == CIRCLE && !find_circle(points, shape) ? "the three points of a circle must not be on a line."
                                                             : NULL;
}

static ax_status apply(const ax_operator_context* context, const void* given, ax_error* error)
{
    const arguments* a = given;
    static const ax_curve_kind kinds[] = {AX_CURVE_LINE, AX_CURVE_CIRCLE, AX_CURVE_POLYLINE, AX_CURVE_SPLINE};
    double(*points)[3] = (double(*)[3])a->points.values, shape[3][3];
    ax_form_constraint constraint = {.kind = AX_HELD_CURVE,
                                     .curve = {.kind = kinds[a->curve],
                                               .closed = a->closed,
                                               .count = a->points.count,
                                               .points = (const double(*)[3])points}};
    if (a->curve == CIRCLE)
        find_circle(points, shape);
    if (a->curve == LINE) {
        memcpy(shape[0], points[0], sizeof shape[0]);
        ax_sub3(points[1], points[0], shape[1]);
    }
    if (a->curve <= CIRCLE)
        constraint.curve.points = (const double(*)[3])shape;
    return ax_hold_put(context, &a->hold, 1, &constraint, error);
}

const ax_operator_type ax_operator_hold_curve = {
    .name = "hold_curve",
    .title = "Hold on a curve",
    .doc = "Holds hinges on a curve in space: a line, circle, polyline or spline through points.",
    .group = "constraint",
    .fields = fields,
    .field_count = AX_COUNT(fields),
    .size = sizeof(arguments),
    .defaults = defaults,
    .check = check,
    .settles = true,
    .apply = apply,
};
