// Pictures: that the file is what was asked for, that colours mean what the legend says, and the parts they are made with.
#include "ax/picture.h"
#include "base/random.h"
#include "picture/colour.h"
#include "picture/legend.h"
#include "picture/raster.h"
#include "picture/view.h"
#include "support/shapes.h"
#include "support/test.h"

#include <cairo.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/ax-picture-XXXXXX";
static char path[64];
static ax_design design;

static int open_folder(void** state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/picture.png", folder);
    ax_mesh target = shape_cap(20, 0.8);
    ax_design_options options = ax_design_options_default();
    options.triangles = 150;
    ax_error error;
    ax_status status = ax_design_from_target(&target, &options, NULL, &design, &error);
    ax_mesh_free(&target);
    return status == AX_OK ? 0 : -1;
}

static int close_folder(void** state)
{
    (void)state;
    unlink(path);
    ax_design_free(&design);
    return rmdir(folder); // fails if anything else was left behind
}

typedef struct image {
    int width, height;
    unsigned* pixels; // 0xRRGGBB
} image;

static image load(void)
{
    cairo_surface_t* surface = cairo_image_surface_create_from_png(path);
    assert_int_equal(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
    image out = {cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), NULL};
    out.pixels = malloc((size_t)out.width * (size_t)out.height * sizeof *out.pixels);
    int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < out.height; ++y) {
        memcpy(out.pixels + y * out.width, cairo_image_surface_get_data(surface) + y * stride,
               (size_t)out.width * sizeof *out.pixels);
        for (int x = 0; x < out.width; ++x)
            out.pixels[y * out.width + x] &= 0xffffff;
    }
    cairo_surface_destroy(surface);
    unlink(path);
    return out;
}

static image draw(const ax_design* of, ax_state which, int width, int height)
{
    ax_error error = {0};
    if (ax_picture_design(of, which, width, height, path, &error) != AX_OK)
        fail_msg("%s", error.message);
    return load();
}

static int channel(unsigned pixel, int c)
{
    return (int)(pixel >> (16 - 8 * c) & 255);
}

static int difference(unsigned a, unsigned b)
{
    int most = 0;
    for (int c = 0; c < 3; ++c) {
        int d = abs(channel(a, c) - channel(b, c));
        most = d > most ? d : most;
    }
    return most;
}

// Share of the pixels that fulfil a condition.
static double share(const image* of, bool (*condition)(unsigned pixel))
{
    size_t count = 0, all = (size_t)of->width * (size_t)of->height;
    for (size_t i = 0; i < all; ++i)
        count += condition(of->pixels[i]);
    return (double)count / (double)all;
}

static bool is_coloured(unsigned p)
{
    int high = 0, low = 255;
    for (int c = 0; c < 3; ++c) {
        high = channel(p, c) > high ? channel(p, c) : high;
        low = channel(p, c) < low ? channel(p, c) : low;
    }
    return high - low > 30;
}

static bool is_blue(unsigned p)
{
    return channel(p, 2) > channel(p, 0) + 40;
}

static bool is_orange(unsigned p)
{
    return channel(p, 0) > channel(p, 2) + 40;
}

static bool is_ink(unsigned p)
{
    return channel(p, 0) < 110 && channel(p, 1) < 110 && channel(p, 2) < 110;
}

static void every_state_becomes_a_picture_of_the_size_asked(void** state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {65, 130}, {640, 333}, {1000, 640}};
    for (int which = AX_STATE_DEFAULT; which <= AX_STATE_SIMULATED; ++which)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k) {
            image drawn = draw(&design, (ax_state)which, sizes[k][0], sizes[k][1]);
            assert_int_equal(drawn.width, sizes[k][0]);
            assert_int_equal(drawn.height, sizes[k][1]);
            double panels = share(&drawn, is_coloured);
            assert_true(panels > 0.02 && panels < 0.7);
            free(drawn.pixels);
        }
}

static void the_largest_picture_can_be_drawn(void** state)
{
    (void)state;
    image drawn = draw(&design, AX_STATE_DEPLOYED, 8192, 64);
    assert_int_equal(drawn.width, 8192);
    free(drawn.pixels);
}

static void flat_panels_show_exactly_the_colour_of_their_scale_factor(void** state)
{
    (void)state;
    image drawn = draw(&design, AX_STATE_FLAT, 300, 190); // too small for a legend: all colour is the panels'
    for (int t = 0; t < design.linkage.triangle_count; ++t) {
        double rgb[3];
        ax_colour_scale(design.scale[t], rgb);
        unsigned wanted = 0;
        for (int c = 0; c < 3; ++c)
            wanted = wanted << 8 | (unsigned)lrint(255 * rgb[c]);
        int nearest = 255;
        for (int i = 0; i < drawn.width * drawn.height; ++i) {
            int d = difference(drawn.pixels[i], wanted);
            nearest = d < nearest ? d : nearest;
        }
        assert_in_range(nearest, 0, 2);
    }
    free(drawn.pixels);
}

static void the_legend_shows_the_whole_map(void** state)
{
    (void)state;
    image drawn = draw(&design, AX_STATE_DEPLOYED, 1280, 800);
    for (int k = 0; k <= 8; ++k) {
        double rgb[3];
        ax_colour_scale(1 + k / 8.0, rgb);
        int nearest = 255;
        for (int y = 600; y < 800; ++y)
            for (int x = 0; x < 320; ++x) {
                unsigned wanted = 0;
                for (int c = 0; c < 3; ++c)
                    wanted = wanted << 8 | (unsigned)lrint(255 * rgb[c]);
                int d = difference(drawn.pixels[y * drawn.width + x], wanted);
                nearest = d < nearest ? d : nearest;
            }
        assert_in_range(nearest, 0, 2);
    }
    free(drawn.pixels);
}

static void place_and_size_of_the_model_do_not_matter(void** state)
{
    (void)state;
    image here = draw(&design, AX_STATE_DEPLOYED, 300, 190);
    int hinges = design.linkage.hinge_count;
    double(*kept)[3] = design.deployed, (*moved)[3] = ax_copy(kept, (size_t)hinges, sizeof *moved);
    static const double moves[][4] = {{1, 1e6, -2e6, 3e5}, {1e-3, 0, 0, 0}, {1e5, -1e9, 0, 0}};
    for (size_t k = 0; k < sizeof moves / sizeof *moves; ++k) {
        for (int h = 0; h < hinges; ++h)
            for (int c = 0; c < 3; ++c)
                moved[h][c] = moves[k][0] * kept[h][c] + moves[k][1 + c];
        design.deployed = moved;
        image there = draw(&design, AX_STATE_DEPLOYED, 300, 190);
        design.deployed = kept;
        int differing = 0;
        for (int i = 0; i < here.width * here.height; ++i)
            differing += difference(here.pixels[i], there.pixels[i]) > 8;
        assert_in_range(differing, 0, here.width * here.height / 500);
        free(there.pixels);
    }
    ax_free(moved);
    free(here.pixels);
}

static void a_shell_turned_any_way_is_seen_from_its_coloured_side(void** state)
{
    (void)state;
    int hinges = design.linkage.hinge_count;
    double(*kept)[3] = design.deployed, (*turned)[3] = ax_copy(kept, (size_t)hinges, sizeof *turned);
    double reference = 0;
    for (int turn = 0; turn < 4; ++turn) {
        for (int h = 0; h < hinges; ++h) {
            const double* x = kept[h];
            const double places[4][3] = {
                {x[0], x[1], x[2]}, {x[0], -x[1], -x[2]}, {x[2], x[0], x[1]}, {-x[2], -x[0], x[1]}};
            memcpy(turned[h], places[turn], sizeof turned[h]);
        }
        design.deployed = turned;
        image drawn = draw(&design, AX_STATE_DEPLOYED, 300, 190);
        design.deployed = kept;
        double colour = share(&drawn, is_coloured);
        reference = turn == 0 ? colour : reference;
        assert_true(colour > 0.5 * reference);
        free(drawn.pixels);
    }
    ax_free(turned);
}

static void the_same_call_gives_the_same_file(void** state)
{
    (void)state;
    unsigned char* bytes[2];
    long count[2];
    for (int k = 0; k < 2; ++k) {
        assert_int_equal(ax_picture_design(&design, AX_STATE_SIMULATED, 500, 400, path, NULL), AX_OK);
        FILE* file = fopen(path, "rb");
        fseek(file, 0, SEEK_END);
        count[k] = ftell(file);
        rewind(file);
        bytes[k] = malloc((size_t)count[k]);
        assert_int_equal(fread(bytes[k], 1, (size_t)count[k], file), count[k]);
        fclose(file);
    }
    assert_int_equal(count[0], count[1]);
    assert_memory_equal(bytes[0], bytes[1], (size_t)count[0]);
    free(bytes[0]), free(bytes[1]);
}

static void edge_forces_colour_the_simulated_state(void** state)
{
    (void)state;
    size_t panels = (size_t)design.linkage.triangle_count;
    double(*kept)[3] = design.edge_forces, (*forces)[3] = ax_copy(kept, panels, sizeof *forces);
    design.edge_forces = forces;
    for (int sign = -1; sign <= 1; sign += 2) {
        for (size_t t = 0; t < panels; ++t)
            for (int k = 0; k < 3; ++k)
                forces[t][k] = sign * 75.0;
        image drawn = draw(&design, AX_STATE_SIMULATED, 300, 190);
        assert_true(share(&drawn, sign < 0 ? is_blue : is_orange) > 0.03);
        assert_true(share(&drawn, sign < 0 ? is_orange : is_blue) == 0);
        free(drawn.pixels);
    }
    design.edge_forces = kept;
    ax_free(forces);
}

static ax_screen screen_with(const ax_mesh* mesh, double* values)
{
    return (ax_screen){.vertex_count = mesh->vertex_count, .curvature = values};
}

static image draw_screen(const ax_mesh* mesh, const ax_screen* screen, ax_screen_field field)
{
    ax_error error = {0};
    if (ax_picture_screen(mesh, screen, field, 300, 200, path, &error) != AX_OK)
        fail_msg("%s", error.message);
    return load();
}

static void where_a_surface_dips_it_is_blue_and_hatched(void** state)
{
    (void)state;
    ax_mesh mesh = shape_paraboloid(12, 0.3);
    double* values = AX_NEW(double, mesh.vertex_count);
    ax_screen screen = screen_with(&mesh, values);
    for (int v = 0; v < mesh.vertex_count; ++v)
        values[v] = 0.1 + 1e-3 * mesh.positions[v][0];
    image bulging = draw_screen(&mesh, &screen, AX_SCREEN_CURVATURE);
    assert_true(share(&bulging, is_orange) > 0.2);
    assert_true(share(&bulging, is_blue) == 0 && share(&bulging, is_ink) == 0);
    for (int v = 0; v < mesh.vertex_count; ++v) // weak, yet of the wrong sign on one half
        values[v] = mesh.positions[v][0] > 0 ? 0.1 : -1e-6;
    image dipping = draw_screen(&mesh, &screen, AX_SCREEN_CURVATURE);
    assert_true(share(&dipping, is_blue) > 0.1 && share(&dipping, is_orange) > 0.1);
    assert_true(share(&dipping, is_ink) > 0.005);
    free(bulging.pixels), free(dipping.pixels);
    ax_free(values);
    ax_mesh_free(&mesh);
}

static void a_request_that_cannot_be_met_says_why(void** state)
{
    (void)state;
    static const int bad[][2] = {{63, 100}, {100, 63}, {8193, 100}, {100, 8193}, {0, 0}, {-5, 100}};
    ax_error error;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        assert_int_equal(ax_picture_design(&design, AX_STATE_FLAT, bad[k][0], bad[k][1], path, &error), AX_USAGE);
        assert_non_null(strstr(error.message, "64 to 8192"));
    }
    double(*simulated)[3] = design.simulated;
    design.simulated = NULL;
    assert_int_equal(ax_picture_design(&design, AX_STATE_SIMULATED, 100, 100, path, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "simulate"));
    design.simulated = simulated;

    ax_mesh mesh = shape_paraboloid(4, 0.3);
    double* values = AX_NEW0(double, mesh.vertex_count);
    ax_screen screen = screen_with(&mesh, values);
    assert_int_equal(ax_picture_screen(&mesh, &screen, AX_SCREEN_SCALE, 100, 100, path, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "flatten"));
    ax_free(values);
    ax_mesh_free(&mesh);

    double kept = design.deployed[3][1];
    design.deployed[3][1] = NAN;
    assert_int_equal(ax_picture_design(&design, AX_STATE_DEPLOYED, 100, 100, path, &error), AX_BAD_INPUT);
    design.deployed[3][1] = kept;
    assert_int_not_equal(access(path, F_OK), 0); // nothing was begun
}

static void a_place_that_cannot_be_written_is_named(void** state)
{
    (void)state;
    ax_error error;
    assert_int_equal(ax_picture_design(&design, AX_STATE_FLAT, 100, 100, "/nowhere/at/all.png", &error), AX_FAILED);
    assert_non_null(strstr(error.message, "/nowhere/at/all.png"));
    assert_int_equal(ax_picture_design(&design, AX_STATE_FLAT, 100, 100, folder, &error), AX_FAILED);
    assert_non_null(strstr(error.message, folder));
}

// Sums what each call of ax_raster shows.
static void count_samples(void* context, const ax_raster_tile* tile)
{
    int* count = context;
    for (int j = 0; tile->faces && j < tile->height; ++j)
        for (int i = 0; i < tile->width * AX_RASTER_SAMPLES; ++i)
            *count += tile->faces[j * AX_RASTER_TILE * AX_RASTER_SAMPLES + i] >= 0;
}

static void triangles_that_tile_a_square_cover_every_sample_once(void** state)
{
    (void)state;
    // A grid whose inner points are thrown about inside their cells, corners of the square at whole pixels.
    enum { CELLS = 12, POINTS = (CELLS + 1) * (CELLS + 1), SIDE = 150 };
    ax_raster_vertex points[POINTS];
    ax_random random = {7};
    for (int j = 0; j <= CELLS; ++j)
        for (int i = 0; i <= CELLS; ++i) {
            bool inner = i > 0 && j > 0 && i < CELLS && j < CELLS;
            double shift[2];
            for (int c = 0; c < 2; ++c)
                shift[c] = inner ? ax_random_uniform(&random, -0.4, 0.4) : 0;
            points[j * (CELLS + 1) + i] = (ax_raster_vertex){10 + SIDE * (i + shift[0]) / CELLS,
                                                             20 + SIDE * (j + shift[1]) / CELLS, (float)(i + j)};
        }
    int faces[2 * CELLS * CELLS][3], sum = 0, together = 0;
    for (int j = 0, f = 0; j < CELLS; ++j)
        for (int i = 0; i < CELLS; ++i, f += 2) {
            int a = j * (CELLS + 1) + i, b = a + 1, c = a + CELLS + 1, d = c + 1;
            int both[2][3] = {{a, b, d}, {d, a, c}}; // in either sense
            memcpy(faces[f], both, sizeof both);
        }
    for (int f = 0; f < 2 * CELLS * CELLS; ++f)
        ax_raster(200, 200, AX_RASTER_SAMPLES, POINTS, points, 1, (const int(*)[3]) & faces[f], count_samples, &sum);
    ax_raster(200, 200, AX_RASTER_SAMPLES, POINTS, points, 2 * CELLS * CELLS, (const int(*)[3])faces, count_samples,
              &together);
    assert_int_equal(sum, SIDE * SIDE * AX_RASTER_SAMPLES);
    assert_int_equal(together, SIDE * SIDE * AX_RASTER_SAMPLES);
}

static void see_only_face(void* context, const ax_raster_tile* tile)
{
    int wanted = *(const int*)context;
    for (int j = 0; tile->faces && j < tile->height; ++j)
        for (int i = 0; i < tile->width; ++i) {
            int face = tile->faces[j * AX_RASTER_TILE + i];
            assert_true(face == wanted || face < 0);
        }
}

static void the_nearer_of_two_triangles_is_seen(void** state)
{
    (void)state;
    ax_raster_vertex points[] = {{10, 10, 1}, {90, 15, 2}, {40, 90, 3},    {10, 10, 0.5f}, {90, 15, 1.5f},
                                 {40, 90, 2}, {10, 10, 4}, {90, 15, 2.5f}, {40, 90, 3.5f}};
    const int faces[][3] = {{0, 1, 2}, {6, 7, 8}, {3, 4, 5}};
    int nearest = 1;
    ax_raster(100, 100, 1, 9, points, 3, faces, see_only_face, &nearest);
}

static void what_is_framed_lies_inside_and_clear_of_the_legend(void** state)
{
    (void)state;
    ax_random random = {11};
    for (int trial = 0; trial < 40; ++trial) {
        enum { COUNT = 60 };
        float points[COUNT][3];
        for (int i = 0; i < COUNT; ++i)
            for (int c = 0; c < 3; ++c)
                points[i][c] = (float)ax_random_uniform(&random, -0.3, 0.3);
        ax_rectangle safe = {20, 40, ax_random_uniform(&random, 200, 900), ax_random_uniform(&random, 200, 900)};
        ax_rectangle card = {0, safe.y + safe.height - 90, 150, 120};
        ax_view view = ax_view_from(ax_random_uniform(&random, 0, 6), 0.6, 2);
        ax_view_frame(&view, COUNT, (const float(*)[3])points, safe, 1, &card);
        for (int i = 0; i < COUNT; ++i) {
            ax_raster_vertex at = ax_view_project(&view, points[i]);
            assert_true(at.x >= safe.x - 1e-6 && at.x <= safe.x + safe.width + 1e-6);
            assert_true(at.y >= safe.y - 1e-6 && at.y <= safe.y + safe.height + 1e-6);
            assert_false(at.x > card.x && at.x < card.x + card.width && at.y > card.y && at.y < card.y + card.height);
        }
    }
}

static void a_ray_leads_back_to_what_is_seen(void** state)
{
    (void)state;
    ax_view views[] = {ax_view_from(1, 0.6, 2), ax_view_along((const double[3]){0, 0, -1})};
    const float place[3] = {0.1f, -0.2f, 0.15f};
    for (int k = 0; k < 2; ++k) {
        views[k].scale = 300, views[k].offset[0] = 120, views[k].offset[1] = 80;
        ax_raster_vertex at = ax_view_project(&views[k], place);
        double origin[3], direction[3], to[3], across[3];
        ax_view_ray(&views[k], at.x, at.y, origin, direction);
        for (int c = 0; c < 3; ++c)
            to[c] = place[c] - origin[c];
        ax_cross(to, direction, across);
        assert_at_most(ax_norm3(across), 1e-7);
    }
}

static void maps_have_the_colours_of_their_ends_and_a_grey_for_no_value(void** state)
{
    (void)state;
    double rgb[3];
    ax_colour_scale(1, rgb);
    assert_near(rgb[0], 0x31 / 255.0, 1e-12);
    ax_colour_scale(3, rgb); // clamped
    assert_near(rgb[0], 0xfb / 255.0, 1e-12);
    ax_colour_scale(1.5, rgb);
    assert_near(rgb[1], 0xa3 / 255.0, 1e-12);
    ax_colour_level(-1, rgb);
    assert_near(rgb[2], 0x7b / 255.0, 1e-12);
    ax_colour_level(1, rgb);
    assert_near(rgb[2], 0x19 / 255.0, 1e-12);
    ax_colour_level(NAN, rgb);
    assert_near(rgb[0], 0x9a / 255.0, 1e-12);
    for (int k = 0; k <= 100; ++k)
        assert_near(ax_colour_from_linear(ax_colour_to_linear(k / 100.0)), k / 100.0, 1e-6);
}

static void numbers_are_written_the_same_everywhere(void** state)
{
    (void)state;
    static const struct {
        double value;
        int decimals;
        const char* text;
    } cases[] = {
        {1.25, 2, "1.25"},
        {1.5, 0, "2"},
        {0.005, 2, "0.01"},
        {12, 0, "12"},
        {-60, 0,
         "\u2212"
         "60"},
        {-0.001, 2, "0.00"},
        {0, 1, "0.0"},
        {2e7, 0, "2e7"},
        {-2.5e-7, 8,
         "\u2212"
         "2.5e-7"},
        {9.99e6, 0, "1e7"},
        {999999, 0, "999999"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[32];
        ax_write_number(text, sizeof text, cases[k].value, cases[k].decimals);
        assert_string_equal(text, cases[k].text);
    }
    assert_near(ax_round_length(0.73), 0.5, 1e-15);
    assert_near(ax_round_length(2), 2, 1e-15);
    assert_near(ax_round_length(1999), 1000, 1e-9);
    assert_near(ax_round_length(1e-3), 1e-3, 1e-15);
    assert_near(ax_palette_limit(53), 60, 1e-9);
    assert_near(ax_palette_limit(0.2), 0.2, 1e-15);
    assert_near(ax_palette_limit(61), 100, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_state_becomes_a_picture_of_the_size_asked),
        cmocka_unit_test(the_largest_picture_can_be_drawn),
        cmocka_unit_test(flat_panels_show_exactly_the_colour_of_their_scale_factor),
        cmocka_unit_test(the_legend_shows_the_whole_map),
        cmocka_unit_test(place_and_size_of_the_model_do_not_matter),
        cmocka_unit_test(a_shell_turned_any_way_is_seen_from_its_coloured_side),
        cmocka_unit_test(the_same_call_gives_the_same_file),
        cmocka_unit_test(edge_forces_colour_the_simulated_state),
        cmocka_unit_test(where_a_surface_dips_it_is_blue_and_hatched),
        cmocka_unit_test(a_request_that_cannot_be_met_says_why),
        cmocka_unit_test(a_place_that_cannot_be_written_is_named),
        cmocka_unit_test(triangles_that_tile_a_square_cover_every_sample_once),
        cmocka_unit_test(the_nearer_of_two_triangles_is_seen),
        cmocka_unit_test(what_is_framed_lies_inside_and_clear_of_the_legend),
        cmocka_unit_test(a_ray_leads_back_to_what_is_seen),
        cmocka_unit_test(maps_have_the_colours_of_their_ends_and_a_grey_for_no_value),
        cmocka_unit_test(numbers_are_written_the_same_everywhere),
    };
    return cmocka_run_group_tests_name("picture", tests, open_folder, close_folder);
}
