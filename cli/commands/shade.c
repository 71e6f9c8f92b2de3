// auxshell shade: the shade of layers of shells on the ground.
#include "options.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/document.h"
#include "ax/picture.h"
#include "ax/shade.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 16, STEPS = 48, CELLS = 40000, COARSE = 6000 };
static const double degree = 0.017453292519943295;

typedef struct wish_list {
    int count;
    ax_shade_wish wishes[MOST];
} wish_list;

typedef struct day {
    bool given;
    int year, month, day;
} day;

typedef struct pair {
    bool given;
    double first, second;
} pair;

typedef struct arguments {
    word_list layers;
    pair place, sun, hours;
    day date;
    wish_list wishes;
    double zone, north, ground, shift, turn;
    bool extent, arrange, json;
    int rounds;
    const char* png;
} arguments;

static void defaults(void* given)
{
    arguments* a = given;
    a->hours = (pair){.first = 0, .second = 24};
    a->ground = NAN;
    a->shift = NAN;
    a->turn = 30;
    a->rounds = 6;
}

static const char* parse_pair(const char* text, void* value)
{
    pair* p = value;
    char end;
    p->given = true;
    return sscanf(text, "%lf,%lf%c", &p->first, &p->second, &end) == 2 ? NULL : "two numbers with a comma";
}

static const char* parse_place(const char* text, void* value)
{
    const pair* p = value;
    const char* wrong = parse_pair(text, value);
    return !wrong && fabs(p->first) <= 90 && fabs(p->second) <= 360 ? NULL
                                                                    : "latitude and longitude in degrees, 47.38,8.54";
}

static const char* parse_sun(const char* text, void* value)
{
    const pair* p = value;
    const char* wrong = parse_pair(text, value);
    return !wrong && p->second > 0 && p->second <= 90 ? NULL : "azimuth and height in degrees, 180,60; height 0 to 90";
}

static const char* parse_hours(const char* text, void* value)
{
    const pair* p = value;
    const char* wrong = parse_pair(text, value);
    return !wrong && p->first >= 0 && p->first <= p->second && p->second <= 24 ? NULL : "two hours of the day, 9,17";
}

static const char* parse_date(const char* text, void* value)
{
    day* d = value;
    char end;
    d->given = true;
    bool well = sscanf(text, "%d-%d-%d%c", &d->year, &d->month, &d->day, &end) == 3 && d->year >= 1950 &&
                d->year <= 2050 && d->month >= 1 && d->month <= 12 && d->day >= 1 && d->day <= 31;
    return well ? NULL : "a date from 1950 to 2050, 2026-06-21";
}

static const char* parse_wish(const char* text, void* value)
{
    wish_list* list = value;
    ax_shade_wish w;
    char end;
    if (list->count == MOST ||
        sscanf(text, "%lf,%lf,%lf,%lf%c", &w.at[0], &w.at[1], &w.radius, &w.opacity, &end) != 4 || !(w.radius > 0) ||
        w.opacity < 0 || w.opacity > 1)
        return "X,Y,RADIUS,OPACITY: a disc on the ground and 0 to 1, at most 16 of them";
    list->wishes[list->count++] = w;
    return NULL;
}

static const command_option options[] = {
    {.name = "P.auxshell...",
     .text = "the layers; each may be placed: P.auxshell:x=0.3,y=0,z=-0.5,turn=20,extent=2, in the unit of the first "
             "document "
             "and in degrees; extent keeps the panels so near to the origin",
     .kind = OPTION_WORDS,
     .operand = true,
     .required = true,
     .offset = offsetof(arguments, layers)},
    {.name = "--place",
     .value = "LAT,LON",
     .text = "where it stands: degrees, north and east positive",
     .kind = OPTION_OTHER,
     .parse = parse_place,
     .fallback = "",
     .offset = offsetof(arguments, place)},
    {.name = "--date",
     .value = "YYYY-MM-DD",
     .text = "the day over which the sun moves; needs --place",
     .kind = OPTION_OTHER,
     .parse = parse_date,
     .fallback = "",
     .offset = offsetof(arguments, date)},
    {.name = "--hours",
     .value = "FROM,TO",
     .text = "the part of that day that counts, local time",
     .kind = OPTION_OTHER,
     .parse = parse_hours,
     .fallback = "0,24",
     .offset = offsetof(arguments, hours)},
    {.name = "--zone",
     .value = "H",
     .text = "local time minus universal time",
     .kind = OPTION_NUMBER,
     .lo = -14,
     .hi = 14,
     .unit = "h",
     .offset = offsetof(arguments, zone)},
    {.name = "--sun",
     .value = "AZIMUTH,HEIGHT",
     .text = "the sun's direction instead of place and date: degrees, azimuth from north through east",
     .kind = OPTION_OTHER,
     .parse = parse_sun,
     .fallback = "",
     .excludes = "--date",
     .offset = offsetof(arguments, sun)},
    {.name = "--north",
     .value = "DEG",
     .text = "how far the document's y axis points clockwise from north, seen from above",
     .kind = OPTION_NUMBER,
     .lo = -360,
     .hi = 360,
     .unit = "degrees",
     .offset = offsetof(arguments, north)},
    {.name = "--ground",
     .value = "Z",
     .text = "height of the ground, in the first document's unit",
     .kind = OPTION_NUMBER,
     .lo = -1e9,
     .hi = 1e9,
     .fallback = "2.5 m below the lowest hinge, or a third of the layers' width if that is less",
     .offset = offsetof(arguments, ground)},
    {.name = "--want",
     .value = "X,Y,R,OPACITY",
     .text = "a disc on the ground and the mean opacity wanted there; may be given up to 16 times",
     .kind = OPTION_OTHER,
     .parse = parse_wish,
     .fallback = "",
     .offset = offsetof(arguments, wishes)},
    {.name = "--arrange",
     .text = "move and turn every layer but the first so that the wishes are met as well as can be",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, arrange)},
    {.name = "--shift",
     .value = "LEN",
     .text = "how far --arrange may move a layer in x and y",
     .kind = OPTION_NUMBER,
     .hi = 1e9,
     .fallback = "the mean edge of the first layer",
     .offset = offsetof(arguments, shift)},
    {.name = "--turn",
     .value = "DEG",
     .text = "how far --arrange may turn a layer",
     .kind = OPTION_NUMBER,
     .hi = 180,
     .unit = "degrees",
     .offset = offsetof(arguments, turn)},
    {.name = "--extent",
     .text = "--arrange may cut layers down to the panels near the origin",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, extent)},
    {.name = "--rounds",
     .value = "N",
     .text = "rounds of --arrange, each with half the steps of the one before",
     .kind = OPTION_INTEGER,
     .lo = 1,
     .hi = 12,
     .offset = offsetof(arguments, rounds)},
    {.name = "--png",
     .value = "FILE",
     .text = "draw the map of opacity",
     .kind = OPTION_TEXT,
     .offset = offsetof(arguments, png)},
    {.name = "--json",
     .text = "print figures and placements as JSON",
     .kind = OPTION_FLAG,
     .offset = offsetof(arguments, json)},
};

// "P.auxshell:x=1,turn=20": the path goes to `path`, the placement to the layer.
static ax_status parse_layer(const char* word, char path[PATH_MAX], ax_layer* layer, ax_error* error)
{
    static const char* const names[] = {"x", "y", "z", "turn", "extent"};
    const char* mark = strstr(word, ".auxshell:");
    size_t length = mark ? (size_t)(mark - word) + strlen(".auxshell") : strlen(word);
    if (length >= PATH_MAX)
        return ax_fail(error, AX_USAGE, "The name of a layer is longer than the system allows.");
    snprintf(path, PATH_MAX, "%.*s", (int)length, word);
    *layer = (ax_layer){.extent = INFINITY};
    double* const places[] = {&layer->move[0], &layer->move[1], &layer->move[2], &layer->turn, &layer->extent};
    for (const char* at = word + length; *at;) {
        int k = 0, used = 0;
        size_t name = strcspn(++at, "=");
        while (k < 5 && (strlen(names[k]) != name || strncmp(names[k], at, name) != 0))
            ++k;
        if (k == 5 || sscanf(at + name, "=%lf%n", places[k], &used) != 1 ||
            (at[name + (size_t)used] && at[name + (size_t)used] != ','))
            return ax_fail(
                error, AX_USAGE,
                "A layer is placed by x, y, z, turn and extent, as in P.auxshell:x=0.3,turn=20; not by \"%s\".", at);
        at += name + (size_t)used;
    }
    layer->turn *= degree;
    return AX_OK;
}

typedef struct scene {
    int count;
    ax_layer layers[MOST];
    ax_design designs[MOST];
    char paths[MOST][PATH_MAX];
    int ray_count;
    ax_ray rays[STEPS];
    ax_ground ground;
    double* opacity;
} scene;

static ax_status load(const arguments* a, scene* s, ax_error* error)
{
    if (a->layers.count > MOST)
        return ax_fail(error, AX_USAGE, "At most %d layers are taken.", MOST);
    ax_status status = AX_OK;
    for (int k = 0; k < a->layers.count && status == AX_OK; ++k) {
        status = parse_layer(a->layers.words[k], s->paths[k], &s->layers[k], error);
        if (status == AX_OK)
            status = ax_document_load(s->paths[k], &s->designs[k], error);
        s->count += status == AX_OK;
        s->layers[k].design = &s->designs[k];
        s->layers[k].state = s->designs[k].simulated ? AX_STATE_SIMULATED : AX_STATE_DEPLOYED;
    }
    return status;
}

static ax_status light(const arguments* a, scene* s, ax_error* error)
{
    if (a->sun.given) {
        s->rays[0] = ax_sun_ray((ax_sun){a->sun.first * degree, a->sun.second * degree}, a->north * degree);
        s->ray_count = 1;
        return AX_OK;
    }
    if (!a->place.given || !a->date.given)
        return ax_fail(error, AX_USAGE, "Where does the sun stand? Give --place and --date, or --sun.");
    ax_instant t = {a->date.year, a->date.month, a->date.day, a->hours.first - a->zone};
    double hours = a->hours.second - a->hours.first;
    s->ray_count =
        ax_sun_day(a->place.first, a->place.second, a->north * degree, t, hours, hours > 0 ? STEPS : 1, s->rays);
    if (s->ray_count == 0)
        return ax_fail(error, AX_CANNOT_REALISE, "The sun does not rise then. Choose other hours or another day.");
    return AX_OK;
}

// What is looked at: the ground under the layers as they hang, where people are, not the long shadows of the evening. Under a small shell
// it is nearer, so that a model stands over its own shadow as the roof does.
static void look_below(const arguments* a, scene* s, int cells)
{
    const double people = 2.5, first = ax_unit_in_metres(s->designs[0].unit);
    const ax_ray above = {{0, 0, 1}, 1};
    double lowest = INFINITY;
    for (int k = 0; k < s->count; ++k) {
        const ax_design* d = &s->designs[k];
        for (int h = 0; h < d->linkage.hinge_count; ++h)
            lowest =
                fmin(lowest, (d->simulated ? d->simulated : d->deployed)[h][2] * ax_unit_in_metres(d->unit) / first +
                                 s->layers[k].move[2]);
    }
    ax_shade_ground(s->count, s->layers, 1, &above, 0, cells, &s->ground, NULL);
    double width = s->ground.cell * fmax(s->ground.columns, s->ground.rows);
    s->ground.height = isnan(a->ground) ? lowest - fmin(people / first, width / 3) : a->ground;
}

static ax_status cover_wishes(const arguments* a, scene* s, ax_error* error)
{
    ax_ground* g = &s->ground;
    double lo[2], hi[2];
    for (int d = 0; d < 2; ++d)
        lo[d] = g->lo[d], hi[d] = lo[d] + g->cell * (d ? g->rows : g->columns);
    for (int k = 0; k < a->wishes.count; ++k)
        for (int d = 0; d < 2; ++d) {
            const ax_shade_wish* w = &a->wishes.wishes[k];
            lo[d] = fmin(lo[d], w->at[d] - w->radius), hi[d] = fmax(hi[d], w->at[d] + w->radius);
        }
    double columns = ceil((hi[0] - lo[0]) / g->cell), rows = ceil((hi[1] - lo[1]) / g->cell);
    if (columns * rows > AX_GROUND_CELLS)
        return ax_fail(error, AX_USAGE, "A wish lies far off what the layers cover. Give discs near them.");
    *g = (ax_ground){g->height, {lo[0], lo[1]}, g->cell, (int)columns, (int)rows};
    return AX_OK;
}

static ax_status arrange(const arguments* a, scene* s, ax_shade_found* found, ax_error* error)
{
    const ax_shade_search how = {.wish_count = a->wishes.count,
                                 .wishes = a->wishes.wishes,
                                 .shift = isnan(a->shift) ? s->designs[0].report.edge_mean : a->shift,
                                 .turn = a->turn * degree,
                                 .extent = a->extent,
                                 .rounds = a->rounds};
    look_below(a, s, COARSE);
    ax_status status = cover_wishes(a, s, error);
    if (status == AX_OK)
        status = ax_shade_arrange(s->count, s->layers, s->ray_count, s->rays, &s->ground, &how, progress_reporter(),
                                  found, error);
    progress_end();
    return status;
}

static void placement_words(const scene* s, int k, char* words, size_t size)
{
    const ax_layer* l = &s->layers[k];
    int used = snprintf(words, size, "%s:x=%.4g,y=%.4g,z=%.4g,turn=%.4g", s->paths[k], l->move[0], l->move[1],
                        l->move[2], l->turn / degree);
    if (!isinf(l->extent) && used > 0 && (size_t)used < size)
        snprintf(words + used, size - (size_t)used, ",extent=%.4g", l->extent);
}

static double mean_of(const scene* s)
{
    double sum = 0;
    int count = s->ground.columns * s->ground.rows;
    for (int k = 0; k < count; ++k)
        sum += s->opacity[k] / count;
    return sum;
}

static void print(const arguments* a, const scene* s, const ax_shade_found* found)
{
    const char* unit = ax_unit_name(s->designs[0].unit);
    char words[PATH_MAX + 128];
    printf("  Ground          %.4g by %.4g %s at height %.4g, %d by %d cells\n", s->ground.cell * s->ground.columns,
           s->ground.cell * s->ground.rows, unit, s->ground.height, s->ground.columns, s->ground.rows);
    printf("  Sun             from %d direction%s\n", s->ray_count, s->ray_count == 1 ? "" : "s");
    printf("  Opacity         %.3f on the mean of this ground\n", mean_of(s));
    for (int k = 0; k < a->wishes.count; ++k)
        printf("    disc %-2d       %.3f, wanted %.3f\n", k + 1,
               ax_shade_mean(&s->ground, s->opacity, &a->wishes.wishes[k]), a->wishes.wishes[k].opacity);
    if (found->tried)
        printf("  Arranged        wishes missed by %.3f (rms), before by %.3f; %d placements tried\n", found->after,
               found->before, found->tried);
    for (int k = 0; k < s->count; ++k) {
        placement_words(s, k, words, sizeof words);
        printf("  Layer           %s\n", words);
    }
}

static json_t* to_json(const arguments* a, const scene* s, const ax_shade_found* found)
{
    json_t *layers = json_array(), *wishes = json_array();
    char words[PATH_MAX + 128];
    for (int k = 0; k < s->count; ++k) {
        placement_words(s, k, words, sizeof words);
        json_array_append_new(layers, json_string(words));
    }
    for (int k = 0; k < a->wishes.count; ++k)
        json_array_append_new(wishes,
                              json_pack("{s:o, s:f}", "opacity",
                                        json_number(ax_shade_mean(&s->ground, s->opacity, &a->wishes.wishes[k])),
                                        "wanted", a->wishes.wishes[k].opacity));
    return json_pack("{s:s, s:o, s:o, s:i, s:o, s:o, s:i}", "units", ax_unit_name(s->designs[0].unit), "opacity",
                     json_number(mean_of(s)), "wishes", wishes, "directions", s->ray_count, "layers", layers, "missed",
                     found->tried ? json_number(found->after) : json_null(), "tried", found->tried);
}

static ax_status draw(const arguments* a, const scene* s, ax_error* error)
{
    char text[160];
    if (a->sun.given)
        snprintf(text, sizeof text, "sun at azimuth %.0f, height %.0f degrees", a->sun.first, a->sun.second);
    else
        snprintf(text, sizeof text, "%.2f, %.2f on %d-%02d-%02d, %.4g to %.4g h", a->place.first, a->place.second,
                 a->date.year, a->date.month, a->date.day, a->hours.first, a->hours.second);
    const ax_shade_picture picture = {s->count,        s->layers,        &s->ground,        s->opacity,
                                      a->wishes.count, a->wishes.wishes, a->north * degree, text};
    return ax_picture_shade(&picture, 1280, 960, a->png, error);
}

static ax_status run(const void* given, ax_error* error)
{
    const arguments* a = given;
    scene* s = AX_NEW0(scene, 1);
    ax_shade_found found = {0};
    ax_status status = a->png ? output_check(a->png, ".png", error) : AX_OK;
    if (status == AX_OK && a->arrange && a->wishes.count == 0)
        status = ax_fail(error, AX_USAGE, "--arrange needs to know what is wanted: give --want.");
    if (status == AX_OK)
        status = load(a, s, error);
    if (status == AX_OK)
        status = light(a, s, error);
    if (status == AX_OK && a->arrange)
        status = arrange(a, s, &found, error);
    if (status == AX_OK) {
        look_below(a, s, CELLS);
        status = cover_wishes(a, s, error);
    }
    if (status == AX_OK) {
        s->opacity = AX_NEW(double, (size_t)s->ground.columns*(size_t)s->ground.rows);
        status = ax_shade_map(s->count, s->layers, s->ray_count, s->rays, &s->ground, progress_reporter(), s->opacity,
                              error);
        progress_end();
    }
    if (status == AX_OK && a->png)
        status = draw(a, s, error);
    if (status == AX_OK && a->json)
        json_print(to_json(a, s, &found), stdout);
    else if (status == AX_OK)
        print(a, s, &found);
    for (int k = 0; k < MOST; ++k)
        ax_design_free(&s->designs[k]);
    ax_free(s->opacity);
    ax_free(s);
    return status;
}

const command command_shade = {
    .name = "shade",
    .summary = "map the shade of layers of shells on the ground, and arrange them for what is wanted",
    .text = "Casts the shadows of one or several designs on the level ground below them, for a direction of the sun or "
            "over a "
            "day, and prints how much of the sun they stop: 0 is full sun, 1 full shade. With --arrange, layers are "
            "moved and "
            "turned until the discs of --want have the opacity asked for.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(arguments),
    .defaults = defaults,
    .run = run,
};
