// Selections by words: "rim:0..90/3, #arch".
#include "operator/selection.h"

#include "input/number.h"
#include "linkage/lattice.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char ax_no_name[] = "a name has up to 48 letters, digits, dots, dashes and underscores, a letter first.";

bool ax_is_name(const char* text)
{
    size_t length = strlen(text);
    if (length < 1 || length > 48 || !isalpha((unsigned char)*text))
        return false;
    for (const char* at = text; *at; ++at)
        if (!isalnum((unsigned char)*at) && !strchr("-_.", *at))
            return false;
    return true;
}

typedef struct reader {
    ax_form* form;
    ax_form_view view;
    const char *words, *at;
    ax_error* error;
} reader;

static ax_status refuse(const reader* r, const char* expected)
{
    return ax_fail(r->error, AX_BAD_INPUT,
                   "The selection \"%.200s\" cannot be read at character %d: %s. For example rim, rim/3, 0-12,40, C14, "
                   "#name.",
                   r->words, (int)(r->at - r->words) + 1, expected);
}

static bool take(reader* r, const char* word)
{
    size_t length = strlen(word);
    if (strncmp(r->at, word, length) != 0)
        return false;
    r->at += length;
    return true;
}

static void skip_space(reader* r)
{
    r->at += strspn(r->at, " ");
}

static bool take_number(reader* r, double* value)
{
    skip_space(r);
    const char *end = ax_number_read(r->at, value), *dots = strstr(r->at, "..");
    if (!end || fabs(*value) > 1e9)
        return false;
    r->at = dots && dots < end ? dots : end; // 0..90: the point belongs to the dots
    return true;
}

static ax_status take_hinge(reader* r, int* hinge)
{
    skip_space(r);
    const char* start = r->at;
    long value = -1;
    char* end = (char*)start;
    if (isdigit((unsigned char)*start))
        value = strtol(start, &end, 10);
    if (value < 0)
        return refuse(r, "the number of a hinge is wanted");
    if (value >= r->view.linkage->hinge_count)
        return ax_fail(r->error, AX_BAD_INPUT, "Hinges are numbered 0 to %d; %ld is not among them.",
                       r->view.linkage->hinge_count - 1, value);
    *hinge = (int)value;
    r->at = end;
    return AX_OK;
}

// "(a, b, ...)": `least` to `most` numbers; those that are left out stay as they are.
static ax_status take_up_to(reader* r, int least, int most, double* values)
{
    for (int k = 0; k < most; ++k) {
        skip_space(r);
        if (k >= least && *r->at == ')')
            break;
        if (!take(r, k ? "," : "(") || !take_number(r, &values[k]))
            return refuse(r, "numbers in parentheses, separated by commas, are wanted");
    }
    skip_space(r);
    return take(r, ")") ? AX_OK : refuse(r, "a closing parenthesis is wanted");
}

static ax_status take_numbers(reader* r, int count, double* values)
{
    return take_up_to(r, count, count, values);
}

// A hinge by its number, or that of `count` (NULL: of all) which is nearest to a point of the sheet, (x, y).
static ax_status take_spot(reader* r, int count, const int* among, int* hinge)
{
    skip_space(r);
    if (*r->at != '(')
        return take_hinge(r, hinge);
    double at[2];
    ax_status status = take_numbers(r, 2, at);
    *hinge = -1;
    for (int k = 0; k < count && status == AX_OK; ++k) {
        int h = among ? among[k] : k;
        if (*hinge < 0 || ax_distance2(r->view.sheet[h], at) < ax_distance2(r->view.sheet[*hinge], at))
            *hinge = h;
    }
    return status;
}

static ax_status take_pair(reader* r, int* a, int* b)
{
    int all = r->view.linkage->hinge_count;
    if (!take(r, "("))
        return refuse(r, "two hinges in parentheses are wanted");
    ax_status status = take_spot(r, all, NULL, a);
    if (status == AX_OK && (skip_space(r), !take(r, ",")))
        status = refuse(r, "a comma and a second hinge are wanted");
    if (status == AX_OK)
        status = take_spot(r, all, NULL, b);
    if (status == AX_OK && (skip_space(r), !take(r, ")")))
        status = refuse(r, "a closing parenthesis is wanted");
    return status;
}

// An angle in degrees brought to 0 to 360.
static double turn_by(double angle)
{
    double rest = fmod(angle, 360);
    return rest < 0 ? rest + 360 : rest;
}

// "near(x, y)", the nearest of these hinges, or "near(x, y, distance)", all within it.
static ax_status take_near(reader* r, const ax_hinges* among, ax_hinges* set)
{
    double v[3] = {0, 0, 0};
    ax_status status = take_up_to(r, 2, 3, v);
    if (status == AX_OK && v[2] < 0)
        status = refuse(r, "a distance of 0 or more is wanted");
    if (status == AX_OK)
        ax_select_nearest(&r->view, among, v, v[2], set);
    return status;
}

static ax_status find_corners(const reader* r, const ax_hinges* rim, ax_corner* corners, int* count)
{
    *count = ax_select_corners(&r->view, rim->count, rim->hinges, corners);
    return *count > 0
               ? AX_OK
               : ax_fail(r->error, AX_BAD_INPUT,
                         "The sheet has no sides and corners: its outline turns nowhere sharply, or more than %d "
                         "times. Choose a part by angle, such as rim:0..90, or near a point, such as "
                         "rim:near(1,0,0.2).",
                         AX_CORNERS_MOST);
}

// The number that follows "side" or "corner", 1 to n.
static ax_status take_count(reader* r, const char* of, int n, int* number)
{
    char* end = (char*)r->at;
    long value = isdigit((unsigned char)*r->at) ? strtol(r->at, &end, 10) : 0;
    if (value < 1 || value > n)
        return ax_fail(r->error, AX_BAD_INPUT, "The rim has %s 1 to %d.", of, n);
    r->at = end;
    *number = (int)value;
    return AX_OK;
}

// Puts a run of places, cyclic, in place of the rim.
static void keep_run(const reader* r, int from, int to, ax_hinges* rim)
{
    ax_hinges part = ax_hinges_make(r->view.linkage);
    int many = (to - from + rim->count) % rim->count + 1;
    for (int k = 0; k < many; ++k)
        ax_hinges_add(&part, rim->hinges[(from + k) % rim->count]);
    ax_hinges_free(rim);
    *rim = part;
}

static ax_status take_side(reader* r, ax_hinges* rim)
{
    ax_corner corners[AX_CORNERS_MOST];
    int n, side = 0;
    ax_status status = find_corners(r, rim, corners, &n);
    if (status == AX_OK && (status = take_count(r, "sides", n, &side)) == AX_OK)
        keep_run(r, corners[side - 1].place, corners[side % n].place, rim);
    return status;
}

static ax_status take_corner(reader* r, ax_hinges* rim)
{
    ax_corner corners[AX_CORNERS_MOST];
    int n, corner = 0;
    double distance = 0;
    ax_hinges part = ax_hinges_make(r->view.linkage);
    ax_status status = find_corners(r, rim, corners, &n);
    if (status == AX_OK)
        status = take_count(r, "corners", n, &corner);
    if (status == AX_OK && *r->at == '(')
        status = take_numbers(r, 1, &distance);
    if (status == AX_OK && distance < 0)
        status = refuse(r, "a distance of 0 or more is wanted");
    if (status == AX_OK)
        ax_select_nearest(&r->view, rim, corners[corner - 1].at, distance, &part);
    ax_hinges_free(rim);
    *rim = part;
    return status;
}

static ax_status take_angles(reader* r, double lo, ax_hinges* rim)
{
    double hi;
    if (!take_number(r, &hi))
        return refuse(r, "a second angle in degrees is wanted");
    double middle[2];
    ax_sheet_middle(&r->view, middle);
    ax_hinges part = ax_hinges_make(r->view.linkage);
    int start = -1; // in order from the first angle on: a run may go on past 0 degrees
    double smallest = INFINITY;
    for (int k = 0; k < rim->count; ++k) {
        double beyond = turn_by(ax_angle_about(middle, r->view.sheet[rim->hinges[k]]) - lo);
        if (beyond < smallest)
            smallest = beyond, start = k;
    }
    for (int k = 0; k < rim->count; ++k) {
        int h = rim->hinges[(start + k) % rim->count];
        if (turn_by(ax_angle_about(middle, r->view.sheet[h]) - lo) <= (hi > lo ? hi - lo : turn_by(hi - lo)))
            ax_hinges_add(&part, h);
    }
    ax_hinges_free(rim);
    *rim = part;
    return AX_OK;
}

// One end of a run of the rim; its place in the rim.
static ax_status take_end(reader* r, const ax_hinges* rim, int* place)
{
    int hinge;
    ax_status status = take_spot(r, rim->count, rim->hinges, &hinge);
    if (status == AX_OK && !rim->in[hinge])
        status = ax_fail(r->error, AX_BAD_INPUT, "Hinge %d is not on the rim.", hinge);
    for (int k = 0; k < rim->count; ++k)
        *place = rim->hinges[k] == hinge ? k : *place;
    return status;
}

// What follows "rim:": "30..60" by angle, "side2", "corner2(0.1)", "near(1,0)", "12>40" or "(1,0)>(0,1)" from hinge to hinge. `rim` is
// cut down to that.
static ax_status take_part(reader* r, ax_hinges* rim)
{
    if (take(r, "side"))
        return take_side(r, rim);
    if (take(r, "corner"))
        return take_corner(r, rim);
    if (take(r, "near")) {
        ax_hinges part = ax_hinges_make(r->view.linkage);
        ax_status status = take_near(r, rim, &part);
        ax_hinges_free(rim);
        *rim = part;
        return status;
    }
    reader ahead = *r;
    double lo;
    if (take_number(&ahead, &lo) && take(&ahead, "..")) {
        r->at = ahead.at;
        return take_angles(r, lo, rim);
    }
    int from = 0, to = 0;
    if (!isdigit((unsigned char)*r->at) && *r->at != '(')
        return refuse(r, "a part of the rim is wanted: 0..90 (degrees), side1, corner1, near(1,0), 12>40 (hinges) or "
                         "(1,0)>(0,1) (points)");
    ax_status status = take_end(r, rim, &from);
    if (status == AX_OK && (skip_space(r), !take(r, ">")))
        status = refuse(r, "> and the other end of a part of the rim are wanted");
    if (status == AX_OK)
        status = take_end(r, rim, &to);
    if (status == AX_OK)
        keep_run(r, from, to, rim);
    return status;
}

static ax_status take_rim(reader* r, ax_hinges* set)
{
    ax_hinges rim = ax_hinges_make(r->view.linkage);
    ax_select_rim(&r->view, &rim);
    ax_status status = take(r, ":") ? take_part(r, &rim) : AX_OK;
    long every = 1;
    if (status == AX_OK && take(r, "/")) {
        char* end = (char*)r->at;
        every = isdigit((unsigned char)*r->at) ? strtol(r->at, &end, 10) : 0;
        if (every < 1 || every > rim.count)
            status = refuse(r, "a whole number, 1 or more and no more than the rim has hinges, is wanted");
        r->at = end;
    }
    for (long k = 0; status == AX_OK && k < rim.count; k += every)
        ax_hinges_add(set, rim.hinges[k]);
    ax_hinges_free(&rim);
    return status;
}

static ax_status take_name(reader* r, ax_hinges* set)
{
    char name[64];
    size_t length = strcspn(r->at, ",&! ");
    snprintf(name, sizeof name, "%.*s", length < 60 ? (int)length : 60, r->at);
    int count;
    const int* hinges = ax_form_selection(r->form, name, &count);
    if (!hinges)
        return ax_fail(r->error, AX_BAD_INPUT, "There is no selection \"%s\". \"select\" makes one.", name);
    for (int k = 0; k < count; ++k)
        ax_hinges_add(set, hinges[k]);
    r->at += length;
    return AX_OK;
}

static ax_status take_panel(reader* r, ax_hinges* set)
{
    char name[24];
    const char* end = r->at + (*r->at == '-');
    end += strspn(end, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
    end += *end == '-';
    end += strspn(end, "0123456789");
    snprintf(name, sizeof name, "%.*s", (int)(end - r->at < 20 ? end - r->at : 20), r->at);
    const ax_linkage* l = r->view.linkage;
    for (int t = 0; t < l->triangle_count; ++t) {
        char text[16];
        ax_panel_name(l, t, text);
        if (strcmp(text, name) == 0) {
            for (int k = 0; k < 3; ++k)
                ax_hinges_add(set, l->triangles[t][k]);
            r->at = end;
            return AX_OK;
        }
    }
    return ax_fail(r->error, AX_BAD_INPUT, "There is no panel \"%s\".", name);
}

static ax_status take_range(reader* r, ax_hinges* set)
{
    int from, to;
    ax_status status = take_hinge(r, &from);
    to = from;
    if (status == AX_OK && take(r, "-"))
        status = take_hinge(r, &to);
    if (status == AX_OK && to < from)
        status = refuse(r, "a range runs from the smaller to the larger number");
    for (int h = from; status == AX_OK && h <= to; ++h)
        ax_hinges_add(set, h);
    return status;
}

static ax_status take_factor(reader* r, ax_hinges* set)
{
    double v[4];
    int a, b;
    ax_status status;
    skip_space(r);
    if (take(r, "all")) {
        for (int h = 0; h < r->view.linkage->hinge_count; ++h)
            ax_hinges_add(set, h);
        return AX_OK;
    }
    if (take(r, "rim"))
        return take_rim(r, set);
    if (take(r, "#"))
        return take_name(r, set);
    if (take(r, "line")) {
        status = take_pair(r, &a, &b);
        if (status == AX_OK && (a == b || !ax_select_line(r->view.linkage, a, b, set)))
            status =
                ax_fail(r->error, AX_BAD_INPUT,
                        "No straight line of panel edges runs through hinges %d and %d. curve(%d,%d) follows edges "
                        "from one to the other.",
                        a, b, a, b);
        return status;
    }
    if (take(r, "curve")) {
        status = take_pair(r, &a, &b);
        if (status == AX_OK)
            ax_select_curve(&r->view, a, b, set);
        return status;
    }
    if (take(r, "box")) {
        status = take_numbers(r, 4, v);
        if (status == AX_OK)
            ax_select_box(&r->view, v, v + 2, set);
        return status;
    }
    if (take(r, "disc")) {
        status = take_numbers(r, 3, v);
        if (status == AX_OK)
            ax_select_near(&r->view, 1, (const double(*)[2])v, false, v[2], set);
        return status;
    }
    if (take(r, "near")) {
        ax_hinges every = ax_hinges_make(r->view.linkage);
        for (int h = 0; h < r->view.linkage->hinge_count; ++h)
            ax_hinges_add(&every, h);
        status = take_near(r, &every, set);
        ax_hinges_free(&every);
        return status;
    }
    if (isdigit((unsigned char)*r->at))
        return take_range(r, set);
    if (isupper((unsigned char)*r->at) || (*r->at == '-' && isupper((unsigned char)r->at[1])))
        return take_panel(r, set);
    return refuse(r, "all, rim, a hinge, a panel, a #name, line(), curve(), box(), disc() or near() is wanted");
}

// factor & factor & ...: those in all of them, in the order of the first.
static ax_status take_term(reader* r, ax_hinges* term)
{
    ax_status status = take_factor(r, term);
    while (status == AX_OK && (skip_space(r), take(r, "&"))) {
        ax_hinges other = ax_hinges_make(r->view.linkage);
        status = take_factor(r, &other);
        int kept = 0;
        for (int k = 0; k < term->count; ++k) {
            int h = term->hinges[k];
            if (other.in[h])
                term->hinges[kept++] = h;
            else
                term->in[h] = 0;
        }
        term->count = kept;
        ax_hinges_free(&other);
    }
    return status;
}

static void take_away(ax_hinges* set, const ax_hinges* term)
{
    int kept = 0;
    for (int k = 0; k < set->count; ++k)
        if (term->in[set->hinges[k]])
            set->in[set->hinges[k]] = 0;
        else
            set->hinges[kept++] = set->hinges[k];
    set->count = kept;
}

ax_status ax_select(ax_form* form, const char* words, int** hinges, int* count, ax_error* error)
{
    reader r = {.form = form, .view = ax_form_look(form), .words = words, .at = words, .error = error};
    ax_hinges set = ax_hinges_make(r.view.linkage);
    ax_status status;
    do {
        ax_hinges term = ax_hinges_make(r.view.linkage);
        skip_space(&r);
        bool away = take(&r, "!");
        status = take_term(&r, &term);
        if (status == AX_OK && away)
            take_away(&set, &term);
        for (int k = 0; status == AX_OK && !away && k < term.count; ++k)
            ax_hinges_add(&set, term.hinges[k]);
        ax_hinges_free(&term);
        skip_space(&r);
    } while (status == AX_OK && take(&r, ","));
    if (status == AX_OK && *r.at)
        status = refuse(&r, "a comma or & is wanted");
    *hinges = NULL;
    *count = 0;
    if (status == AX_OK) {
        *hinges = set.hinges;
        *count = set.count;
        set.hinges = NULL;
    }
    ax_hinges_free(&set);
    return status;
}
