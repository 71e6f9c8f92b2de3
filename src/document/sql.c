#include "document/sql.h"

#include <assert.h>
#include <stdarg.h>
#include <stddef.h>

static sqlite3_stmt* ask(sqlite3* db, const char* sql, const char* types, va_list values)
{
    sqlite3_stmt* statement = NULL;
    int result = sqlite3_prepare_v2(db, sql, -1, &statement, NULL);
    for (int k = 1; *types && result == SQLITE_OK; ++k, ++types)
        switch (*types) {
        case 'i':
            result = sqlite3_bind_int64(statement, k, va_arg(values, int64_t));
            break;
        case 'd':
            result = sqlite3_bind_double(statement, k, va_arg(values, double));
            break;
        case 't':
            result = sqlite3_bind_text(statement, k, va_arg(values, const char*), -1, SQLITE_STATIC);
            break;
        default: {
            assert(*types == 'b');
            const void* bytes = va_arg(values, const void*);
            result = sqlite3_bind_blob64(statement, k, bytes, va_arg(values, size_t), SQLITE_STATIC);
        }
        }
    if (result == SQLITE_OK)
        return statement;
    sqlite3_finalize(statement);
    return NULL;
}

sqlite3_stmt* ax_sql_ask(sqlite3* db, const char* sql, const char* types, ...)
{
    va_list values;
    va_start(values, types);
    sqlite3_stmt* statement = ask(db, sql, types, values);
    va_end(values);
    return statement;
}

int ax_sql_run(sqlite3* db, const char* sql, const char* types, ...)
{
    va_list values;
    va_start(values, types);
    sqlite3_stmt* statement = ask(db, sql, types, values);
    va_end(values);
    if (!statement)
        return sqlite3_errcode(db);
    int result = sqlite3_step(statement);
    sqlite3_finalize(statement);
    return result == SQLITE_DONE || result == SQLITE_ROW ? SQLITE_OK : result;
}

int ax_sql_next(sqlite3_stmt* rows, int* result)
{
    int stepped = rows ? sqlite3_step(rows) : SQLITE_ERROR;
    if (stepped != SQLITE_ROW && stepped != SQLITE_DONE && *result == SQLITE_OK)
        *result = stepped;
    return stepped == SQLITE_ROW;
}
