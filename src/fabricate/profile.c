// Machine profiles: which layer, colour and speed an operation gets. Colours follow what the makers' programs expect; there is no
// standard, so every sheet carries a legend.
#include "fabricate/profile.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// colours are three values and an index, which must be taken apart first
#define PEN(...) PEN_OF(__VA_ARGS__)
#define PEN_OF(name, r, g, b, index, width, mm_per_s)                                                                  \
    {                                                                                                                  \
        .layer = name, .rgb = {r, g, b}, .aci = index, .stroke = width, .speed = mm_per_s, .used = true                \
    }
#define BLACK 0, 0, 0, 7
#define RED   255, 0, 0, 1
#define BLUE  0, 0, 255, 5
#define GREY  128, 128, 128, 8

static const ax_profile profiles[] = {
    {.name = "generic",
     .doc = "red cuts, blue is marked, black is engraved",
     .pens = {PEN("LABEL", BLACK, 0.1, 100), PEN("SCORE", BLUE, 0.1, 60), PEN("HOLE", RED, 0.1, 15),
              PEN("SLIT", RED, 0.1, 15), PEN("CUT", RED, 0.1, 15), PEN("NOTE", GREY, 0.1, 0)},
     .travel_speed = 200},
    {.name = "lightburn",
     .doc = "LightBurn's layers C00 to C04 and the tool layer T1, by their exact colours",
     .pens = {PEN("C00 LABEL", BLACK, 0.1, 100), PEN("C01 SCORE", BLUE, 0.1, 60),
              PEN("C03 HOLE", 0, 224, 0, 3, 0.1, 15), PEN("C04 SLIT", 208, 208, 0, 2, 0.1, 15),
              PEN("C02 CUT", RED, 0.1, 15), PEN("T1 NOTE", 243, 105, 38, 30, 0.1, 0)},
     .travel_speed = 200},
    {.name = "trotec",
     .doc = "Trotec: red cuts, blue cuts lightly, black engraves; hair lines",
     .pens = {PEN("LABEL", BLACK, 0.01, 100), PEN("SCORE", BLUE, 0.01, 60), PEN("HOLE", RED, 0.01, 15),
              PEN("SLIT", RED, 0.01, 15), PEN("CUT", RED, 0.01, 15), PEN("NOTE", GREY, 0.01, 0)},
     .travel_speed = 400},
    {.name = "epilog",
     .doc = "Epilog: pure colours by colour mapping, lines of 0.001 inch",
     .pens = {PEN("LABEL", BLACK, 0.0254, 100), PEN("SCORE", BLUE, 0.0254, 60), PEN("HOLE", 0, 255, 0, 3, 0.0254, 15),
              PEN("SLIT", 255, 0, 255, 6, 0.0254, 15), PEN("CUT", RED, 0.0254, 15),
              PEN("NOTE", 255, 255, 0, 2, 0.0254, 0)},
     .travel_speed = 300},
    {.name = "uls",
     .doc = "Universal Laser Systems: eight pure colours; red cuts, blue marks, black engraves",
     .pens = {PEN("LABEL", BLACK, 0.0254, 100), PEN("SCORE", BLUE, 0.0254, 60), PEN("HOLE", 0, 255, 0, 3, 0.0254, 15),
              PEN("SLIT", 255, 0, 255, 6, 0.0254, 15), PEN("CUT", RED, 0.0254, 15),
              PEN("NOTE", 255, 255, 0, 2, 0.0254, 0)},
     .travel_speed = 300},
    {.name = "plotter",
     .doc = "knife or pen plotter: black draws, red cuts",
     .pens = {PEN("LABEL", BLACK, 0.25, 200), PEN("SCORE", BLACK, 0.25, 200), PEN("HOLE", RED, 0.25, 60),
              PEN("SLIT", RED, 0.25, 60), PEN("CUT", RED, 0.25, 60), PEN("NOTE", GREY, 0.25, 0)},
     .travel_speed = 400},
};

const ax_profile* ax_profiles(int* count)
{
    *count = (int)(sizeof profiles / sizeof *profiles);
    return profiles;
}

// --- a user's own, from JSON: what is not given is taken from the profile named "base", or generic

// The member `key` of an object as a number within lo..hi; unchanged if it is not there.
static ax_status read_number(const json_t* object, const char* key, double lo, double hi, double* value,
                             ax_error* error)
{
    const json_t* given = json_object_get(object, key);
    if (!given)
        return AX_OK;
    double number = json_number_value(given);
    if (!json_is_number(given) || !(number >= lo && number <= hi))
        return ax_fail(error, AX_BAD_INPUT, "\"%s\" must be a number from %g to %g.", key, lo, hi);
    *value = number;
    return AX_OK;
}

// Text that layer tables can hold: printable ASCII without quotes and brackets.
static ax_status read_name(const json_t* object, const char* key, char* out, size_t size, ax_error* error)
{
    const json_t* given = json_object_get(object, key);
    if (!given)
        return AX_OK;
    const char* text = json_string_value(given);
    bool sound = text && *text && strlen(text) < size;
    for (const char* at = text; sound && *at; ++at)
        sound = *at >= ' ' && *at <= '~' && !strchr("<>/\\\":;?*|=`'", *at);
    if (!sound)
        return ax_fail(
            error, AX_BAD_INPUT,
            "\"%s\" must be a text of 1 to %zu letters, digits, blanks and signs other than <>/\\\":;?*|=`'.", key,
            size - 1);
    memcpy(out, text, strlen(text) + 1);
    return AX_OK;
}

static ax_status refuse_unknown(const json_t* object, const char* const* known, ax_error* error)
{
    for (void* at = json_object_iter((json_t*)object); at; at = json_object_iter_next((json_t*)object, at)) {
        const char* const* k = known;
        while (*k && strcmp(*k, json_object_iter_key(at)) != 0)
            ++k;
        if (!*k)
            return ax_fail(error, AX_BAD_INPUT, "\"%.40s\" is no key of a profile.", json_object_iter_key(at));
    }
    return AX_OK;
}

static ax_status read_pen(const json_t* object, ax_profile_pen* pen, ax_error* error)
{
    static const char* const known[] = {"layer", "rgb", "aci", "stroke", "speed", "used", NULL};
    if (!json_is_object(object))
        return ax_fail(error, AX_BAD_INPUT, "each of \"operations\" must be an object.");
    double aci = pen->aci;
    ax_status status = refuse_unknown(object, known, error);
    if (status == AX_OK)
        status = read_name(object, "layer", pen->layer, sizeof pen->layer, error);
    if (status == AX_OK)
        status = read_number(object, "aci", 1, 255, &aci, error);
    if (status == AX_OK)
        status = read_number(object, "stroke", 0.001, 10, &pen->stroke, error);
    if (status == AX_OK)
        status = read_number(object, "speed", 0.001, 1e5, &pen->speed, error);
    pen->aci = (int)aci;
    const json_t *rgb = json_object_get(object, "rgb"), *used = json_object_get(object, "used");
    for (size_t c = 0; c < 3 && rgb && status == AX_OK; ++c) {
        const json_t* value = json_array_get(rgb, c);
        if (json_array_size(rgb) != 3 || !json_is_integer(value) || json_integer_value(value) < 0 ||
            json_integer_value(value) > 255)
            status = ax_fail(error, AX_BAD_INPUT, "\"rgb\" must be three whole numbers from 0 to 255.");
        else
            pen->rgb[c] = (unsigned char)json_integer_value(value);
    }
    if (used && !json_is_boolean(used) && status == AX_OK)
        status = ax_fail(error, AX_BAD_INPUT, "\"used\" must be true or false.");
    pen->used = used ? json_is_true(used) : pen->used;
    return status;
}

static ax_status read_operations(const json_t* operations, ax_profile* profile, ax_error* error)
{
    if (operations && !json_is_object(operations))
        return ax_fail(error, AX_BAD_INPUT, "\"operations\" must be an object.");
    const char* known[AX_OPERATIONS + 1] = {0};
    for (int k = 0; k < AX_OPERATIONS; ++k)
        known[k] = ax_operation_name((ax_operation)k);
    ax_status status = refuse_unknown(operations, known, error);
    for (int k = 0; k < AX_OPERATIONS && status == AX_OK; ++k) {
        const json_t* pen = json_object_get(operations, known[k]);
        ax_error detail;
        if (pen && read_pen(pen, &profile->pens[k], &detail) != AX_OK)
            status = ax_fail(error, AX_BAD_INPUT, "in \"%s\", %s", known[k], detail.message);
    }
    return status;
}

static const ax_profile* profile_named(const char* name)
{
    int count;
    const ax_profile* all = ax_profiles(&count);
    for (int k = 0; k < count; ++k)
        if (strcmp(all[k].name, name) == 0)
            return &all[k];
    return NULL;
}

static ax_status read_profile(const json_t* root, ax_profile* profile, ax_error* error)
{
    static const char* const known[] = {"name", "doc", "base", "travel_speed", "operations", NULL};
    if (!json_is_object(root))
        return ax_fail(error, AX_BAD_INPUT, "a profile is an object.");
    const json_t* base = json_object_get(root, "base");
    const ax_profile* from = !base ? profiles : json_is_string(base) ? profile_named(json_string_value(base)) : NULL;
    if (!from)
        return ax_fail(error, AX_BAD_INPUT, "\"base\" must name a built-in profile.");
    *profile = *from;
    snprintf(profile->name, sizeof profile->name, "own");
    ax_status status = refuse_unknown(root, known, error);
    if (status == AX_OK)
        status = read_name(root, "name", profile->name, sizeof profile->name, error);
    if (status == AX_OK)
        status = read_name(root, "doc", profile->doc, sizeof profile->doc, error);
    if (status == AX_OK)
        status = read_number(root, "travel_speed", 0.001, 1e5, &profile->travel_speed, error);
    return status == AX_OK ? read_operations(json_object_get(root, "operations"), profile, error) : status;
}

ax_status ax_profile_parse(const char* text, size_t length, ax_profile* profile, ax_error* error)
{
    json_error_t fault;
    json_t* root = json_loadb(text, length, JSON_REJECT_DUPLICATES, &fault);
    if (!root)
        return ax_fail(error, AX_BAD_INPUT, "line %d, column %d: %s.", fault.line, fault.column, fault.text);
    ax_status status = read_profile(root, profile, error);
    json_decref(root);
    return status;
}

static ax_status read_file(const char* path, ax_profile* profile, ax_error* error)
{
    enum { MOST = 1 << 20 }; // bytes; a profile has one or two thousand
    FILE* in = fopen(path, "rb");
    if (!in)
        return ax_fail(error, AX_BAD_INPUT, "Cannot read the profile %s: there is no such file, or it is not readable.",
                       path);
    char* text = AX_NEW(char, MOST);
    size_t length = fread(text, 1, MOST, in);
    bool sound = !ferror(in) && length < MOST;
    fclose(in);
    ax_error detail = {.message = "it is not readable or has more than a megabyte."};
    if (sound)
        sound = ax_profile_parse(text, length, profile, &detail) == AX_OK;
    ax_free(text);
    return sound ? AX_OK : ax_fail(error, AX_BAD_INPUT, "The profile %s cannot be used: %s", path, detail.message);
}

ax_status ax_profile_find(const char* name, ax_profile* profile, ax_error* error)
{
    const ax_profile* found = profile_named(name);
    size_t length = strlen(name);
    if (!found && length > 5 && strcmp(name + length - 5, ".json") == 0)
        return read_file(name, profile, error);
    if (found) {
        *profile = *found;
        return AX_OK;
    }
    char known[256] = "";
    int count;
    ax_profiles(&count);
    for (int k = 0; k < count; ++k) {
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%.31s, ", profiles[k].name);
    }
    return ax_fail(error, AX_USAGE,
                   "There is no profile \"%s\". Known are %sand the path of a file that ends in .json.", name, known);
}
