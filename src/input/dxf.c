// Entities of ASCII DXF: pairs of lines, a group code and its value. Codes as in Autodesk's DXF reference.
#include "input/drawing.h"
#include "input/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { most_listed = 4000000, codes = 240 };

typedef struct list {
    int count, capacity;
    double* values;
} list;

// A POLYLINE is an entity whose vertices are entities too.
typedef struct polyline {
    bool open; // its vertices are being collected
    bool closed, passed;
    int line;
    double side;
    char layer[64];
} polyline;

typedef struct reader {
    ax_pen* pen;
    const char* at;
    int line;        // at which `at` stands
    int code;        // the present group
    char value[256]; // without blanks around it
    double unit;     // of the document, metres
    char section[32], variable[32];
    // the entity being collected
    char entity[32], layer[64];
    int entity_line;
    double number[codes]; // by code; NaN: not given
    list points;          // x, y, x, y ...
    list
        extra; // LWPOLYLINE and VERTEX: bulge of each, tan of a quarter of the angle of the arc to the next; SPLINE: weights
    list knots;
    polyline polyline;
} reader;

static void take_line(reader* r, char* out, size_t size)
{
    const char* end = r->at + strcspn(r->at, "\r\n");
    r->at += strspn(r->at, " \t");
    size_t length = end > r->at ? (size_t)(end - r->at) : 0;
    while (length && (r->at[length - 1] == ' ' || r->at[length - 1] == '\t'))
        --length;
    length = length < size ? length : size - 1;
    memcpy(out, r->at, length);
    out[length] = '\0';
    r->at = *end ? end + (end[0] == '\r' && end[1] == '\n' ? 2 : 1) : end;
    ++r->line;
}

// Takes the next group. False on a fault.
static bool next_group(reader* r)
{
    char code[32];
    double value;
    r->pen->line = r->line;
    if (!*r->at) {
        ax_pen_fail(r->pen, "the drawing breaks off here. Export it again.");
        return false;
    }
    take_line(r, code, sizeof code);
    const char* after = ax_number_read(code, &value);
    if (after && !*after && fabs(value) < 10000) {
        r->code = (int)value;
        take_line(r, r->value, sizeof r->value);
        return true;
    }
    if (r->pen->line == 1)
        ax_pen_fail(r->pen, "this is neither SVG nor DXF as text. Export the drawing as one of these; save binary DXF "
                            "or DWG as ASCII DXF.");
    else
        ax_pen_fail(r->pen, "a group code should stand here, not \"%.20s\". Export the drawing again.", code);
    return false;
}

static double number(reader* r)
{
    double value;
    const char* after = ax_number_read(r->value, &value);
    if (after && !*after && fabs(value) < 1e100)
        return value;
    r->pen->line = r->line - 1;
    ax_pen_fail(r->pen, "a number should stand here, not \"%.20s\". Export the drawing again.", r->value);
    return 0;
}

static void push(reader* r, list* l, double value)
{
    if (l->count == most_listed) {
        ax_pen_fail(r->pen, "this %s has more points than can be. Leave out what is not needed.", r->entity);
        return;
    }
    if (l->count == l->capacity) {
        l->capacity = l->capacity ? 2 * l->capacity : 64;
        l->values = ax_realloc(l->values, (size_t)l->capacity, sizeof *l->values);
    }
    l->values[l->count++] = value;
}

static void set_last(list* l, double value)
{
    if (l->count)
        l->values[l->count - 1] = value;
}

static double given(const reader* r, int code, double otherwise)
{
    return isnan(r->number[code]) ? otherwise : r->number[code];
}

static int whole(const reader* r, int code)
{
    double value = given(r, code, 0);
    return fabs(value) < 1e9 ? (int)value : 0;
}

static bool is(const reader* r, const char* entity)
{
    return strcmp(r->entity, entity) == 0;
}

// ---- entities ---------------------------------------------------------------------------------------------------------------

// Entities in a plane of their own are seen from the front, or from behind if its normal points down: then x is turned over.
static double facing(reader* r)
{
    double nx = given(r, 210, 0), ny = given(r, 220, 0), nz = given(r, 230, 1);
    if (!(fabs(nx) + fabs(ny) < 1e-6 * fabs(nz)))
        ax_pen_fail(r->pen, "this %s lies in a tilted plane. Flatten the drawing.", r->entity);
    return nz < 0 ? -1 : 1;
}

static void draw_line(reader* r)
{
    ax_pen_move(r->pen, given(r, 10, 0), given(r, 20, 0));
    ax_pen_line(r->pen, given(r, 11, 0), given(r, 21, 0));
}

static void draw_part(reader* r, const double c[2], const double u[2], const double v[2], double from, double to)
{
    double sweep = fmod(to - from, 2 * M_PI);
    if (sweep <= 1e-9)
        sweep += 2 * M_PI;
    if (sweep > 2 * M_PI - 1e-9) {
        ax_pen_ellipse(r->pen, c, u, v);
        return;
    }
    to = from + sweep;
    ax_pen_move(r->pen, c[0] + u[0] * cos(from) + v[0] * sin(from), c[1] + u[1] * cos(from) + v[1] * sin(from));
    double end[2] = {c[0] + u[0] * cos(to) + v[0] * sin(to), c[1] + u[1] * cos(to) + v[1] * sin(to)};
    ax_pen_arc(r->pen, c, u, v, from, sweep, end);
}

static void draw_circle(reader* r, bool full)
{
    double side = facing(r), radius = given(r, 40, 0);
    double centre[2] = {side * given(r, 10, 0), given(r, 20, 0)}, u[2] = {side * radius, 0}, v[2] = {0, radius};
    double from = full ? 0 : given(r, 50, 0) * M_PI / 180, to = full ? 0 : given(r, 51, 0) * M_PI / 180;
    if (radius > 0)
        draw_part(r, centre, u, v, from, to);
}

static void draw_ellipse(reader* r)
{
    double ratio = facing(r) * given(r, 40, 1), centre[2] = {given(r, 10, 0), given(r, 20, 0)};
    double u[2] = {given(r, 11, 0), given(r, 21, 0)}, v[2] = {-ratio * u[1], ratio * u[0]};
    if (ratio != 0 && hypot(u[0], u[1]) > 0)
        draw_part(r, centre, u, v, given(r, 41, 0), given(r, 42, 0));
}

static void draw_bulge(reader* r, const double a[2], const double b[2], double bulge)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], away = (1 - bulge * bulge) / (4 * bulge);
    if (fabs(bulge) < 1e-9 || (dx == 0 && dy == 0)) {
        ax_pen_line(r->pen, b[0], b[1]);
        return;
    }
    double centre[2] = {a[0] + dx / 2 - away * dy, a[1] + dy / 2 + away * dx};
    double u[2] = {a[0] - centre[0], a[1] - centre[1]}, v[2] = {-u[1], u[0]};
    ax_pen_arc(r->pen, centre, u, v, 0, 4 * atan(bulge), b);
}

static void draw_polyline(reader* r, bool closed, double side)
{
    int count = r->points.count / 2;
    if (count < 2)
        return;
    double* x = r->points.values;
    for (int k = 0; k < count; ++k)
        x[2 * k] *= side;
    ax_pen_move(r->pen, x[0], x[1]);
    for (int k = 0; k < (closed ? count : count - 1); ++k)
        draw_bulge(r, x + 2 * k, x + 2 * ((k + 1) % count), side * r->extra.values[k]);
    if (closed)
        ax_pen_close(r->pen);
}

static void draw_spline(reader* r)
{
    int degree = whole(r, 71), count = r->points.count / 2;
    while (r->extra.count < count)
        push(r, &r->extra, 1);
    bool sound = degree >= 1 && degree <= AX_PEN_DEGREE && count > degree && r->knots.count == count + degree + 1;
    for (int k = 0; k + 1 < r->knots.count && sound; ++k)
        sound = r->knots.values[k] <= r->knots.values[k + 1];
    for (int k = 0; k < count && sound; ++k)
        sound = r->extra.values[k] > 0;
    if (sound)
        ax_pen_spline(r->pen, degree, count, (const double(*)[2])r->points.values, r->extra.values, r->knots.values);
    else
        ax_pen_fail(r->pen,
                    "this SPLINE has no sound control points and knots. Export it with them, or as a polyline.");
}

static void end_entity(reader* r)
{
    r->pen->line = r->entity_line;
    memcpy(r->pen->name, r->layer, sizeof r->pen->name);
    polyline* p = &r->polyline;
    if (whole(r, 67) == 1) // on paper, not in the model
        ;
    else if (is(r, "VERTEX") && p->open && !(whole(r, 70) & 16)) { // 16: of the frame of a spline
        push(r, &r->points, given(r, 10, 0));
        push(r, &r->points, given(r, 20, 0));
        push(r, &r->extra, given(r, 42, 0));
    } else if (is(r, "POLYLINE")) {
        *p = (polyline){.open = true, .closed = whole(r, 70) & 1, .line = r->entity_line, .side = facing(r)};
        p->passed = whole(r, 70) & (16 | 64); // meshes
        memcpy(p->layer, r->layer, sizeof p->layer);
    } else if (is(r, "LINE"))
        draw_line(r);
    else if (is(r, "CIRCLE") || is(r, "ARC"))
        draw_circle(r, is(r, "CIRCLE"));
    else if (is(r, "ELLIPSE"))
        draw_ellipse(r);
    else if (is(r, "LWPOLYLINE"))
        draw_polyline(r, whole(r, 70) & 1, facing(r));
    else if (is(r, "SPLINE"))
        draw_spline(r);
}

static void end_polyline(reader* r)
{
    polyline* p = &r->polyline;
    r->pen->line = p->line;
    memcpy(r->pen->name, p->layer, sizeof r->pen->name);
    if (!p->passed)
        draw_polyline(r, p->closed, p->side);
    p->open = false;
}

static void begin_entity(reader* r)
{
    if (r->polyline.open && strcmp(r->value, "VERTEX") != 0)
        end_polyline(r);
    snprintf(r->entity, sizeof r->entity, "%.31s", r->value);
    r->entity_line = r->line - 2;
    *r->layer = '\0';
    for (int k = 0; k < codes; ++k)
        r->number[k] = NAN;
    if (!r->polyline.open)
        r->points.count = r->extra.count = r->knots.count = 0;
}

// ---- groups -----------------------------------------------------------------------------------------------------------------

static void take_entity_group(reader* r)
{
    bool light = is(r, "LWPOLYLINE"), spline = is(r, "SPLINE");
    if (r->code == 8)
        snprintf(r->layer, sizeof r->layer, "%.63s", r->value);
    else if ((light || spline) && r->code == 10) {
        push(r, &r->points, number(r));
        push(r, &r->points, 0);
        if (light)
            push(r, &r->extra, 0);
    } else if ((light || spline) && r->code == 20)
        set_last(&r->points, number(r));
    else if (light && r->code == 42)
        set_last(&r->extra, number(r));
    else if (spline && r->code == 40)
        push(r, &r->knots, number(r));
    else if (spline && r->code == 41)
        push(r, &r->extra, number(r));
    else if ((r->code >= 10 && r->code < 80) || (r->code >= 210 && r->code < codes))
        r->number[r->code] = number(r);
}

// Metres of the codes of $INSUNITS; 0: none.
static void set_unit(reader* r)
{
    static const double metres[] = {0,         0.0254,    0.3048, 1609.344, 1e-3, 1e-2, 1,  1e3,
                                    0.0254e-6, 0.0254e-3, 0.9144, 1e-10,    1e-9, 1e-6, 0.1};
    double code = number(r);
    if (!(code >= 0 && code < (double)(sizeof metres / sizeof *metres)))
        ax_pen_fail(r->pen, "$INSUNITS is %.20s, a unit that is not known. Export the drawing in millimetres.",
                    r->value);
    else if (metres[(int)code] > 0)
        r->pen->matrix[0] = r->pen->matrix[3] = metres[(int)code] / r->unit;
}

// True when this was the last group.
static bool take_group(reader* r)
{
    bool entities = strcmp(r->section, "ENTITIES") == 0;
    if (r->code == 0) {
        if (entities) {
            end_entity(r);
            begin_entity(r);
        }
        bool end = strcmp(r->value, "EOF") == 0;
        if (end || strcmp(r->value, "ENDSEC") == 0 || strcmp(r->value, "SECTION") == 0)
            snprintf(r->section, sizeof r->section, "%.31s", end ? "" : r->value);
        return end;
    }
    if (r->code == 2 && strcmp(r->section, "SECTION") == 0) {
        snprintf(r->section, sizeof r->section, "%.31s", r->value);
        *r->entity = '\0';
    } else if (r->code == 9)
        snprintf(r->variable, sizeof r->variable, "%.31s", r->value);
    else if (r->code == 70 && strcmp(r->section, "HEADER") == 0 && strcmp(r->variable, "$INSUNITS") == 0)
        set_unit(r);
    else if (entities)
        take_entity_group(r);
    return false;
}

void ax_dxf_draw(ax_pen* pen, const char* bytes, size_t size, double unit)
{
    if (strlen(bytes) != size) {
        ax_pen_fail(pen, "this is neither SVG nor DXF as text. Export the drawing as one of these; save binary DXF or "
                         "DWG as ASCII DXF.");
        return;
    }
    reader r = {.pen = pen, .at = bytes + (strncmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0), .line = 1, .unit = unit};
    for (int k = 0; k < codes; ++k)
        r.number[k] = NAN;
    while (pen->status == AX_OK && next_group(&r) && !take_group(&r))
        ;
    ax_free(r.points.values);
    ax_free(r.extra.values);
    ax_free(r.knots.values);
}
