// auxshell shade: the shade of layers of shells on the ground.
#include "shade.h"
#include "output.h"
#include "progress.h"
#include "report.h"

#include "ax/picture.h"

#include <math.h>

enum { CELLS = 40000, COARSE = 6000 };

static void defaults(void* given)
{
    shade_arguments* a = given;
    a->hours = (shade_pair){.first = 0, .second = 24};
    a->ground = NAN;
    a->shift = NAN;
    a->turn = 30;
    a->rounds = 6;
}

static const command_option options[] = {
    {.name = "P.auxshell...",
     .text = "the layers; each may be placed: P.auxshell:x=0.3,y=0,z=-0.5,turn=20,extent=2, in the unit of the first "
             "document and in degrees; extent keeps the panels so near to the origin",
     .kind = OPTION_WORDS,
     .operand = true,
     .required = true,
     .offset = offsetof(shade_arguments, layers)},
    {.name = "--place",
     .value = "LAT,LON",
     .text = "where it stands: degrees, north and east positive",
     .kind = OPTION_OTHER,
     .parse = shade_parse_place,
     .fallback = "",
     .offset = offsetof(shade_arguments, place)},
    {.name = "--date",
     .value = "YYYY-MM-DD",
     .text = "the day over which the sun moves; needs --place",
     .kind = OPTION_OTHER,
     .parse = shade_parse_date,
     .fallback = "",
     .offset = offsetof(shade_arguments, date)},
    {.name = "--hours",
     .value = "FROM,TO",
     .text = "the part of that day that counts, local time",
     .kind = OPTION_OTHER,
     .parse = shade_parse_hours,
     .fallback = "0,24",
     .offset = offsetof(shade_arguments, hours)},
    {.name = "--zone",
     .value = "H",
     .text = "local time minus universal time",
     .kind = OPTION_NUMBER,
     .lo = -14,
     .hi = 14,
     .unit = "h",
     .offset = offsetof(shade_arguments, zone)},
    {.name = "--sun",
     .value = "AZIMUTH,HEIGHT",
     .text = "the sun's direction instead of place and date: degrees, azimuth from north through east",
     .kind = OPTION_OTHER,
     .parse = shade_parse_sun,
     .fallback = "",
     .excludes = "--date",
     .offset = offsetof(shade_arguments, sun)},
    {.name = "--north",
     .value = "DEG",
     .text = "how far the document's y axis points clockwise from north, seen from above",
     .kind = OPTION_NUMBER,
     .lo = -360,
     .hi = 360,
     .unit = "degrees",
     .offset = offsetof(shade_arguments, north)},
    {.name = "--ground",
     .value = "Z",
     .text = "height of the ground, in the first document's unit",
     .kind = OPTION_NUMBER,
     .lo = -1e9,
     .hi = 1e9,
     .fallback = "2.5 m below the lowest hinge, or a third of the layers' width if that is less",
     .offset = offsetof(shade_arguments, ground)},
    {.name = "--want",
     .value = "X,Y,R,OPACITY",
     .text = "a disc on the ground and the mean opacity wanted there; may be given up to 16 times",
     .kind = OPTION_OTHER,
     .parse = shade_parse_wish,
     .fallback = "",
     .offset = offsetof(shade_arguments, wishes)},
    {.name = "--arrange",
     .text = "move and turn every layer but the first so that the wishes are met as well as can be",
     .kind = OPTION_FLAG,
     .offset = offsetof(shade_arguments, arrange)},
    {.name = "--shift",
     .value = "LEN",
     .text = "how far --arrange may move a layer in x and y",
     .kind = OPTION_NUMBER,
     .hi = 1e9,
     .fallback = "the mean edge of the first layer",
     .offset = offsetof(shade_arguments, shift)},
    {.name = "--turn",
     .value = "DEG",
     .text = "how far --arrange may turn a layer",
     .kind = OPTION_NUMBER,
     .hi = 180,
     .unit = "degrees",
     .offset = offsetof(shade_arguments, turn)},
    {.name = "--extent",
     .text = "--arrange may cut layers down to the panels near the origin",
     .kind = OPTION_FLAG,
     .offset = offsetof(shade_arguments, extent)},
    {.name = "--rounds",
     .value = "N",
     .text = "rounds of --arrange, each with half the steps of the one before",
     .kind = OPTION_INTEGER,
     .lo = 1,
     .hi = 12,
     .offset = offsetof(shade_arguments, rounds)},
    {.name = "--png",
     .value = "FILE",
     .text = "draw the map of opacity",
     .kind = OPTION_TEXT,
     .offset = offsetof(shade_arguments, png)},
    {.name = "--json",
     .text = "print figures and placements as JSON",
     .kind = OPTION_FLAG,
     .offset = offsetof(shade_arguments, json)},
};

static ax_status arrange(const shade_arguments* a, shade_scene* s, ax_shade_found* found, ax_error* error)
{
    const ax_shade_search how = {.wish_count = a->wishes.count,
                                 .wishes = a->wishes.wishes,
                                 .shift = isnan(a->shift) ? s->designs[0].report.edge_mean : a->shift,
                                 .turn = a->turn * shade_degree,
                                 .extent = a->extent,
                                 .rounds = a->rounds};
    shade_look_below(a, s, COARSE);
    ax_status status = shade_cover_wishes(a, s, error);
    if (status == AX_OK)
        status = ax_shade_arrange(s->count, s->layers, s->ray_count, s->rays, &s->ground, &how, progress_reporter(),
                                  found, error);
    progress_end();
    return status;
}

static double mean_of(const shade_scene* s)
{
    double sum = 0;
    int count = s->ground.columns * s->ground.rows;
    for (int k = 0; k < count; ++k)
        sum += s->opacity[k] / count;
    return sum;
}

static void print(const shade_arguments* a, const shade_scene* s, const ax_shade_found* found)
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
        shade_placement_words(s, k, words, sizeof words);
        printf("  Layer           %s\n", words);
    }
}

static json_t* to_json(const shade_arguments* a, const shade_scene* s, const ax_shade_found* found)
{
    json_t *layers = json_array(), *wishes = json_array();
    char words[PATH_MAX + 128];
    for (int k = 0; k < s->count; ++k) {
        shade_placement_words(s, k, words, sizeof words);
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

static ax_status draw(const shade_arguments* a, const shade_scene* s, ax_error* error)
{
    char text[160];
    if (a->sun.given)
        snprintf(text, sizeof text, "sun at azimuth %.0f, height %.0f degrees", a->sun.first, a->sun.second);
    else
        snprintf(text, sizeof text, "%.2f, %.2f on %d-%02d-%02d, %.4g to %.4g h", a->place.first, a->place.second,
                 a->date.year, a->date.month, a->date.day, a->hours.first, a->hours.second);
    const ax_shade_picture picture = {
        s->count, s->layers, &s->ground, s->opacity, a->wishes.count, a->wishes.wishes, a->north * shade_degree, text};
    return ax_picture_shade(&picture, 1280, 960, a->png, error);
}

static ax_status run(const void* given, ax_error* error)
{
    const shade_arguments* a = given;
    shade_scene* s = AX_NEW0(shade_scene, 1);
    ax_shade_found found = {0};
    ax_status status = a->png ? output_check(a->png, ".png", error) : AX_OK;
    if (status == AX_OK && a->arrange && a->wishes.count == 0)
        status = ax_fail(error, AX_USAGE, "--arrange needs to know what is wanted: give --want.");
    if (status == AX_OK)
        status = shade_load(a, s, error);
    if (status == AX_OK)
        status = shade_light(a, s, error);
    if (status == AX_OK && a->arrange)
        status = arrange(a, s, &found, error);
    if (status == AX_OK) {
        shade_look_below(a, s, CELLS);
        status = shade_cover_wishes(a, s, error);
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
    for (int k = 0; k < SHADE_MOST; ++k)
        ax_design_free(&s->designs[k]);
    ax_free(s->opacity);
    ax_free(s);
    return status;
}

const command command_shade = {
    .name = "shade",
    .summary = "map the shade of layers of shells on the ground, and arrange them for what is wanted",
    .text = "Casts the shadows of one or several designs on the level ground below them, for a direction of the sun or "
            "over a day, and prints how much of the sun they stop: 0 is full sun, 1 full shade. With --arrange, layers "
            "are moved and turned until the discs of --want have the opacity asked for.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .size = sizeof(shade_arguments),
    .defaults = defaults,
    .run = run,
};
