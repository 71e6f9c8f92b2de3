// SVG cut file: one sheet of a cut plan at true size. One user unit is a millimetre, and width, height and viewBox all say so;
// programs that guess a resolution have nothing to guess. Layers come in the order of work.
#include "export/writing.h"

#include <jansson.h>
#include <math.h>

static void put_point(ax_writer* out, const char* command, double x, double y)
{
    ax_put_words(out, command);
    ax_put_mm(out, x);
    ax_put_words(out, " ");
    ax_put_mm(out, y);
}

// y of the plan points up, y of the sheet down.
static void put_way(ax_writer* out, const ax_cut_point* from, const ax_cut_point* to, double height)
{
    if (from->bulge == 0) {
        put_point(out, "L", to->x, height - to->y);
        return;
    }
    ax_cut_arc arc = ax_cut_arc_of(from, to);
    put_point(out, "A", arc.radius, arc.radius);
    put_point(out, arc.sweep < 0 ? " 0 0 1 " : " 0 0 0 ", to->x, height - to->y); // no arc is more than a half circle
}

static void put_path(ax_writer* out, const ax_cut_plan* plan, const ax_cut_path* path, double height)
{
    const ax_cut_point *first = &plan->points[path->first], *last = first + path->count - 1;
    put_point(out, "M", first->x, height - first->y);
    for (const ax_cut_point* p = first; p < last; ++p)
        put_way(out, p, p + 1, height);
    if (path->closed && last->bulge != 0)
        put_way(out, last, first, height);
    if (path->closed)
        ax_put_words(out, "Z");
}

static void put_escaped(ax_writer* out, const char* text)
{
    json_t* valid = json_string(text); // jansson knows UTF-8; a file's name may be anything
    for (; *text; ++text)
        switch (*text) {
        case '&':
            ax_put_words(out, "&amp;");
            break;
        case '<':
            ax_put_words(out, "&lt;");
            break;
        case '>':
            ax_put_words(out, "&gt;");
            break;
        default:
            ax_put_words(out, (const char[]){(unsigned char)*text < ' ' || (*text & 0x80 && !valid) ? '?' : *text, 0});
        }
    json_decref(valid);
}

static void put_items(ax_writer* out, const ax_cut_plan* plan, const ax_cut_sheet* sheet)
{
    int layer = -1;
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
        const ax_cut_item* item = &plan->items[i];
        const ax_profile_pen* pen = &plan->profile->pens[item->operation];
        if (!pen->used)
            continue;
        if ((int)item->operation != layer) {
            ax_put_words(out, layer < 0 ? "" : "</g>\n");
            layer = (int)item->operation;
            ax_put_format(out, "<g inkscape:groupmode=\"layer\" inkscape:label=\"");
            put_escaped(out, pen->layer);
            ax_put_format(out, "\" id=\"%s\">\n", ax_operation_name(item->operation));
        }
        ax_put_format(out, "<path id=\"%s\" d=\"", item->name);
        for (int k = item->first; k < item->first + item->count; ++k)
            put_path(out, plan, &plan->paths[k], sheet->height);
        ax_put_format(out, "\" fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-width=\"%g\"/>\n", pen->rgb[0],
                      pen->rgb[1], pen->rgb[2], pen->stroke);
    }
    ax_put_words(out, layer < 0 ? "" : "</g>\n");
}

static ax_status write_sheet(const ax_design* design, const ax_cut_plan* plan, int number, const char* path,
                             ax_error* error)
{
    (void)design;
    const ax_cut_sheet* sheet = number < plan->sheet_count ? &plan->sheets[number] : &plan->overview;
    FILE* file = ax_export_open(path, error);
    if (!file)
        return AX_FAILED;
    ax_writer writer = {.out = file}, *out = &writer;
    ax_put_words(
        out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
             "width=\"");
    ax_put_mm(out, sheet->width);
    ax_put_words(out, "mm\" height=\"");
    ax_put_mm(out, sheet->height);
    ax_put_words(out, "mm\" viewBox=\"0 0 ");
    ax_put_mm(out, sheet->width);
    ax_put_words(out, " ");
    ax_put_mm(out, sheet->height);
    ax_put_words(out, "\">\n<title>");
    put_escaped(out, *plan->title ? plan->title : "Auxshell cut sheet");
    ax_put_format(out, "</title>\n<desc>Auxshell %s, flat state, lengths in mm, kerf %g, ", ax_version(), plan->kerf);
    if (number < plan->sheet_count)
        ax_put_format(out, "sheet %d of %d</desc>\n", number + 1, plan->sheet_count);
    else
        ax_put_format(out, "overview of %d sheets, not to be cut</desc>\n", plan->sheet_count);
    put_items(out, plan, sheet);
    ax_put_words(out, "</svg>\n");
    return ax_writer_close(out, path, error);
}

const ax_export_type ax_export_svg = {
    .ending = ".svg",
    .name = "SVG cut file",
    .doc = "The flat panels on sheets at true size in mm, with layers in the order of work.",
    .default_state = AX_STATE_FLAT,
    .states = {[AX_STATE_DEFAULT] = true, [AX_STATE_FLAT] = true},
    .write_sheet = write_sheet,
};
