// A form as bytes: a magic number, a version, every field in order, and a checksum. Little-endian, as the document's arrays are.
#include "form/state.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static const char magic[8] = "axform09";
enum { MOST = 100000000 };                                      // entries of any one array
enum { RIM_PART = 8, CONSTRAINT = 73, SET = 8, UNDERLAY = 20 }; // the fewest bytes that one of these takes

typedef struct stream {
    unsigned char* bytes;
    size_t size, at, room; // writing: room allocated; reading: size given
    bool reading, bad;
} stream;

static void raw(stream* s, void* data, size_t bytes)
{
    if (s->reading) {
        if (s->bad || s->size - s->at < bytes) {
            s->bad = true;
            memset(data, 0, bytes);
            return;
        }
        memcpy(data, s->bytes + s->at, bytes);
        s->at += bytes;
        return;
    }
    if (s->room - s->size < bytes) {
        s->room = 2 * (s->room + bytes) + 4096;
        s->bytes = ax_realloc(s->bytes, s->room, 1);
    }
    if (bytes)
        memcpy(s->bytes + s->size, data, bytes);
    s->size += bytes;
}

#define FIELD(s, value) raw(s, &(value), sizeof(value))

// An array of `count` elements, whose count is known; allocated when reading.
static void* array(stream* s, const void* data, size_t count, size_t size)
{
    if (!s->reading) {
        raw(s, (void*)data, count * size);
        return (void*)data;
    }
    if (s->bad || count > MOST || s->size - s->at < count * size) {
        s->bad = true;
        return ax_calloc(1, size);
    }
    void* block = ax_alloc(count ? count : 1, size);
    raw(s, block, count * size);
    return block;
}

#define ARRAY(s, pointer, count) ((pointer) = array(s, pointer, (size_t)(count), sizeof *(pointer)))

// How many things follow that take at least `each` bytes, so that no more is allocated than the bytes given can fill.
static void counted(stream* s, int* count, int least, size_t each)
{
    raw(s, count, sizeof *count);
    if (*count < least || *count > MOST || (s->reading && (size_t)*count > (s->size - s->at) / each))
        s->bad = true, *count = 0;
}

// Bytes of bools and enumerators that are none may come from outside; padding of structs must not get in.
static void flag(stream* s, bool* value)
{
    unsigned char byte = *value;
    raw(s, &byte, 1);
    s->bad = s->bad || byte > 1;
    *value = byte == 1;
}

static int choice(stream* s, int value, int last)
{
    raw(s, &value, sizeof value);
    s->bad = s->bad || value < 0 || value > last;
    return s->bad ? 0 : value;
}

#define CHOICE(s, value, last) ((value) = choice(s, (int)(value), last))

// Numbers that solvers can bear.
static void reals(stream* s, const double* values, size_t count)
{
    for (size_t k = 0; k < count && s->reading && !s->bad; ++k)
        s->bad = !(fabs(values[k]) <= 1e15);
}

#define REAL(s, value)                                                                                                 \
    (raw(s, &(value), sizeof(value)), reals(s, (const double*)&(value), sizeof(value) / sizeof(double)))

static void indices(stream* s, const int* list, int count, int limit)
{
    for (int k = 0; k < count && !s->bad; ++k)
        s->bad = list[k] < 0 || list[k] >= limit;
}

static void text(stream* s, const char** value)
{
    int length = s->reading ? 0 : (int)strlen(*value);
    counted(s, &length, 0, 1);
    char* to = s->reading ? ax_calloc((size_t)length + 1, 1) : (char*)*value;
    raw(s, to, (size_t)length);
    *value = to;
}

static void shape(stream* s, ax_curve_shape* curve)
{
    CHOICE(s, curve->kind, AX_CURVE_SPLINE);
    flag(s, &curve->closed);
    REAL(s, curve->fillet);
    counted(s, &curve->count, 0, sizeof *curve->points);
    ARRAY(s, curve->points, curve->count);
    reals(s, *curve->points, s->bad ? 0 : 3 * (size_t)curve->count);
}

static void mesh(stream* s, ax_mesh* m)
{
    counted(s, &m->vertex_count, 0, sizeof *m->positions);
    counted(s, &m->face_count, 0, sizeof *m->faces);
    ARRAY(s, m->positions, m->vertex_count);
    reals(s, *m->positions, s->bad ? 0 : 3 * (size_t)m->vertex_count);
    ARRAY(s, m->faces, m->face_count);
    if (!s->bad)
        indices(s, &m->faces[0][0], 3 * m->face_count, m->vertex_count);
}

static void rising(stream* s, const int* start, int count)
{
    s->bad = s->bad || start[0] != 0;
    for (int k = 0; k < count && !s->bad; ++k)
        s->bad = start[k] > start[k + 1];
}

static void linkage(stream* s, ax_linkage* l)
{
    counted(s, &l->triangle_count, 1, sizeof *l->triangles);
    counted(s, &l->hinge_count, 1, sizeof *l->on_rim);
    counted(s, &l->hole_count, 0, sizeof *l->hole_start);
    counted(s, &l->opening_count, 0, sizeof *l->opening_start);
    ARRAY(s, l->triangles, l->triangle_count);
    ARRAY(s, l->panels, l->triangle_count);
    ARRAY(s, l->hole_start, l->hole_count + 1);
    ARRAY(s, l->opening_start, l->opening_count + 1);
    rising(s, l->hole_start, l->hole_count);
    rising(s, l->opening_start, l->opening_count);
    if (s->bad)
        return;
    ARRAY(s, l->hole_hinges, l->hole_start[l->hole_count]);
    ARRAY(s, l->opening_hinges, l->opening_start[l->opening_count]);
    ARRAY(s, l->on_rim, l->hinge_count);
    for (int h = 0; h < l->hinge_count && !s->bad; ++h)
        s->bad = l->on_rim[h] > 1;
}

static void rim_part(stream* s, ax_rim_part* part)
{
    CHOICE(s, part->kind, AX_RIM_SLIDE);
    counted(s, &part->count, 0, sizeof *part->hinges);
    ARRAY(s, part->hinges, part->count);
    if (part->kind == AX_RIM_FIXED) {
        ARRAY(s, part->places, part->count);
        reals(s, *part->places, s->bad ? 0 : 3 * (size_t)part->count);
    }
    if (part->kind == AX_RIM_SLIDE)
        shape(s, &part->curve);
}

static void constraint(stream* s, ax_form_constraint* c)
{
    text(s, &c->name);
    CHOICE(s, c->kind, AX_HELD_FAIR);
    counted(s, &c->count, 0, sizeof *c->hinges);
    ARRAY(s, c->hinges, c->count);
    REAL(s, c->weight);
    REAL(s, c->point);
    REAL(s, c->direction);
    FIELD(s, c->order);
    flag(s, &c->support);
    if (c->kind == AX_HELD_FIXED) {
        ARRAY(s, c->places, c->count);
        reals(s, *c->places, s->bad ? 0 : 3 * (size_t)c->count);
    }
    if (c->kind == AX_HELD_CURVE)
        shape(s, &c->curve);
    if (c->kind == AX_HELD_SURFACE) {
        if (s->reading)
            c->surface = AX_NEW0(ax_mesh, 1);
        mesh(s, (ax_mesh*)c->surface);
    }
}

static void lattice(stream* s, ax_lattice* l)
{
    linkage(s, &l->linkage);
    ARRAY(s, l->hinges, l->linkage.hinge_count);
    reals(s, *l->hinges, s->bad ? 0 : 2 * (size_t)l->linkage.hinge_count);
    REAL(s, l->spacing);
    s->bad = s->bad || (s->reading && !(l->spacing > 1e-12));
    REAL(s, l->angle);
    REAL(s, l->offset);
}

// Copies an array of the form when reading, so that those made with the form stay in place.
static void state(stream* s, void* data, size_t bytes)
{
    raw(s, data, bytes);
    reals(s, data, s->bad ? 0 : bytes / sizeof(double));
}

static void dynamics(stream* s, ax_form_dynamics* d)
{
    CHOICE(s, d->kind, AX_DYNAMICS_INFLATION);
    CHOICE(s, d->load.kind, AX_LOAD_INFLATION);
    REAL(s, d->load.direction);
    REAL(s, d->load.pressure);
    REAL(s, d->load.density);
    flag(s, &d->adapt);
    REAL(s, d->give);
    flag(s, &d->adopt);
    flag(s, &d->collisions);
}

static ax_status load(const void* bytes, size_t size, int most, ax_form** out, ax_error* error);

// The coarser sheet, itself as bytes.
static void coarser(stream* s, ax_form* f)
{
    bool any = f->coarser != NULL;
    flag(s, &any);
    flag(s, &f->outdated);
    s->bad = s->bad || (any && f->outline_count == 0);
    if (!any || s->bad)
        return;
    size_t size = 0;
    void* bytes = s->reading ? NULL : ax_form_save(f->coarser, &size);
    uint64_t length = size;
    FIELD(s, length);
    bytes = array(s, bytes, length, 1);
    if (s->reading && !s->bad)
        s->bad = load(bytes, length, f->lattice.linkage.triangle_count / 4 * 3, &f->coarser, NULL) != AX_OK;
    ax_free(bytes);
}

static void body(stream* s, ax_form* f)
{
    size_t n = (size_t)f->lattice.linkage.hinge_count, t = (size_t)f->lattice.linkage.triangle_count;
    state(s, f->prescribed, t * sizeof *f->prescribed);
    state(s, f->stretch, t * sizeof *f->stretch);
    counted(s, &f->outline_count, 0, sizeof *f->outline);
    ARRAY(s, f->outline, f->outline_count);
    reals(s, *f->outline, s->bad ? 0 : 2 * (size_t)f->outline_count);
    REAL(s, f->mouth_min);
    flag(s, &f->released);
    dynamics(s, &f->dynamics);
    state(s, f->flat, n * sizeof *f->flat);
    state(s, f->deployed, n * sizeof *f->deployed);
    state(s, f->simulated, n * sizeof *f->simulated);
    state(s, f->side, t * sizeof *f->side);
    REAL(s, f->growth);
    flag(s, &f->exact);
    flag(s, &f->settled);
    flag(s, &f->turned);
    FIELD(s, f->folds);
    REAL(s, f->apart);
    FIELD(s, f->apart_hinge);
    s->bad = s->bad || (s->reading && !(f->apart_hinge >= 0 && (size_t)f->apart_hinge < n));
    bool drawn = f->drawn != NULL;
    flag(s, &drawn);
    s->bad = s->bad || (drawn && f->outline_count == 0);
    if (drawn && !s->bad) {
        ARRAY(s, f->drawn, n);
        reals(s, *f->drawn, s->bad ? 0 : 3 * n);
    }
    flag(s, &f->lightly);
    coarser(s, f);
    FIELD(s, f->revision);
    FIELD(s, f->iterations);

    counted(s, &f->rim_count, 0, RIM_PART);
    if (s->reading)
        f->rim = AX_NEW0(ax_rim_part, f->rim_count + 1);
    for (int k = 0; k < f->rim_count && !s->bad; ++k)
        rim_part(s, f->rim + k);
    counted(s, &f->held_count, 0, CONSTRAINT);
    if (s->reading)
        f->held = AX_NEW0(ax_form_constraint, f->held_count + 1);
    for (int k = 0; k < f->held_count && !s->bad; ++k)
        constraint(s, f->held + k);
    counted(s, &f->set_count, 0, SET);
    if (s->reading)
        f->sets = AX_NEW0(ax_named_set, f->set_count + 1);
    for (int k = 0; k < f->set_count && !s->bad; ++k) {
        text(s, (const char**)&f->sets[k].name);
        counted(s, &f->sets[k].count, 0, sizeof *f->sets[k].hinges);
        ARRAY(s, f->sets[k].hinges, f->sets[k].count);
        indices(s, f->sets[k].hinges, s->bad ? 0 : f->sets[k].count, f->lattice.linkage.hinge_count);
    }
    counted(s, &f->underlay_count, 0, UNDERLAY);
    if (s->reading) {
        f->underlay_names = AX_NEW0(const char*, f->underlay_count + 1);
        f->underlays = AX_NEW0(ax_mesh, f->underlay_count + 1);
    }
    for (int k = 0; k < f->underlay_count && !s->bad; ++k) {
        text(s, f->underlay_names + k);
        mesh(s, f->underlays + k);
    }
    ARRAY(s, f->clearances, f->underlay_count);
    reals(s, f->clearances, s->bad ? 0 : (size_t)f->underlay_count);
}

static uint64_t checksum(const unsigned char* bytes, size_t size)
{
    uint64_t sum = 0xcbf29ce484222325u; // FNV-1a
    for (size_t k = 0; k < size; ++k)
        sum = (sum ^ bytes[k]) * 0x100000001b3u;
    return sum;
}

void* ax_form_save(const ax_form* form, size_t* size)
{
    stream s = {0};
    ax_form* f = (ax_form*)form; // writing changes nothing
    raw(&s, (void*)magic, sizeof magic);
    CHOICE(&s, f->unit, AX_METRE);
    lattice(&s, &f->lattice);
    body(&s, f);
    size_t count;
    double* multipliers = ax_form_multipliers(f, &count);
    uint64_t length = count;
    FIELD(&s, length);
    raw(&s, multipliers, count * sizeof *multipliers);
    ax_free(multipliers);
    uint64_t sum = checksum(s.bytes, s.size);
    FIELD(&s, sum);
    *size = s.size;
    return s.bytes;
}

static ax_status damaged(ax_error* error)
{
    return ax_fail(error, AX_BAD_INPUT, "The stored form is damaged or was written by another version.");
}

// A form of at most so many panels.
static ax_status load(const void* bytes, size_t size, int most, ax_form** out, ax_error* error)
{
    *out = NULL;
    uint64_t sum;
    if (size < sizeof magic + sizeof sum || memcmp(bytes, magic, sizeof magic) != 0)
        return damaged(error);
    memcpy(&sum, (const unsigned char*)bytes + size - sizeof sum, sizeof sum);
    if (sum != checksum(bytes, size - sizeof sum))
        return damaged(error);
    stream s = {.bytes = (unsigned char*)bytes, .size = size - sizeof sum, .at = sizeof magic, .reading = true};
    ax_unit unit = AX_METRE;
    ax_lattice sheet = {0};
    CHOICE(&s, unit, AX_METRE);
    lattice(&s, &sheet);
    if (s.bad || sheet.linkage.triangle_count > most || ax_linkage_check(&sheet.linkage, NULL) != AX_OK) {
        ax_lattice_free(&sheet);
        return damaged(error);
    }
    ax_form* f = ax_form_over(&sheet, unit);
    body(&s, f);
    ax_form_spare_uneven(f);
    uint64_t length = 0;
    FIELD(&s, length);
    f->pending = array(&s, NULL, length, sizeof *f->pending);
    f->pending_count = length;
    reals(&s, f->pending, s.bad ? 0 : length);
    s.bad = s.bad || s.at != s.size || ax_form_check_rim(f, f->rim_count, f->rim, NULL) != AX_OK;
    for (int k = 0; k < f->held_count && !s.bad; ++k)
        s.bad = ax_form_check_constraint(f, f->held + k, NULL) != AX_OK;
    if (s.bad) {
        ax_form_free(f);
        return damaged(error);
    }
    if (length == 0) {
        ax_free(f->pending);
        f->pending = NULL;
    }
    *out = f;
    return AX_OK;
}

ax_status ax_form_load(const void* bytes, size_t size, ax_form** out, ax_error* error)
{
    return load(bytes, size, INT_MAX, out, error);
}
