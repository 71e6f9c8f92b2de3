// Readers of drawings, formulas, tables and images: right values from sound files, and from others a message that tells the place.
#include "base/random.h"
#include "base/vec.h"
#include "input/formula.h"
#include "input/image.h"
#include "input/outline.h"
#include "input/table.h"
#include "support/sample.h"
#include "support/test.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void assert_says(const ax_error* error, const char* words)
{
    if (!strstr(error->message, words))
        fail_msg("\"%s\" does not say \"%s\"", error->message, words);
}

// ---- formulas ---------------------------------------------------------------------------------------------------------------

static const char* const names[] = {"x", "y", "r", "lambda"};

static double value(const char* text, double x, double y)
{
    ax_formula* formula;
    ax_error error;
    if (ax_formula_parse(text, 4, names, &formula, &error) != AX_OK)
        fail_msg("%s: %s", text, error.message);
    double result = ax_formula_value(formula, (double[]){x, y, hypot(x, y), 1.5});
    ax_formula_free(formula);
    return result;
}

static void formulas_have_the_values_of_mathematics(void** state)
{
    (void)state;
    static const struct {
        const char* text;
        double value; // at x = 0.3, y = -0.4
    } cases[] = {
        {"1.3 + 0.4*exp(-(x^2+y^2)/0.5)", 1.3 + 0.4 * 0.60653065971263342}, // exp(-1/2)
        {"-x^2", -0.09},
        {"2^3^2", 512},
        {"2^-1", 0.5},
        {"1-2-3", -4},
        {"8/4/2", 1},
        {"2+3*4", 14},
        {"(2+3)*4", 20},
        {"r", 0.5},
        {"lambda * 2", 3},
        {".5e1", 5},
        {"x < 0.3", 0},
        {"x <= 0.3", 1},
        {"x != 0.3 || y < 0", 1},
        {"x > 0 && y > 0", 0},
        {"!x + 1", 1},
        {"x > 0 ? 10 : y > 0 ? 20 : 30", 10},
        {"x < 0 ? 10 : y > 0 ? 20 : 30", 30},
        {"if(y < 0, 7, 1/0)", 7},
        {"min(3, 1, 2) + max(3, 1, 2)", 4},
        {"clamp(5, 1, 2)", 2},
        {"mod(-1, 3)", 2},
        {"cos(pi)", -1},
        {"atan2(1, 1) * 4", 3.14159265358979312},
        {"smoothstep(0, 2, 1)", 0.5},
        {"step(0.5, 0.5)", 1},
        {"sqrt(2)^2 - 2", 4.4408920985006262e-16},
        {"hypot(3, 4)", 5},
        {"sign(-3) + round(2.5) + floor(-0.5) + ceil(0.2)", 2},
        {"\t1 +\n 1 ", 2},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        double got = value(cases[k].text, 0.3, -0.4);
        if (!(fabs(got - cases[k].value) <= 1e-15 * fmax(1, fabs(cases[k].value))))
            fail_msg("%s is %.17g, not %.17g", cases[k].text, got, cases[k].value);
    }
    assert_true(isnan(value("log(-1)", 0, 0)));
    assert_true(isinf(value("1/x", 0, 0)));
}

static void wrong_formulas_are_told_by_column(void** state)
{
    (void)state;
    static const struct {
        const char *text, *column, *what;
    } cases[] = {
        {"", "column 1", "number"},
        {"1 +", "column 4", "number"},
        {"1 + z", "column 5", "x, y, r, lambda"},
        {"sin x", "column 5", "parenthes"},
        {"(1", "column 3", "closed"},
        {"1 2", "column 3", "operator"},
        {"exp(1,2)", "column 1", "argument"},
        {"min(1)", "column 1", "2 argument"},
        {"1 < 2 < 3", "column 7", "chain"},
        {"x ? 1", "column 6", "colon"},
        {"0x10", "column 2", "operator"},
        {"1..2", "column 3", "operator"},
        {"a = 3", "column 1", "no such"},
        {"x = 3", "column 3", "operator"},
        {"inf", "column 1", "no such"},
        {"xx", "column 1", "no such"},
        {"system(\"ls\")", "column 1", "no such"},
        {"1 + expp(x)", "column 5", "did you mean exp;"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ax_formula* formula;
        ax_error error = {0};
        assert_int_equal(ax_formula_parse(cases[k].text, 4, names, &formula, &error), AX_BAD_INPUT);
        assert_null(formula);
        assert_says(&error, cases[k].column);
        assert_says(&error, cases[k].what);
    }
}

static void formulas_are_bounded(void** state)
{
    (void)state;
    static const char* const nests[] = {"(", "-", "sin(", "1+(", "2^", "1?1:", "!", "min(1,", "1<(1+1*("};
    for (size_t n = 0; n < sizeof nests / sizeof *nests; ++n) {
        char text[AX_FORMULA_LENGTH + 1] = "";
        size_t used = 0;
        while (used + strlen(nests[n]) <= AX_FORMULA_LENGTH)
            strcpy(text + used, nests[n]), used += strlen(nests[n]);
        ax_formula* formula;
        ax_error error = {0};
        assert_int_equal(ax_formula_parse(text, 4, names, &formula, &error), AX_BAD_INPUT);
        assert_says(&error, "nested too deeply");
    }
    char longer[AX_FORMULA_LENGTH + 2];
    memset(longer, '1', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    ax_formula* formula;
    ax_error error;
    assert_int_equal(ax_formula_parse(longer, 4, names, &formula, &error), AX_BAD_INPUT);
    assert_says(&error, "4097 characters");
}

// ---- drawings ---------------------------------------------------------------------------------------------------------------

static ax_outline outline_of(const char* text, double unit, double tolerance)
{
    ax_outline outline;
    ax_error error;
    if (ax_outline_parse("a.svg", text, strlen(text), unit, tolerance, &outline, &error) != AX_OK)
        fail_msg("%s", error.message);
    return outline;
}

static void assert_refused_drawing(const char* text, const char* line, const char* what)
{
    ax_outline outline;
    ax_error error = {0};
    if (ax_outline_parse("a.svg", text, strlen(text), 1, 0, &outline, &error) != AX_BAD_INPUT)
        fail_msg("accepted: %s", text);
    assert_int_equal(outline.count, 0);
    assert_says(&error, "a.svg");
    assert_says(&error, line);
    assert_says(&error, what);
}

static double area_of(const ax_outline_curve* curve)
{
    double area = 0;
    for (int k = 0; k < curve->count; ++k)
        area += ax_cross2(curve->points[k], curve->points[(k + 1) % curve->count]) / 2;
    return area;
}

static void bounds_of(const ax_outline_curve* curve, double lo[2], double hi[2])
{
    for (int d = 0; d < 2; ++d) {
        lo[d] = INFINITY, hi[d] = -INFINITY;
        for (int k = 0; k < curve->count; ++k)
            lo[d] = fmin(lo[d], curve->points[k][d]), hi[d] = fmax(hi[d], curve->points[k][d]);
    }
}

static void assert_box(const ax_outline_curve* curve, double x0, double y0, double x1, double y1, double tolerance)
{
    double lo[2], hi[2];
    bounds_of(curve, lo, hi);
    assert_near(lo[0], x0, tolerance);
    assert_near(lo[1], y0, tolerance);
    assert_near(hi[0], x1, tolerance);
    assert_near(hi[1], y1, tolerance);
}

#define SVG(attributes, content) "<svg xmlns=\"http://www.w3.org/2000/svg\" " attributes ">" content "</svg>"

static void shapes_of_svg_have_their_area_and_place(void** state)
{
    (void)state;
    const double eps = 1e-5;
    static const struct {
        const char* shape;
        double area, box[4]; // y up: the page is 10 high
    } cases[] = {
        {"<rect x='1' y='2' width='4' height='3'/>", 12, {1, 5, 5, 8}},
        {"<rect x='1' y='2' width='4' height='3' rx='1'/>", 12 - 4 + M_PI, {1, 5, 5, 8}},
        {"<rect width='4' height='4' rx='9' ry='1'/>", 16 - (8 - 2 * M_PI), {0, 6, 4, 10}},
        {"<circle cx='5' cy='5' r='2'/>", 4 * M_PI, {3, 3, 7, 7}},
        {"<ellipse cx='5' cy='5' rx='3' ry='1'/>", 3 * M_PI, {2, 4, 8, 6}},
        {"<polygon points='0,0 4,0 4,3'/>", 6, {0, 7, 4, 10}},
        {"<path d='M1 1h4v3h-4z'/>", 12, {1, 6, 5, 9}},
        {"<path d='m1,1 4,0 0,3-4,0z'/>", 12, {1, 6, 5, 9}},
        {"<path d='M1 1 5 1 5 4 1 4 1 1'/>", 12, {1, 6, 5, 9}}, // closed by coming back
        {"<path d='M0 5A5 5 0 0 0 10 5A5 5 0 0 0 0 5z'/>", 25 * M_PI, {0, 0, 10, 10}},
        {"<path d='M0 5a5 5 0 1010 0 5 5 0 01-10 0z'/>", 0, {0, 0, 10, 5}}, // flags run together; there and back
        {"<path d='M3 3A1 1 0 0 0 7 7A1 1 0 0 0 3 3z'/>",
         8 * M_PI,
         {5 - 2.8284271247461903, 5 - 2.8284271247461903, 5 + 2.8284271247461903,
          5 + 2.8284271247461903}}, // radii too small
        {"<path d='M0 10C0 0 10 0 10 10z'/>", 60, {0, 0, 10, 7.5}},
        {"<path d='M0 10Q5 0 10 10z'/>", 100 / 3.0, {0, 0, 10, 5}},
        {"<path d='M0 5Q2.5 0 5 5T10 5z'/>", 0, {0, 2.5, 10, 7.5}},
        {"<g transform='translate(5,5) rotate(90)'><rect width='4' height='2'/></g>", 8, {3, 1, 5, 5}},
        {"<rect transform='matrix(1 0 0 1 1 1) scale(2)' width='2' height='1'/>", 8, {1, 7, 5, 9}},
        {"<rect transform='rotate(45 5 5)' x='4' y='4' width='2' height='2'/>",
         4,
         {5 - M_SQRT2, 5 - M_SQRT2, 5 + M_SQRT2, 5 + M_SQRT2}},
        {"<rect transform='skewX(45)' width='2' height='2'/>", 4, {0, 8, 4, 10}},
        {"<ellipse transform='scale(1 3)' cx='5' cy='2' rx='3' ry='1'/>", 9 * M_PI, {2, 1, 8, 7}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[600];
        snprintf(text, sizeof text, SVG("viewBox='0 0 10 10'", "%s"), cases[k].shape);
        ax_outline outline = outline_of(text, 1, eps);
        if (outline.count != 1 || !outline.curves[0].closed)
            fail_msg("%s: %d curves", cases[k].shape, outline.count);
        const ax_outline_curve* c = &outline.curves[0];
        if (!(fabs(fabs(area_of(c)) - cases[k].area) <= 40 * eps))
            fail_msg("%s: area %.9g, not %.9g", cases[k].shape, area_of(c), cases[k].area);
        assert_box(c, cases[k].box[0], cases[k].box[1], cases[k].box[2], cases[k].box[3], 2 * eps);
        ax_outline_free(&outline);
    }
}

static void assert_same_curves(const char* a, const char* b)
{
    char text[2][600];
    snprintf(text[0], sizeof text[0], SVG("", "<path d='%s'/>"), a);
    snprintf(text[1], sizeof text[1], SVG("", "<path d='%s'/>"), b);
    ax_outline x = outline_of(text[0], 1, 1e-3), y = outline_of(text[1], 1, 1e-3);
    assert_int_equal(x.count, y.count);
    for (int c = 0; c < x.count; ++c) {
        assert_int_equal(x.curves[c].count, y.curves[c].count);
        assert_int_equal(x.curves[c].closed, y.curves[c].closed);
        for (int k = 0; k < x.curves[c].count; ++k)
            assert_near(ax_distance2(x.curves[c].points[k], y.curves[c].points[k]), 0, 1e-12);
    }
    ax_outline_free(&x);
    ax_outline_free(&y);
}

static void path_commands_mean_what_the_standard_says(void** state)
{
    (void)state;
    assert_same_curves("M0 0C1 2 3 4 5 0S9 -4 9 0", "M0 0C1 2 3 4 5 0C7-4 9-4 9 0");
    assert_same_curves("M0 0L5 0S9 4 9 0", "M0 0L5 0C5 0 9 4 9 0"); // no cubic before: the control point is where it is
    assert_same_curves("M0 0Q1 2 3 0T6 0T9 0", "M0 0Q1 2 3 0Q5-2 6 0Q7 2 9 0");
    assert_same_curves("M0 0Q3 6 6 0", "M0 0C2 4 4 4 6 0");
    assert_same_curves("M1 1c1 2 3 4 5 0s4-4 4 0q1 2 3 0t3 0a1 2 30 0 1 1 1h3v2l1 1",
                       "M1 1C2 3 4 5 6 1S10 -3 10 1Q11 3 13 1T16 1A1 2 30 0 1 17 2H20V4L21 5");
    assert_same_curves("M0 0h1v1zl-2-2-1 0z", "M0 0L1 0L1 1ZM0 0L-2-2L-3-2Z");
    assert_same_curves("M1 1 2 2m3 3 1 0", "M1 1L2 2M5 5L6 5");
    assert_same_curves("M0 0A0 3 0 0 1 2 2", "M0 0L2 2"); // no radius: a line
    assert_same_curves("M.5.5.6-1e0", "M0.5 0.5L0.6 -1");
}

static void chords_stay_within_the_tolerance(void** state)
{
    (void)state;
    for (double tolerance = 1e-1; tolerance > 1e-6; tolerance /= 10) {
        ax_outline o = outline_of(SVG("", "<circle r='3'/>"), 1, tolerance);
        const ax_outline_curve* c = &o.curves[0];
        for (int k = 0; k < c->count; ++k) {
            const double *a = c->points[k], *b = c->points[(k + 1) % c->count];
            assert_near(hypot(a[0], a[1]), 3, 1e-14);
            assert_at_most(3 - hypot((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), tolerance);
        }
        assert_true(c->count < 20 + 8 / sqrt(tolerance)); // and not for nothing
        ax_outline_free(&o);
    }
    ax_outline o = outline_of(SVG("", "<circle r='3'/>"), 1, 0);
    assert_at_most(o.curves[0].count, 400);
    ax_outline_free(&o);
}

static void units_of_svg_become_those_of_the_document(void** state)
{
    (void)state;
    static const struct {
        const char* page;
        double unit, side; // of a square of 10 user units
    } cases[] = {
        {"viewBox='0 0 100 100'", 1, 10},
        {"width='100' height='100' viewBox='0 0 50 50'", 1e-3, 10},
        {"width='100%' height='100%' viewBox='0 0 50 50'", 1e-3, 10},
        {"width='200mm' height='200mm' viewBox='0 0 100 100'", 1e-3, 20},
        {"width='200mm' height='200mm' viewBox='0 0 100 100'", 1, 0.020},
        {"width='20cm' viewBox='0 0 100 100'", 1e-2, 2},
        {"height='10in' viewBox='0 0 100 100'", 1e-3, 25.4},
        {"width='96px' viewBox='0 0 10 10'", 1e-3, 25.4},
        {"width='72pt' height='1in' viewBox='0 0 10 10'", 1e-3, 25.4},
        {"width='100mm' height='100mm'", 1e-3, 10 * 25.4 / 96},
        {"width='200mm' height='100mm' viewBox='0 0 100 100'", 1e-3, 10}, // meets the page
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[300];
        snprintf(text, sizeof text, SVG("%s", "<rect x='3' y='4' width='10' height='10'/>"), cases[k].page);
        ax_outline o = outline_of(text, cases[k].unit, 0);
        double lo[2], hi[2];
        bounds_of(&o.curves[0], lo, hi);
        assert_near(hi[0] - lo[0], cases[k].side, 1e-12 * cases[k].side);
        assert_near(hi[1] - lo[1], cases[k].side, 1e-12 * cases[k].side);
        ax_outline_free(&o);
    }
    ax_outline o = outline_of(SVG("width='30mm' height='10mm' viewBox='0 0 30 20' preserveAspectRatio='none'",
                                  "<rect width='10mm' height='10'/>"),
                              1e-3, 0);
    assert_box(&o.curves[0], 0, 5, 10 * 96 / 25.4, 10, 1e-12);
    ax_outline_free(&o);
}

static void curves_have_names_and_lines(void** state)
{
    (void)state;
    ax_outline o =
        outline_of("<?xml version='1.0'?>\n<svg:svg xmlns:svg='http://www.w3.org/2000/svg' xmlns:i='urn:i' id='page'>\n"
                   "<i:path d='M0 0L1 1'/><svg:defs><svg:rect width='9' height='9'/></svg:defs>\n"
                   "<svg:g id='walls'><svg:rect id='hall' width='2' height='2'/>\n<svg:circle r='3'/></svg:g>\n"
                   "<svg:g display='none'><svg:rect width='9' height='9'/></svg:g><svg:rect style='fill:red;display: "
                   "none' width='9' height='9'/>\n"
                   "<svg:path d='M0 0H1M0 5H7'/></svg:svg>",
                   1, 0);
    assert_int_equal(o.count, 4);
    assert_string_equal(o.curves[0].name, "hall");
    assert_int_equal(o.curves[0].line, 4);
    assert_string_equal(o.curves[1].name, "walls");
    assert_int_equal(o.curves[1].line, 5);
    assert_string_equal(o.curves[2].name, "");
    assert_int_equal(ax_outline_find(&o, "walls", true), 1);
    assert_int_equal(ax_outline_find(&o, "walls", false), -1);
    assert_int_equal(ax_outline_find(&o, NULL, true), 1);
    assert_int_equal(ax_outline_find(&o, "", false), 3);
    ax_outline_free(&o);
}

static void touching_pieces_become_one_curve(void** state)
{
    (void)state;
    // a square of four lines, each drawn in its own direction; a cross, whose ends nobody can order; a pair of lines
    ax_outline o = outline_of(SVG("", "<line x1='0' y1='0' x2='4' y2='0'/><line x1='4' y1='4' x2='4' y2='0.0001'/>"
                                      "<line x1='4' y1='4' x2='0' y2='4'/><polyline points='0,0 0,4'/>"
                                      "<path d='M10 10l1 0M10 10l0 1M10 10l-1 0'/><path d='M20 0h1M22 1L21 0'/>"),
                              1, 1e-3);
    assert_int_equal(o.count, 5);
    assert_true(o.curves[0].closed);
    assert_int_equal(o.curves[0].count, 4);
    assert_near(fabs(area_of(&o.curves[0])), 16, 1e-3);
    assert_near(o.curves[0].points[1][0], 4, 0); // runs as its first piece does
    for (int c = 1; c < 4; ++c) {
        assert_false(o.curves[c].closed);
        assert_int_equal(o.curves[c].count, 2);
    }
    assert_int_equal(o.curves[4].count, 3);
    ax_outline_free(&o);

    // many pieces in a shuffled order
    enum { pieces = 20000 };
    ax_random random = {7};
    int* order = malloc(pieces * sizeof *order);
    for (int k = 0; k < pieces; ++k)
        order[k] = k;
    for (int k = pieces - 1; k > 0; --k) {
        int other = (int)(ax_random_bits(&random) % (unsigned)(k + 1)), kept = order[k];
        order[k] = order[other], order[other] = kept;
    }
    char* text = malloc(pieces * 80 + 200);
    int used = sprintf(text, "<svg xmlns='http://www.w3.org/2000/svg'><path d='");
    for (int k = 0; k < pieces; ++k) {
        double a = 2 * M_PI * order[k] / pieces, b = 2 * M_PI * (order[k] + 1) / pieces, turned = order[k] % 2;
        used += sprintf(text + used, "M%.9f %.9fL%.9f %.9f", cos(turned ? a : b), sin(turned ? a : b),
                        cos(turned ? b : a), sin(turned ? b : a));
    }
    sprintf(text + used, "'/></svg>");
    o = outline_of(text, 1, 1e-6);
    assert_int_equal(o.count, 1);
    assert_true(o.curves[0].closed);
    assert_int_equal(o.curves[0].count, pieces);
    assert_near(fabs(area_of(&o.curves[0])), M_PI, 1e-6);
    ax_outline_free(&o);
    free(text);
    free(order);
}

// Groups written as "code value" on one line each.
static char* dxf(const char* head, const char* groups)
{
    static char text[8192];
    int used = snprintf(text, sizeof text, "  0\nSECTION\n  2\nHEADER\n%s  0\nENDSEC\n0\nSECTION\n2\nENTITIES\n", head);
    while (*groups) {
        int code, length = (int)strcspn(groups, "\n"), after;
        sscanf(groups, "%d%n", &code, &after);
        used += snprintf(text + used, sizeof text - (size_t)used, "%3d\r\n%.*s\r\n", code, length - after - 1,
                         groups + after + 1);
        groups += length + 1;
    }
    snprintf(text + used, sizeof text - (size_t)used, "  0\nENDSEC\n  0\nEOF\n");
    return text;
}

static void entities_of_dxf_have_their_area_and_place(void** state)
{
    (void)state;
    const double eps = 1e-5;
    static const struct {
        const char* entity;
        double area, box[4];
    } cases[] = {
        {"0 CIRCLE\n8 hall\n10 5\n20 6\n40 2\n", 4 * M_PI, {3, 4, 7, 8}},
        {"0 LWPOLYLINE\n90 4\n70 1\n10 0\n20 0\n10 4\n20 0\n10 4\n20 3\n10 0\n20 3\n", 12, {0, 0, 4, 3}},
        {"0 LWPOLYLINE\n90 2\n70 1\n10 0\n20 0\n42 1\n10 4\n20 0\n42 1\n", 4 * M_PI, {0, -2, 4, 2}},
        {"0 LWPOLYLINE\n70 1\n10 0\n20 0\n42 0.414213562373095\n10 2\n20 2\n10 0\n20 2\n", M_PI, {0, 0, 2, 2}},
        {"0 LWPOLYLINE\n70 1\n230 -1\n10 0\n20 0\n42 0.414213562373095\n10 2\n20 2\n10 0\n20 2\n", M_PI, {-2, 0, 0, 2}},
        {"0 POLYLINE\n66 1\n70 1\n8 a\n0 VERTEX\n10 0\n20 0\n0 VERTEX\n10 4\n20 0\n42 1\n0 VERTEX\n10 4\n20 2\n0 "
         "VERTEX\n10 0\n20 2\n0 SEQEND\n",
         8 + M_PI / 2,
         {0, 0, 5, 2}},
        {"0 ELLIPSE\n10 5\n20 5\n11 0\n21 3\n40 0.5\n41 0\n42 6.28318530717959\n", 4.5 * M_PI, {3.5, 2, 6.5, 8}},
        {"0 ELLIPSE\n10 0\n20 0\n11 2\n21 0\n40 0.5\n41 0\n42 3.14159265358979\n0 LINE\n10 -2\n20 0\n11 2\n21 0\n",
         M_PI,
         {-2, 0, 2, 1}},
        {"0 ARC\n10 0\n20 0\n40 1\n50 270\n51 90\n0 LINE\n10 0\n20 1\n11 0\n21 -1\n", M_PI / 2, {0, -1, 1, 1}},
        {"0 ARC\n10 0\n20 0\n40 1\n50 270\n51 90\n230 -1\n0 LINE\n10 0\n20 1\n11 0\n21 -1\n", M_PI / 2, {-1, -1, 0, 1}},
        // a rational quadratic whose four arcs make a circle
        {"0 SPLINE\n70 12\n71 2\n72 12\n73 9\n40 0\n40 0\n40 0\n40 1\n40 1\n40 2\n40 2\n40 3\n40 3\n40 4\n40 4\n40 4\n"
         "41 1\n41 0.707106781186548\n41 1\n41 0.707106781186548\n41 1\n41 0.707106781186548\n41 1\n41 "
         "0.707106781186548\n41 1\n"
         "10 1\n20 0\n10 1\n20 1\n10 0\n20 1\n10 -1\n20 1\n10 -1\n20 0\n10 -1\n20 -1\n10 0\n20 -1\n10 1\n20 -1\n10 "
         "1\n20 0\n",
         M_PI,
         {-1, -1, 1, 1}},
        // one cubic, as a B-spline: the one of the SVG test
        {"0 SPLINE\n71 3\n40 0\n40 0\n40 0\n40 0\n40 7\n40 7\n40 7\n40 7\n10 0\n20 0\n10 0\n20 10\n10 10\n20 10\n10 "
         "10\n20 0\n"
         "0 LINE\n10 0\n20 0\n11 10\n21 0\n",
         60,
         {0, 0, 10, 7.5}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ax_outline o = outline_of(dxf("", cases[k].entity), 1, eps);
        if (o.count != 1 || !o.curves[0].closed)
            fail_msg("%s: %d curves", cases[k].entity, o.count);
        if (!(fabs(fabs(area_of(&o.curves[0])) - cases[k].area) <= 40 * eps))
            fail_msg("%s: area %.9g, not %.9g", cases[k].entity, area_of(&o.curves[0]), cases[k].area);
        const double* box = cases[k].box;
        assert_box(&o.curves[0], box[0], box[1], box[2], box[3], 2 * eps);
        ax_outline_free(&o);
    }
    ax_outline o = outline_of(dxf("9\n$INSUNITS\n70\n5\n", cases[0].entity), 1, 0); // centimetres
    assert_box(&o.curves[0], 0.03, 0.04, 0.07, 0.08, 1e-5);
    assert_string_equal(o.curves[0].name, "hall");
    ax_outline_free(&o);
    // a spline without weights counts as one with ones; what lies on paper does not count
    o = outline_of(dxf("", "0 LINE\n67 1\n10 0\n20 0\n11 9\n21 9\n0 TEXT\n1 hello\n0 LINE\n10 0\n20 0\n11 1\n21 1\n"),
                   1, 0);
    assert_int_equal(o.count, 1);
    assert_box(&o.curves[0], 0, 0, 1, 1, 0);
    ax_outline_free(&o);
}

static void broken_drawings_are_told_by_line(void** state)
{
    (void)state;
    assert_refused_drawing("<svg>\n<rect></svg>", "line 2", "XML is broken");
    assert_refused_drawing("<html>\n</html>", "line 1", "no SVG");
    assert_refused_drawing(SVG("", "\n\n<path d='M0 0L1'/>"), "line 3", "character 5");
    assert_refused_drawing(SVG("", "<path d='L1 1'/>"), "line 1", "character 1");
    assert_refused_drawing(SVG("", "<path d='M0 0A1 1 0 2 0 1 1'/>"), "line 1", "character 5");
    assert_refused_drawing(SVG("", "<path d='M0 0X'/>"), "line 1", "character 5");
    assert_refused_drawing(SVG("", "<path d='M0 0Z0 0'/>"), "line 1", "character 6");
    assert_refused_drawing(SVG("", "<polygon points='0 0 1 1 2'/>"), "line 1", "points");
    assert_refused_drawing(SVG("", "<rect width='50%%' height='3'/>"), "line 1", "50%");
    assert_refused_drawing(SVG("", "<g transform='turn(3)'><rect width='5' height='3'/></g>"), "line 1", "turn(3)");
    assert_refused_drawing(SVG("", "<g transform='scale(1 2 3)'><rect width='5' height='3'/></g>"), "line 1", "scale");
    assert_refused_drawing(SVG("viewBox='0 0 1'", "<rect width='5' height='3'/>"), "line 1", "viewBox");
    assert_refused_drawing(SVG("", "<line x2='1e200' y2='1'/>"), "line 1", "coordinate");
    assert_refused_drawing(SVG("", "<text>hello</text>"), "", "no curve");
    assert_refused_drawing("hello", "line 1", "neither SVG nor DXF");
    assert_refused_drawing(dxf("", "0 LINE\n10 a\n"), "line 14", "\"a\"");
    assert_refused_drawing(dxf("", "0 SPLINE\n71 3\n10 0\n20 0\n"), "line 11", "SPLINE");
    assert_refused_drawing(dxf("", "0 CIRCLE\n10 0\n20 0\n40 1\n210 0.7\n230 0.7\n"), "line 11", "tilted");
    assert_refused_drawing(dxf("9\n$INSUNITS\n70\n99\n", "0 LINE\n11 1\n"), "line", "$INSUNITS is 99");
    assert_refused_drawing("0\nSECTION\n2\nENTITIES\n0\nLINE\n11\n5\n", "line 9", "breaks off");
    assert_refused_drawing("0\nSECTION\n2\nENTITIES\nLINE\n11\n5\n", "line 5", "group code");

    size_t depth = 300;
    char* text = calloc(depth * 3 + 100, 1);
    strcpy(text, "<svg>");
    for (size_t k = 0; k < depth; ++k)
        strcat(text, "<g>");
    assert_refused_drawing(text, "line 1", "nested");
    free(text);

    ax_outline outline;
    ax_error error;
    const char* fine = SVG("", "<circle r='1e9'/>");
    assert_int_equal(ax_outline_parse("a.svg", fine, strlen(fine), 1, 1e-9, &outline, &error), AX_BAD_INPUT);
    assert_says(&error, "a million points");
    assert_int_equal(ax_outline_read("/nowhere/a.svg", 1, 0, &outline, &error), AX_BAD_INPUT);
    assert_says(&error, "/nowhere/a.svg cannot be read");
    assert_int_equal(ax_outline_read("/tmp", 1, 0, &outline, &error), AX_BAD_INPUT);
    assert_says(&error, "folder");
}

// ---- tables -----------------------------------------------------------------------------------------------------------------

static ax_table table_of(const char* text)
{
    ax_table table;
    ax_error error;
    if (ax_table_parse("a.csv", text, strlen(text), &table, &error) != AX_OK)
        fail_msg("%s", error.message);
    return table;
}

static void tables_are_read_in_every_dialect(void** state)
{
    (void)state;
    static const char* const same[] = {
        "x,y,lambda\n1.5,-2,1.25\n3,4,1.5\n",
        "\xef\xbb\xbfX;Y;Scale\r\n1,5;-2;1,25\r\n\r\n3;4;1,5",
        "# made by hand\n lambda\tname\ty\tx\n1.25\t\"a\t\"\"b\"\"\"\t-2\t1.5\n\n# more\n1.5\t\t4\t\"3\"\n",
        "x , y , lambda , remark\r 1.5 , -2 , 1.25 , none\r3,4,1.5,",
    };
    for (size_t k = 0; k < sizeof same / sizeof *same; ++k) {
        ax_table t = table_of(same[k]);
        assert_false(t.by_panel);
        assert_int_equal(t.count, 2);
        assert_near(t.places[0][0], 1.5, 0);
        assert_near(t.places[0][1], -2, 0);
        assert_near(t.scale[0], 1.25, 0);
        assert_near(t.places[1][0], 3, 0);
        assert_near(t.scale[1], 1.5, 0);
        ax_table_free(&t);
    }
    ax_table t = table_of("panel,lambda\nC14,1.5\n\"-B-3\",1.25\n");
    assert_true(t.by_panel);
    assert_string_equal(t.panels[1], "-B-3");
    assert_int_equal(t.lines[1], 3);
    ax_table_free(&t);
}

static void wrong_tables_are_told_by_line_and_column(void** state)
{
    (void)state;
    static const struct {
        const char *text, *line, *what;
    } cases[] = {
        {"1,2,3\n", "line 1", "must name the columns"},
        {"x,lambda\n", "line 1", "must name the columns"},
        {"x,y,lambda\n", "a.csv", "no rows"},
        {"\n# only this\n\n", "a.csv", "only empty lines"},
        {"x,y,lambda\n1,2\n", "line 2, column 3", "ends before"},
        {"x,y,lambda\n\n1,a,1\n", "line 3, column 2", "a number"},
        {"x,y,lambda\n1,2,0\n", "line 2, column 3", "greater than 0"},
        {"x,y,lambda\n1,2,nan\n", "line 2, column 3", "a number"},
        {"x,y,lambda\n1,2,1e999\n", "line 2, column 3", "a number"},
        {"x,y,lambda\n1,-1e13,1\n", "line 2, column 2", "larger"},
        {"x,y,lambda\n1,\"2,1\n", "line 2, column 2", "quote"},
        {"x,y,lambda\n1,\"2\"3,1\n", "line 2, column 2", "quote"},
        {"x,y,x,lambda\n", "line 1, column 3", "twice"},
        {"panel,lambda\n,1\n", "line 2, column 1", "panel"},
        {"panel,lambda\nABCDEFGHIJKLMNOPQRSTUVWXYZ,1\n", "line 2, column 1", "panel"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        ax_table table;
        ax_error error = {0};
        if (ax_table_parse("a.csv", cases[k].text, strlen(cases[k].text), &table, &error) != AX_BAD_INPUT)
            fail_msg("accepted: %s", cases[k].text);
        assert_int_equal(table.count, 0);
        assert_says(&error, cases[k].line);
        assert_says(&error, cases[k].what);
    }
    ax_table table;
    ax_error error = {0};
    assert_int_equal(ax_table_parse("a.csv", "x\0y", 3, &table, &error), AX_BAD_INPUT);
    assert_says(&error, "UTF-8");
}

static void tables_set_the_panels_they_name(void** state)
{
    (void)state;
    ax_design design = sample_design();
    int count = design.linkage.triangle_count;
    double* scale = calloc((size_t)count, sizeof *scale);
    char text[200], first[16], last[16];
    ax_panel_name(&design.linkage, 0, first);
    ax_panel_name(&design.linkage, count - 1, last);
    snprintf(text, sizeof text, "panel,lambda\n%s,1.5\n%s,1.25\n", first, last);
    ax_table t = table_of(text);
    ax_error error;
    assert_int_equal(ax_table_apply(&t, "a.csv", &design.linkage, (const double(*)[2])design.flat, scale, &error),
                     AX_OK);
    assert_near(scale[0], 1.5, 0);
    assert_near(scale[count - 1], 1.25, 0);
    for (int k = 1; k < count - 1; ++k)
        assert_near(scale[k], 0, 0);
    ax_table_free(&t);
    snprintf(text, sizeof text, "panel,lambda\n%s,1.5\nZZ99,1.25\n", last);
    t = table_of(text);
    assert_int_equal(ax_table_apply(&t, "a.csv", &design.linkage, (const double(*)[2])design.flat, scale, &error),
                     AX_BAD_INPUT);
    assert_says(&error, "a.csv, line 3: there is no panel \"ZZ99\"");
    assert_near(scale[count - 1], 1.25, 0);
    ax_table_free(&t);
    snprintf(text, sizeof text, "panel,lambda\n%s,1.5\n%s,1.25\n", last, last);
    t = table_of(text);
    assert_int_equal(ax_table_apply(&t, "a.csv", &design.linkage, (const double(*)[2])design.flat, scale, &error),
                     AX_BAD_INPUT);
    assert_says(&error, "line 3");
    assert_says(&error, "line 2 already");
    ax_table_free(&t);
    free(scale);
    ax_design_free(&design);
}

// One triangle after the other at given places, as a linkage that is nothing else.
static double scattered(const ax_table* table, double x, double y)
{
    int triangle[1][3] = {{0, 1, 2}};
    ax_linkage linkage = {.triangle_count = 1, .hinge_count = 3, .triangles = triangle};
    double sheet[3][2] = {{x - 1, y}, {x + 1, y - 1}, {x, y + 1}}, scale;
    assert_int_equal(ax_table_apply(table, "a.csv", &linkage, (const double(*)[2])sheet, &scale, NULL), AX_OK);
    return scale;
}

static double plane(double x, double y)
{
    return 1.5 + 0.01 * x - 0.02 * y;
}

static void scattered_samples_are_met_and_planes_reproduced(void** state)
{
    (void)state;
    ax_random random = {11};
    static char text[20000];
    int used = sprintf(text, "x,y,lambda\n");
    enum { samples = 200 };
    double x[samples][2];
    for (int k = 0; k < samples; ++k) {
        x[k][0] = floor(ax_random_uniform(&random, -10, 10) * 8) / 8,
        x[k][1] = floor(ax_random_uniform(&random, -10, 10) * 8) / 8;
        used += sprintf(text + used, "%.17g,%.17g,%.17g\n", x[k][0], x[k][1], plane(x[k][0], x[k][1]));
    }
    ax_table t = table_of(text);
    for (int k = 0; k < samples; ++k) {
        assert_near(scattered(&t, x[k][0], x[k][1]), plane(x[k][0], x[k][1]), 1e-9);
        double px = ax_random_uniform(&random, -7, 7), py = ax_random_uniform(&random, -7, 7);
        assert_near(scattered(&t, px, py), plane(px, py), 1e-9);
    }
    ax_table_free(&t);

    // far outside no value is invented; one sample, and samples on a line, are enough
    t = table_of("x,y,lambda\n0,0,1\n1,0,2\n0,1,1.5\n");
    assert_at_most(scattered(&t, 100, 100), 2);
    assert_true(scattered(&t, -100, -100) >= 1);
    ax_table_free(&t);
    t = table_of("x,y,lambda\n0,0,1.25\n");
    assert_near(scattered(&t, 3, 4), 1.25, 0);
    ax_table_free(&t);
    t = table_of("x,y,lambda\n0,0,1\n1,1,1.5\n2,2,2\n");
    assert_near(scattered(&t, 1, 1), 1.5, 1e-12);
    assert_true(scattered(&t, 0.5, 0.5) > 1 && scattered(&t, 0.5, 0.5) < 1.5);
    ax_table_free(&t);
}

// ---- images -----------------------------------------------------------------------------------------------------------------

static char image_path[64];

static int make_image_path(void** state)
{
    (void)state;
    strcpy(image_path, "/tmp/ax_image_XXXXXX");
    int descriptor = mkstemp(image_path);
    return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_image(void** state)
{
    (void)state;
    return unlink(image_path);
}

// Writes rows of the given kind with libpng's full interface, which knows 16 bits and interlacing.
static void write_png(int width, int height, int depth, int colour, int interlace, png_bytepp rows)
{
    FILE* out = fopen(image_path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, out);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, depth, colour, interlace, 0, 0);
    png_write_info(png, info);
    png_write_image(png, rows);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(out);
}

static ax_image read_png(void)
{
    ax_image image;
    ax_error error;
    if (ax_image_read(image_path, &image, &error) != AX_OK)
        fail_msg("%s", error.message);
    return image;
}

static void images_of_every_kind_keep_their_values(void** state)
{
    (void)state;
    for (int interlace = 0; interlace < 2; ++interlace) {
        png_byte grey8[2][3] = {{0, 51, 255}, {1, 2, 3}},
                 grey16[2][6] = {{0, 0, 0x12, 0x34, 0xff, 0xff}, {0, 1, 0, 2, 0, 3}};
        write_png(3, 2, 8, PNG_COLOR_TYPE_GRAY, interlace, (png_byte*[]){grey8[0], grey8[1]});
        ax_image image = read_png();
        assert_int_equal(image.width, 3);
        assert_int_equal(image.height, 2);
        for (int k = 0; k < 6; ++k)
            assert_int_equal(image.grey[k], 257 * grey8[k / 3][k % 3]);
        ax_image_free(&image);
        write_png(3, 2, 16, PNG_COLOR_TYPE_GRAY, interlace, (png_byte*[]){grey16[0], grey16[1]});
        image = read_png();
        assert_int_equal(image.grey[1], 0x1234);
        assert_int_equal(image.grey[5], 3);
        ax_image_free(&image);
        png_byte rgb[1][9] = {{100, 100, 100, 255, 0, 0, 0, 255, 0}}, rgba[1][8] = {{0, 0, 0, 0, 10, 10, 10, 255}},
                 bits[1][1] = {{0xa0}};
        write_png(3, 1, 8, PNG_COLOR_TYPE_RGB, interlace, (png_byte*[]){rgb[0]});
        image = read_png();
        assert_int_equal(image.grey[0], 25700);
        assert_int_equal(image.grey[1], 13933); // 0.2126 of white
        assert_int_equal(image.grey[2], 46871);
        ax_image_free(&image);
        write_png(2, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, interlace, (png_byte*[]){rgba[0]});
        image = read_png();
        assert_int_equal(image.grey[0], 65535);
        assert_int_equal(image.grey[1], 2570);
        ax_image_free(&image);
        write_png(3, 1, 1, PNG_COLOR_TYPE_GRAY, interlace, (png_byte*[]){bits[0]});
        image = read_png();
        assert_int_equal(image.grey[0], 65535);
        assert_int_equal(image.grey[1], 0);
        assert_int_equal(image.grey[2], 65535);
        ax_image_free(&image);
    }
}

static void images_are_sampled_over_their_box(void** state)
{
    (void)state;
    uint16_t grey[6] = {0, 6553, 65535, 13107, 0, 0};
    ax_image image = {3, 2, grey};
    const double lo[2] = {10, 20}, hi[2] = {16, 24}, none = 65535;
    assert_near(ax_image_at(&image, lo, hi, (double[]){11, 23}), 0, 0);
    assert_near(ax_image_at(&image, lo, hi, (double[]){13, 23}), 6553 / none, 1e-15);
    assert_near(ax_image_at(&image, lo, hi, (double[]){12, 23}), 6553 / none / 2, 1e-15);
    assert_near(ax_image_at(&image, lo, hi, (double[]){15, 23}), 1, 0);
    assert_near(ax_image_at(&image, lo, hi, (double[]){11, 21}), 0.2, 1e-15); // the lower row
    assert_near(ax_image_at(&image, lo, hi, (double[]){11, 22}), 0.1, 1e-15);
    assert_near(ax_image_at(&image, lo, hi, (double[]){-100, -100}), 0.2, 1e-15);
    assert_near(ax_image_at(&image, lo, hi, (double[]){100, 100}), 1, 0);
}

static void broken_images_are_refused(void** state)
{
    (void)state;
    png_byte row[4] = {1, 2, 3, 4};
    write_png(4, 1, 8, PNG_COLOR_TYPE_GRAY, 0, (png_byte*[]){row});
    FILE* in = fopen(image_path, "rb");
    char bytes[400];
    size_t size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    ax_image image;
    ax_error error;
    assert_int_equal(ax_image_parse("a.png", bytes, size, &image, &error), AX_OK);
    ax_image_free(&image);
    for (size_t part = 0; part < size; ++part) {
        assert_int_equal(ax_image_parse("a.png", bytes, part, &image, &error), AX_BAD_INPUT);
        assert_null(image.grey);
        assert_says(&error, "a.png");
    }
    assert_int_equal(ax_image_parse("a.png", "GIF89a..", 8, &image, &error), AX_BAD_INPUT);
    assert_says(&error, "not a PNG");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formulas_have_the_values_of_mathematics),
        cmocka_unit_test(wrong_formulas_are_told_by_column),
        cmocka_unit_test(formulas_are_bounded),
        cmocka_unit_test(shapes_of_svg_have_their_area_and_place),
        cmocka_unit_test(path_commands_mean_what_the_standard_says),
        cmocka_unit_test(chords_stay_within_the_tolerance),
        cmocka_unit_test(units_of_svg_become_those_of_the_document),
        cmocka_unit_test(curves_have_names_and_lines),
        cmocka_unit_test(touching_pieces_become_one_curve),
        cmocka_unit_test(entities_of_dxf_have_their_area_and_place),
        cmocka_unit_test(broken_drawings_are_told_by_line),
        cmocka_unit_test(tables_are_read_in_every_dialect),
        cmocka_unit_test(wrong_tables_are_told_by_line_and_column),
        cmocka_unit_test(tables_set_the_panels_they_name),
        cmocka_unit_test(scattered_samples_are_met_and_planes_reproduced),
        cmocka_unit_test_setup_teardown(images_of_every_kind_keep_their_values, make_image_path, remove_image),
        cmocka_unit_test(images_are_sampled_over_their_box),
        cmocka_unit_test_setup_teardown(broken_images_are_refused, make_image_path, remove_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
