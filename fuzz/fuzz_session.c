// Documents with history changed at random: raw bytes of the file, or values of its tables that are sealed again. What opens can be
// walked along, edited and opened again.
#include "ax/session.h"
#include "document/schema.h"
#include "file.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerInitialize(int* argc, char*** argv);

static char folder[] = "/dev/shm/fuzz_session_XXXXXX", path[64];
static unsigned char* original;
static size_t original_size;

static void remove_folder(void)
{
    char journal[80], lock[80];
    snprintf(journal, sizeof journal, "%s-journal", path);
    snprintf(lock, sizeof lock, "%s/.a.auxshell.lock", folder);
    unlink(journal);
    unlink(lock);
    unlink(path);
    rmdir(folder);
}

int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    (void)argc, (void)argv;
    static const char* const steps[] = {
        "{\"op\": \"start_circle\", \"radius\": 1, \"triangles\": 24, \"scale\": 1.4}",
        "{\"op\": \"rim_circle\", \"radius\": 1.1}",
        "{\"op\": \"select\", \"name\": \"few\", \"hinges\": \"0-3\"}",
        "{\"op\": \"fill\", \"value\": 1.5}",
    };
    promise(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.auxshell", folder);
    atexit(remove_folder);
    ax_recipe* recipe = ax_recipe_make();
    for (int k = 0; k < 4; ++k)
        promise(ax_recipe_insert(recipe, k, steps[k], NULL) == AX_OK);
    ax_session* session;
    promise(ax_session_create(path, &(ax_session_start){.recipe = recipe, .until = -1}, NULL, &session, NULL) == AX_OK);
    promise(ax_session_undo(session, NULL, NULL) == AX_OK);
    ax_session_close(session);
    ax_recipe_free(recipe);
    original = read_file(path, &original_size);
    return 0;
}

static void change_bytes(const uint8_t* edits, size_t size)
{
    unsigned char* bytes = malloc(original_size);
    memcpy(bytes, original, original_size);
    for (; size >= 4; edits += 4, size -= 4) // three bytes of place: some beyond the tables' roots
        bytes[(edits[0] | edits[1] << 8 | (edits[2] % 4) << 16) % original_size] = edits[3];
    write_file(path, bytes, original_size);
    free(bytes);
}

// Three bytes an edit: column, row, value. The rest is a text that takes an operator's place.
static void change_values(const uint8_t* edits, size_t size)
{
    static const char* const columns[][2] = {
        {"moment", "tip"},     {"moment", "state"},    {"moment", "steps"},    {"moment", "at"},
        {"moment", "number"},  {"moment", "words"},    {"moment", "time"},     {"moment", "failure"},
        {"step", "parent"},    {"step", "id"},         {"step", "operator"},   {"session", "now"},
        {"session", "folder"}, {"checkpoint", "form"}, {"checkpoint", "step"}, {"checkpoint", "digest"}};
    static const char* const values[] = {"0",   "1",     "2",          "3",       "4",   "-1",    "NULL",
                                         "'x'", "x'00'", "2147483647", "1 << 40", "1.5", "9e999", "zeroblob(40)"};
    write_file(path, original, original_size);
    sqlite3* db;
    promise(sqlite3_open(path, &db) == SQLITE_OK);
    sqlite3_exec(db, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN", NULL, NULL, NULL);
    for (; size >= 3 && edits[0] != 255; edits += 3, size -= 3) {
        const char* const* column = columns[edits[0] % (sizeof columns / sizeof *columns)];
        char* sql = sqlite3_mprintf("UPDATE OR IGNORE %s SET %s = %s WHERE rowid = %d", column[0], column[1],
                                    values[edits[2] % (sizeof values / sizeof *values)], edits[1] % 5);
        sqlite3_exec(db, sql, NULL, NULL, NULL);
        sqlite3_free(sql);
    }
    if (size >= 2) {
        char* sql =
            sqlite3_mprintf("UPDATE step SET operator = '%.*q' WHERE id = %d; DELETE FROM checkpoint WHERE step >= %d",
                            (int)size - 2, (const char*)edits + 2, edits[1] % 5, edits[1] % 5);
        sqlite3_exec(db, sql, NULL, NULL, NULL);
        sqlite3_free(sql);
    }
    promise(ax_schema_seal(db) == SQLITE_OK);
    sqlite3_exec(db, "COMMIT", NULL, NULL, NULL);
    sqlite3_close(db);
}

static bool go_on(void* context, const char* stage, double fraction, double residual)
{
    (void)stage, (void)fraction, (void)residual;
    return --*(int*)context > 0; // an operator that asks for much is not waited for
}

static void check_error(const ax_error* error)
{
    promise(strlen(error->message) > 10 && strchr(".?", error->message[strlen(error->message) - 1]));
}

static void use(ax_session* session)
{
    int left = 300;
    const ax_progress progress = {go_on, &left};
    ax_error error = {0};
    const ax_design* design;
    if (ax_session_design(session, &progress, &design, &error) != AX_OK)
        check_error(&error);
    if (ax_session_undo(session, &progress, &error) != AX_OK)
        check_error(&error);
    if (ax_session_apply(session, "{\"op\": \"rim_free\"}", &progress, &error) != AX_OK)
        check_error(&error);
    else {
        char* recipe = ax_recipe_text(ax_session_recipe(session));
        ax_session_close(session);
        promise(ax_session_open(path, false, NULL, NULL, &session, &error) == AX_OK);
        char* again = ax_recipe_text(ax_session_recipe(session));
        promise(strcmp(recipe, again) == 0);
        ax_free(recipe);
        ax_free(again);
    }
    ax_session_close(session);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size < 1)
        return 0;
    if (data[0] % 4 == 0)
        change_bytes(data + 1, size - 1);
    else
        change_values(data + 1, size - 1);
    int left = 300;
    ax_session* session;
    ax_error error = {0};
    if (ax_session_open(path, true, NULL, &(ax_progress){go_on, &left}, &session, &error) == AX_OK)
        use(session);
    else
        check_error(&error);
    return 0;
}
