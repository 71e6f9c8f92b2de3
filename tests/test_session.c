// Documents with history: nothing that was acknowledged is ever lost, and going back and forth leads to the same bits.
#include "ax/session.h"

#include "ax/document.h"
#include "base/random.h"
#include "document/schema.h"
#include "support/compare.h"
#include "support/sample.h"
#include "support/test.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static char folder[] = "/tmp/ax_session_XXXXXX";
static char path[64], other[64];
static uint64_t seed;

static void remove_files(void)
{
    DIR* entries = opendir(folder);
    for (struct dirent* entry; (entry = readdir(entries));) {
        char name[400];
        snprintf(name, sizeof name, "%s/%s", folder, entry->d_name);
        unlink(name);
    }
    closedir(entries);
}

static int set_up(void** state)
{
    (void)state;
    const char* given = getenv("AX_SEED");
    seed = given ? strtoull(given, NULL, 10) : (uint64_t)time(NULL);
    print_message("seed %llu (AX_SEED repeats it)\n", (unsigned long long)seed);
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/roof.auxshell", folder);
    snprintf(other, sizeof other, "%s/other.auxshell", folder);
    return 0;
}

static int tear_down(void** state)
{
    (void)state;
    remove_files();
    return rmdir(folder);
}

static int clean(void** state)
{
    (void)state;
    remove_files();
    return 0;
}

static void assert_ok(ax_status status, const ax_error* error)
{
    if (status != AX_OK)
        fail_msg("%d: %s", status, error->message);
}

static void assert_says(const ax_error* error, const char* words)
{
    if (!strstr(error->message, words))
        fail_msg("\"%s\" does not say \"%s\"", error->message, words);
}

#define CIRCLE(triangles) "{\"op\": \"start_circle\", \"radius\": 1, \"scale\": 1.4, \"triangles\": " #triangles "}"

static ax_recipe* recipe_of(int count, const char* const* operators)
{
    ax_recipe* recipe = ax_recipe_make();
    ax_error error;
    for (int k = 0; k < count; ++k)
        assert_ok(ax_recipe_insert(recipe, k, operators[k], &error), &error);
    return recipe;
}

static ax_session* create(const char* at, int count, const char* const* operators)
{
    ax_recipe* recipe = recipe_of(count, operators);
    ax_session* s;
    ax_error error;
    assert_ok(ax_session_create(at, &(ax_session_start){.recipe = recipe, .until = -1, .program = "a test"}, NULL, &s,
                                &error),
              &error);
    ax_recipe_free(recipe);
    return s;
}

static ax_session* open_session(const char* at)
{
    ax_session* s;
    ax_error error;
    assert_ok(ax_session_open(at, true, "a test", NULL, &s, &error), &error);
    assert_null(ax_session_read_only(s));
    return s;
}

static void apply(ax_session* s, const char* json)
{
    ax_error error;
    assert_ok(ax_session_apply(s, json, NULL, &error), &error);
}

static void undo(ax_session* s)
{
    ax_error error;
    assert_ok(ax_session_undo(s, NULL, &error), &error);
}

static void redo(ax_session* s)
{
    ax_error error;
    assert_ok(ax_session_redo(s, NULL, &error), &error);
}

static int present(const ax_session* s)
{
    int now;
    ax_session_history(s, NULL, &now);
    return now;
}

static int moments(const ax_session* s)
{
    return ax_session_history(s, NULL, NULL);
}

// What a moment is: all its steps, how many are applied, and every bit of the form.
typedef struct snapshot {
    char* recipe;
    int at;
    void* form;
    size_t size;
} snapshot;

static snapshot look(const ax_session* s)
{
    snapshot shot = {.recipe = ax_recipe_text(ax_session_recipe(s)), .at = ax_session_at(s)};
    if (ax_session_form(s))
        shot.form = ax_form_save(ax_session_form(s), &shot.size);
    return shot;
}

static void forget(snapshot* shot)
{
    ax_free(shot->recipe);
    ax_free(shot->form);
}

static void assert_same(const snapshot* a, const snapshot* b)
{
    assert_string_equal(a->recipe, b->recipe);
    assert_int_equal(a->at, b->at);
    assert_int_equal(a->size, b->size);
    if (a->size)
        assert_memory_equal(a->form, b->form, a->size);
}

static void assert_shows(const ax_session* s, const snapshot* expected)
{
    snapshot now = look(s);
    assert_same(expected, &now);
    forget(&now);
}

static sqlite3* open_database(const char* at)
{
    sqlite3* db;
    assert_int_equal(sqlite3_open(at, &db), SQLITE_OK);
    sqlite3_busy_timeout(db, 5000);
    return db;
}

static int ask_number(const char* at, const char* sql)
{
    sqlite3* db = open_database(at);
    sqlite3_stmt* row;
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &row, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    int value = sqlite3_column_int(row, 0);
    sqlite3_finalize(row);
    sqlite3_close(db);
    return value;
}

static void run_sql(const char* at, const char* sql)
{
    sqlite3* db = open_database(at);
    char* message = NULL;
    if (sqlite3_exec(db, sql, NULL, NULL, &message) != SQLITE_OK)
        fail_msg("%s: %s", sql, message);
    assert_int_equal(ax_schema_seal(db), SQLITE_OK);
    sqlite3_close(db);
}

static void assert_sound(const char* at)
{
    sqlite3* db = open_database(at);
    sqlite3_stmt* row;
    assert_int_equal(sqlite3_prepare_v2(db, "PRAGMA integrity_check", -1, &row, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    assert_string_equal((const char*)sqlite3_column_text(row, 0), "ok");
    sqlite3_finalize(row);
    sqlite3_close(db);
}

// ---- going back and forth ---------------------------------------------------------------------------------------------------

static void history_survives_closing(void** state)
{
    (void)state;
    ax_session* s = create(path, 2, (const char*[]){CIRCLE(40), "{\"op\": \"fill\", \"value\": 1.5}"});
    assert_int_equal(moments(s), 2);
    apply(s, "{\"op\": \"rim_fixed\"}");
    apply(s, "{\"op\": \"gravity\"}");
    snapshot last = look(s);
    undo(s);
    snapshot before = look(s);
    undo(s);
    assert_int_equal(ax_session_at(s), 2);
    ax_session_close(s);

    s = open_session(path);
    assert_int_equal(moments(s), 4);
    assert_int_equal(present(s), 1);
    redo(s);
    assert_shows(s, &before);
    ax_session_close(s);
    s = open_session(path);
    redo(s);
    assert_shows(s, &last);
    ax_error error = {0};
    assert_int_equal(ax_session_redo(s, NULL, &error), AX_USAGE);
    assert_says(&error, "nothing to redo");
    for (int k = 0; k < 3; ++k)
        undo(s);
    assert_int_equal(ax_session_undo(s, NULL, &error), AX_USAGE);
    const ax_moment* list;
    int now, count = ax_session_history(s, &list, &now);
    assert_int_equal(count, 4);
    assert_int_equal(now, 0);
    assert_non_null(strstr(list[1].words, "1.5"));
    assert_int_equal(list[2].steps, 3);
    assert_true(fabs(list[3].time - (double)time(NULL)) < 100);
    forget(&last);
    forget(&before);
    ax_session_close(s);
}

static void a_new_change_drops_what_was_undone(void** state)
{
    (void)state;
    ax_session* s = create(path, 1, (const char*[]){CIRCLE(40)});
    apply(s, "{\"op\": \"fill\", \"value\": 1.5}");
    apply(s, "{\"op\": \"fill\", \"value\": 1.6}");
    undo(s);
    undo(s);
    apply(s, "{\"op\": \"fill\", \"value\": 1.3}");
    assert_int_equal(moments(s), 2);
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), 2);
    ax_session_close(s);
    assert_int_equal(ask_number(path, "SELECT count(*) FROM step"), 2); // nothing is left of them
    assert_int_equal(ask_number(path, "SELECT count(*) FROM checkpoint WHERE step NOT IN (SELECT id FROM step)"), 0);
}

static int reports;
static bool count_reports(void* context, const char* stage, double fraction, double residual)
{
    (void)context, (void)stage, (void)fraction, (void)residual;
    ++reports;
    return true;
}

static void undo_and_reopening_compute_nothing(void** state)
{
    (void)state;
    const ax_progress progress = {count_reports, NULL};
    ax_session* s = create(path, 3, (const char*[]){CIRCLE(60), "{\"op\": \"rim_fixed\"}", "{\"op\": \"gravity\"}"});
    ax_error error;
    reports = 0;
    assert_ok(ax_session_apply(s, "{\"op\": \"fill\", \"value\": 1.5}", &progress, &error), &error);
    assert_true(reports > 0); // settling reports
    reports = 0;
    assert_ok(ax_session_undo(s, &progress, &error), &error);
    assert_ok(ax_session_redo(s, &progress, &error), &error);
    assert_ok(ax_session_undo(s, &progress, &error), &error);
    assert_ok(ax_session_apply(s, "{\"op\": \"fill\", \"value\": 1.5}", &progress, &error), &error); // is known
    ax_session_close(s);
    assert_ok(ax_session_open(path, true, NULL, &progress, &s, &error), &error);
    assert_int_equal(reports, 0);
    ax_session_close(s);
}

// One operator at random, with values that it takes. Some fail all the same: no such hinges, no room.
static void random_operator(ax_random* random, char json[400])
{
    double u = ax_random_uniform(random, 0, 1), x = ax_random_uniform(random, -0.8, 0.8),
           y = ax_random_uniform(random, -0.8, 0.8);
    double scale = ax_random_uniform(random, 1.1, 1.8);
    switch (ax_random_bits(random) % 18) {
    case 0:
    case 1:
    case 2:
        sprintf(json,
                "{\"op\": \"paint\", \"value\": %.3f, \"radius\": %.3f, \"points\": [[%.3f, %.3f], [%.3f, %.3f]]}",
                scale, 0.2 + 0.4 * u, x, y, y, u);
        return;
    case 3:
        sprintf(json, "{\"op\": \"fill\", \"value\": %.3f}", scale);
        return;
    case 4:
        sprintf(json, "{\"op\": \"smooth\", \"amount\": %.3f}", 0.05 + 0.2 * u);
        return;
    case 5:
        sprintf(json, "{\"op\": \"clamp\", \"lo\": %.3f, \"hi\": %.3f}", 1 + 0.3 * u, 1.5 + 0.3 * u);
        return;
    case 6:
        sprintf(json, "{\"op\": \"formula\", \"formula\": \"%.3f + 0.3*exp(-(x^2+y^2)/%.3f)\"}", 1.1 + 0.3 * u,
                0.2 + u);
        return;
    case 7:
        sprintf(json, "{\"op\": \"rim_fixed\"}");
        return;
    case 8:
        sprintf(json, "{\"op\": \"rim_circle\", \"radius\": %.3f}", 0.9 + 0.3 * u);
        return;
    case 9:
        sprintf(json, "{\"op\": \"rim_free\"}");
        return;
    case 10:
        sprintf(json, "{\"op\": \"gravity\", \"density\": %.1f}", 1 + 5 * u);
        return;
    case 11:
        sprintf(json, "{\"op\": \"inflation\", \"pressure\": %.1f}", 10 + 100 * u);
        return;
    case 12:
        sprintf(json, "{\"op\": \"expand\"}");
        return;
    case 13:
        sprintf(json, "{\"op\": \"rest\"}");
        return;
    case 14:
        sprintf(json, "{\"op\": \"select\", \"name\": \"s%d\", \"hinges\": \"%d-%d\"}", (int)(3 * u), (int)(9 * u),
                (int)(30 * u + 10));
        return;
    case 15:
        sprintf(json, "{\"op\": \"hold_plane\", \"name\": \"p%d\", \"hinges\": \"%d-%d\"}", (int)(2 * u), (int)(20 * u),
                (int)(20 * u + 9));
        return;
    case 16:
        sprintf(json, "{\"op\": \"settle\", \"steps\": %d}", 1 + (int)(20 * u));
        return;
    default:
        sprintf(json, "{\"op\": \"restart\", \"height\": %.3f}", 0.05 + 0.2 * u);
    }
}

static void random_recipes_go_back_and_forth_with_the_same_bits(void** state)
{
    (void)state;
    int rounds = getenv("AX_QUICK") ? 1 : 2, operators = getenv("AX_QUICK") ? 30 : 100;
    ax_random random = {seed};
    for (int round = 0; round < rounds; ++round) {
        char start[200];
        int triangles = 60 + (int)(ax_random_bits(&random) % (round ? 140 : 40)); // fewer may leave no disc
        sprintf(start, "{\"op\": \"start_circle\", \"radius\": 1, \"scale\": 1.4, \"triangles\": %d}", triangles);
        ax_session* s = create(path, 1, (const char*[]){start});
        snapshot* shots = calloc((size_t)operators + 1, sizeof *shots);
        shots[0] = look(s);
        int refused = 0;
        for (int k = 1; k <= operators;) {
            char json[400];
            ax_error error = {0};
            random_operator(&random, json);
            ax_status status = ax_session_apply(s, json, NULL, &error);
            if (status == AX_OK) {
                shots[k++] = look(s);
                assert_int_equal(present(s), k - 1);
                continue;
            }
            assert_shows(s, &shots[k - 1]); // a refusal changes nothing
            if (++refused > 10 * operators)
                fail_msg("%s: %s", json, error.message);
        }
        print_message("%d triangles, %d operators, %d refused\n", triangles, operators, refused);
        for (int k = operators - 1; k >= 0; --k) {
            undo(s);
            assert_shows(s, &shots[k]);
            if (ax_random_bits(&random) % 16 == 0) {
                ax_session_close(s);
                s = open_session(path);
                assert_shows(s, &shots[k]);
            }
        }
        for (int k = 1; k <= operators; ++k) {
            redo(s);
            assert_shows(s, &shots[k]);
        }
        for (int k = 0; k < 5; ++k) {
            ax_error error;
            int moment = (int)(ax_random_bits(&random) % (unsigned)operators);
            assert_ok(ax_session_jump(s, moment, NULL, &error), &error);
            assert_shows(s, &shots[moment]);
        }
        ax_session_close(s);
        assert_in_range(ask_number(path, "SELECT count(*) FROM checkpoint"), 1, 64);
        // and the recipe alone leads there too
        s = open_session(path);
        ax_error error;
        assert_ok(ax_session_jump(s, operators, NULL, &error), &error);
        ax_form* form;
        int done;
        assert_ok(ax_recipe_play(ax_session_recipe(s), -1, folder, NULL, NULL, NULL, &form, &done, &error), &error);
        size_t size;
        void* bytes = ax_form_save(form, &size);
        assert_int_equal(size, shots[operators].size);
        assert_memory_equal(bytes, shots[operators].form, size);
        ax_free(bytes);
        ax_form_free(form);
        ax_session_close(s);
        for (int k = 0; k <= operators; ++k)
            forget(&shots[k]);
        free(shots);
        remove_files();
    }
}

// ---- editing what came before -----------------------------------------------------------------------------------------------

static void an_edited_step_gives_what_a_new_recipe_gives(void** state)
{
    (void)state;
    const char* steps[] = {CIRCLE(60), "{\"op\": \"rim_fixed\"}", "{\"op\": \"fill\", \"value\": 1.3}",
                           "{\"op\": \"gravity\"}", "{\"op\": \"smooth\", \"amount\": 0.2}"};
    ax_session* s = create(path, 5, steps);
    snapshot original = look(s);
    ax_error error;
    assert_ok(ax_session_edit(s, 2, "{\"op\": \"fill\", \"value\": 1.6}", NULL, &error), &error);
    assert_int_equal(ax_session_at(s), 5);
    snapshot edited = look(s);
    undo(s);
    assert_shows(s, &original);
    redo(s);
    assert_shows(s, &edited);
    assert_ok(ax_session_edit(s, 2, NULL, NULL, &error), &error); // removed
    assert_int_equal(ax_session_at(s), 4);
    snapshot removed = look(s);
    reports = 0;
    ax_recipe* before = recipe_of(5, steps);
    assert_ok(ax_session_replace(s, before, &(ax_progress){count_reports, NULL}, &error), &error);
    ax_recipe_free(before);
    assert_int_equal(reports, 0); // all of its states are known
    assert_shows(s, &original);
    ax_session_close(s);

    const char* new_steps[5];
    memcpy(new_steps, steps, sizeof steps);
    new_steps[2] = "{\"op\": \"fill\", \"value\": 1.6}";
    s = create(other, 5, new_steps);
    assert_shows(s, &edited);
    ax_session_close(s);
    new_steps[2] = steps[3], new_steps[3] = steps[4];
    s = create(other, 4, new_steps);
    assert_shows(s, &removed);
    assert_int_equal(ax_session_edit(s, 4, steps[1], NULL, &error), AX_USAGE);
    assert_int_equal(ax_session_edit(s, 0, NULL, NULL, &error), AX_USAGE);
    assert_says(&error, "first step starts");
    assert_int_equal(ax_session_edit(s, 1, "{\"op\": \"fill\"}", NULL, &error), AX_BAD_INPUT);
    assert_shows(s, &removed);
    ax_session_close(s);
    forget(&original);
    forget(&edited);
    forget(&removed);
}

static void steps_stay_ahead_after_going_back(void** state)
{
    (void)state;
    ax_session* s = create(path, 4,
                           (const char*[]){CIRCLE(40), "{\"op\": \"fill\", \"value\": 1.3}",
                                           "{\"op\": \"fill\", \"value\": 1.4}", "{\"op\": \"fill\", \"value\": 1.5}"});
    snapshot all = look(s);
    ax_error error;
    assert_ok(ax_session_go(s, 2, NULL, &error), &error);
    assert_int_equal(ax_session_at(s), 2);
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), 4);
    ax_session_close(s);
    s = open_session(path);
    assert_int_equal(ax_session_at(s), 2);
    assert_ok(ax_session_go(s, 4, NULL, &error), &error);
    assert_shows(s, &all);
    assert_int_equal(moments(s), 6);
    assert_int_equal(ax_session_go(s, 5, NULL, &error), AX_USAGE);
    assert_int_equal(ax_session_go(s, 0, NULL, &error), AX_USAGE);
    undo(s);
    assert_int_equal(ax_session_at(s), 2);
    apply(s, "{\"op\": \"fill\", \"value\": 1.7}"); // drops those ahead
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), 3);
    forget(&all);
    ax_session_close(s);
}

static void a_step_that_fails_later_is_named_and_can_be_mended(void** state)
{
    (void)state;
    // the selection goes, so that what needs it fails
    ax_session* s = create(path, 4,
                           (const char*[]){CIRCLE(60), "{\"op\": \"select\", \"name\": \"arch\", \"hinges\": \"0-9\"}",
                                           "{\"op\": \"hold_plane\", \"name\": \"p\", \"hinges\": \"#arch\"}",
                                           "{\"op\": \"fill\", \"value\": 1.5}"});
    snapshot good = look(s);
    const char* why;
    ax_error error;
    assert_int_equal(ax_session_failed(s, &why), -1);
    assert_null(why);
    assert_ok(ax_session_edit(s, 1, "{\"op\": \"select\", \"name\": \"other\", \"hinges\": \"0-9\"}", NULL, &error),
              &error);
    assert_int_equal(ax_session_at(s), 2);
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), 4);
    assert_int_equal(ax_session_failed(s, &why), 2);
    assert_non_null(strstr(why, "arch"));
    ax_session_close(s);
    s = open_session(path);
    assert_int_equal(ax_session_failed(s, &why), 2);
    assert_ok(ax_session_edit(s, 1, "{\"op\": \"select\", \"name\": \"arch\", \"hinges\": \"0-9\"}", NULL, &error),
              &error);
    assert_int_equal(ax_session_failed(s, &why), -1);
    assert_shows(s, &good);
    // the edited step itself may not fail
    assert_int_equal(
        ax_session_edit(s, 2, "{\"op\": \"hold_plane\", \"name\": \"p\", \"hinges\": \"#nowhere\"}", NULL, &error),
        AX_BAD_INPUT);
    assert_shows(s, &good);
    forget(&good);
    ax_session_close(s);
}

static bool cancel(void* context, const char* stage, double fraction, double residual)
{
    (void)stage, (void)fraction, (void)residual;
    return --*(int*)context > 0;
}

static void cancelling_changes_nothing(void** state)
{
    (void)state;
    ax_session* s = create(path, 3, (const char*[]){CIRCLE(60), "{\"op\": \"rim_fixed\"}", "{\"op\": \"gravity\"}"});
    snapshot before = look(s);
    for (int after = 1; after < 4; ++after) {
        int left = after;
        ax_error error;
        assert_int_equal(
            ax_session_apply(s, "{\"op\": \"fill\", \"value\": 1.7}", &(ax_progress){cancel, &left}, &error),
            AX_CANCELLED);
        assert_shows(s, &before);
        left = after;
        assert_int_equal(ax_session_edit(s, 0, CIRCLE(80), &(ax_progress){cancel, &left}, &error), AX_CANCELLED);
        assert_shows(s, &before);
    }
    assert_int_equal(moments(s), 3);
    ax_session_close(s);
    s = open_session(path);
    assert_shows(s, &before);
    forget(&before);
    ax_session_close(s);
    ax_recipe* recipe = recipe_of(2, (const char*[]){CIRCLE(60), "{\"op\": \"settle\"}"});
    int left = 1;
    ax_error error;
    assert_int_equal(ax_session_create(other,
                                       &(ax_session_start){.recipe = recipe, .until = -1, .keep = AX_KEEP_BEFORE_ANY},
                                       &(ax_progress){cancel, &left}, &s, &error),
                     AX_CANCELLED);
    assert_null(s);
    assert_int_equal(access(other, F_OK), -1);
    ax_recipe_free(recipe);
}

static void a_recipe_that_fails_makes_nothing_or_what_came_before(void** state)
{
    (void)state;
    ax_recipe* recipe = recipe_of(4, (const char*[]){CIRCLE(40), "{\"op\": \"fill\", \"value\": 1.5}",
                                                     "{\"op\": \"fill\", \"value\": 1.6, \"hinges\": \"#nowhere\"}",
                                                     "{\"op\": \"rim_fixed\"}"});
    ax_session* s;
    ax_error error;
    ax_session_start start = {.recipe = recipe, .until = -1};
    assert_int_equal(ax_session_create(path, &start, NULL, &s, &error), AX_BAD_INPUT);
    assert_says(&error, "nowhere");
    assert_int_equal(access(path, F_OK), -1);
    start.keep = AX_KEEP_BEFORE_UNREALISABLE; // it could exist, were its words right
    assert_int_equal(ax_session_create(path, &start, NULL, &s, &error), AX_BAD_INPUT);
    start.keep = AX_KEEP_BEFORE_ANY;
    assert_ok(ax_session_create(path, &start, NULL, &s, &error), &error);
    assert_int_equal(ax_session_at(s), 2);
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), 4);
    assert_int_equal(ax_session_failed(s, NULL), 2);
    ax_session_close(s);
    start.keep = AX_KEEP_NOTHING, start.until = 2;
    assert_ok(ax_session_create(path, &start, NULL, &s, &error), &error);
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), 2);
    assert_int_equal(ax_session_failed(s, NULL), -1);
    ax_session_close(s);
    ax_recipe_free(recipe);
}

static void an_empty_document_takes_a_start(void** state)
{
    (void)state;
    ax_session* s;
    ax_error error;
    assert_ok(ax_session_create(path, &(ax_session_start){0}, NULL, &s, &error), &error);
    assert_null(ax_session_form(s));
    assert_int_equal(moments(s), 1);
    assert_int_equal(ax_session_apply(s, "{\"op\": \"fill\", \"value\": 1.5}", NULL, &error), AX_BAD_INPUT);
    apply(s, CIRCLE(40));
    assert_non_null(ax_session_form(s));
    undo(s);
    assert_null(ax_session_form(s));
    ax_session_close(s);
    s = open_session(path);
    assert_null(ax_session_form(s));
    ax_design design;
    assert_int_equal(ax_document_load(path, &design, &error), AX_BAD_INPUT);
    assert_says(&error, "is empty");
    redo(s);
    assert_non_null(ax_session_form(s));
    ax_session_close(s);
}

// ---- accidents --------------------------------------------------------------------------------------------------------------

// The n-th change of the script: fills with a value that tells its number, now and then an undo or a redo.
static ax_status scripted_change(ax_session* s, int n, ax_error* error)
{
    char json[80];
    if (n % 7 == 5)
        return ax_session_undo(s, NULL, error);
    if (n % 7 == 6)
        return ax_session_redo(s, NULL, error);
    sprintf(json, "{\"op\": \"fill\", \"value\": %.6f}", 1.1 + 1e-6 * n);
    return ax_session_apply(s, json, NULL, error);
}

// True if the document is as the script leaves it after `done` changes.
static bool is_after(const ax_session* s, int done)
{
    int fills = done / 7 * 5 + (done % 7 < 5 ? done % 7 : 5), now, steps = ax_recipe_count(ax_session_recipe(s));
    int count = ax_session_history(s, NULL, &now), shown = fills - (done % 7 == 6);
    if (count != fills + 1 || now != shown || steps != shown + 1 || ax_session_at(s) != steps)
        return false;
    for (int k = 0, n = 0; k < shown; ++k, ++n) {
        n += n % 7 == 5 ? 2 : 0;
        const char* value = strstr(ax_recipe_operator(ax_session_recipe(s), k + 1), "value");
        if (!value || !(fabs(strtod(value + strcspn(value, "0123456789"), NULL) - (1.1 + 1e-6 * n)) < 1e-9))
            return false;
    }
    return true;
}

static void edit_until_killed(int next, int pipe)
{
    ax_session* s;
    ax_error error;
    if (ax_session_open(path, true, "a test", NULL, &s, &error) != AX_OK || ax_session_read_only(s))
        _exit(1);
    for (int n = next;; ++n) {
        if (write(pipe, &n, sizeof n) != sizeof n) // acknowledges the one before
            _exit(2);
        if (scripted_change(s, n, &error) != AX_OK)
            _exit(3);
    }
}

static void nothing_acknowledged_is_lost_when_killed(void** state)
{
    (void)state;
    int rounds = getenv("AX_QUICK") ? 20 : 200, done = 0, unacknowledged = 0;
    ax_session_close(create(path, 1, (const char*[]){CIRCLE(24)}));
    ax_random random = {seed};
    for (int round = 0; round < rounds; ++round) {
        int ends[2], n, ended;
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        if (child == 0) {
            close(ends[0]);
            edit_until_killed(done, ends[1]);
        }
        close(ends[1]);
        // half of the times while it opens the document, else in the midst of its changes
        if (round % 2 && read(ends[0], &n, sizeof n) == sizeof n)
            assert_int_equal(n, done);
        usleep((useconds_t)ax_random_uniform(&random, 0, 100000));
        assert_int_equal(waitpid(child, &ended, WNOHANG), 0); // still at work
        kill(child, SIGKILL);
        waitpid(child, &ended, 0);
        while (read(ends[0], &n, sizeof n) == sizeof n) {
            assert_in_range(n, done, done + 1);
            done = n;
        }
        close(ends[0]);

        ax_session* s = open_session(path); // the lock went with its process
        bool further = is_after(s, done + 1);
        if (!further && !is_after(s, done))
            fail_msg("round %d: the document is not what %d changes make it", round, done);
        unacknowledged += further;
        done += further;
        ax_session_close(s);
        assert_sound(path);
    }
    print_message("%d changes, %d of them written when they were not acknowledged yet\n", done, unacknowledged);
    assert_true(done > rounds / 8);
}

static void a_full_disk_leaves_the_document(void** state)
{
    (void)state;
    ax_session_close(
        create(path, 3, (const char*[]){CIRCLE(60), "{\"op\": \"rim_fixed\"}", "{\"op\": \"fill\", \"value\": 1.5}"}));
    struct stat info;
    stat(path, &info);
    for (int share = 0; share < 8; ++share) {
        fflush(NULL);
        pid_t child = fork();
        if (child == 0) {
            signal(SIGXFSZ, SIG_IGN);
            ax_session* s;
            ax_error error = {0};
            if (ax_session_open(path, true, NULL, NULL, &s, &error) != AX_OK)
                _exit(1);
            snapshot before = look(s), after;
            rlim_t room = (rlim_t)info.st_size * (rlim_t)share / 8 + 1;
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){room, RLIM_INFINITY});
            int failures = 0;
            for (int k = 0; k < 20 && !failures; ++k) { // until there is no more room
                char json[80];
                sprintf(json, "{\"op\": \"fill\", \"value\": %.3f}", 1.2 + 0.01 * k + 0.001 * share);
                forget(&before);
                before = look(s);
                failures += ax_session_apply(s, json, NULL, &error) == AX_FAILED;
            }
            after = look(s);
            bool same =
                before.at == after.at && before.size == after.size && memcmp(before.form, after.form, after.size) == 0;
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){RLIM_INFINITY, RLIM_INFINITY});
            bool goes_on = ax_session_apply(s, "{\"op\": \"fill\", \"value\": 1.9}", NULL, NULL) == AX_OK;
            ax_session_close(s);
            _exit(!failures ? 2 : !same ? 3 : !goes_on ? 4 : strstr(error.message, "Nothing was changed") ? 0 : 5);
        }
        int ended;
        waitpid(child, &ended, 0);
        assert_int_equal(WEXITSTATUS(ended), 0);
        assert_sound(path);
        ax_session* s = open_session(path);
        assert_non_null(strstr(ax_recipe_operator(ax_session_recipe(s), ax_session_at(s) - 1), "1.9"));
        ax_session_close(s);
    }
}

static void a_damaged_checkpoint_is_computed_again(void** state)
{
    (void)state;
    ax_session* s = create(path, 4,
                           (const char*[]){CIRCLE(60), "{\"op\": \"rim_fixed\"}", "{\"op\": \"gravity\"}",
                                           "{\"op\": \"fill\", \"value\": 1.5}"});
    snapshot good = look(s);
    ax_session_close(s);
    static const char* const damages[] = {
        "UPDATE checkpoint SET form = substr(form, 1, length(form) / 2) || x'00' || substr(form, length(form) / 2 + 2)",
        "UPDATE checkpoint SET form = substr(form, 1, length(form) - 9)",
        "UPDATE checkpoint SET form = zeroblob(0)",
        "UPDATE checkpoint SET form = 'text' WHERE step > 1",
        "DELETE FROM checkpoint WHERE step = 4; UPDATE checkpoint SET step = 4 WHERE step = 3", // another's
        "DELETE FROM checkpoint",
    };
    for (size_t k = 0; k < sizeof damages / sizeof *damages; ++k) {
        run_sql(path, damages[k]);
        s = open_session(path);
        assert_shows(s, &good);
        ax_session_close(s);
        const ax_progress progress = {count_reports, NULL};
        ax_error error;
        reports = 0; // it was kept
        assert_ok(ax_session_open(path, true, NULL, &progress, &s, &error), &error);
        assert_int_equal(reports, 0);
        assert_shows(s, &good);
        ax_session_close(s);
    }
    forget(&good);
}

static void a_contradictory_history_is_refused(void** state)
{
    (void)state;
    static const char* const damages[] = {
        "UPDATE session SET now = 7",
        "UPDATE session SET now = -1",
        "DELETE FROM session",
        "UPDATE moment SET tip = 99",
        "UPDATE moment SET steps = 1000000000",
        "UPDATE moment SET at = 3",
        "UPDATE moment SET state = 1",
        "UPDATE moment SET number = 7 WHERE number = 0",
        "UPDATE step SET parent = id",
        "UPDATE step SET parent = 77 WHERE id = 1",
        "UPDATE step SET operator = '{\"op\": \"wish\"}'",
        "UPDATE step SET operator = 7",
        "UPDATE step SET operator = x'00'",
    };
    for (size_t k = 0; k < sizeof damages / sizeof *damages; ++k) {
        ax_session_close(create(path, 2, (const char*[]){CIRCLE(24), "{\"op\": \"fill\", \"value\": 1.5}"}));
        run_sql(path, damages[k]);
        ax_session* s;
        ax_error error = {0};
        if (ax_session_open(path, true, NULL, NULL, &s, &error) != AX_BAD_INPUT)
            fail_msg("accepted: %s", damages[k]);
        assert_null(s);
        assert_says(&error, path);
    }
    ax_session_close(create(path, 1, (const char*[]){CIRCLE(24)}));
    sqlite3* db = open_database(path); // not sealed again
    assert_int_equal(sqlite3_exec(db, "UPDATE moment SET words = 'x'", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    ax_session* s;
    ax_error error = {0};
    assert_int_equal(ax_session_open(path, true, NULL, NULL, &s, &error), AX_BAD_INPUT);
    assert_says(&error, "not what was saved");
}

static void flipped_bytes_are_found_or_harmless(void** state)
{
    (void)state;
    ax_session* s =
        create(path, 3, (const char*[]){CIRCLE(24), "{\"op\": \"rim_fixed\"}", "{\"op\": \"fill\", \"value\": 1.5}"});
    snapshot good = look(s);
    ax_session_close(s);
    FILE* in = fopen(path, "rb");
    fseek(in, 0, SEEK_END);
    size_t size = (size_t)ftell(in);
    rewind(in);
    unsigned char* bytes = malloc(size);
    assert_int_equal(fread(bytes, 1, size, in), size);
    fclose(in);
    ax_random random = {seed};
    int refused = 0, rounds = getenv("AX_QUICK") ? 50 : 300;
    for (int round = 0; round < rounds; ++round) {
        unsigned char was[8];
        size_t place[8], count = 1 + ax_random_bits(&random) % 8;
        for (size_t k = 0; k < count; ++k) { // most pages hold checkpoints; the tables' roots come first
            place[k] = ax_random_bits(&random) % (round % 2 ? size : 65536);
            was[k] = bytes[place[k]];
            bytes[place[k]] ^= (unsigned char)(1 + ax_random_bits(&random) % 255);
        }
        FILE* out = fopen(other, "wb");
        assert_int_equal(fwrite(bytes, 1, size, out), size);
        fclose(out);
        for (size_t k = count; k-- > 0;)
            bytes[place[k]] = was[k];
        ax_error error = {0};
        if (ax_session_open(other, false, NULL, NULL, &s, &error) == AX_OK) {
            assert_shows(s, &good);
            ax_session_close(s);
        } else {
            assert_says(&error, other);
            ++refused;
        }
    }
    assert_in_range(refused, 1, rounds - 1);
    free(bytes);
    forget(&good);
}

// ---- several programs -------------------------------------------------------------------------------------------------------

static void a_second_program_is_told_and_may_only_read(void** state)
{
    (void)state;
    ax_session* first = create(path, 2, (const char*[]){CIRCLE(40), "{\"op\": \"fill\", \"value\": 1.5}"});
    snapshot shown = look(first);
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        ax_session* s;
        ax_error error = {0};
        char process[40];
        sprintf(process, "process %d", (int)getppid());
        if (ax_session_open(path, true, "the second", NULL, &s, &error) != AX_OK)
            _exit(1);
        const char* why = ax_session_read_only(s);
        if (!why || !strstr(why, "a test") || !strstr(why, process))
            _exit(2);
        if (ax_session_apply(s, "{\"op\": \"rim_fixed\"}", NULL, &error) != AX_FAILED ||
            !strstr(error.message, "a test"))
            _exit(3);
        if (ax_session_undo(s, NULL, &error) != AX_FAILED)
            _exit(4);
        snapshot seen = look(s);
        bool same = seen.size == shown.size && memcmp(seen.form, shown.form, seen.size) == 0;
        ax_session_close(s);
        _exit(same ? 0 : 5);
    }
    int ended;
    waitpid(child, &ended, 0);
    assert_int_equal(WEXITSTATUS(ended), 0);

    // the same within one program, and by another name of the file
    ax_session* second;
    ax_error error = {0};
    char link[128];
    snprintf(link, sizeof link, "%s/link.auxshell", folder);
    assert_int_equal(symlink(path, link), 0);
    assert_ok(ax_session_open(link, true, NULL, NULL, &second, &error), &error);
    assert_non_null(ax_session_read_only(second));
    apply(first, "{\"op\": \"rim_fixed\"}"); // reading does not hinder
    assert_shows(second, &shown);
    ax_session_close(second);

    ax_design design = sample_design();
    assert_int_equal(ax_document_save(path, &design, &error), AX_FAILED); // nor may it be replaced
    assert_says(&error, "is open in a test");
    ax_design_free(&design);
    ax_session_close(first);
    second = open_session(path);
    assert_int_equal(moments(second), 3);
    ax_session_close(second);
    forget(&shown);
}

static void one_of_many_gets_the_lock(void** state)
{
    (void)state;
    ax_session_close(create(path, 1, (const char*[]){CIRCLE(24)}));
    enum { programs = 8 };
    pid_t children[programs];
    int ends[2], done[2], ended, edits = 0;
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(pipe(done), 0);
    for (int k = 0; k < programs; ++k)
        if ((children[k] = fork()) == 0) {
            char go;
            close(ends[1]);
            if (read(ends[0], &go, 1) != 0) // all at once, when the other end is closed
                _exit(2);
            for (int round = 0; round < 30; ++round) {
                ax_session* s;
                char json[80];
                ax_error error;
                sprintf(json, "{\"op\": \"fill\", \"value\": %.4f}", 1.1 + 0.01 * k + 1e-4 * round);
                if (ax_session_open(path, true, NULL, NULL, &s, &error) != AX_OK)
                    _exit(3);
                if (!ax_session_read_only(s) &&
                    (ax_session_apply(s, json, NULL, &error) != AX_OK || write(done[1], json, 1) != 1))
                    _exit(4);
                ax_session_close(s);
            }
            _exit(0);
        }
    close(ends[0]);
    close(ends[1]);
    close(done[1]);
    for (char c; read(done[0], &c, 1) == 1;)
        ++edits;
    close(done[0]);
    for (int k = 0; k < programs; ++k) {
        waitpid(children[k], &ended, 0);
        assert_int_equal(WEXITSTATUS(ended), 0);
    }
    assert_sound(path);
    ax_session* s = open_session(path);
    assert_int_equal(moments(s), edits + 1); // none overwrote another's
    assert_int_equal(ax_recipe_count(ax_session_recipe(s)), edits + 1);
    print_message("%d of %d attempts got the lock\n", edits, 30 * programs);
    assert_true(edits >= programs);
    ax_session_close(s);
    char lock[128];
    snprintf(lock, sizeof lock, "%s/.roof.auxshell.lock", folder);
    assert_int_equal(access(lock, F_OK), -1);
}

// ---- designs ----------------------------------------------------------------------------------------------------------------

static void copy_file(const char* from, const char* to)
{
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    for (int c; (c = getc(in)) != EOF;)
        putc(c, out);
    fclose(in);
    assert_int_equal(fclose(out), 0);
}

static void a_document_of_version_1_is_upgraded_by_its_first_change(void** state)
{
    (void)state;
    copy_file(AX_SOURCE_DIR "/tests/documents/version-1.auxshell", path);
    ax_design was;
    ax_error error;
    assert_ok(ax_document_load(path, &was, &error), &error);
    ax_session* s = open_session(path);
    assert_true(ax_session_from_design(s));
    assert_int_equal(moments(s), 1);
    assert_int_equal(ask_number(path, "PRAGMA user_version"), 1);
    const ax_design* design;
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_same_design(design, &was);
    snapshot beginning = look(s);
    apply(s, "{\"op\": \"fill\", \"value\": 1.4}");
    assert_int_equal(ask_number(path, "PRAGMA user_version"), ax_document_schema.version);
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_null(design);
    ax_session_close(s);
    ax_design now;
    assert_ok(ax_document_load(path, &now, &error), &error); // as it stands
    assert_int_equal(now.linkage.triangle_count, was.linkage.triangle_count);
    assert_null(now.simulated);
    ax_design_free(&now);
    assert_sound(path);
    s = open_session(path);
    undo(s);
    assert_shows(s, &beginning);
    assert_int_equal(ax_session_apply(s, CIRCLE(40), NULL, &error), AX_BAD_INPUT); // it has begun already
    ax_session_close(s);
    assert_ok(ax_document_load(path, &now, &error), &error);
    assert_same_design(&now, &was);
    ax_design_free(&now);
    ax_design_free(&was);
    forget(&beginning);
}

static void write_table(const char* text)
{
    char name[80];
    snprintf(name, sizeof name, "%s/scale.csv", folder);
    FILE* out = fopen(name, "w");
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void remove_table(void)
{
    char name[80];
    snprintf(name, sizeof name, "%s/scale.csv", folder);
    assert_int_equal(unlink(name), 0);
}

// The file was written by the program when documents had version 2: with a history, without what its files held, and with forms stored in a
// format that is not read any more.
static void a_document_of_version_2_is_upgraded_by_its_first_change(void** state)
{
    (void)state;
    copy_file(AX_SOURCE_DIR "/tests/documents/version-2.auxshell", path);
    write_table("x,y,lambda\n-1,0,1.2\n1,0,1.4\n0,1,1.3\n0,-1,1.3\n");
    ax_session* s = open_session(path);
    assert_int_equal(ax_session_at(s), 4);
    assert_int_equal(ask_number(path, "PRAGMA user_version"), 2);
    apply(s, "{\"op\": \"fill\", \"value\": 1.3}");
    assert_int_equal(ask_number(path, "PRAGMA user_version"), ax_document_schema.version);
    ax_session_close(s);
    assert_sound(path);
}

// The file was written by the program when documents had version 3: without variants.
static void a_document_of_version_3_is_upgraded_by_its_first_variant(void** state)
{
    (void)state;
    copy_file(AX_SOURCE_DIR "/tests/documents/version-3.auxshell", path);
    ax_session* s = open_session(path);
    ax_error error;
    const ax_variant* variants;
    assert_int_equal(ax_session_variants(s, &variants), 0);
    assert_int_equal(ask_number(path, "PRAGMA user_version"), 3);
    snapshot was = look(s);
    assert_ok(ax_session_keep_variant(s, "first", "{}", &error), &error);
    assert_int_equal(ask_number(path, "PRAGMA user_version"), ax_document_schema.version);
    ax_session_close(s);
    assert_sound(path);
    s = open_session(path);
    assert_shows(s, &was);
    assert_int_equal(ax_session_variants(s, &variants), 1);
    assert_true(variants->present);
    ax_session_close(s);
    forget(&was);
}

static void assert_variant(ax_session* s, const char* name, const snapshot* expected)
{
    ax_error error;
    ax_form* form;
    size_t size;
    assert_ok(ax_session_variant_form(s, name, NULL, &form, &error), &error);
    void* bytes = ax_form_save(form, &size);
    assert_int_equal(size, expected->size);
    assert_memory_equal(bytes, expected->form, size);
    ax_free(bytes);
    ax_form_free(form);
}

// Where no moment leads any more, after the document was closed, copied, and had its checkpoints lost.
static void variants_outlive_the_history_that_led_to_them(void** state)
{
    (void)state;
    const ax_variant* variants;
    ax_error error;
    ax_session* s = create(path, 2, (const char*[]){CIRCLE(40), "{\"op\": \"fill\", \"value\": 1.5}"});
    snapshot low = look(s);
    assert_ok(ax_session_keep_variant(s, "low", "{\"panels\": 40}", &error), &error);
    apply(s, "{\"op\": \"rim_fixed\"}");
    snapshot held = look(s);
    assert_ok(ax_session_keep_variant(s, "held", "", &error), &error);
    undo(s);
    undo(s);
    apply(s, "{\"op\": \"fill\", \"value\": 1.2}"); // drops the moments that led to both
    snapshot now = look(s);
    ax_session_close(s);
    for (int lost = 0; lost < 2; ++lost) {
        s = open_session(path);
        assert_shows(s, &now);
        assert_int_equal(ax_session_variants(s, &variants), 2);
        assert_string_equal(variants[0].name, "low");
        assert_string_equal(variants[0].figures, "{\"panels\": 40}");
        assert_int_equal(variants[1].at, 3);
        assert_true(fabs(variants[1].time - (double)time(NULL)) < 100);
        assert_false(variants[0].present || variants[1].present);
        assert_variant(s, "low", &low);
        assert_variant(s, "held", &held);
        assert_shows(s, &now); // looking changes nothing
        assert_ok(ax_session_copy(s, other, &error), &error);
        ax_session_close(s);
        run_sql(path, "DELETE FROM checkpoint");
    }
    assert_sound(path);

    s = open_session(other);
    assert_ok(ax_session_take_variant(s, "held", NULL, &error), &error);
    assert_shows(s, &held);
    assert_int_equal(ax_session_variants(s, &variants), 2);
    assert_true(variants[1].present && !variants[0].present);
    assert_int_equal(moments(s), 3);
    undo(s);
    assert_shows(s, &now);
    redo(s);
    assert_shows(s, &held);
    assert_int_equal(ax_session_take_variant(s, "high", NULL, &error), AX_BAD_INPUT);
    assert_says(&error, "no variant \"high\"");

    // what only a variant needed goes with it
    apply(s, "{\"op\": \"rim_free\"}");
    undo(s);
    assert_ok(ax_session_keep_variant(s, "low", "again", &error), &error); // under a name that is taken: instead of it
    assert_int_equal(ax_session_variants(s, &variants), 2);
    assert_string_equal(variants[0].figures, "again");
    assert_ok(ax_session_drop_variant(s, "low", &error), &error);
    assert_ok(ax_session_drop_variant(s, "held", &error), &error);
    assert_int_equal(ax_session_drop_variant(s, "held", &error), AX_BAD_INPUT);
    assert_shows(s, &held);
    undo(s);
    apply(s, "{\"op\": \"rim_fixed\"}");
    ax_session_close(s);
    assert_int_equal(ask_number(other, "SELECT count(*) FROM step"), 3);
    assert_int_equal(ask_number(other, "SELECT count(*) FROM checkpoint WHERE step NOT IN (SELECT id FROM step)"), 0);
    assert_sound(other);
    forget(&low);
    forget(&held);
    forget(&now);
}

static void variants_have_names_and_are_not_too_many(void** state)
{
    (void)state;
    const ax_variant* variants;
    ax_error error;
    char name[AX_VARIANT_NAME + 2];
    ax_session* s = create(path, 1, (const char*[]){CIRCLE(40)});
    memset(name, 'x', sizeof name);
    name[sizeof name - 1] = 0;
    assert_int_equal(ax_session_keep_variant(s, name, "", &error), AX_USAGE);
    assert_int_equal(ax_session_keep_variant(s, "", "", &error), AX_USAGE);
    for (int k = 0; k < AX_VARIANTS_MOST; ++k) {
        snprintf(name, sizeof name, "%d", k);
        assert_ok(ax_session_keep_variant(s, name, "", &error), &error);
    }
    assert_int_equal(ax_session_keep_variant(s, "one more", "", &error), AX_USAGE);
    assert_ok(ax_session_keep_variant(s, name, "", &error), &error);
    assert_int_equal(ax_session_variants(s, &variants), AX_VARIANTS_MOST);
    ax_session* looker;
    assert_ok(ax_session_open(path, false, NULL, NULL, &looker, &error), &error);
    assert_int_equal(ax_session_variants(looker, &variants), AX_VARIANTS_MOST);
    assert_int_equal(ax_session_keep_variant(looker, "mine", "", &error), AX_FAILED);
    assert_int_equal(ax_session_drop_variant(looker, name, &error), AX_FAILED);
    snapshot shown = look(s);
    assert_variant(looker, name, &shown);
    forget(&shown);
    ax_session_close(looker);
    ax_session_close(s);
}

// A document goes elsewhere without the files that its steps name, and is computed again from the beginning.
static void a_document_holds_what_its_files_held(void** state)
{
    (void)state;
    const char* const operators[] = {CIRCLE(60), "{\"op\": \"table\", \"file\": \"scale.csv\"}"};
    for (int changed = 0; changed < 2; ++changed) { // a file that is there counts, whatever it held before
        write_table("x,y,lambda\n-1,0,1.2\n1,0,1.7\n0,1,1.3\n0,-1,1.3\n");
        ax_session* s = create(path, 2, operators);
        snapshot was = look(s);
        ax_session_close(s);
        assert_int_equal(ask_number(path, "SELECT count(*) FROM file"), 1);
        run_sql(path, "DELETE FROM checkpoint");
        remove_table();
        if (changed)
            write_table("x,y,lambda\n-1,0,1.25\n1,0,1.25\n0,1,1.25\n0,-1,1.25\n");
        s = open_session(path);
        assert_int_equal(ax_session_at(s), 2);
        if (changed) {
            ax_form_view view = ax_form_look(ax_session_form(s));
            for (int t = 0; t < view.linkage->triangle_count; ++t)
                assert_near(view.prescribed[t], 1.25, 1e-12);
        } else {
            assert_shows(s, &was);
            undo(s); // what no step names any more is not kept
            apply(s, "{\"op\": \"fill\", \"value\": 1.4}");
            if (ask_number(path, "SELECT count(*) FROM step WHERE operator LIKE '%table%'") == 0)
                assert_int_equal(ask_number(path, "SELECT count(*) FROM file"), 0);
        }
        ax_session_close(s);
        assert_sound(path);
        forget(&was);
        unlink(path);
    }
}

static void a_finished_design_is_there_until_it_is_edited(void** state)
{
    (void)state;
    ax_session* s = create(
        path, 3, (const char*[]){CIRCLE(60), "{\"op\": \"rim_circle\", \"radius\": 1}", "{\"op\": \"inflation\"}"});
    ax_error error;
    ax_finish figures;
    const ax_design* design;
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_null(design);
    assert_ok(ax_session_finish(s, NULL, &figures, &error), &error);
    assert_true(figures.exact);
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_non_null(design);
    assert_at_most(design->report.congruence_max, 1e-9);
    snapshot finished = look(s);
    ax_session_close(s);
    ax_design loaded;
    assert_ok(ax_document_load(path, &loaded, &error), &error);

    s = open_session(path);
    apply(s, "{\"op\": \"fill\", \"value\": 1.35}");
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_null(design);
    undo(s);
    assert_shows(s, &finished);
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_same_design(design, &loaded);
    ax_session_close(s);

    // one that was dropped to save room is finished again, with the same bits
    run_sql(path, "DELETE FROM property; DELETE FROM array");
    s = open_session(path);
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_non_null(design);
    size_t hinges = (size_t)design->linkage.hinge_count;
    assert_memory_equal(design->flat, loaded.flat, hinges * sizeof *design->flat);
    assert_memory_equal(design->deployed, loaded.deployed, hinges * sizeof *design->deployed);
    assert_memory_equal(design->simulated, loaded.simulated, hinges * sizeof *design->simulated);
    assert_shows(s, &finished);

    // another load on it, without another moment
    ax_design changed = loaded;
    changed.mouth_min = 7;
    assert_ok(ax_session_put_design(s, &changed, &error), &error);
    assert_ok(ax_session_design(s, NULL, &design, &error), &error);
    assert_same_design(design, &changed);
    assert_int_equal(moments(s), 5);
    ax_session_close(s);
    ax_design_free(&loaded);
    forget(&finished);
}

static void a_copy_has_all_of_it(void** state)
{
    (void)state;
    ax_session* s = create(path, 2, (const char*[]){CIRCLE(40), "{\"op\": \"fill\", \"value\": 1.5}"});
    apply(s, "{\"op\": \"rim_fixed\"}");
    undo(s);
    snapshot shown = look(s);
    ax_error error;
    assert_ok(ax_session_copy(s, other, &error), &error);
    assert_int_equal(ax_session_copy(s, path, &error), AX_FAILED); // not onto itself
    apply(s, "{\"op\": \"rim_free\"}");
    ax_session_close(s);
    s = open_session(other);
    assert_shows(s, &shown);
    assert_int_equal(moments(s), 3);
    redo(s);
    ax_session_close(s);
    assert_sound(other);
    forget(&shown);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(history_survives_closing, clean),
        cmocka_unit_test_teardown(a_new_change_drops_what_was_undone, clean),
        cmocka_unit_test_teardown(undo_and_reopening_compute_nothing, clean),
        cmocka_unit_test_teardown(random_recipes_go_back_and_forth_with_the_same_bits, clean),
        cmocka_unit_test_teardown(an_edited_step_gives_what_a_new_recipe_gives, clean),
        cmocka_unit_test_teardown(steps_stay_ahead_after_going_back, clean),
        cmocka_unit_test_teardown(a_step_that_fails_later_is_named_and_can_be_mended, clean),
        cmocka_unit_test_teardown(cancelling_changes_nothing, clean),
        cmocka_unit_test_teardown(a_recipe_that_fails_makes_nothing_or_what_came_before, clean),
        cmocka_unit_test_teardown(an_empty_document_takes_a_start, clean),
        cmocka_unit_test_teardown(nothing_acknowledged_is_lost_when_killed, clean),
        cmocka_unit_test_teardown(a_full_disk_leaves_the_document, clean),
        cmocka_unit_test_teardown(a_damaged_checkpoint_is_computed_again, clean),
        cmocka_unit_test_teardown(a_contradictory_history_is_refused, clean),
        cmocka_unit_test_teardown(flipped_bytes_are_found_or_harmless, clean),
        cmocka_unit_test_teardown(a_second_program_is_told_and_may_only_read, clean),
        cmocka_unit_test_teardown(one_of_many_gets_the_lock, clean),
        cmocka_unit_test_teardown(a_document_of_version_1_is_upgraded_by_its_first_change, clean),
        cmocka_unit_test_teardown(a_document_of_version_2_is_upgraded_by_its_first_change, clean),
        cmocka_unit_test_teardown(a_document_of_version_3_is_upgraded_by_its_first_variant, clean),
        cmocka_unit_test_teardown(variants_outlive_the_history_that_led_to_them, clean),
        cmocka_unit_test_teardown(variants_have_names_and_are_not_too_many, clean),
        cmocka_unit_test_teardown(a_document_holds_what_its_files_held, clean),
        cmocka_unit_test_teardown(a_finished_design_is_there_until_it_is_edited, clean),
        cmocka_unit_test_teardown(a_copy_has_all_of_it, clean),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
