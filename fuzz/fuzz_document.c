// Documents changed at random: raw bytes of the file, or values that are sealed again, so that only the checks behind the seal
// stand between them and the program. What loads can be saved and exported.
#include "ax/document.h"
#include "ax/export.h"
#include "document/schema.h"
#include "file.h"
#include "support/sample.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
int LLVMFuzzerInitialize(int* argc, char*** argv);

static char path[] = "/dev/shm/fuzz_document_XXXXXX";
static unsigned char* original;
static size_t original_size;

static void remove_file(void)
{
    unlink(path);
}

int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    (void)argc, (void)argv;
    ax_design design = sample_design();
    int descriptor = mkstemp(path);
    promise(descriptor >= 0);
    close(descriptor);
    atexit(remove_file);
    promise(ax_document_save(path, &design, NULL) == AX_OK);
    ax_design_free(&design);
    original = read_file(path, &original_size);
    return 0;
}

typedef struct edit {
    uint32_t place;
    uint8_t row, value;
} edit;

static void change_bytes(const edit* edits, size_t count)
{
    unsigned char* bytes = malloc(original_size);
    memcpy(bytes, original, original_size);
    for (size_t k = 0; k < count; ++k) // the row chooses the beginning of the file more often than its size would
        bytes[edits[k].place % (edits[k].row % 2 ? original_size : 8192)] = edits[k].value;
    write_file(path, bytes, original_size);
    free(bytes);
}

// Even rows change a byte of an array, odd ones a property.
static void change_values(const edit* edits, size_t count)
{
    write_file(path, original, original_size);
    sqlite3* db;
    promise(sqlite3_open(path, &db) == SQLITE_OK);
    sqlite3_exec(db, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN", NULL, NULL, NULL);
    for (size_t k = 0; k < count; ++k) {
        sqlite3_blob* blob;
        if (edits[k].row % 2 == 0 &&
            sqlite3_blob_open(db, "main", "array", "data", 1 + edits[k].row / 2 % 20, 1, &blob) == SQLITE_OK) {
            int bytes = sqlite3_blob_bytes(blob);
            sqlite3_blob_write(blob, &edits[k].value, 1, bytes ? (int)(edits[k].place % (uint32_t)bytes) : 0);
            sqlite3_blob_close(blob);
            continue;
        }
        static const char* const values[] = {"value + 1",      "value - 1",  "-value", "value * 1e300", "NULL",
                                             "9e999",          "0",          "'m'",    "'none'",        "x'00ff'",
                                             "zeroblob(4000)", "2147483647", "1.5",    "-1 << 40"};
        char* sql =
            sqlite3_mprintf("UPDATE property SET value = %s WHERE rowid = %d",
                            values[edits[k].value % (sizeof values / sizeof *values)], (int)(edits[k].place % 90));
        sqlite3_exec(db, sql, NULL, NULL, NULL);
        sqlite3_free(sql);
    }
    promise(ax_schema_seal(db) == SQLITE_OK);
    sqlite3_exec(db, "COMMIT", NULL, NULL, NULL);
    sqlite3_close(db);
}

static void use(const ax_design* design)
{
    int count;
    const ax_export_type* const* types = ax_export_types(&count);
    for (int k = 0; k < count; ++k)
        if (types[k]->write && strcmp(types[k]->ending, ".png") != 0) // slow, and of another module
            types[k]->write(design, types[k]->default_state, &(ax_export_options){0}, "/dev/null", NULL);
    promise(ax_document_save(path, design, NULL) == AX_OK);
    ax_design again;
    promise(ax_document_load(path, &again, NULL) == AX_OK);
    ax_design_free(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    if (size < 1)
        return 0;
    edit edits[64];
    size_t count = 0;
    for (const uint8_t* at = data + 1; at + 6 <= data + size && count < 64; at += 6, ++count) {
        memcpy(&edits[count].place, at, 4);
        edits[count].row = at[4], edits[count].value = at[5];
    }
    if (data[0] % 4 == 0)
        change_bytes(edits, count);
    else
        change_values(edits, count);
    ax_design design;
    ax_error error = {0};
    if (ax_document_load(path, &design, &error) == AX_OK) {
        use(&design);
        ax_design_free(&design);
    } else
        promise(strlen(error.message) > 20 && error.message[strlen(error.message) - 1] == '.');
    return 0;
}
