// What a linkage is called and how it is copied; laying the lattice is tested with the solvers.
#include "ax/linkage.h"

#include "base/vec.h"
#include "linkage/lattice.h"
#include "support/sample.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static void name_of(int column, int row, int down, char text[16])
{
    ax_linkage one = {.triangle_count = 1, .panels = &(int[3]){column, row, down}};
    ax_panel_name(&one, 0, text);
}

static void panels_are_named_by_row_and_place(void** state)
{
    (void)state;
    const struct {
        int column, row, down;
        const char* name;
    } cases[] = {
        {0, 0, 0, "A1"},
        {0, 0, 1, "A2"},
        {6, 2, 1, "C14"},
        {-1, 0, 0, "A-2"},
        {-1, 0, 1, "A-1"},
        {3, -1, 0, "-A7"},
        {-4, -2, 1, "-B-7"},
        {0, 25, 0, "Z1"},
        {0, 26, 0, "AA1"},
        {0, 26 + 26 * 26 - 1, 0, "ZZ1"},
        {0, 26 + 26 * 26, 0, "AAA1"},
        {-AX_PANEL_LIMIT, -AX_PANEL_LIMIT, 0, "-UVXWJ-20000000"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[16];
        name_of(cases[k].column, cases[k].row, cases[k].down, text);
        assert_string_equal(text, cases[k].name);
    }
}

static void a_new_lattice_is_numbered_from_its_own_corner(void** state)
{
    (void)state;
    const double square[4][2] = {{-7, -3}, {5, -3}, {5, 8}, {-7, 8}}, offset[2] = {0.3, 0.7};
    ax_lattice lattice;
    assert_int_equal(ax_lattice_lay(&(ax_outline){4, square}, 1, 0.4, offset, false, &lattice, NULL), AX_OK);
    const ax_linkage* l = &lattice.linkage;
    assert_true(l->panels[0][1] < 0);
    ax_lattice_renumber(&lattice);
    int lowest[2] = {1, 1};
    for (int t = 0; t < l->triangle_count; ++t) {
        double centre[2] = {0, 0}, wanted[2];
        for (int d = 0; d < 2; ++d) {
            assert_true(l->panels[t][d] >= 0);
            lowest[d] = l->panels[t][d] < lowest[d] ? l->panels[t][d] : lowest[d];
            for (int k = 0; k < 3; ++k)
                centre[d] += lattice.hinges[l->triangles[t][k]][d] / 3;
        }
        // the centroid lies a third of the cell's diagonal from its corner, two thirds in a triangle that points down
        double u = l->panels[t][0] + (1 + l->panels[t][2]) / 3.0, v = l->panels[t][1] + (1 + l->panels[t][2]) / 3.0;
        for (int d = 0; d < 2; ++d)
            wanted[d] = lattice.offset[d] + u * (d ? sin(0.4) : cos(0.4)) +
                        v * (d ? sin(0.4 + AX_PI / 3) : cos(0.4 + AX_PI / 3));
        assert_near(centre[0], wanted[0], 1e-12);
        assert_near(centre[1], wanted[1], 1e-12);
    }
    assert_int_equal(lowest[0], 0);
    assert_int_equal(lowest[1], 0);
    ax_lattice_free(&lattice);

    ax_design design = sample_design();
    for (int t = 0; t < design.linkage.triangle_count; ++t) {
        char name[16];
        ax_panel_name(&design.linkage, t, name);
        assert_null(strchr(name, '-'));
    }
    ax_design_free(&design);
}

static int by_text(const void* a, const void* b)
{
    return strcmp(a, b);
}

static void panel_names_are_unique_on_both_sides_of_the_origin(void** state)
{
    (void)state;
    enum { REACH = 30, COUNT = (2 * REACH + 1) * (2 * REACH + 1) * 2 };
    static char names[COUNT][16];
    int n = 0;
    for (int column = -REACH; column <= REACH; ++column)
        for (int row = -REACH; row <= REACH; ++row)
            for (int down = 0; down < 2; ++down)
                name_of(column, row, down, names[n++]);
    assert_int_equal(n, COUNT);
    qsort(names, COUNT, sizeof *names, by_text);
    for (int k = 1; k < COUNT; ++k)
        assert_string_not_equal(names[k - 1], names[k]);
}

static void a_copy_holds_the_same_and_nothing_in_common(void** state)
{
    (void)state;
    ax_design design = sample_design();
    const ax_linkage* a = &design.linkage;
    ax_linkage b = ax_linkage_copy(a);
    size_t triangles = (size_t)a->triangle_count, hinges = (size_t)a->hinge_count;
    size_t holes = (size_t)a->hole_count, openings = (size_t)a->opening_count;
    assert_true(holes > 0 && openings > 0);
    assert_memory_equal(&a->hole_count, &b.hole_count, sizeof a->hole_count);
    assert_memory_equal(a->triangles, b.triangles, triangles * sizeof *a->triangles);
    assert_memory_equal(a->panels, b.panels, triangles * sizeof *a->panels);
    assert_memory_equal(a->hole_start, b.hole_start, (holes + 1) * sizeof(int));
    assert_memory_equal(a->hole_hinges, b.hole_hinges, (size_t)a->hole_start[holes] * sizeof(int));
    assert_memory_equal(a->opening_start, b.opening_start, (openings + 1) * sizeof(int));
    assert_memory_equal(a->opening_hinges, b.opening_hinges, (size_t)a->opening_start[openings] * sizeof(int));
    assert_memory_equal(a->on_rim, b.on_rim, hinges);
    ax_design_free(&design);
    assert_in_range(b.triangles[0][0], 0, b.hinge_count - 1); // still there
    ax_linkage_free(&b);
    assert_null(b.triangles);
    ax_linkage nothing = {0};
    b = ax_linkage_copy(&nothing);
    assert_null(b.hole_start);
    ax_linkage_free(&b);
    ax_linkage_free(NULL);
}

static void a_linkage_that_contradicts_itself_is_refused(void** state)
{
    (void)state;
    ax_design design = sample_design();
    ax_linkage* l = &design.linkage;
    ax_error error = {0};
    assert_int_equal(ax_linkage_check(l, &error), AX_OK);
    l->opening_count -= 1; // the last opening's edges are now on none
    assert_int_equal(ax_linkage_check(l, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "no hole and no opening"));
    l->opening_count += 1;
    l->hinge_count += 1; // one that nothing holds
    l->on_rim = ax_realloc(l->on_rim, (size_t)l->hinge_count, 1);
    l->on_rim[l->hinge_count - 1] = 1;
    assert_int_equal(ax_linkage_check(l, &error), AX_BAD_INPUT);
    assert_non_null(strstr(error.message, "held by 0 triangles"));
    ax_design_free(&design);
}

// A flat sheet's cover is its area without gap or overlap: as much as its rim encloses.
static void the_cover_closes_holes_and_what_is_open_along_the_rim(void** state)
{
    (void)state;
    ax_design design = sample_design();
    const ax_linkage* l = &design.linkage;
    ax_mesh cover = ax_linkage_cover(l, (const double(*)[3])design.deployed);
    assert_int_equal(cover.vertex_count, l->hinge_count + l->hole_count);
    int* order = AX_NEW(int, l->hinge_count);
    int rim = ax_linkage_rim(l, order);
    double enclosed = 0, covered = 0;
    for (int k = 0; k < rim; ++k) // clockwise, as the openings run
        enclosed -= 0.5 * ax_cross2(design.deployed[order[k]], design.deployed[order[(k + 1) % rim]]);
    for (int f = 0; f < cover.face_count; ++f) {
        const int* v = cover.faces[f];
        covered += 0.5 * ax_orient2(cover.positions[v[0]], cover.positions[v[1]], cover.positions[v[2]]);
    }
    assert_near(covered, enclosed, 1e-12 * fabs(enclosed));
    ax_free(order);
    ax_mesh_free(&cover);
    ax_design_free(&design);
}

static void units_have_names_and_lengths(void** state)
{
    (void)state;
    ax_unit unit = AX_METRE;
    assert_true(ax_unit_parse("cm", &unit));
    assert_int_equal(unit, AX_CENTIMETRE);
    assert_near(ax_unit_in_metres(unit), 0.01, 0);
    assert_string_equal(ax_unit_name(AX_MILLIMETRE), "mm");
    assert_false(ax_unit_parse("inch", &unit));
    assert_int_equal(unit, AX_CENTIMETRE); // untouched
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panels_are_named_by_row_and_place),
        cmocka_unit_test(panel_names_are_unique_on_both_sides_of_the_origin),
        cmocka_unit_test(a_new_lattice_is_numbered_from_its_own_corner),
        cmocka_unit_test(a_copy_holds_the_same_and_nothing_in_common),
        cmocka_unit_test(a_linkage_that_contradicts_itself_is_refused),
        cmocka_unit_test(the_cover_closes_holes_and_what_is_open_along_the_rim),
        cmocka_unit_test(units_have_names_and_lengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
