// Group codes after the DXF references of AutoCAD R12 and 2000 (Autodesk). R2000 demands handles that are unique and owners that
// exist; the fixed ones below stay under FIRST_HANDLE.
#include "export/dxf.h"

#include "export/writing.h"

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
    ax_writer writer;
    const ax_cut_plan* plan;
    bool modern; // R2000
    unsigned handle;
} dxf;

static void word(dxf* d, int group, const char* words)
{
    ax_put_whole(&d->writer, group);
    ax_put_words(&d->writer, "\n");
    ax_put_words(&d->writer, words);
    ax_put_words(&d->writer, "\n");
}

static void whole(dxf* d, int group, int value)
{
    ax_put_whole(&d->writer, group);
    ax_put_words(&d->writer, "\n");
    ax_put_whole(&d->writer, value);
    ax_put_words(&d->writer, "\n");
}

static void decimal(dxf* d, int group, double value, int decimals)
{
    ax_put_whole(&d->writer, group);
    ax_put_words(&d->writer, "\n");
    ax_put_fixed(&d->writer, value, decimals);
    ax_put_words(&d->writer, "\n");
}

static void number(dxf* d, int group, double value)
{
    decimal(d, group, value, 6);
}

// A handle, hexadecimal.
static void put_handle(dxf* d, int group, unsigned value)
{
    char digits[9] = "", *at = digits + 8;
    do
        *--at = "0123456789ABCDEF"[value % 16];
    while (value /= 16);
    word(d, group, at);
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
    put_handle(d, 5, handle);
    put_handle(d, 330, owner);
    word(d, 100, class);
}

static void header(dxf* d, const ax_cut_sheet* sheet, unsigned next_handle)
{
    char program[64];
    snprintf(program, sizeof program, "Auxshell %s", ax_version());
    word(d, 999, program);
    word(d, 0, "SECTION");
    word(d, 2, "HEADER");
    word(d, 9, "$ACADVER");
    word(d, 1, d->modern ? "AC1015" : "AC1009");
    if (d->modern) {
        word(d, 9, "$DWGCODEPAGE");
        word(d, 3, "ANSI_1252");
        word(d, 9, "$INSUNITS"); // millimetres
        word(d, 70, "4");
        word(d, 9, "$MEASUREMENT"); // metric
        word(d, 70, "1");
        word(d, 9, "$HANDSEED");
        put_handle(d, 5, next_handle);
    }
    word(d, 9, "$EXTMIN");
    point(d, 10, 0, 0);
    number(d, 30, 0);
    word(d, 9, "$EXTMAX");
    point(d, 10, sheet->width, sheet->height);
    number(d, 30, 0);
    word(d, 0, "ENDSEC");
}

static void begin_table(dxf* d, const char* name, unsigned handle, int count)
{
    word(d, 0, "TABLE");
    word(d, 2, name);
    identity(d, handle, 0, "AcDbSymbolTable");
    whole(d, 70, count);
}

static void begin_record(dxf* d, const char* type, const char* class, unsigned handle, unsigned owner, const char* name)
{
    word(d, 0, type);
    identity(d, handle, owner, "AcDbSymbolTableRecord");
    if (d->modern)
        word(d, 100, class);
    word(d, 2, name);
    if (strcmp(type, "BLOCK_RECORD") != 0)
        word(d, 70, "0");
}

static void line_type(dxf* d, unsigned handle, const char* name, const char* text)
{
    begin_record(d, "LTYPE", "AcDbLinetypeTableRecord", handle, LINETYPES, name);
    word(d, 3, text);
    word(d, 72, "65");
    word(d, 73, "0");
    number(d, 40, 0);
}

static void layer(dxf* d, unsigned handle, const char* name, int colour)
{
    begin_record(d, "LAYER", "AcDbLayerTableRecord", handle, LAYERS, name);
    whole(d, 62, colour);
    word(d, 6, "CONTINUOUS");
}

static void tables(dxf* d)
{
    word(d, 0, "SECTION");
    word(d, 2, "TABLES");
    if (d->modern) {
        begin_table(d, "VPORT", VIEWPORTS, 0);
        word(d, 0, "ENDTAB");
    }
    begin_table(d, "LTYPE", LINETYPES, d->modern ? 3 : 1);
    if (d->modern) {
        line_type(d, BY_BLOCK, "ByBlock", "");
        line_type(d, BY_LAYER, "ByLayer", "");
    }
    line_type(d, CONTINUOUS, "CONTINUOUS", "Solid line");
    word(d, 0, "ENDTAB");
    begin_table(d, "LAYER", LAYERS, AX_OPERATIONS + 1);
    layer(d, LAYER_0, "0", 7);
    for (int k = 0; k < AX_OPERATIONS; ++k)
        layer(d, FIRST_LAYER + (unsigned)k, d->plan->profile->pens[k].layer, d->plan->profile->pens[k].aci);
    word(d, 0, "ENDTAB");
    begin_table(d, "STYLE", STYLES, 1);
    begin_record(d, "STYLE", "AcDbTextStyleTableRecord", STYLE, STYLES, "STANDARD");
    number(d, 40, 0);
    number(d, 41, 1);
    number(d, 50, 0);
    word(d, 71, "0");
    number(d, 42, 2.5);
    word(d, 3, "txt");
    word(d, 4, "");
    word(d, 0, "ENDTAB");
    if (d->modern) {
        begin_table(d, "VIEW", VIEWS, 0);
        word(d, 0, "ENDTAB");
        begin_table(d, "UCS", COORDINATES, 0);
        word(d, 0, "ENDTAB");
        begin_table(d, "APPID", APPLICATIONS, 1);
        begin_record(d, "APPID", "AcDbRegAppTableRecord", APPLICATION, APPLICATIONS, "ACAD");
        word(d, 0, "ENDTAB");
        begin_table(d, "DIMSTYLE", DIMENSIONS, 1);
        word(d, 100, "AcDbDimStyleTable");
        word(d, 0, "DIMSTYLE");
        put_handle(d, 105, DIMENSION); // of all objects these alone have their handle here
        put_handle(d, 330, DIMENSIONS);
        word(d, 100, "AcDbSymbolTableRecord");
        word(d, 100, "AcDbDimStyleTableRecord");
        word(d, 2, "STANDARD");
        word(d, 70, "0");
        word(d, 0, "ENDTAB");
        begin_table(d, "BLOCK_RECORD", BLOCKS, 2);
        begin_record(d, "BLOCK_RECORD", "AcDbBlockTableRecord", MODEL, BLOCKS, "*Model_Space");
        begin_record(d, "BLOCK_RECORD", "AcDbBlockTableRecord", PAPER, BLOCKS, "*Paper_Space");
        word(d, 0, "ENDTAB");
    }
    word(d, 0, "ENDSEC");
}

static void block(dxf* d, const char* name, unsigned record, unsigned begin, unsigned end)
{
    word(d, 0, "BLOCK");
    identity(d, begin, record, "AcDbEntity");
    word(d, 8, "0");
    word(d, 100, "AcDbBlockBegin");
    word(d, 2, name);
    word(d, 70, "0");
    point(d, 10, 0, 0);
    number(d, 30, 0);
    word(d, 3, name);
    word(d, 1, "");
    word(d, 0, "ENDBLK");
    identity(d, end, record, "AcDbEntity");
    word(d, 8, "0");
    word(d, 100, "AcDbBlockEnd");
}

static void begin_entity(dxf* d, const char* type, const char* class, const char* layer_name)
{
    word(d, 0, type);
    if (d->modern)
        identity(d, d->handle++, MODEL, "AcDbEntity");
    word(d, 8, layer_name);
    if (d->modern)
        word(d, 100, class);
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
        whole(d, 90, path->count);
        whole(d, 70, path->closed);
        number(d, 43, 0);
    } else {
        begin_entity(d, "POLYLINE", "", layer_name);
        word(d, 66, "1");
        point(d, 10, 0, 0);
        number(d, 30, 0);
        whole(d, 70, path->closed);
    }
    for (int k = 0; k < path->count; ++k) {
        if (!d->modern)
            begin_entity(d, "VERTEX", "", layer_name);
        point(d, 10, p[k].x, p[k].y);
        if (!d->modern)
            number(d, 30, 0);
        if (p[k].bulge != 0 && (path->closed || k + 1 < path->count))
            decimal(d, 42, p[k].bulge, 9); // the arc ends where the vertex is
    }
    if (!d->modern)
        begin_entity(d, "SEQEND", "", layer_name);
}

static void entities(dxf* d, const ax_cut_sheet* sheet)
{
    const ax_cut_plan* plan = d->plan;
    word(d, 0, "SECTION");
    word(d, 2, "ENTITIES");
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
    word(d, 0, "ENDSEC");
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
    dxf d = {.plan = plan,
             .modern = version == AX_DXF_R2000,
             .handle = FIRST_HANDLE,
             .writer = {.out = ax_export_open(path, error)}};
    if (!d.writer.out)
        return AX_FAILED;
    header(&d, sheet, FIRST_HANDLE + count_entities(plan, sheet));
    if (d.modern) {
        word(&d, 0, "SECTION");
        word(&d, 2, "CLASSES");
        word(&d, 0, "ENDSEC");
    }
    tables(&d);
    if (d.modern) {
        word(&d, 0, "SECTION");
        word(&d, 2, "BLOCKS");
        block(&d, "*Model_Space", MODEL, MODEL_BLOCK, MODEL_END);
        block(&d, "*Paper_Space", PAPER, PAPER_BLOCK, PAPER_END);
        word(&d, 0, "ENDSEC");
    }
    entities(&d, sheet);
    if (d.modern) {
        word(&d, 0, "SECTION");
        word(&d, 2, "OBJECTS");
        word(&d, 0, "DICTIONARY");
        identity(&d, DICTIONARY, 0, "AcDbDictionary");
        word(&d, 281, "1");
        word(&d, 3, "ACAD_GROUP");
        put_handle(&d, 350, GROUPS);
        word(&d, 0, "DICTIONARY");
        identity(&d, GROUPS, DICTIONARY, "AcDbDictionary");
        word(&d, 281, "1");
        word(&d, 0, "ENDSEC");
    }
    word(&d, 0, "EOF");
    return ax_writer_close(&d.writer, path, error);
}
