// Group codes after the DXF references of AutoCAD R12 and 2000 (Autodesk). R2000 demands handles that are unique and owners that
// exist; the fixed ones below stay under FIRST_HANDLE.
#include "export/dxf.h"

#include "export/writing.h"

#include <stdarg.h>
#include <string.h>

enum {
    DICTIONARY = 0x1,
    GROUPS,
    VIEWPORTS,
    LINETYPES,
    BY_BLOCK,
    BY_LAYER,
    CONTINUOUS,
    LAYERS,
    LAYER_0,
    STYLES,
    STYLE,
    VIEWS,
    COORDINATES,
    APPLICATIONS,
    APPLICATION,
    DIMENSIONS,
    DIMENSION,
    BLOCKS,
    MODEL,
    PAPER,
    MODEL_BLOCK,
    MODEL_END,
    PAPER_BLOCK,
    PAPER_END,
    VIEWPORT,
    FIRST_LAYER,
    FIRST_HANDLE = FIRST_LAYER + AX_OPERATIONS + 1,
};

typedef struct dxf {
    FILE* out;
    const ax_cut_plan* plan;
    bool modern; // R2000
    unsigned handle;
} dxf;

static void code(dxf* d, int group, const char* format, ...) __attribute__((format(printf, 3, 4)));
static void code(dxf* d, int group, const char* format, ...)
{
    fprintf(d->out, "%d\n", group);
    va_list arguments;
    va_start(arguments, format);
    vfprintf(d->out, format, arguments);
    va_end(arguments);
    putc('\n', d->out);
}

static void number(dxf* d, int group, double value)
{
    fprintf(d->out, "%d\n%.6f\n", group, value == 0 ? 0 : value); // no "-0.000000"
}

static void point(dxf* d, int group, double x, double y)
{
    number(d, group, x);
    number(d, group + 10, y);
}

// Handle, owner and classes of R2000 objects.
static void identity(dxf* d, unsigned handle, unsigned owner, const char* class)
{
    if (!d->modern)
        return;
    code(d, 5, "%X", handle);
    code(d, 330, "%X", owner);
    code(d, 100, "%s", class);
}

static void header(dxf* d, const ax_cut_sheet* sheet, unsigned next_handle)
{
    code(d, 999, "Auxshell %s", ax_version());
    code(d, 0, "SECTION");
    code(d, 2, "HEADER");
    code(d, 9, "$ACADVER");
    code(d, 1, d->modern ? "AC1015" : "AC1009");
    if (d->modern) {
        code(d, 9, "$DWGCODEPAGE");
        code(d, 3, "ANSI_1252");
        code(d, 9, "$INSUNITS"); // millimetres
        code(d, 70, "4");
        code(d, 9, "$MEASUREMENT"); // metric
        code(d, 70, "1");
        code(d, 9, "$HANDSEED");
        code(d, 5, "%X", next_handle);
    }
    code(d, 9, "$EXTMIN");
    point(d, 10, 0, 0);
    number(d, 30, 0);
    code(d, 9, "$EXTMAX");
    point(d, 10, sheet->width, sheet->height);
    number(d, 30, 0);
    code(d, 0, "ENDSEC");
}

static void begin_table(dxf* d, const char* name, unsigned handle, int count)
{
    code(d, 0, "TABLE");
    code(d, 2, "%s", name);
    identity(d, handle, 0, "AcDbSymbolTable");
    code(d, 70, "%d", count);
}

static void begin_record(dxf* d, const char* type, const char* class, unsigned handle, unsigned owner, const char* name)
{
    code(d, 0, "%s", type);
    identity(d, handle, owner, "AcDbSymbolTableRecord");
    if (d->modern)
        code(d, 100, "%s", class);
    code(d, 2, "%s", name);
    if (strcmp(type, "BLOCK_RECORD") != 0)
        code(d, 70, "0");
}

static void line_type(dxf* d, unsigned handle, const char* name, const char* text)
{
    begin_record(d, "LTYPE", "AcDbLinetypeTableRecord", handle, LINETYPES, name);
    code(d, 3, "%s", text);
    code(d, 72, "65");
    code(d, 73, "0");
    number(d, 40, 0);
}

static void layer(dxf* d, unsigned handle, const char* name, int colour)
{
    begin_record(d, "LAYER", "AcDbLayerTableRecord", handle, LAYERS, name);
    code(d, 62, "%d", colour);
    code(d, 6, "CONTINUOUS");
}

static void tables(dxf* d)
{
    code(d, 0, "SECTION");
    code(d, 2, "TABLES");
    if (d->modern) {
        begin_table(d, "VPORT", VIEWPORTS, 0);
        code(d, 0, "ENDTAB");
    }
    begin_table(d, "LTYPE", LINETYPES, d->modern ? 3 : 1);
    if (d->modern) {
        line_type(d, BY_BLOCK, "ByBlock", "");
        line_type(d, BY_LAYER, "ByLayer", "");
    }
    line_type(d, CONTINUOUS, "CONTINUOUS", "Solid line");
    code(d, 0, "ENDTAB");
    begin_table(d, "LAYER", LAYERS, AX_OPERATIONS + 1);
    layer(d, LAYER_0, "0", 7);
    for (int k = 0; k < AX_OPERATIONS; ++k)
        layer(d, FIRST_LAYER + (unsigned)k, d->plan->profile->pens[k].layer, d->plan->profile->pens[k].aci);
    code(d, 0, "ENDTAB");
    begin_table(d, "STYLE", STYLES, 1);
    begin_record(d, "STYLE", "AcDbTextStyleTableRecord", STYLE, STYLES, "STANDARD");
    number(d, 40, 0);
    number(d, 41, 1);
    number(d, 50, 0);
    code(d, 71, "0");
    number(d, 42, 2.5);
    code(d, 3, "txt");
    code(d, 4, "%s", "");
    code(d, 0, "ENDTAB");
    if (d->modern) {
        begin_table(d, "VIEW", VIEWS, 0);
        code(d, 0, "ENDTAB");
        begin_table(d, "UCS", COORDINATES, 0);
        code(d, 0, "ENDTAB");
        begin_table(d, "APPID", APPLICATIONS, 1);
        begin_record(d, "APPID", "AcDbRegAppTableRecord", APPLICATION, APPLICATIONS, "ACAD");
        code(d, 0, "ENDTAB");
        begin_table(d, "DIMSTYLE", DIMENSIONS, 1);
        code(d, 100, "AcDbDimStyleTable");
        code(d, 0, "DIMSTYLE");
        code(d, 105, "%X", DIMENSION); // of all objects these alone have their handle here
        code(d, 330, "%X", DIMENSIONS);
        code(d, 100, "AcDbSymbolTableRecord");
        code(d, 100, "AcDbDimStyleTableRecord");
        code(d, 2, "STANDARD");
        code(d, 70, "0");
        code(d, 0, "ENDTAB");
        begin_table(d, "BLOCK_RECORD", BLOCKS, 2);
        begin_record(d, "BLOCK_RECORD", "AcDbBlockTableRecord", MODEL, BLOCKS, "*Model_Space");
        begin_record(d, "BLOCK_RECORD", "AcDbBlockTableRecord", PAPER, BLOCKS, "*Paper_Space");
        code(d, 0, "ENDTAB");
    }
    code(d, 0, "ENDSEC");
}

static void block(dxf* d, const char* name, unsigned record, unsigned begin, unsigned end)
{
    code(d, 0, "BLOCK");
    identity(d, begin, record, "AcDbEntity");
    code(d, 8, "0");
    code(d, 100, "AcDbBlockBegin");
    code(d, 2, "%s", name);
    code(d, 70, "0");
    point(d, 10, 0, 0);
    number(d, 30, 0);
    code(d, 3, "%s", name);
    code(d, 1, "%s", "");
    code(d, 0, "ENDBLK");
    identity(d, end, record, "AcDbEntity");
    code(d, 8, "0");
    code(d, 100, "AcDbBlockEnd");
}

static void begin_entity(dxf* d, const char* type, const char* class, const char* layer_name)
{
    code(d, 0, "%s", type);
    if (d->modern)
        identity(d, d->handle++, MODEL, "AcDbEntity");
    code(d, 8, "%s", layer_name);
    if (d->modern)
        code(d, 100, "%s", class);
}

static void circle(dxf* d, const char* layer_name, const double centre[2], double radius)
{
    begin_entity(d, "CIRCLE", "AcDbCircle", layer_name);
    point(d, 10, centre[0], centre[1]);
    number(d, 30, 0);
    number(d, 40, radius);
}

static void polyline(dxf* d, const char* layer_name, const ax_cut_path* path)
{
    const ax_cut_point* p = d->plan->points + path->first;
    if (d->modern) {
        begin_entity(d, "LWPOLYLINE", "AcDbPolyline", layer_name);
        code(d, 90, "%d", path->count);
        code(d, 70, "%d", path->closed);
        number(d, 43, 0);
    } else {
        begin_entity(d, "POLYLINE", "", layer_name);
        code(d, 66, "1");
        point(d, 10, 0, 0);
        number(d, 30, 0);
        code(d, 70, "%d", path->closed);
    }
    for (int k = 0; k < path->count; ++k) {
        if (!d->modern)
            begin_entity(d, "VERTEX", "", layer_name);
        point(d, 10, p[k].x, p[k].y);
        if (!d->modern)
            number(d, 30, 0);
        if (p[k].bulge != 0 && (path->closed || k + 1 < path->count)) // nine digits: the arc ends where the vertex is
            fprintf(d->out, "42\n%.9f\n", p[k].bulge);
    }
    if (!d->modern)
        begin_entity(d, "SEQEND", "", layer_name);
}

static void entities(dxf* d, const ax_cut_sheet* sheet)
{
    const ax_cut_plan* plan = d->plan;
    code(d, 0, "SECTION");
    code(d, 2, "ENTITIES");
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i) {
        const ax_cut_item* item = plan->items + i;
        const ax_profile_pen* pen = plan->profile->pens + item->operation;
        for (int k = item->first; k < item->first + item->count && pen->used; ++k) {
            double centre[2], radius;
            if (ax_cut_path_is_circle(plan, plan->paths + k, centre, &radius))
                circle(d, pen->layer, centre, radius);
            else if (plan->paths[k].count > 1)
                polyline(d, pen->layer, plan->paths + k);
        }
    }
    code(d, 0, "ENDSEC");
}

// How many handles the entities will take.
static unsigned count_entities(const ax_cut_plan* plan, const ax_cut_sheet* sheet)
{
    unsigned count = 0;
    for (int i = sheet->first; i < sheet->first + sheet->count; ++i)
        count += (unsigned)plan->items[i].count;
    return count;
}

ax_status ax_dxf_write(const ax_cut_plan* plan, int k, ax_dxf_version version, const char* path, ax_error* error)
{
    const ax_cut_sheet* sheet = k == plan->sheet_count ? &plan->overview : plan->sheets + k;
    dxf d = {
        .plan = plan, .modern = version == AX_DXF_R2000, .handle = FIRST_HANDLE, .out = ax_export_open(path, error)};
    if (!d.out)
        return AX_FAILED;
    header(&d, sheet, FIRST_HANDLE + count_entities(plan, sheet));
    if (d.modern) {
        code(&d, 0, "SECTION");
        code(&d, 2, "CLASSES");
        code(&d, 0, "ENDSEC");
    }
    tables(&d);
    if (d.modern) {
        code(&d, 0, "SECTION");
        code(&d, 2, "BLOCKS");
        block(&d, "*Model_Space", MODEL, MODEL_BLOCK, MODEL_END);
        block(&d, "*Paper_Space", PAPER, PAPER_BLOCK, PAPER_END);
        code(&d, 0, "ENDSEC");
    }
    entities(&d, sheet);
    if (d.modern) {
        code(&d, 0, "SECTION");
        code(&d, 2, "OBJECTS");
        code(&d, 0, "DICTIONARY");
        identity(&d, DICTIONARY, 0, "AcDbDictionary");
        code(&d, 281, "1");
        code(&d, 3, "ACAD_GROUP");
        code(&d, 350, "%X", GROUPS);
        code(&d, 0, "DICTIONARY");
        identity(&d, GROUPS, DICTIONARY, "AcDbDictionary");
        code(&d, 281, "1");
        code(&d, 0, "ENDSEC");
    }
    code(&d, 0, "EOF");
    return ax_export_close(d.out, path, error);
}
