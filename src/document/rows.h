// Values and arrays of a document, to and from rows of its tables. One description of a design serves both directions, so that
// what is saved and what is loaded cannot drift apart.
#pragma once

#include "ax/base.h"

#include <sqlite3.h>

typedef enum ax_element { AX_F64, AX_I32, AX_U8 } ax_element;

// After the first failure every call does nothing, so that a description needs no checks between.
typedef struct ax_rows {
    sqlite3* db;
    sqlite3_int64 design;
    bool loading;
    int result;       // of SQLite
    char damaged[64]; // name of the first row that does not hold what it should, else empty
    sqlite3_stmt *property, *array;
} ax_rows;

// Of the design with this number.
ax_rows ax_rows_begin(sqlite3* db, sqlite3_int64 design, bool loading);
void ax_rows_end(ax_rows* rows);
bool ax_rows_sound(const ax_rows* rows);
void ax_rows_damaged(ax_rows* rows, const char* name);

// Each writes `value`, or replaces it by what is stored. Reals may be NaN, which is stored as NULL.
void ax_rows_real(ax_rows* rows, const char* name, double* value);
void ax_rows_whole(ax_rows* rows, const char* name, int* value, int lo, int hi);
void ax_rows_flag(ax_rows* rows, const char* name, bool* value);
// Writes `now`, or reads into `text`. True when something was read.
bool ax_rows_word(ax_rows* rows, const char* name, const char* now, char text[16]);
// Writes `count` rows of `width` elements, or returns what is stored in a new block if it has that size. Reals are finite. NULL is
// stored as no row; with `optional`, no row is read as NULL, else it is damage.
void* ax_rows_array(ax_rows* rows, const char* name, ax_element type, int width, int count, bool optional, void* now);
