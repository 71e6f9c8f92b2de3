// Memory, failures, progress, and files that are never half written.
#include "base/file.h"
#include "base/random.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void failure_carries_its_message(void** state)
{
    (void)state;
    ax_error error = {0};
    assert_int_equal(ax_fail(&error, AX_BAD_INPUT, "Face %d has no area.", 7), AX_BAD_INPUT);
    assert_int_equal(error.status, AX_BAD_INPUT);
    assert_string_equal(error.message, "Face 7 has no area.");
    assert_int_equal(ax_fail(NULL, AX_USAGE, "nobody listens"), AX_USAGE);
}

static bool remember(void* context, const char* stage, double fraction, double residual)
{
    (void)stage, (void)residual;
    *(double*)context = fraction;
    return fraction < 0.5;
}

static void progress_parts_map_into_the_whole_and_cancel(void** state)
{
    (void)state;
    double seen = -1;
    ax_progress whole = {remember, &seen};
    ax_progress_part slot;
    const ax_progress* part = ax_progress_within(&slot, &whole, 0.4, 0.8);
    assert_true(ax_progress_report(part, "half", 0.0, 0));
    assert_near(seen, 0.4, 1e-15);
    assert_false(ax_progress_report(part, "half", 0.5, 0));
    assert_near(seen, 0.6, 1e-15);
    assert_true(ax_progress_report(NULL, "nobody", 1, 0));
    assert_null(ax_progress_within(&slot, NULL, 0, 1));
}

static void a_committed_file_replaces_the_old_one_whole(void** state)
{
    (void)state;
    char folder[] = "/tmp/auxshell-file-XXXXXX";
    assert_non_null(mkdtemp(folder));
    char path[64];
    snprintf(path, sizeof path, "%s/out.txt", folder);
    for (int round = 0; round < 2; ++round) {
        ax_file file;
        assert_int_equal(ax_file_begin(&file, path, NULL), AX_OK);
        fprintf(file.stream, "round %d", round);
        assert_int_equal(ax_file_commit(&file, NULL), AX_OK);
    }
    ax_file file;
    assert_int_equal(ax_file_begin(&file, path, NULL), AX_OK);
    fprintf(file.stream, "never");
    ax_file_abandon(&file);

    char text[32] = {0};
    FILE* stream = fopen(path, "r");
    assert_non_null(stream);
    assert_true(fread(text, 1, sizeof text - 1, stream) > 0);
    fclose(stream);
    assert_string_equal(text, "round 1");
    unlink(path);
    assert_int_equal(rmdir(folder), 0); // nothing else was left behind
}

static void a_full_disk_is_an_error_and_leaves_nothing(void** state)
{
    (void)state;
    ax_error error;
    ax_file file;
    assert_int_equal(ax_file_begin(&file, "/tmp", &error), AX_FAILED);
    assert_non_null(strstr(error.message, "folder"));
    assert_int_equal(ax_file_begin(&file, "/nowhere/at/all", &error), AX_FAILED);
    assert_non_null(strstr(error.message, "/nowhere/at/all"));
}

static void random_numbers_are_the_published_sequence(void** state)
{
    (void)state;
    ax_random random = {1234567};
    assert_true(ax_random_bits(&random) == 6457827717110365317u); // splitmix64 reference output for this seed
    for (int k = 0; k < 1000; ++k) {
        double x = ax_random_uniform(&random, -2, 3);
        assert_true(x >= -2 && x < 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(failure_carries_its_message),
        cmocka_unit_test(progress_parts_map_into_the_whole_and_cancel),
        cmocka_unit_test(a_committed_file_replaces_the_old_one_whole),
        cmocka_unit_test(a_full_disk_is_an_error_and_leaves_nothing),
        cmocka_unit_test(random_numbers_are_the_published_sequence),
    };
    return cmocka_run_group_tests_name("base", tests, NULL, NULL);
}
