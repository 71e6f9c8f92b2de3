// Choices of joint, material and sheet from words, as they stand on a command line or in a recipe.
#include "ax/fabricate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const ax_sheet_size sizes[] = {
    {"A4", 297, 210},        {"A3", 420, 297},          {"A2", 594, 420},      {"A1", 841, 594},
    {"A0", 1189, 841},       {"600x300", 600, 300},     {"600x400", 600, 400}, {"900x600", 900, 600},
    {"1200x600", 1200, 600}, {"1220x2440", 1220, 2440},
};

const ax_sheet_size* ax_sheet_sizes(int* count)
{
    *count = (int)(sizeof sizes / sizeof *sizes);
    return sizes;
}

// A value that can be set by name.
typedef struct setting {
    const char *name, *unit;
    double least, most;
    double* value;
} setting;

static void append(char* words, size_t size, const char* text, bool first)
{
    size_t used = strlen(words);
    snprintf(words + used, size - used, "%s%s", first ? "" : ", ", text);
}

// Reads "key=value,key=value".
static ax_status set_all(const char* what, const char* text, const setting* settings, int count, ax_error* error)
{
    for (const char* at = text; at && *at;) {
        const char *equals = strchr(at, '='), *end = strchr(at, ',');
        end = end ? end : at + strlen(at);
        const setting* s = NULL;
        for (int k = 0; k < count && equals && equals < end; ++k)
            if (strlen(settings[k].name) == (size_t)(equals - at) &&
                strncmp(settings[k].name, at, (size_t)(equals - at)) == 0)
                s = &settings[k];
        if (!s) {
            char known[256] = "";
            for (int k = 0; k < count; ++k)
                append(known, sizeof known, settings[k].name, k == 0);
            return ax_fail(error, AX_USAGE, "%s takes %s, each as NAME=VALUE, separated by commas; not \"%.60s\".",
                           what, known, at);
        }
        char* after;
        double value = strtod(equals + 1, &after);
        if (after != end || !(value >= s->least && value <= s->most))
            return ax_fail(error, AX_USAGE, "%s of %s takes a number from %g to %g %s, not \"%.*s\".", s->name, what,
                           s->least, s->most, s->unit, (int)fmin(40, (double)(end - equals - 1)), equals + 1);
        *s->value = value;
        at = *end ? end + 1 : end;
    }
    return AX_OK;
}

// Copies what stands before the colon and returns what stands after it, NULL if there is none.
static const char* take_name(const char* words, char* name, size_t size)
{
    const char* colon = strchr(words, ':');
    size_t length = colon ? (size_t)(colon - words) : strlen(words);
    length = length < size ? length : size - 1;
    memcpy(name, words, length);
    name[length] = '\0';
    return colon ? colon + 1 : NULL;
}

ax_status ax_fabricate_set_joint(ax_fabricate_options* options, const char* words, ax_error* error)
{
    char name[64];
    const char* rest = take_name(words, name, sizeof name);
    const ax_joint_type* joint = ax_joint_named(name);
    if (!joint) {
        char known[256] = "";
        int count;
        const ax_joint_type* const* types = ax_joint_types(&count);
        for (int k = 0; k < count; ++k)
            append(known, sizeof known, types[k]->name, k == 0);
        return ax_fail(error, AX_USAGE, "There is no joint \"%s\". Known are %s.", name, known);
    }
    double values[8];
    setting settings[8];
    for (int k = 0; k < joint->parameter_count; ++k) {
        const ax_joint_parameter* p = &joint->parameters[k];
        values[k] = NAN;
        settings[k] = (setting){p->name, p->unit, p->least, p->most, &values[k]};
    }
    ax_status status = set_all(name, rest, settings, joint->parameter_count, error);
    if (status != AX_OK)
        return status;
    options->joint = joint;
    memcpy(options->joint_values, values, (size_t)joint->parameter_count * sizeof *values);
    return AX_OK;
}

ax_status ax_fabricate_set_material(ax_fabricate_options* options, const char* words, ax_error* error)
{
    char name[64];
    const char* rest = take_name(words, name, sizeof name);
    const ax_material* found = ax_material_named(name);
    if (!found) {
        char known[512] = "";
        int count;
        const ax_material* all = ax_materials(&count);
        for (int k = 0; k < count; ++k)
            append(known, sizeof known, all[k].name, k == 0);
        return ax_fail(error, AX_USAGE,
                       "There is no material \"%s\". Known are %s; each can be adjusted: %s:thickness=2.9.", name,
                       known, all[0].name);
    }
    ax_material material = *found;
    const setting settings[] = {{"thickness", "mm", 0.01, 1000, &material.thickness},
                                {"density", "kg/m3", 1, 30000, &material.density},
                                {"feature", "mm", 0, 1000, &material.feature},
                                {"strength", "MPa", 0.001, 10000, &material.strength}};
    ax_status status = set_all(name, rest, settings, sizeof settings / sizeof *settings, error);
    if (status == AX_OK)
        options->material = material;
    return status;
}

ax_status ax_fabricate_set_sheet(ax_fabricate_options* options, const char* words, ax_error* error)
{
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k)
        if (strcmp(sizes[k].name, words) == 0) {
            options->sheet[0] = sizes[k].width, options->sheet[1] = sizes[k].height;
            return AX_OK;
        }
    char *times, *end = NULL;
    double width = strtod(words, &times), height = times != words && *times == 'x' ? strtod(times + 1, &end) : 0;
    if (!end || end == times + 1 || *end || !(width >= 10 && width <= 1e6) || !(height >= 10 && height <= 1e6))
        return ax_fail(error, AX_USAGE,
                       "A sheet is WIDTHxHEIGHT in mm, 10 to 1000000 each, as in 600x400, or A4 to A0; not \"%.60s\".",
                       words);
    options->sheet[0] = width, options->sheet[1] = height;
    return AX_OK;
}
