// Documents: nothing is lost, nothing half-written is ever seen, and no file makes the program fall over.
#include "ax/document.h"

#include "base/clock.h"
#include "base/random.h"
#include "document/load.h"
#include "support/compare.h"
#include "support/sample.h"
#include "support/test.h"

#include <dirent.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/ax_document_XXXXXX";
static char path[64], other[64];
static ax_design sample;

static int set_up(void** state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/dome.auxshell", folder);
    snprintf(other, sizeof other, "%s/other.auxshell", folder);
    sample = sample_design();
    // fields that a good design leaves at zero are told apart too
    sample.repairs = (ax_mesh_repairs){1, 2, 3, 4, 5, true};
    sample.projected = true;
    sample.projection = (ax_projection){0.25, 0.125, 1e-300, 0x1.fffffffffffffp-3, 7};
    sample.border = AX_BORDER_RELEASED;
    sample.load.direction[0] = -0.0, sample.load.direction[2] = -1;
    return 0;
}

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

static int tear_down(void** state)
{
    (void)state;
    remove_files();
    rmdir(folder);
    ax_design_free(&sample);
    return 0;
}

static void assert_ok(ax_status status, const ax_error* error)
{
    if (status != AX_OK)
        fail_msg("%s", error->message);
}

static void save(const char* to, const ax_design* design)
{
    ax_error error;
    assert_ok(ax_document_save(to, design, &error), &error);
}

static ax_design load(const char* from)
{
    ax_error error;
    ax_design design;
    assert_ok(ax_document_load(from, &design, &error), &error);
    return design;
}

// Loading fails as bad input with the file's name and `word` in the message, and leaves an empty design.
static void assert_refused(const char* from, const char* word)
{
    ax_error error = {0};
    ax_design design;
    memset(&design, 1, sizeof design);
    assert_int_equal(ax_document_load(from, &design, &error), AX_BAD_INPUT);
    assert_int_equal(error.status, AX_BAD_INPUT);
    if (!strstr(error.message, word) || !strstr(error.message, from))
        fail_msg("\"%s\" does not name %s and \"%s\"", error.message, from, word);
    assert_null(design.flat);
    assert_null(design.linkage.triangles);
}

static unsigned char* read_bytes(const char* from, size_t* size)
{
    FILE* in = fopen(from, "rb");
    assert_non_null(in);
    fseek(in, 0, SEEK_END);
    *size = (size_t)ftell(in);
    rewind(in);
    unsigned char* bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, in), *size);
    fclose(in);
    return bytes;
}

static void write_bytes(const char* to, const void* bytes, size_t size)
{
    FILE* out = fopen(to, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static void run_sql(const char* on, const char* sql)
{
    sqlite3* db;
    char* message = NULL;
    assert_int_equal(sqlite3_open(on, &db), SQLITE_OK);
    if (sqlite3_exec(db, sql, NULL, NULL, &message) != SQLITE_OK)
        fail_msg("%s: %s", sql, message);
    sqlite3_close(db);
}

static void reseal(const char* on)
{
    sqlite3* db;
    assert_int_equal(sqlite3_open(on, &db), SQLITE_OK);
    assert_int_equal(ax_schema_seal(db), SQLITE_OK);
    sqlite3_close(db);
}

// Saves the sample, overwrites a part of one of its arrays, seals it again: only the checks of the contents can refuse it.
static void assert_patch_refused(const char* array, int at, const void* bytes, int count, const char* word)
{
    sqlite3* db;
    sqlite3_stmt* row;
    sqlite3_blob* blob;
    save(other, &sample);
    assert_int_equal(sqlite3_open(other, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "SELECT rowid FROM array WHERE name = ?", -1, &row, NULL), SQLITE_OK);
    sqlite3_bind_text(row, 1, array, -1, SQLITE_STATIC);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    sqlite3_int64 id = sqlite3_column_int64(row, 0);
    sqlite3_finalize(row);
    assert_int_equal(sqlite3_blob_open(db, "main", "array", "data", id, 1, &blob), SQLITE_OK);
    assert_int_equal(sqlite3_blob_write(blob, bytes, count, at), SQLITE_OK);
    sqlite3_blob_close(blob);
    assert_int_equal(ax_schema_seal(db), SQLITE_OK);
    sqlite3_close(db);
    assert_refused(other, word);
}

static int count_files(void)
{
    int count = 0;
    DIR* entries = opendir(folder);
    for (struct dirent* entry; (entry = readdir(entries));)
        count += entry->d_name[0] != '.';
    closedir(entries);
    return count;
}

static void a_design_comes_back_bit_for_bit(void** state)
{
    (void)state;
    save(path, &sample);
    ax_design back = load(path);
    assert_same_design(&sample, &back);
    assert_true(signbit(back.load.direction[0])); // the sign of zero too
    ax_design_free(&back);
    assert_int_equal(count_files(), 1);
}

static void a_design_without_target_and_simulation_comes_back(void** state)
{
    (void)state;
    ax_design bare = sample;
    bare.simulated = NULL, bare.forces = NULL, bare.edge_forces = NULL;
    bare.target = (ax_mesh){0};
    bare.report.force_residual = NAN;
    save(path, &bare);
    ax_design back = load(path);
    assert_same_design(&bare, &back);
    assert_true(isnan(back.report.force_residual));
    ax_design_free(&back);
}

static void saving_the_same_design_gives_the_same_bytes(void** state)
{
    (void)state;
    size_t n, m;
    save(path, &sample);
    ax_design back = load(path);
    save(other, &back);
    unsigned char *a = read_bytes(path, &n), *b = read_bytes(other, &m);
    assert_int_equal(n, m);
    assert_memory_equal(a, b, n);
    free(a);
    free(b);
    ax_design_free(&back);
}

static void a_document_is_a_sound_database_that_sql_can_ask(void** state)
{
    (void)state;
    save(path, &sample);
    sqlite3* db;
    sqlite3_stmt* row;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "PRAGMA integrity_check", -1, &row, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    assert_string_equal((const char*)sqlite3_column_text(row, 0), "ok");
    sqlite3_finalize(row);
    assert_int_equal(
        sqlite3_prepare_v2(db, "SELECT value FROM property WHERE name = 'report.edge_mean'", -1, &row, NULL),
        SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    assert_near(sqlite3_column_double(row, 0), sample.report.edge_mean, 0);
    sqlite3_finalize(row);
    sqlite3_close(db);
}

static void what_is_no_document_is_refused_by_name(void** state)
{
    (void)state;
    assert_refused("/nowhere/dome.auxshell", "no file");
    assert_refused(folder, "folder");
    write_bytes(path, "", 0);
    assert_refused(path, "not an Auxshell document");
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write_bytes(path, text, sizeof text);
    assert_refused(path, "not an Auxshell document");
    unlink(path);
    run_sql(path, "CREATE TABLE a(b); PRAGMA user_version = 3");
    assert_refused(path, "another program");
    unlink(path);
    run_sql(path, "PRAGMA application_id = 0x41585348; PRAGMA user_version = 1; CREATE TABLE property(a, b)");
    assert_refused(path, "damaged");
    assert_refused("/dev/null", "not a file");
}

static void a_newer_document_is_refused_by_its_version(void** state)
{
    (void)state;
    unlink(path);
    save(path, &sample);
    run_sql(path, "PRAGMA user_version = 77");
    assert_refused(path, "version 77");
}

// Opens a document under a schema, which must neither lose anything nor touch the file.
static ax_design upgrade(const ax_schema* schema, const char* from)
{
    size_t n, m;
    unsigned char* before = read_bytes(from, &n);
    ax_error error;
    ax_design back;
    assert_ok(ax_document_load_as(schema, from, &back, &error), &error);
    unsigned char* after = read_bytes(from, &m);
    assert_int_equal(n, m);
    assert_memory_equal(before, after, n);
    free(before);
    free(after);
    return back;
}

static void a_document_of_a_coming_version_can_be_reached(void** state)
{
    (void)state;
    const char* steps[] = {
        ax_document_schema.steps[0],
        ax_document_schema.steps[1],
        ax_document_schema.steps[2],
        ax_document_schema.steps[3],
        ax_document_schema.steps[4],
        "ALTER TABLE property RENAME TO old;"
        "CREATE TABLE property(design INTEGER, name TEXT NOT NULL, value, note TEXT, PRIMARY KEY(design, name));"
        "INSERT INTO property SELECT design, name, value, 'from version 5' FROM old; DROP TABLE old",
    };
    const ax_schema next = {.version = 6, .steps = steps};
    save(path, &sample);
    ax_design back = upgrade(&next, path);
    assert_same_design(&sample, &back);
    ax_design_free(&back);
}

// The file was written by the program when documents had version 1.
static void a_document_of_version_1_is_read(void** state)
{
    (void)state;
    ax_design back = upgrade(&ax_document_schema, AX_SOURCE_DIR "/tests/documents/version-1.auxshell");
    assert_int_equal(back.linkage.triangle_count, 42);
    assert_non_null(back.simulated);
    ax_report was = back.report;
    ax_design_measure(&back); // what was measured then is what the states say now
    assert_near(back.report.edge_mean, was.edge_mean, 1e-12);
    assert_near(back.report.scale_max, was.scale_max, 1e-12);
    assert_near(back.report.simulated_rms_over_L, was.simulated_rms_over_L, 1e-12);
    assert_string_equal(ax_report_opening(&back.report), "opened from flat in one go"); // there was no other way then
    ax_design_free(&back);
}

// Every flipped bit in the data is found; one in what SQLite leaves unused may do no harm.
static void flipped_bytes_are_found(void** state)
{
    (void)state;
    save(path, &sample);
    size_t size;
    unsigned char* bytes = read_bytes(path, &size);
    ax_random random = {20180701};
    int refused = 0, harmless = 0;
    for (int round = 0; round < 600; ++round) {
        unsigned char was[8];
        size_t place[8], count = 1 + ax_random_bits(&random) % 8;
        for (size_t k = 0; k < count; ++k) {
            // most pages hold blobs; a third of the flips goes to the header and the tables' roots
            place[k] = ax_random_bits(&random) % (round % 3 ? size : 4096);
            was[k] = bytes[place[k]];
            bytes[place[k]] ^= (unsigned char)(1 + ax_random_bits(&random) % 255);
        }
        write_bytes(other, bytes, size);
        ax_design back;
        ax_error error = {0};
        ax_status status = ax_document_load(other, &back, &error);
        if (status == AX_OK) {
            assert_same_design(&sample, &back);
            ++harmless;
        } else {
            assert_true(strlen(error.message) > 20);
            ++refused;
        }
        ax_design_free(&back);
        for (size_t k = count; k-- > 0;)
            bytes[place[k]] = was[k];
    }
    free(bytes);
    assert_true(refused > 300);
    assert_true(harmless < 300);
}

static void truncated_documents_are_refused(void** state)
{
    (void)state;
    save(path, &sample);
    size_t size;
    unsigned char* bytes = read_bytes(path, &size);
    for (size_t keep = 1; keep < size; keep += 1 + size / 97) {
        write_bytes(other, bytes, keep);
        assert_refused(other, "");
    }
    free(bytes);
}

// Damage that somebody has sealed again: the checks below the seal must hold alone.
static void contradictory_contents_are_refused(void** state)
{
    (void)state;
    static const struct {
        const char *sql, *word;
    } cases[] = {
        {"UPDATE property SET value = 1000000 WHERE name = 'hinge_count'", "on_rim"},
        {"UPDATE property SET value = -1 WHERE name = 'triangle_count'", "triangle_count"},
        {"UPDATE property SET value = 'inch' WHERE name = 'unit'", "unit"},
        {"UPDATE property SET value = 'a very long name indeed' WHERE name = 'border'", "border"},
        {"UPDATE property SET value = zeroblob(8) WHERE name = 'border'", "border"},
        {"UPDATE property SET value = 7 WHERE name = 'mouth_min'", "mouth_min"}, // not a real
        {"UPDATE property SET value = 9999 WHERE name = 'report.overlap_first.0'", "report"},
        {"UPDATE property SET value = 1e30 WHERE name = 'report.newton_steps'", "newton_steps"},
        {"DELETE FROM property WHERE name = 'report.edge_mean'", "edge_mean"},
        {"DELETE FROM array WHERE name = 'flat'", "flat"},
        {"DELETE FROM array WHERE name = 'forces'", "forces"},
        {"DELETE FROM array WHERE name = 'target_faces'", "target"},
        {"UPDATE array SET data = substr(data, 2) WHERE name = 'deployed'", "deployed"},
        {"UPDATE array SET type = 'i32' WHERE name = 'scale'", "scale"},
        {"UPDATE array SET width = 3 WHERE name = 'flat'", "flat"},
        {"UPDATE array SET data = CAST(data AS TEXT) WHERE name = 'supports'", "supports"},
        {"UPDATE array SET data = zeroblob(length(data)) WHERE name = 'on_rim'", "not marked"},
        {"CREATE TRIGGER t AFTER INSERT ON property BEGIN SELECT 1; END", "tables"},
        {"ALTER TABLE array RENAME TO a; CREATE VIEW array AS SELECT * FROM a", "tables"},
        {"DELETE FROM property WHERE name <> 'border'", "unit"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        save(other, &sample);
        run_sql(other, cases[k].sql);
        reseal(other);
        assert_refused(other, cases[k].word);
    }
    save(other, &sample);
    run_sql(other, "UPDATE property SET value = 3.5 WHERE name = 'mouth_min'"); // sound, but not what was saved
    assert_refused(other, "not what was saved");
    run_sql(other, "DELETE FROM seal");
    assert_refused(other, "not what was saved");
}

static void arrays_that_contradict_each_other_are_refused(void** state)
{
    (void)state;
    const ax_linkage* l = &sample.linkage;
    const int wrong[] = {-1, l->hinge_count, INT_MIN, INT_MAX}, two = 2, far = AX_PANEL_LIMIT + 1;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        assert_patch_refused("triangles", 4, &wrong[k], 4, "Triangle 0 names hinge");
        assert_patch_refused("hole_hinges", 8, &wrong[k], 4, "Hole 0 names hinge");
        assert_patch_refused("opening_hinges", 4, &wrong[k], 4, "Opening 0 names hinge");
        assert_patch_refused("hole_start", 4, &wrong[k], 4, "hole_");
    }
    assert_patch_refused("target_faces", 12, &wrong[0], 4, "Face 1 of the target surface");
    assert_patch_refused("target_faces", 12, &sample.target.vertex_count, 4, "Face 1 of the target surface");
    assert_patch_refused("triangles", 0, &l->triangles[0][1], 4, "twice");
    assert_patch_refused("triangles", 0, l->triangles[1], 12, "Hinge");
    assert_patch_refused("panels", 4, &far, 4, "no place in the lattice");
    assert_patch_refused("panels", 8, &two, 4, "no place in the lattice");
    assert_patch_refused("on_rim", 5, &two, 1, "neither 0 nor 1");
    assert_patch_refused("supports", 5, &two, 1, "neither 0 nor 1");
    const int turned[2] = {l->hole_hinges[1], l->hole_hinges[0]};
    assert_patch_refused("hole_hinges", 0, turned, 8, "Hole 0 goes from hinge");
    assert_patch_refused("opening_hinges", 0, &l->opening_hinges[1], 4, "Opening 0");
    assert_patch_refused("target_faces", 0, sample.target.faces[1], 12, "target surface");
    const double bad[] = {NAN, INFINITY};
    for (int k = 0; k < 2; ++k) {
        assert_patch_refused("flat", 16, &bad[k], 8, "flat");
        assert_patch_refused("simulated", 0, &bad[k], 8, "simulated");
        assert_patch_refused("scale", 8, &bad[k], 8, "scale");
    }
}

static void a_killed_save_leaves_the_old_or_the_new_document(void** state)
{
    (void)state;
    ax_design changed = sample;
    changed.mouth_min = 33;
    double start = ax_seconds(); // a save and another one
    save(path, &changed);
    save(path, &sample);
    double duration = 1e6 * (ax_seconds() - start);
    ax_random random = {7};
    int old = 0;
    for (int round = 0; round < 40; ++round) {
        pid_t child = fork();
        if (child == 0)
            for (int k = 0;; ++k)
                if (ax_document_save(path, k % 2 ? &sample : &changed, NULL) != AX_OK)
                    _exit(1);
        usleep((useconds_t)ax_random_uniform(&random, 0.1 * duration, 3 * duration));
        int ended;
        assert_int_equal(waitpid(child, &ended, WNOHANG), 0); // still saving
        kill(child, SIGKILL);
        waitpid(child, &ended, 0);
        ax_design back = load(path);
        if (same_design(&back, &sample))
            ++old;
        else
            assert_same_design(&back, &changed);
        ax_design_free(&back);
    }
    assert_in_range(old, 1, 39); // both have been seen
    remove_files();
}

static void a_full_disk_leaves_the_old_document(void** state)
{
    (void)state;
    save(path, &sample);
    size_t size;
    free(read_bytes(path, &size));
    for (rlim_t room = 0; room < size; room += size / 7) {
        fflush(NULL);
        pid_t child = fork();
        if (child == 0) {
            ax_error error = {0};
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){room, room});
            ax_design changed = sample;
            changed.mouth_min = 33;
            ax_status status = ax_document_save(path, &changed, &error);
            _exit(status == AX_FAILED && strstr(error.message, path) && strstr(error.message, "Nothing was changed")
                      ? 0
                      : 1);
        }
        int ended;
        waitpid(child, &ended, 0);
        assert_int_equal(ended, 0);
        ax_design back = load(path);
        assert_same_design(&sample, &back);
        ax_design_free(&back);
        assert_int_equal(count_files(), 1);
    }
}

static void a_folder_that_cannot_be_written_is_named(void** state)
{
    (void)state;
    ax_error error;
    assert_int_equal(ax_document_save("/nowhere/dome.auxshell", &sample, &error), AX_FAILED);
    assert_non_null(strstr(error.message, "/nowhere/dome.auxshell"));
    assert_int_equal(ax_document_save(folder, &sample, &error), AX_FAILED);
    assert_non_null(strstr(error.message, "folder"));

    save(path, &sample);
    chmod(folder, 0555);
    pid_t child = fork();
    if (child == 0) { // root may write anywhere
        ax_error inner = {0};
        if (geteuid() == 0 && setuid(65534) != 0)
            _exit(2);
        ax_status status = ax_document_save(path, &sample, &inner);
        _exit(status == AX_FAILED && strstr(inner.message, "Permission denied") ? 0 : 1);
    }
    int ended;
    waitpid(child, &ended, 0);
    chmod(folder, 0755);
    assert_int_equal(ended, 0);
    assert_int_equal(count_files(), 1);
    ax_design back = load(path);
    assert_same_design(&sample, &back);
    ax_design_free(&back);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_design_comes_back_bit_for_bit),
        cmocka_unit_test(a_design_without_target_and_simulation_comes_back),
        cmocka_unit_test(saving_the_same_design_gives_the_same_bytes),
        cmocka_unit_test(a_document_is_a_sound_database_that_sql_can_ask),
        cmocka_unit_test(what_is_no_document_is_refused_by_name),
        cmocka_unit_test(a_newer_document_is_refused_by_its_version),
        cmocka_unit_test(a_document_of_a_coming_version_can_be_reached),
        cmocka_unit_test(a_document_of_version_1_is_read),
        cmocka_unit_test(flipped_bytes_are_found),
        cmocka_unit_test(truncated_documents_are_refused),
        cmocka_unit_test(contradictory_contents_are_refused),
        cmocka_unit_test(arrays_that_contradict_each_other_are_refused),
        cmocka_unit_test(a_killed_save_leaves_the_old_or_the_new_document),
        cmocka_unit_test(a_full_disk_leaves_the_old_document),
        cmocka_unit_test(a_folder_that_cannot_be_written_is_named),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
