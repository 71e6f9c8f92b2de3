// Shapes of SVG 1.1. Attributes that CSS sets are not seen, but for display: none.
#include "input/drawing.h"
#include "input/number.h"

#include <expat.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { deepest = 256 };
static const double pixel = 0.0254 / 96; // metres, as CSS has it
static const char spaces[] = " \t\r\n\f,";

typedef struct group {
    double matrix[6];
    char name[64];
} group;

typedef struct reader {
    ax_pen* pen;
    XML_Parser parser;
    double unit; // metres
    int depth;   // of open elements
    int passed;  // depth from which on elements are passed over; 0: none
    group groups[deepest];
} reader;

static const char* skip_spaces(const char* at)
{
    return at + strspn(at, spaces);
}

static const char* attribute(const XML_Char** attributes, const char* name)
{
    for (; *attributes; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            return attributes[1];
    return NULL;
}

// a b: first b, then a.
static void multiply(const double a[6], const double b[6], double out[6])
{
    double product[6] = {a[0] * b[0] + a[2] * b[1], a[1] * b[0] + a[3] * b[1],        a[0] * b[2] + a[2] * b[3],
                         a[1] * b[2] + a[3] * b[3], a[0] * b[4] + a[2] * b[5] + a[4], a[1] * b[4] + a[3] * b[5] + a[5]};
    memcpy(out, product, sizeof product);
}

// Metres of a unit behind a number: 0 for none, negative for one that has no fixed length.
static double unit_of(const char* text)
{
    static const struct {
        const char* name;
        double metres;
    } units[] = {{"px", 0.0254 / 96}, {"mm", 1e-3},       {"cm", 1e-2},  {"in", 0.0254},
                 {"pt", 0.0254 / 72}, {"pc", 0.0254 / 6}, {"Q", 0.25e-3}};
    size_t length = strcspn(text, spaces);
    for (size_t k = 0; k < sizeof units / sizeof *units; ++k)
        if (strlen(units[k].name) == length && strncmp(text, units[k].name, length) == 0)
            return units[k].metres;
    return length ? -1 : 0;
}

// A length attribute in user units.
static double length(reader* r, const XML_Char** attributes, const char* name, double otherwise)
{
    const char* text = attribute(attributes, name);
    if (!text)
        return otherwise;
    double value = 0;
    const char* after = ax_number_read(skip_spaces(text), &value);
    double unit = after ? unit_of(after) : -1;
    if (unit < 0)
        ax_pen_fail(r->pen, "%s=\"%.40s\" is not a length. Write a number, or one with mm, cm, in, pt or px.", name,
                    text);
    return unit > 0 ? value * unit / pixel : value;
}

// Reads numbers as long as they come, at most `most`; returns how many.
static int read_numbers(const char** at, int most, double* values)
{
    int count = 0;
    while (count < most) {
        const char* after = ax_number_read(skip_spaces(*at), &values[count]);
        if (!after)
            break;
        *at = after;
        ++count;
    }
    return count;
}

static bool make_transform(const char* name, size_t length, int count, const double v[6], double out[6])
{
#define IS(word) (length == strlen(word) && strncmp(name, word, length) == 0)
    double turn[6] = {1, 0, 0, 1, 0, 0};
    if (IS("matrix") && count == 6)
        memcpy(turn, v, sizeof turn);
    else if (IS("translate") && (count == 1 || count == 2))
        turn[4] = v[0], turn[5] = count == 2 ? v[1] : 0;
    else if (IS("scale") && (count == 1 || count == 2))
        turn[0] = v[0], turn[3] = count == 2 ? v[1] : v[0];
    else if (IS("rotate") && (count == 1 || count == 3)) {
        double c = cos(v[0] * M_PI / 180), s = sin(v[0] * M_PI / 180), x = count == 3 ? v[1] : 0,
               y = count == 3 ? v[2] : 0;
        turn[0] = turn[3] = c, turn[1] = s, turn[2] = -s;
        turn[4] = x - c * x + s * y, turn[5] = y - s * x - c * y;
    } else if (IS("skewX") && count == 1)
        turn[2] = tan(v[0] * M_PI / 180);
    else if (IS("skewY") && count == 1)
        turn[1] = tan(v[0] * M_PI / 180);
    else
        return false;
#undef IS
    memcpy(out, turn, sizeof turn);
    return true;
}

static void apply_transforms(reader* r, const char* text, double matrix[6])
{
    for (const char* at = skip_spaces(text); *at; at = skip_spaces(at)) {
        const char* name = at;
        size_t length = strcspn(at, " \t\r\n(");
        at = skip_spaces(at + length);
        double values[7], step[6];
        bool open = *at == '(';
        at += open;
        int count = open ? read_numbers(&at, 7, values) : 0;
        at = skip_spaces(at);
        if (*at != ')' || !make_transform(name, length, count, values, step)) {
            ax_pen_fail(r->pen, "transform=\"%.60s\" is not understood at character %d.", text, (int)(name - text) + 1);
            return;
        }
        ++at;
        multiply(matrix, step, matrix);
    }
}

// ---- path data --------------------------------------------------------------------------------------------------------------

typedef struct path {
    reader* r;
    const char *text, *at;
    char command;          // being drawn
    double x[2], start[2]; // present place, start of the subpath
    double control[2];     // last control point of C, S, Q, T
    char before;           // command before this one, upper case
    bool begun;            // a curve is open at x
} path;

static void draw_line(path* p, double x, double y)
{
    ax_pen_line(p->r->pen, x, y);
    p->x[0] = x, p->x[1] = y;
}

static void draw_cubic(path* p, const double a[2], const double b[2], const double end[2])
{
    ax_pen_cubic(p->r->pen, a, b, end);
    memcpy(p->control, b, sizeof p->control);
    memcpy(p->x, end, sizeof p->x);
}

static void draw_quadratic(path* p, const double c[2], const double end[2])
{
    double a[2], b[2], control[2] = {c[0], c[1]};
    for (int d = 0; d < 2; ++d) {
        a[d] = p->x[d] + 2 * (c[d] - p->x[d]) / 3;
        b[d] = end[d] + 2 * (c[d] - end[d]) / 3;
    }
    draw_cubic(p, a, b, end);
    memcpy(p->control, control, sizeof control);
}

// From end points to centre: SVG 1.1, appendix F.6.5.
static void draw_arc(path* p, double rx, double ry, double degrees, bool large, bool positive, const double end[2])
{
    rx = fabs(rx), ry = fabs(ry);
    double c = cos(degrees * M_PI / 180), s = sin(degrees * M_PI / 180);
    double dx = (p->x[0] - end[0]) / 2, dy = (p->x[1] - end[1]) / 2;
    double x = (c * dx + s * dy) / rx, y = (-s * dx + c * dy) / ry; // where the ellipse is the unit circle
    double squared = x * x + y * y;
    if (!(squared > 0) || !isfinite(squared)) { // no radius, or no way to go
        draw_line(p, end[0], end[1]);
        return;
    }
    if (squared > 1) // too small to reach: the smallest that does
        rx *= sqrt(squared), ry *= sqrt(squared), x /= sqrt(squared), y /= sqrt(squared), squared = 1;
    double away = sqrt((1 - squared) / squared) * (large == positive ? -1 : 1);
    double cx = away * y, cy = -away * x;
    double from = atan2(y - cy, x - cx), to = atan2(-y - cy, -x - cx), sweep = to - from;
    if (positive && sweep < 0)
        sweep += 2 * M_PI;
    else if (!positive && sweep > 0)
        sweep -= 2 * M_PI;
    double u[2] = {c * rx, s * rx}, v[2] = {-s * ry, c * ry};
    double centre[2] = {(p->x[0] + end[0]) / 2 + cx * u[0] + cy * v[0], (p->x[1] + end[1]) / 2 + cx * u[1] + cy * v[1]};
    ax_pen_arc(p->r->pen, centre, u, v, from, sweep, end);
    memcpy(p->x, end, sizeof p->x);
}

// The flags of an arc need no separator: "a1 1 0 011 1".
static bool read_flag(path* p, double* value)
{
    p->at = skip_spaces(p->at);
    if (*p->at != '0' && *p->at != '1')
        return false;
    *value = *p->at++ - '0';
    return true;
}

static bool read_arguments(path* p, int count, double* v)
{
    if (count != 7)
        return read_numbers(&p->at, count, v) == count;
    return read_numbers(&p->at, 3, v) == 3 && read_flag(p, &v[3]) && read_flag(p, &v[4]) &&
           read_numbers(&p->at, 2, v + 5) == 2;
}

static int argument_count(char upper)
{
    switch (upper) {
    case 'M':
    case 'L':
    case 'T':
        return 2;
    case 'H':
    case 'V':
        return 1;
    case 'S':
    case 'Q':
        return 4;
    case 'C':
        return 6;
    case 'A':
        return 7;
    default:
        return -1;
    }
}

// The last control point mirrored, if the command before was of the same kind.
static void mirrored(const path* p, char kind, char smooth, double out[2])
{
    for (int d = 0; d < 2; ++d)
        out[d] = p->before == kind || p->before == smooth ? 2 * p->x[d] - p->control[d] : p->x[d];
}

static void draw_command(path* p, char upper, double* v)
{
    double control[2];
    if (upper != 'M' && !p->begun)
        ax_pen_move(p->r->pen, p->x[0], p->x[1]);
    p->begun = true;
    switch (upper) {
    case 'M':
        ax_pen_move(p->r->pen, v[0], v[1]);
        p->x[0] = p->start[0] = v[0], p->x[1] = p->start[1] = v[1];
        break;
    case 'L':
        draw_line(p, v[0], v[1]);
        break;
    case 'H':
        draw_line(p, v[0], p->x[1]);
        break;
    case 'V':
        draw_line(p, p->x[0], v[0]);
        break;
    case 'C':
        draw_cubic(p, v, v + 2, v + 4);
        break;
    case 'S':
        mirrored(p, 'C', 'S', control);
        draw_cubic(p, control, v, v + 2);
        break;
    case 'Q':
        draw_quadratic(p, v, v + 2);
        break;
    case 'T':
        mirrored(p, 'Q', 'T', control);
        draw_quadratic(p, control, v);
        break;
    default:
        draw_arc(p, v[0], v[1], v[2], v[3] != 0, v[4] != 0, v + 5);
    }
    p->before = upper;
}

static void make_absolute(const path* p, char upper, int count, double* v)
{
    if (upper == 'H')
        v[0] += p->x[0];
    else if (upper == 'V')
        v[0] += p->x[1];
    else if (upper == 'A')
        v[5] += p->x[0], v[6] += p->x[1];
    else
        for (int k = 0; k < count; ++k)
            v[k] += p->x[k % 2];
}

static void draw_path(reader* r, const char* text)
{
    path p = {.r = r, .text = text, .at = skip_spaces(text)};
    while (*p.at && r->pen->status == AX_OK) {
        const char* place = p.at;
        if (strchr("MmLlHhVvCcSsQqTtAaZz", *p.at))
            p.command = *p.at++;
        else if (p.command == 'M' || p.command == 'm') // further pairs are lines
            --p.command;
        bool relative = p.command >= 'a';
        char upper = relative ? (char)(p.command - 32) : p.command;
        double v[7];
        int count = argument_count(upper);
        if (upper == 'Z' && place < p.at && p.before) {
            ax_pen_close(r->pen);
            memcpy(p.x, p.start, sizeof p.x);
            p.begun = false;
            p.before = 'Z';
        } else if (count > 0 && (p.before || upper == 'M') && read_arguments(&p, count, v)) {
            if (relative)
                make_absolute(&p, upper, count, v);
            draw_command(&p, upper, v);
        } else
            ax_pen_fail(r->pen, "the path data is wrong at character %d, which reads \"%.20s\".",
                        (int)(place - text) + 1, place);
        p.at = skip_spaces(p.at);
    }
}

// ---- shapes -----------------------------------------------------------------------------------------------------------------

static void draw_poly(reader* r, const char* text, bool closed)
{
    double v[2];
    const char *at = text, *pair = text;
    bool begun = false;
    for (; read_numbers(&at, 2, v) == 2; pair = at) {
        (begun ? ax_pen_line : ax_pen_move)(r->pen, v[0], v[1]);
        begun = true;
    }
    if (*skip_spaces(pair))
        ax_pen_fail(r->pen, "the points are wrong at character %d, which reads \"%.20s\".", (int)(pair - text) + 1,
                    pair);
    if (closed && begun)
        ax_pen_close(r->pen);
}

static void draw_ellipse(reader* r, double cx, double cy, double rx, double ry)
{
    if (rx > 0 && ry > 0)
        ax_pen_ellipse(r->pen, (double[]){cx, cy}, (double[]){rx, 0}, (double[]){0, ry});
}

static void draw_rectangle(reader* r, const XML_Char** attributes)
{
    double x = length(r, attributes, "x", 0), y = length(r, attributes, "y", 0);
    double w = length(r, attributes, "width", 0), h = length(r, attributes, "height", 0);
    double rx = length(r, attributes, "rx", NAN), ry = length(r, attributes, "ry", NAN);
    if (!(w > 0 && h > 0))
        return;
    rx = isnan(rx) ? ry : rx, ry = isnan(ry) ? rx : ry;
    rx = rx > 0 && ry > 0 ? fmin(rx, w / 2) : 0, ry = rx > 0 ? fmin(ry, h / 2) : 0;
    // corners with the quarter of an ellipse, anticlockwise as seen on the page
    const double inner[4][2] = {{x + w - rx, y + ry}, {x + rx, y + ry}, {x + rx, y + h - ry}, {x + w - rx, y + h - ry}};
    const double u[4][2] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}}, v[4][2] = {{0, -1}, {-1, 0}, {0, 1}, {1, 0}};
    for (int k = 0; k < 4; ++k) {
        double a[2] = {rx * u[k][0], ry * u[k][1]}, b[2] = {rx * v[k][0], ry * v[k][1]};
        (k ? ax_pen_line : ax_pen_move)(r->pen, inner[k][0] + a[0], inner[k][1] + a[1]);
        if (rx > 0)
            ax_pen_arc(r->pen, inner[k], a, b, 0, M_PI / 2, (double[]){inner[k][0] + b[0], inner[k][1] + b[1]});
    }
    ax_pen_close(r->pen);
}

static void draw_shape(reader* r, const char* name, const XML_Char** attributes)
{
    if (strcmp(name, "path") == 0)
        draw_path(r, attribute(attributes, "d") ? attribute(attributes, "d") : "");
    else if (strcmp(name, "rect") == 0)
        draw_rectangle(r, attributes);
    else if (strcmp(name, "circle") == 0) {
        double radius = length(r, attributes, "r", 0);
        draw_ellipse(r, length(r, attributes, "cx", 0), length(r, attributes, "cy", 0), radius, radius);
    } else if (strcmp(name, "ellipse") == 0)
        draw_ellipse(r, length(r, attributes, "cx", 0), length(r, attributes, "cy", 0), length(r, attributes, "rx", 0),
                     length(r, attributes, "ry", 0));
    else if (strcmp(name, "line") == 0) {
        ax_pen_move(r->pen, length(r, attributes, "x1", 0), length(r, attributes, "y1", 0));
        ax_pen_line(r->pen, length(r, attributes, "x2", 0), length(r, attributes, "y2", 0));
    } else if (strcmp(name, "polyline") == 0 || strcmp(name, "polygon") == 0)
        draw_poly(r, attribute(attributes, "points") ? attribute(attributes, "points") : "",
                  strcmp(name, "polygon") == 0);
}

// ---- the document -----------------------------------------------------------------------------------------------------------

// Size of the page in metres; 0 if it has none of its own: percentages, or numbers without a unit.
static double page_size(const XML_Char** attributes, const char* name)
{
    const char* text = attribute(attributes, name);
    double value;
    const char* after = text ? ax_number_read(skip_spaces(text), &value) : NULL;
    double unit = after ? unit_of(after) : 0;
    return unit > 0 && value > 0 ? value * unit : 0;
}

// From user units, y down, to document units, y up.
static void set_page(reader* r, const XML_Char** attributes)
{
    double box[4], w = page_size(attributes, "width"), h = page_size(attributes, "height"), bottom = 0;
    const char *text = attribute(attributes, "viewBox"), *ratio = attribute(attributes, "preserveAspectRatio");
    double sx = 1, sy = 1;
    bool boxed = text && read_numbers(&text, 4, box) == 4 && box[2] > 0 && box[3] > 0;
    if (attribute(attributes, "viewBox") && !boxed)
        ax_pen_fail(r->pen, "viewBox=\"%.60s\" should be four numbers: x y width height.",
                    attribute(attributes, "viewBox"));
    if (boxed) {
        bottom = box[1] + box[3];
        if (w > 0 || h > 0) {
            sx = w > 0 ? w / box[2] : h / box[3];
            sy = h > 0 ? h / box[3] : sx;
        }
        if (!ratio || strncmp(ratio, "none", 4) != 0)
            sx = sy = ratio && strstr(ratio, "slice") ? fmax(sx, sy) : fmin(sx, sy);
    } else {
        const char* height = attribute(attributes, "height");
        sx = sy = w > 0 || h > 0 ? pixel : 1;
        bottom = height && strchr(height, '%') ? 0 : length(r, attributes, "height", 0);
    }
    if (w > 0 || h > 0)
        sx /= r->unit, sy /= r->unit;
    const double page[6] = {sx, 0, 0, -sy, 0, sy * bottom};
    memcpy(r->groups[0].matrix, page, sizeof page);
}

static bool is_hidden(const XML_Char** attributes)
{
    const char *display = attribute(attributes, "display"), *style = attribute(attributes, "style");
    const char* in_style = style ? strstr(style, "display:") : NULL;
    return (display && strcmp(display, "none") == 0) ||
           (in_style && strncmp(in_style + 8 + strspn(in_style + 8, " "), "none", 4) == 0);
}

static bool is_container(const char* name)
{
    return strcmp(name, "g") == 0 || strcmp(name, "a") == 0 || strcmp(name, "switch") == 0;
}

// Name without its namespace; NULL if that is not SVG's.
static const char* local_name(const char* name)
{
    static const char svg[] = "http://www.w3.org/2000/svg ";
    if (!strchr(name, ' '))
        return name;
    return strncmp(name, svg, sizeof svg - 1) == 0 ? name + sizeof svg - 1 : NULL;
}

static void XMLCALL on_start(void* context, const XML_Char* full, const XML_Char** attributes)
{
    reader* r = context;
    ax_pen* pen = r->pen;
    pen->line = (int)XML_GetCurrentLineNumber(r->parser);
    if (++r->depth >= deepest) {
        ax_pen_fail(pen, "elements are nested more than %d deep. Ungroup the drawing.", deepest - 1);
        XML_StopParser(r->parser, XML_FALSE);
        return;
    }
    if (r->passed)
        return;
    const char* name = local_name(full);
    if (r->depth == 1) {
        if (!name || strcmp(name, "svg") != 0)
            ax_pen_fail(pen, "this is no SVG drawing: its first element is <%.40s>. Export the drawing as SVG or DXF.",
                        full);
        else
            set_page(r, attributes);
        *pen->name = '\0';
    }
    group *outer = &r->groups[r->depth - 1], *own = &r->groups[r->depth];
    *own = *outer;
    const char *id = attribute(attributes, "id"), *transform = attribute(attributes, "transform");
    if (id && r->depth > 1)
        snprintf(own->name, sizeof own->name, "%s", id);
    if (transform && name)
        apply_transforms(r, transform, own->matrix);
    if (r->depth > 1 && (!name || is_hidden(attributes)))
        r->passed = r->depth;
    else if (r->depth > 1 && !is_container(name)) {
        memcpy(pen->matrix, own->matrix, sizeof pen->matrix);
        memcpy(pen->name, own->name, sizeof pen->name);
        draw_shape(r, name, attributes);
        r->passed = r->depth; // titles, animations
    }
    if (pen->status != AX_OK)
        XML_StopParser(r->parser, XML_FALSE);
}

static void XMLCALL on_end(void* context, const XML_Char* name)
{
    (void)name;
    reader* r = context;
    if (r->passed == r->depth)
        r->passed = 0;
    --r->depth;
}

void ax_svg_draw(ax_pen* pen, const char* bytes, size_t size, double unit)
{
    reader r = {.pen = pen, .parser = XML_ParserCreateNS(NULL, ' '), .unit = unit};
    if (!r.parser) {
        ax_pen_fail(pen, "the XML parser does not start.");
        return;
    }
    XML_SetUserData(r.parser, &r);
    XML_SetElementHandler(r.parser, on_start, on_end);
    if (XML_Parse(r.parser, bytes, (int)size, XML_TRUE) != XML_STATUS_OK) {
        pen->line = (int)XML_GetCurrentLineNumber(r.parser);
        ax_pen_fail(pen, "the XML is broken at column %d: %s. Export the drawing again.",
                    (int)XML_GetCurrentColumnNumber(r.parser) + 1, XML_ErrorString(XML_GetErrorCode(r.parser)));
    }
    XML_ParserFree(r.parser);
}
