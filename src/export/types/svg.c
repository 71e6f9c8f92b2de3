// SVG cut file: the flat panels at true size. One user unit is a millimetre, and width, height and viewBox all say so; programs
// that guess a resolution have nothing to guess. Layers in the order of work: LABEL, CUT, and NOTE, which is not machined.
#include "base/vec.h"
#include "fabricate/stroke_font.h"
#include "export/writing.h"

#include <jansson.h>

static const double margin = 10;                       // mm, round the sheet and between panels and notes
static const double label_least = 2, label_most = 10;  // mm, letter heights; below 2 mm engraved letters run together
static const double note_height = 4, note_advance = 7; // mm, letters and lines
static const double bar_length = 100, bar_tick = 2;    // mm
static const char bar_text[] = "100 mm";
static const char cut_style[] = "fill=\"none\" stroke=\"#ff0000\" stroke-width=\"0.1\"";
static const char label_style[] = "fill=\"none\" stroke=\"#000000\" stroke-width=\"0.1\"";
static const char note_style[] = "fill=\"none\" stroke=\"#808080\" stroke-width=\"0.1\"";

// Where the design lies on the sheet: y of the design points up, y of the sheet down.
typedef struct sheet {
    FILE* out;
    double mm;            // per document unit
    double left, top;     // of the design, document units
    double cut[2];        // extent of the panels, mm
    double width, height; // mm
} sheet;

static void to_sheet(const sheet* s, const double place[2], double out[2])
{
    out[0] = margin + (place[0] - s->left) * s->mm;
    out[1] = margin + (s->top - place[1]) * s->mm;
}

// A tenth of a micrometre, without trailing zeros: a file of a million panels is a third shorter.
static void put_mm(FILE* out, double mm)
{
    char text[330]; // room for any double
    int length = snprintf(text, sizeof text, "%.4f", mm);
    while (text[length - 1] == '0')
        --length;
    length -= text[length - 1] == '.';
    fwrite(text, 1, (size_t)length, out);
}

static void put_point(FILE* out, char command, double x, double y)
{
    putc(command, out);
    put_mm(out, x);
    putc(' ', out);
    put_mm(out, y);
}

typedef struct lettering {
    FILE* out;
    double x, y, height; // left end of the base line on the sheet
} lettering;

static void draw_letter(void* context, bool down, double x, double y)
{
    const lettering* l = context;
    put_point(l->out, down ? 'L' : 'M', l->x + l->height * x, l->y - l->height * y);
}

static void put_text(FILE* out, const char* text, double x, double y, double height)
{
    lettering l = {out, x, y, height};
    ax_stroke_text(text, draw_letter, &l);
}

// Letter height in mm at which the name fits into the panel, with its middle in that of the inscribed circle: the circle is 0.8
// filled, so that the beam's width does not matter.
static double label_height(const sheet* s, const double (*flat)[2], const int* corner, const char* name,
                           double centre[2])
{
    double side[3], sum = 0, middle[2] = {0, 0};
    for (int k = 0; k < 3; ++k)
        sum += side[k] = ax_distance2(flat[corner[(k + 1) % 3]], flat[corner[(k + 2) % 3]]);
    for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
            middle[d] += side[k] / sum * flat[corner[k]][d];
    to_sheet(s, middle, centre);
    double radius = ax_orient2(flat[corner[0]], flat[corner[1]], flat[corner[2]]) / sum * s->mm;
    return 2 * 0.8 * radius / hypot(ax_stroke_width(name), 1);
}

// One height for all labels, that of the tightest panel, unless this is too small to read: then panels that cannot hold the
// least height go without. Returns the number of panels with a label.
static int choose_label_height(const sheet* s, const ax_design* design, double* height)
{
    const double(*flat)[2] = (const double(*)[2])design->flat;
    int labelled = 0;
    *height = label_most;
    for (int t = 0; t < design->linkage.triangle_count; ++t) {
        char name[16];
        ax_panel_name(&design->linkage, t, name);
        double centre[2], fits = label_height(s, flat, design->linkage.triangles[t], name, centre);
        labelled += fits >= label_least;
        *height = fmin(*height, fits);
    }
    *height = fmax(*height, label_least);
    return labelled;
}

static void put_layer(FILE* out, const char* name)
{
    fprintf(out, "<g inkscape:groupmode=\"layer\" inkscape:label=\"%s\" id=\"%s\">\n", name, name);
}

static void put_labels(const sheet* s, const ax_design* design, double height)
{
    put_layer(s->out, "LABEL");
    for (int t = 0; t < design->linkage.triangle_count; ++t) {
        char name[16];
        ax_panel_name(&design->linkage, t, name);
        double centre[2];
        if (label_height(s, (const double(*)[2])design->flat, design->linkage.triangles[t], name, centre) < height)
            continue;
        fprintf(s->out, "<path id=\"label-%s\" d=\"", name);
        put_text(s->out, name, centre[0] - ax_stroke_width(name) * height / 2, centre[1] + height / 2, height);
        fprintf(s->out, "\" %s/>\n", label_style);
    }
    fputs("</g>\n", s->out);
}

static void put_cuts(const sheet* s, const ax_design* design)
{
    put_layer(s->out, "CUT");
    for (int t = 0; t < design->linkage.triangle_count; ++t) {
        char name[16];
        ax_panel_name(&design->linkage, t, name);
        fprintf(s->out, "<path id=\"cut-%s\" d=\"", name);
        for (int k = 0; k < 3; ++k) {
            double place[2];
            to_sheet(s, design->flat[design->linkage.triangles[t][k]], place);
            put_point(s->out, k ? 'L' : 'M', place[0], place[1]);
        }
        fprintf(s->out, "Z\" %s/>\n", cut_style);
    }
    fputs("</g>\n", s->out);
}

typedef struct notes {
    char lines[4][96];
    int count;
} notes;

static notes compose_notes(const sheet* s, const ax_design* design, const char* title, int labelled)
{
    notes n = {0};
    size_t room = sizeof n.lines[0];
    int triangles = design->linkage.triangle_count;
    if (title)
        snprintf(n.lines[n.count++], room, "%.60s", title);
    snprintf(n.lines[n.count++], room, "%d triangles, %.1f x %.1f mm", triangles, s->cut[0], s->cut[1]);
    snprintf(n.lines[n.count++], room, "Drawn in mm, design in %s", ax_unit_name(design->unit));
    if (labelled < triangles)
        snprintf(n.lines[n.count++], room, "%d panels are too small for a label", triangles - labelled);
    return n;
}

// The bar to measure after cutting or printing, and the notes under it, below the panels.
static void put_notes(const sheet* s, const notes* n)
{
    put_layer(s->out, "NOTE");
    double y = 2 * margin + s->cut[1] + bar_tick, end = margin + bar_length;
    fputs("<path id=\"check-bar\" d=\"", s->out);
    put_point(s->out, 'M', margin, y - bar_tick);
    put_point(s->out, 'L', margin, y + bar_tick);
    put_point(s->out, 'M', margin, y);
    put_point(s->out, 'L', end, y);
    put_point(s->out, 'M', end, y - bar_tick);
    put_point(s->out, 'L', end, y + bar_tick);
    fprintf(s->out, "\" %s/>\n<path d=\"", note_style);
    put_text(s->out, bar_text, end + note_height, y + note_height / 2, note_height);
    for (int k = 0; k < n->count; ++k)
        put_text(s->out, n->lines[k], margin, y + bar_tick + (k + 1) * note_advance, note_height);
    fprintf(s->out, "\" %s/>\n</g>\n", note_style);
}

// Lays the panels and, below them, the notes on a sheet of whole millimetres.
static sheet lay_sheet(const ax_design* design)
{
    sheet s = {.mm = 1000 * ax_unit_in_metres(design->unit)};
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int h = 0; h < design->linkage.hinge_count; ++h)
        for (int d = 0; d < 2; ++d) {
            lo[d] = fmin(lo[d], design->flat[h][d]);
            hi[d] = fmax(hi[d], design->flat[h][d]);
        }
    s.left = lo[0], s.top = hi[1];
    for (int d = 0; d < 2; ++d)
        s.cut[d] = (hi[d] - lo[d]) * s.mm;
    return s;
}

static void size_sheet(sheet* s, const notes* n)
{
    double content = fmax(s->cut[0], bar_length + note_height * (1 + ax_stroke_width(bar_text)));
    for (int k = 0; k < n->count; ++k)
        content = fmax(content, note_height * ax_stroke_width(n->lines[k]));
    s->width = ceil(content + 2 * margin);
    s->height = ceil(s->cut[1] + 3 * margin + 2 * bar_tick + n->count * note_advance);
}

static void put_escaped(FILE* out, const char* text)
{
    json_t* valid = json_string(text); // jansson knows UTF-8; a file's name may be anything
    for (; *text; ++text)
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        default:
            putc((unsigned char)*text < ' ' || (*text & 0x80 && !valid) ? '?' : *text, out);
        }
    json_decref(valid);
}

static ax_status write_svg(const ax_design* design, ax_state state, const ax_export_options* options, const char* path,
                           ax_error* error)
{
    (void)state;
    sheet s = lay_sheet(design);
    double height;
    int labelled = choose_label_height(&s, design, &height);
    const char* title = options->title && *options->title ? options->title : NULL;
    notes n = compose_notes(&s, design, title, labelled);
    size_sheet(&s, &n);
    s.out = ax_export_open(path, error);
    if (!s.out)
        return AX_FAILED;
    fprintf(s.out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
            "width=\"%.0fmm\" height=\"%.0fmm\" viewBox=\"0 0 %.0f %.0f\">\n<title>",
            s.width, s.height, s.width, s.height);
    put_escaped(s.out, title ? title : "Auxshell cut sheet");
    fprintf(s.out, "</title>\n<desc>Auxshell %s, flat state, lengths in mm, kerf 0</desc>\n", ax_version());
    put_labels(&s, design, height);
    put_cuts(&s, design);
    put_notes(&s, &n);
    fputs("</svg>\n", s.out);
    return ax_export_close(s.out, path, error);
}

const ax_export_type ax_export_svg = {
    .ending = ".svg",
    .name = "SVG cut file",
    .doc = "The flat panels at true size in mm, with layers for cutting, labels and notes.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write = write_svg,
};
