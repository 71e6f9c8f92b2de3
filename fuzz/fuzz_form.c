// Stored forms changed at random, with a checksum that fits: what loads can be looked at, solved on and stored again.
#include "ax/form.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerInitialize(int* argc, char*** argv);

static unsigned char* original;
static size_t original_size;

static void promise(bool kept)
{
    if (!kept)
        abort();
}

// Holds something of every kind that a form stores.
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
    original = ax_form_save(form, &original_size);
    ax_form_free(form);
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

// Six bytes an edit: place, what is done, value. Then, rarely, some bytes fewer.
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    unsigned char* bytes = malloc(original_size);
    memcpy(bytes, original, original_size);
    size_t length = original_size - 8;
    for (; size >= 6; data += 6, size -= 6) {
        uint32_t place;
        memcpy(&place, data, sizeof place);
        size_t at = 8 + place % (original_size - 24);
        static const double numbers[] = {NAN, INFINITY, -1e300, 1e-300, 0, -1, 1e9};
        static const int counts[] = {-1, 0, 1, 2147483647, 100000000, 1000};
        if (data[4] % 4 == 0)
            memcpy(bytes + at, &numbers[data[5] % 7], sizeof *numbers);
        else if (data[4] % 4 == 1)
            memcpy(bytes + at, &counts[data[5] % 6], sizeof *counts);
        else
            bytes[at] = data[5];
    }
    if (size == 5)
        length -= data[0];
    uint64_t sum = checksum(bytes, length);
    memcpy(bytes + length, &sum, sizeof sum);
    unsigned char* exact = malloc(length + 8); // so that the sanitizer sees a byte too far
    memcpy(exact, bytes, length + 8);
    ax_form* form;
    if (ax_form_load(exact, length + 8, &form, NULL) == AX_OK) {
        use(form);
        ax_form_free(form);
    }
    free(exact);
    free(bytes);
    return 0;
}
