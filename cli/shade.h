// Layers of shells on the ground under a sun, as words of the command line name them.
#pragma once

#include "options.h"

#include "ax/shade.h"

#include <limits.h>

enum { SHADE_MOST = 16, SHADE_RAYS = 48 };               // layers, and wishes
static const double shade_degree = 0.017453292519943295; // in radians

typedef struct shade_wishes {
    int count;
    ax_shade_wish wishes[SHADE_MOST];
} shade_wishes;

typedef struct shade_day {
    bool given;
    int year, month, day;
} shade_day;

typedef struct shade_pair {
    bool given;
    double first, second;
} shade_pair;

typedef struct shade_arguments {
    word_list layers;
    shade_pair place, sun, hours;
    shade_day date;
    shade_wishes wishes;
    double zone, north, ground, shift, turn;
    bool extent, arrange, json;
    int rounds;
    const char* png;
} shade_arguments;

// How options of these are read: see command_option.
const char* shade_parse_place(const char* text, void* value);
const char* shade_parse_sun(const char* text, void* value);
const char* shade_parse_hours(const char* text, void* value);
const char* shade_parse_date(const char* text, void* value);
const char* shade_parse_wish(const char* text, void* value);

typedef struct shade_scene {
    int count;
    ax_layer layers[SHADE_MOST];
    ax_design designs[SHADE_MOST];
    char paths[SHADE_MOST][PATH_MAX];
    int ray_count;
    ax_ray rays[SHADE_RAYS];
    ax_ground ground;
    double* opacity;
} shade_scene;

// Reads the documents that the words name, and where they stand. AX_USAGE for words that say nothing of the kind; else as
// ax_document_load. What was read before is freed by the caller in any case.
ax_status shade_load(const shade_arguments* a, shade_scene* s, ax_error* error);
// The directions from which the sun shines. AX_CANNOT_REALISE where it does not rise.
ax_status shade_light(const shade_arguments* a, shade_scene* s, ax_error* error);
// The ground in about `cells` cells: that under the layers as they hang, where people are, not the long shadows of the evening. Under a
// small shell it is nearer, so that a model stands over its own shadow as the roof does.
void shade_look_below(const shade_arguments* a, shade_scene* s, int cells);
// Widens it to the discs that are wanted.
ax_status shade_cover_wishes(const shade_arguments* a, shade_scene* s, ax_error* error);
// "P.auxshell:x=1,turn=20" for layer k, as shade_load reads it.
void shade_placement_words(const shade_scene* s, int k, char* words, size_t size);
