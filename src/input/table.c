#include "input/table.h"

#include "base/vec.h"
#include "input/bytes.h"
#include "input/number.h"
#include "mesh/boxtree.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { most_bytes = 64000000, most_rows = 1000000, most_columns = 64, longest_field = 64 };

typedef enum column { COLUMN_PANEL, COLUMN_X, COLUMN_Y, COLUMN_SCALE, COLUMN_KINDS } column;

typedef struct reader {
    const char *path, *at;
    int line;
    char separator;
    int place[COLUMN_KINDS]; // of each column within a line, from 0; -1: not there
    ax_table* table;
    int capacity;
    ax_error* error;
} reader;

static bool ends_line(char c)
{
    return c == '\0' || c == '\n' || c == '\r';
}

static void skip_blanks(reader* r)
{
    while ((*r->at == ' ' || *r->at == '\t') && *r->at != r->separator)
        ++r->at;
}

// Takes the next field without its quotes and the blanks around it, and the separator behind it. What does not fit is cut: no
// value has so many characters. Returns what is wrong with it, or NULL.
static const char* take_field(reader* r, char field[longest_field])
{
    size_t length = 0;
    skip_blanks(r);
    bool quoted = *r->at == '"';
    r->at += quoted;
    for (; !ends_line(*r->at); ++r->at) {
        if (quoted && *r->at == '"') {
            if (r->at[1] != '"')
                break;
            ++r->at;
        } else if (!quoted && *r->at == r->separator)
            break;
        if (length + 1 < longest_field)
            field[length++] = *r->at;
    }
    if (quoted && *r->at != '"')
        return "a quote is not closed on this line";
    r->at += quoted;
    while (!quoted && length && (field[length - 1] == ' ' || field[length - 1] == '\t'))
        --length;
    field[length] = '\0';
    skip_blanks(r);
    if (!ends_line(*r->at) && *r->at != r->separator)
        return "something follows a closing quote; double the quotes within a value";
    return NULL;
}

// True if another field follows on the line.
static bool take_separator(reader* r)
{
    bool more = !ends_line(*r->at);
    r->at += more;
    return more;
}

// Goes to the next line that holds something; false at the end. Line ends are \n, \r\n or \r.
static bool next_line(reader* r)
{
    for (;; ++r->line) {
        r->at += strcspn(r->at, "\r\n");
        if (!*r->at)
            return false;
        r->at += r->at[0] == '\r' && r->at[1] == '\n' ? 2 : 1;
        const char* content = r->at + strspn(r->at, " \t");
        if (!ends_line(*content) && *content != '#') {
            ++r->line;
            return true;
        }
    }
}

static ax_status fail(const reader* r, int place, const char* what)
{
    return ax_fail(r->error, AX_BAD_INPUT, "%s, line %d, column %d: %s.", r->path, r->line, place + 1, what);
}

static ax_status read_header(reader* r)
{
    static const char* const names[COLUMN_KINDS][2] = {{"panel", "panel"}, {"x", "x"}, {"y", "y"}, {"lambda", "scale"}};
    size_t length = strcspn(r->at, "\r\n");
    r->separator = memchr(r->at, ';', length) ? ';' : (memchr(r->at, '\t', length) ? '\t' : ',');
    for (int kind = 0; kind < COLUMN_KINDS; ++kind)
        r->place[kind] = -1;
    int place = 0;
    do {
        char field[longest_field];
        const char* what = take_field(r, field);
        if (what)
            return fail(r, place, what);
        for (int kind = 0; kind < COLUMN_KINDS; ++kind)
            if (strcasecmp(field, names[kind][0]) == 0 || strcasecmp(field, names[kind][1]) == 0) {
                if (r->place[kind] >= 0)
                    return fail(r, place, "this column stands twice; leave one out");
                r->place[kind] = place;
            }
    } while (take_separator(r) && ++place < most_columns);
    r->table->by_panel = r->place[COLUMN_PANEL] >= 0;
    bool placed = r->place[COLUMN_X] >= 0 && r->place[COLUMN_Y] >= 0;
    if (r->place[COLUMN_SCALE] < 0 || (!r->table->by_panel && !placed))
        return ax_fail(r->error, AX_BAD_INPUT,
                       "%s, line %d: the first line must name the columns, \"panel,lambda\" or \"x,y,lambda\".",
                       r->path, r->line);
    return AX_OK;
}

static bool read_number(const reader* r, char* field, double* value)
{
    char* comma = r->separator == ',' ? NULL : strchr(field, ',');
    if (comma)
        *comma = '.';
    const char* after = ax_number_read(field, value);
    return after && !*after && isfinite(*value);
}

static void grow(reader* r)
{
    ax_table* t = r->table;
    if (t->count < r->capacity)
        return;
    r->capacity = r->capacity ? 2 * r->capacity : 256;
    size_t rows = (size_t)r->capacity;
    t->lines = ax_realloc(t->lines, rows, sizeof *t->lines);
    t->scale = ax_realloc(t->scale, rows, sizeof *t->scale);
    if (t->by_panel)
        t->panels = ax_realloc(t->panels, rows, sizeof *t->panels);
    else
        t->places = ax_realloc(t->places, rows, sizeof *t->places);
}

// One value of the row being read; NULL or what is wrong with it.
static const char* take_value(reader* r, column kind, char* field)
{
    ax_table* t = r->table;
    if (kind == COLUMN_PANEL) {
        if (!*field || strlen(field) >= sizeof *t->panels)
            return "a panel's name should stand here, such as C14";
        strcpy(t->panels[t->count], field);
        return NULL;
    }
    double* value = kind == COLUMN_SCALE ? &t->scale[t->count] : &t->places[t->count][kind - COLUMN_X];
    if (!read_number(r, field, value))
        return "a number should stand here";
    if (fabs(*value) > 1e12) // beyond, boxes of places in single precision lose their differences
        return "this number is larger than any sheet";
    if (kind == COLUMN_SCALE && !(*value > 0))
        return "a scale factor must be greater than 0";
    return NULL;
}

static ax_status read_row(reader* r)
{
    grow(r);
    int place = 0;
    bool missing[COLUMN_KINDS];
    for (column kind = 0; kind < COLUMN_KINDS; ++kind)
        missing[kind] = kind == COLUMN_SCALE || (kind == COLUMN_PANEL) == r->table->by_panel;
    do {
        char field[longest_field];
        const char* what = take_field(r, field);
        for (column kind = 0; kind < COLUMN_KINDS && !what; ++kind)
            if (missing[kind] && r->place[kind] == place) {
                missing[kind] = false;
                what = take_value(r, kind, field);
            }
        if (what)
            return fail(r, place, what);
    } while (take_separator(r) && ++place < most_columns);
    for (column kind = 0; kind < COLUMN_KINDS; ++kind)
        if (missing[kind])
            return fail(r, r->place[kind], "the line ends before this column");
    r->table->lines[r->table->count++] = r->line;
    return AX_OK;
}

static ax_status read_rows(reader* r)
{
    ax_status status = read_header(r);
    while (status == AX_OK && next_line(r)) {
        if (r->table->count == most_rows)
            return ax_fail(r->error, AX_BAD_INPUT, "%s has more than %d rows. Thin it out.", r->path, most_rows);
        status = read_row(r);
    }
    if (status == AX_OK && r->table->count == 0)
        return ax_fail(r->error, AX_BAD_INPUT, "%s names its columns but has no rows.", r->path);
    return status;
}

ax_status ax_table_parse(const char* path, const char* bytes, size_t size, ax_table* out, ax_error* error)
{
    *out = (ax_table){0};
    if (memchr(bytes, '\0', size))
        return ax_fail(error, AX_BAD_INPUT, "%s is not a text file. Save the table as CSV, encoded in UTF-8.", path);
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) // a byte order mark, as spreadsheets write
        bytes += 3;
    reader r = {.path = path, .at = bytes, .line = 1, .table = out, .error = error};
    const char* content = bytes + strspn(bytes, " \t");
    bool some = (!ends_line(*content) && *content != '#') || next_line(&r);
    ax_status status =
        some ? read_rows(&r) : ax_fail(error, AX_BAD_INPUT, "%s holds no table, only empty lines.", path);
    if (status != AX_OK)
        ax_table_free(out);
    return status;
}

ax_status ax_table_read(const char* path, ax_table* out, ax_error* error)
{
    *out = (ax_table){0};
    char* bytes;
    size_t size;
    ax_status status = ax_bytes_read(path, "a table", most_bytes, &bytes, &size, error);
    if (status == AX_OK)
        status = ax_table_parse(path, bytes, size, out, error);
    ax_free(bytes);
    return status;
}

void ax_table_free(ax_table* table)
{
    ax_free(table->lines);
    ax_free(table->scale);
    ax_free(table->panels);
    ax_free(table->places);
    *table = (ax_table){0};
}

typedef struct name {
    char text[16];
    int index; // triangle
} name;

// Of names, or of their texts alone: that is how they begin.
static int compare_names(const void* a, const void* b)
{
    return strcasecmp(a, b);
}

static ax_status apply_by_panel(const ax_table* table, const char* path, const ax_linkage* linkage, double* scale,
                                ax_error* error)
{
    int triangles = linkage->triangle_count;
    name* names = AX_NEW(name, triangles);
    int* set_by = AX_NEW0(int, triangles); // line
    int* rows = AX_NEW(int, table->count); // triangles
    for (int t = 0; t < triangles; ++t) {
        ax_panel_name(linkage, t, names[t].text);
        names[t].index = t;
    }
    qsort(names, (size_t)triangles, sizeof *names, compare_names);
    ax_status status = AX_OK;
    for (int k = 0; k < table->count && status == AX_OK; ++k) {
        const char* wanted = table->panels[k];
        const name* found = bsearch(wanted, names, (size_t)triangles, sizeof *names, compare_names);
        if (!found)
            status = ax_fail(error, AX_BAD_INPUT, "%s, line %d: there is no panel \"%s\" in this design.", path,
                             table->lines[k], wanted);
        else if (set_by[found->index])
            status = ax_fail(error, AX_BAD_INPUT, "%s, line %d: panel \"%s\" stands on line %d already. Leave one out.",
                             path, table->lines[k], wanted, set_by[found->index]);
        else {
            rows[k] = found->index;
            set_by[found->index] = table->lines[k];
        }
    }
    for (int k = 0; k < table->count && status == AX_OK; ++k)
        scale[rows[k]] = table->scale[k];
    ax_free(rows);
    ax_free(set_by);
    ax_free(names);
    return status;
}

// The samples nearest to x, in order of distance, ties by their number.
enum { neighbours = 12 };
typedef struct nearest {
    const ax_table* table;
    const ax_box_tree* tree;
    const double* x;
    int count, index[neighbours];
    double squared[neighbours];
    double limit; // squared distance beyond which nothing counts
} nearest;

static void offer(void* context, int place)
{
    nearest* n = context;
    int sample = n->tree->order[place];
    double dx = n->table->places[sample][0] - n->x[0], dy = n->table->places[sample][1] - n->x[1];
    double squared = dx * dx + dy * dy;
    int k = n->count < neighbours ? n->count++ : neighbours;
    if (k == neighbours) {
        int last = neighbours - 1;
        if (squared > n->squared[last] || (squared == n->squared[last] && sample > n->index[last]))
            return;
        k = last;
    }
    for (; k > 0 && (n->squared[k - 1] > squared || (n->squared[k - 1] == squared && n->index[k - 1] > sample)); --k) {
        n->squared[k] = n->squared[k - 1];
        n->index[k] = n->index[k - 1];
    }
    n->squared[k] = squared;
    n->index[k] = sample;
    n->limit = n->count < neighbours ? INFINITY : n->squared[neighbours - 1];
}

// Local linear fit with the weights of Franke and Nielson (1980): infinite at a sample, zero at the farthest one, so that the
// field takes each sample's value and has no steps. Where the samples lie on a line or at one place, their weighted mean.
static double fit(const nearest* n)
{
    const ax_table* t = n->table;
    if (n->squared[0] == 0 || n->count == 1)
        return t->scale[n->index[0]];
    // fewer samples than neighbours: none has to fade out, as none will be exchanged for another
    double reach = n->count < neighbours ? INFINITY : sqrt(n->squared[n->count - 1]);
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0, wv = 0, wxv = 0, wyv = 0, lo = INFINITY, hi = -INFINITY;
    for (int k = 0; k < n->count; ++k) {
        double value = t->scale[n->index[k]], distance = sqrt(n->squared[k]);
        double x = t->places[n->index[k]][0] - n->x[0], y = t->places[n->index[k]][1] - n->x[1];
        double fade = isinf(reach) ? 1 : 1 - distance / reach;
        double weight = fade * fade / n->squared[k] * n->squared[0]; // at most 1
        w += weight, wx += weight * x, wy += weight * y;
        wxx += weight * x * x, wxy += weight * x * y, wyy += weight * y * y;
        wv += weight * value, wxv += weight * x * value, wyv += weight * y * value;
        lo = fmin(lo, value), hi = fmax(hi, value);
    }
    if (!(w > 0)) // all equally far
        return t->scale[n->index[0]];
    double mx = wx / w, my = wy / w, mean = wv / w;
    double xx = wxx / w - mx * mx, xy = wxy / w - mx * my, yy = wyy / w - my * my;
    double xv = wxv / w - mx * mean, yv = wyv / w - my * mean;
    double determinant = xx * yy - xy * xy, size = xx + yy;
    if (!(determinant > 1e-6 * size * size))
        return mean;
    double gx = (yy * xv - xy * yv) / determinant, gy = (xx * yv - xy * xv) / determinant;
    return ax_clamp(mean - gx * mx - gy * my, lo, hi);
}

static void apply_scattered(const ax_table* table, const ax_linkage* linkage, const double (*sheet)[2], double* scale)
{
    double(*boxes)[2][3] = ax_calloc((size_t)table->count, sizeof *boxes);
    for (int k = 0; k < table->count; ++k)
        for (int side = 0; side < 2; ++side)
            for (int d = 0; d < 2; ++d)
                boxes[k][side][d] = table->places[k][d];
    ax_box_tree tree = ax_box_tree_make(table->count, (const double(*)[2][3])boxes);
    for (int t = 0; t < linkage->triangle_count; ++t) {
        double x[3] = {0};
        for (int corner = 0; corner < 3; ++corner)
            for (int d = 0; d < 2; ++d)
                x[d] += sheet[linkage->triangles[t][corner]][d] / 3;
        nearest n = {.table = table, .tree = &tree, .x = x, .limit = INFINITY};
        ax_box_tree_nearest(&tree, x, x, &n.limit, offer, &n);
        scale[t] = fit(&n);
    }
    ax_box_tree_free(&tree);
    ax_free(boxes);
}

ax_status ax_table_apply(const ax_table* table, const char* path, const ax_linkage* linkage, const double (*sheet)[2],
                         double* scale, ax_error* error)
{
    if (table->by_panel)
        return apply_by_panel(table, path, linkage, scale, error);
    apply_scattered(table, linkage, sheet, scale);
    return AX_OK;
}
