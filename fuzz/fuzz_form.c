// Stored forms changed at random, with a checksum that fits: what loads can be looked at, solved on and stored again.
#include "form/state.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerInitialize(int* argc, char*** argv);

typedef struct stored {
    unsigned char* bytes;
    size_t size;
    size_t inner, inner_size; // where the bytes of a coarser sheet are, if there is one
} stored;

static stored originals[2];

static void promise(bool kept)
{
    if (!kept)
        abort();
}

static stored put_away(ax_form* form)
{
    stored s = {0};
    s.bytes = ax_form_save(form, &s.size);
    ax_form_free(form);
    unsigned char* inner =
        memmem(s.bytes + 8, s.size - 8, s.bytes, 8); // begins as all stored forms do, after its length
    if (inner) {
        uint64_t length;
        memcpy(&length, inner - sizeof length, sizeof length);
        s.inner = (size_t)(inner - s.bytes), s.inner_size = length;
    }
    return s;
}

// The first holds something of every kind that a form stores but a coarser sheet, the second that.
int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    (void)argc, (void)argv;
    const double outline[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const double circle[3][3] = {{0, 0, 0}, {0, 0, 1}, {1.2, 0, 0}}, places[2][3] = {{-1, 0, 0}, {1, 0, 0}};
    double vertices[3][3] = {{-9, -9, 3}, {9, -9, 3}, {0, 9, 3}};
    int faces[1][3] = {{0, 1, 2}}, few[4] = {4, 5, 6, 7};
    const ax_mesh mesh = {3, 1, vertices, faces};
    ax_form* form;
    promise(ax_form_make(&(ax_form_start){4, outline, 24, 0, 1.4, 0, false, AX_METRE}, &form, NULL) == AX_OK);
    const ax_linkage* linkage = ax_form_look(form).linkage;
    int rim[64], count = 0;
    for (int h = 0; h < linkage->hinge_count && count < 64; ++h)
        if (linkage->on_rim[h])
            rim[count++] = h;
    const ax_rim_part parts[2] = {
        {AX_RIM_FIXED, 2, rim, places, {0}},
        {AX_RIM_SLIDE,
         count - 2,
         rim + 2,
         NULL,
         {.kind = AX_CURVE_CIRCLE, .closed = true, .count = 3, .points = circle}},
    };
    promise(ax_form_set_rim(form, 2, parts, NULL) == AX_OK);
    ax_form_constraint held = {.name = "plane", .kind = AX_HELD_PLANE, .count = 4, .hinges = few, .weight = 1};
    promise(ax_form_put_constraint(form, &held, NULL) == AX_OK);
    held.name = "surface", held.kind = AX_HELD_SURFACE, held.surface = &mesh;
    promise(ax_form_put_constraint(form, &held, NULL) == AX_OK);
    ax_form_name_selection(form, "few", 4, few);
    ax_form_put_underlay(form, "room", &mesh, 0.1);
    ax_form_dynamics dynamics = ax_form_dynamics_default();
    dynamics.kind = AX_DYNAMICS_INFLATION;
    dynamics.load.kind = AX_LOAD_INFLATION, dynamics.load.pressure = 100;
    ax_form_set_dynamics(form, &dynamics);
    ax_form_iterate(form, 5);
    originals[0] = put_away(form);
    bool nested;
    promise(ax_form_make(&(ax_form_start){4, outline, 950, 0, 1.2, 0, false, AX_METRE}, &form, NULL) == AX_OK);
    promise(ax_form_nest(form, NULL, &nested) && nested);
    originals[1] = put_away(form);
    promise(originals[1].inner_size > 0);
    return 0;
}

static uint64_t checksum(const unsigned char* bytes, size_t size)
{
    uint64_t sum = 0xcbf29ce484222325u;
    for (size_t k = 0; k < size; ++k)
        sum = (sum ^ bytes[k]) * 0x100000001b3u;
    return sum;
}

static void use(ax_form* form)
{
    ax_form_report report;
    ax_form_look(form);
    ax_form_measure(form, &report);
    ax_form_report_free(&report);
    ax_design design;
    ax_form_snapshot(form, false, &design);
    ax_design_free(&design);
    ax_form_iterate(form, 2);
}

static void keep(const ax_form* form)
{
    size_t size, again_size;
    void* bytes = ax_form_save(form, &size);
    ax_form* again;
    if (ax_form_load(bytes, size, &again, NULL) == AX_OK) { // numbers may have grown beyond what is borne
        void* same = ax_form_save(again, &again_size);
        promise(size == again_size && memcmp(bytes, same, size) == 0);
        ax_form_free(again);
        ax_free(same);
    }
    ax_free(bytes);
}

static void seal(unsigned char* bytes, size_t size)
{
    uint64_t sum = checksum(bytes, size - sizeof sum);
    memcpy(bytes + size - sizeof sum, &sum, sizeof sum);
}

static ax_form* load(const unsigned char* bytes, size_t size)
{
    unsigned char* exact = malloc(size); // so that the sanitizer sees a byte too far
    memcpy(exact, bytes, size);
    ax_form* form;
    bool loaded = ax_form_load(exact, size, &form, NULL) == AX_OK;
    free(exact);
    return loaded ? form : NULL;
}

// No count makes room for more than the bytes can hold, wherever it stands: what asks for 2 GB is ended by libFuzzer.
static void count_too_much(const stored* original)
{
    const int many = 100000000;
    unsigned char* bytes = malloc(original->size);
    for (size_t at = 8; at + sizeof many + 8 <= original->size; ++at) {
        if (original->bytes[at + 2] || original->bytes[at + 3])
            continue; // not a count
        memcpy(bytes, original->bytes, original->size);
        memcpy(bytes + at, &many, sizeof many);
        seal(bytes, original->size);
        ax_form_free(load(bytes, original->size));
    }
    free(bytes);
}

// A byte, n for the nested form, then six bytes an edit: place, what is done, value. Then, rarely, some bytes fewer.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size == 0) {
        count_too_much(originals);
        return 0;
    }
    stored s = originals[*data++ == 'n'];
    unsigned char* bytes = malloc(s.size);
    memcpy(bytes, s.bytes, s.size);
    for (--size; size >= 6; data += 6, size -= 6) {
        uint32_t place;
        memcpy(&place, data, sizeof place);
        size_t at = 8 + place % (s.size - 24);
        static const double numbers[] = {NAN, INFINITY, -1e300, 1e-300, 0, -1, 1e9};
        static const int counts[] = {-1, 0, 1, 2147483647, 100000000, 1000};
        if (data[4] % 4 == 0)
            memcpy(bytes + at, &numbers[data[5] % 7], sizeof *numbers);
        else if (data[4] % 4 == 1)
            memcpy(bytes + at, &counts[data[5] % 6], sizeof *counts);
        else
            bytes[at] = data[5];
    }
    if (s.inner)
        seal(bytes + s.inner, s.inner_size);
    if (size == 5)
        s.size -= data[0];
    seal(bytes, s.size);
    ax_form* form = load(bytes, s.size);
    if (form) {
        if (!s.inner) // of 950 panels would take long
            use(form);
        keep(form);
        ax_form_free(form);
    }
    free(bytes);
    return 0;
}
