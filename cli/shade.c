#include "shade.h"

#include "ax/document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static const char* parse_pair(const char* text, void* value)
{
    shade_pair* p = value;
    char end;
    p->given = true;
    return sscanf(text, "%lf,%lf%c", &p->first, &p->second, &end) == 2 ? NULL : "two numbers with a comma";
}

const char* shade_parse_place(const char* text, void* value)
{
    const shade_pair* p = value;
    const char* wrong = parse_pair(text, value);
    return !wrong && fabs(p->first) <= 90 && fabs(p->second) <= 360 ? NULL
                                                                    : "latitude and longitude in degrees, 47.38,8.54";
}

const char* shade_parse_sun(const char* text, void* value)
{
    const shade_pair* p = value;
    const char* wrong = parse_pair(text, value);
    return !wrong && p->second > 0 && p->second <= 90 ? NULL : "azimuth and height in degrees, 180,60; height 0 to 90";
}

const char* shade_parse_hours(const char* text, void* value)
{
    const shade_pair* p = value;
    const char* wrong = parse_pair(text, value);
    return !wrong && p->first >= 0 && p->first <= p->second && p->second <= 24 ? NULL : "two hours of the day, 9,17";
}

const char* shade_parse_date(const char* text, void* value)
{
    shade_day* d = value;
    char end;
    d->given = true;
    bool well = sscanf(text, "%d-%d-%d%c", &d->year, &d->month, &d->day, &end) == 3 && d->year >= 1950 &&
                d->year <= 2050 && d->month >= 1 && d->month <= 12 && d->day >= 1 && d->day <= 31;
    struct tm day = {.tm_year = d->year - 1900, .tm_mon = d->month - 1, .tm_mday = d->day};
    well = well && timegm(&day) != -1 && day.tm_mday == d->day; // there is no 30th of February
    return well ? NULL : "a date from 1950 to 2050, 2026-06-21";
}

const char* shade_parse_wish(const char* text, void* value)
{
    shade_wishes* list = value;
    ax_shade_wish w;
    char end;
    if (list->count == SHADE_MOST ||
        sscanf(text, "%lf,%lf,%lf,%lf%c", &w.at[0], &w.at[1], &w.radius, &w.opacity, &end) != 4 || !(w.radius > 0) ||
        w.opacity < 0 || w.opacity > 1)
        return "X,Y,RADIUS,OPACITY: a disc on the ground and 0 to 1, at most 16 of them";
    list->wishes[list->count++] = w;
    return NULL;
}

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
    layer->turn *= shade_degree;
    return AX_OK;
}

ax_status shade_load(const shade_arguments* a, shade_scene* s, ax_error* error)
{
    if (a->layers.count > SHADE_MOST)
        return ax_fail(error, AX_USAGE, "At most %d layers are taken.", SHADE_MOST);
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

ax_status shade_light(const shade_arguments* a, shade_scene* s, ax_error* error)
{
    if (a->sun.given) {
        s->rays[0] =
            ax_sun_ray((ax_sun){a->sun.first * shade_degree, a->sun.second * shade_degree}, a->north * shade_degree);
        s->ray_count = 1;
        return AX_OK;
    }
    if (!a->place.given || !a->date.given)
        return ax_fail(error, AX_USAGE, "Where does the sun stand? Give --place and --date, or --sun.");
    ax_instant t = {a->date.year, a->date.month, a->date.day, a->hours.first - a->zone};
    double hours = a->hours.second - a->hours.first;
    s->ray_count = ax_sun_day(a->place.first, a->place.second, a->north * shade_degree, t, hours,
                              hours > 0 ? SHADE_RAYS : 1, s->rays);
    if (s->ray_count == 0)
        return ax_fail(error, AX_CANNOT_REALISE, "The sun does not rise then. Choose other hours or another day.");
    return AX_OK;
}

void shade_look_below(const shade_arguments* a, shade_scene* s, int cells)
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

ax_status shade_cover_wishes(const shade_arguments* a, shade_scene* s, ax_error* error)
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

void shade_placement_words(const shade_scene* s, int k, char* words, size_t size)
{
    const ax_layer* l = &s->layers[k];
    int used = snprintf(words, size, "%s:x=%.4g,y=%.4g,z=%.4g,turn=%.4g", s->paths[k], l->move[0], l->move[1],
                        l->move[2], l->turn / shade_degree);
    if (!isinf(l->extent) && used > 0 && (size_t)used < size)
        snprintf(words + used, size - (size_t)used, ",extent=%.4g", l->extent);
}
