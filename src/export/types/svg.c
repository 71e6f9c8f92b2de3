// SVG cut file: one sheet of a cut plan at true size. One user unit is a millimetre, and width, height and viewBox all say so;
// programs that guess a resolution have nothing to guess. Layers come in the order of work.
#include "export/writing.h"

#include <jansson.h>
#include <math.h>

static void put_point(FILE* out, char command, double x, double y)
{
    putc(command, out);
    ax_put_mm(out, x);
    putc(' ', out);
    ax_put_mm(out, y);
}

// y of the plan points up, y of the sheet down.
static void put_way(FILE* out, const ax_cut_point* from, const ax_cut_point* to, double height)
{
    if (from->bulge == 0) {
        put_point(out, 'L', to->x, height - to->y);
        return;
    }
    ax_cut_arc arc = ax_cut_arc_of(from, to);
    put_point(out, 'A', arc.radius, arc.radius);
    fprintf(out, " 0 0 %d ", arc.sweep < 0); // no arc is more than a half circle
    ax_put_mm(out, to->x);
    putc(' ', out);
    ax_put_mm(out, height - to->y);
}

static void put_path(FILE* out, const ax_cut_plan* plan, const ax_cut_path* path, double height)
{
    const ax_cut_point *first = &plan->points[path->first], *last = first + path->count - 1;
    put_point(out, 'M', first->x, height - first->y);
    for (const ax_cut_point* p = first; p < last; ++p)
        put_way(out, p, p + 1, height);
    if (path->closed && last->bulge != 0)
        put_way(out, last, first, height);
    if (path->closed)
        putc('Z', out);
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

static void put_items(FILE* out, const ax_cut_plan* plan, const ax_cut_sheet* sheet)
{
    int layer = -1;
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
        const ax_cut_item* item = &plan->items[i];
        const ax_profile_pen* pen = &plan->profile->pens[item->operation];
        if (!pen->used)
            continue;
        if ((int)item->operation != layer) {
            fputs(layer < 0 ? "" : "</g>\n", out);
            layer = (int)item->operation;
            fprintf(out, "<g inkscape:groupmode=\"layer\" inkscape:label=\"");
            put_escaped(out, pen->layer);
            fprintf(out, "\" id=\"%s\">\n", ax_operation_name(item->operation));
        }
        fprintf(out, "<path id=\"%s\" d=\"", item->name);
        for (int k = item->first; k < item->first + item->count; ++k)
            put_path(out, plan, &plan->paths[k], sheet->height);
        fprintf(out, "\" fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-width=\"%g\"/>\n", pen->rgb[0], pen->rgb[1],
                pen->rgb[2], pen->stroke);
    }
    fputs(layer < 0 ? "" : "</g>\n", out);
}

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int number, const char* path,
                             ax_error* error)
{
    (void)design;
    const ax_cut_sheet* sheet = number < plan->sheet_count ? &plan->sheets[number] : &plan->overview;
    FILE* out = ax_export_open(path, error);
    if (!out)
        return AX_FAILED;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
          "width=\"",
          out);
    ax_put_mm(out, sheet->width);
    fputs("mm\" height=\"", out);
    ax_put_mm(out, sheet->height);
    fputs("mm\" viewBox=\"0 0 ", out);
    ax_put_mm(out, sheet->width);
    putc(' ', out);
    ax_put_mm(out, sheet->height);
    fputs("\">\n<title>", out);
    put_escaped(out, *plan->title ? plan->title : "Auxshell cut sheet");
    fprintf(out, "</title>\n<desc>Auxshell %s, flat state, lengths in mm, kerf %g, ", ax_version(), plan->kerf);
    if (number < plan->sheet_count)
        fprintf(out, "sheet %d of %d</desc>\n", number + 1, plan->sheet_count);
    else
        fprintf(out, "overview of %d sheets, not to be cut</desc>\n", plan->sheet_count);
    put_items(out, plan, sheet);
    fputs("</svg>\n", out);
    return ax_export_close(out, path, error);
}

const ax_export_type ax_export_svg = {
    .ending = ".svg",
    .name = "SVG cut file",
    .doc = "The flat panels on sheets at true size in mm, with layers in the order of work.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
};
